# SPDX-License-Identifier: BSD-3-Clause
"""Header fields that say the same thing twice are compared.

| format | refused: data that are not there | told in a note: what may be a damaged number, or a setting changed later |
|---|---|---|
| Igor (.ibw) | (check sum and lengths: before any reader sees it) | size of the scan in the note and pixel size |
| Nanosurf (.nid) | file shorter or longer than its channels | size, points and lines in the scan's section |
| Digital Surf (.sur) | file shorter or longer than its pixels; no surface, no height | lowest and highest height |
| PicoView (.mi) | file shorter or longer than its channels | |

No format promises the second column, so it does not refuse a file. The others say nothing twice, or their reader
compares it already (.gwy: array length and pixels).
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ReadError
from .channel import Plane, other_kind
from .checks import LENGTHS

Meta = Mapping[str, Any]
_SURF, _SURF_HEADER = b"DIGITAL SURF", 512
_SURFACE, _INVERSIONS = 2, 3  # type of an object; highest of the ways to turn it over
_TOLERANCE = 2e-3  # of numbers printed with few digits
_NUMBER = r"([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)"


def cross_check(file: Path, format_: str, meta: Meta, plane: Plane) -> tuple[str, ...]:
    """What its header contradicts itself in; a file that lacks data is refused."""
    return tuple(text for text in _CHECKS[format_](file, meta, plane) if text) if format_ in _CHECKS else ()


def _differ(first: tuple[str, float], second: tuple[str, float], tolerance: float = _TOLERANCE) -> str:
    (what, a), (other, b) = first, second
    if abs(a - b) <= tolerance * max(abs(a), abs(b)):
        return ""
    return f"its header contradicts itself: {what} {a:.6g}, but {other} {b:.6g}"


def _check_held(file: Path, held: int, needed: int, line: int) -> None:
    """Refuse data that end early, and those that go on for a `line` [byte] or more: lines or points are then others."""
    if held < needed:
        raise ReadError(f"{file}: {held} bytes of data, but its header states {needed}: it is cut off or damaged")
    if held >= needed + line:
        raise ReadError(
            f"{file}: {held} bytes of data, but its header states {needed}: its points, lines or bits are wrong"
        )


def _length(text: str) -> float | None:
    """``"10 um"`` in metres; None where it is no length."""
    match = re.match(rf"\s*{_NUMBER}\s*(\S+)", text.replace("~m", "um"))
    return float(match[1]) * LENGTHS[match[2]] if match and match[2] in LENGTHS else None


def _igor(file: Path, meta: Meta, plane: Plane) -> Iterator[str]:
    assert plane.pixel_size is not None
    ny, nx = plane.values.shape
    lines, stated_nx = (_positive(meta.get(key)) for key in ("ScanLines", "ScanPoints"))
    if lines and stated_nx and lines * stated_nx == nx * ny and lines != ny:
        raise ReadError(f"{file}: {nx} x {ny} pixels, but its note states {stated_nx:g} x {lines:g}")
    for axis, key, points in ((1, "FastScanSize", "ScanPoints"), (0, "SlowScanSize", "ScanLines")):
        count, pitch = plane.values.shape[axis], plane.pixel_size[axis]
        stated = _positive(meta.get(key))
        if stated is not None and _positive(meta.get(points)) == count:  # else it was cropped or stopped
            yield _differ((f"{key} [m]", stated), ("pixels times their size [m]", count * pitch), 2.0 / count)


def _positive(value: Any) -> float | None:
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return number if 0.0 < number < np.inf else None


def _nanosurf(file: Path, meta: Meta, plane: Plane) -> Iterator[str]:
    content = file.read_bytes()
    header, mark, data = content.partition(b"#!")
    text = header.decode("latin-1")
    assert plane.pixel_size is not None
    ny, nx = plane.values.shape
    scan = re.search(r"\[DataSet\\DataSetInfos\\Scan\](.*?)\n\[", text, re.S)
    if scan:
        facts = dict(line.strip().split("=", 1) for line in scan[1].splitlines() if "=" in line)
        for key, count in (("Points", nx), ("Lines", ny)):
            stated = _positive(facts.get(key))
            if stated is not None:
                yield _differ((f"{key} of the scan", stated), ("of the channel", count), 0.0)
        stated = _length(facts.get("Image size", ""))
        if stated is not None:
            yield _differ(("image size [m]", stated), ("of the channel [m]", nx * plane.pixel_size[1]))
    sections = re.findall(r"\[(DataSet-\d+:\d+)\](.*?)(?=\n\[|\Z)", text, re.S)
    listed = set(re.findall(r"^Gr\d+-Ch\d+=(\S+)", text, re.M))
    sizes = []
    for name, section in ((name, body) for name, body in sections if name in listed):
        facts = _once(file, name, section)
        yield from _nanosurf_scale(file, name, facts)
        if facts.get("SaveMode", "") == "Binary":
            sizes.append(int(facts["Points"]) * int(facts["Lines"]) * int(facts["SaveBits"]) // 8)
    if mark:
        _check_held(file, len(data), sum(sizes), nx)


def _once(file: Path, name: str, section: str) -> dict[str, str]:
    """Keys and values of a section, each said once."""
    facts: dict[str, str] = {}
    for key, mark, value in (line.strip().partition("=") for line in section.splitlines()):
        if mark and facts.setdefault(key, value) != value:
            raise ReadError(f"{file}: [{name}] states {key} as {facts[key]} and as {value}")
    return facts


def _nanosurf_scale(file: Path, name: str, facts: Mapping[str, str]) -> Iterator[str]:
    """A range that turns the heights over is refused."""
    span = re.fullmatch(rf"\s*{_NUMBER}\s*", facts.get("Dim2Range", ""))
    if span and not float(span[1]) > 0.0:
        raise ReadError(f"{file}: [{name}] states Dim2Range as {span[1]}, expected a number above 0")
    if span and "Dim2Min" not in facts:
        yield f"[{name}] states no Dim2Min: its lowest value is taken as 0"


def _digital_surf(file: Path, meta: Meta, plane: Plane) -> Iterator[str]:
    """A header of 512 bytes, a comment, then integers of 16 or 32 bits."""
    head = file.read_bytes()[:_SURF_HEADER]
    if not head.startswith(_SURF):
        return  # packed
    type_, bits, inversion, comment, private = (struct.unpack_from("<h", head, at)[0] for at in (18, 98, 290, 334, 336))
    (spacing,), (low, high) = struct.unpack_from("<f", head, 128), struct.unpack_from("<2i", head, 100)
    name = head[164:180].decode("latin-1").strip(" \0")
    if type_ != _SURFACE:
        raise ReadError(f"{file}: an object of the type {type_}, expected {_SURFACE}, a surface")
    if not 0 <= inversion <= _INVERSIONS:
        raise ReadError(f"{file}: its header states the inversion {inversion}, expected 0 .. {_INVERSIONS}")
    if not spacing > 0.0:
        raise ReadError(f"{file}: its header states a spacing of heights of {spacing:g}, expected a positive number")
    if other_kind(name) or "intensity" in name.casefold():
        raise ReadError(f"{file}: what it measured is named {name!r}, which is no height")
    nx, width = plane.values.shape[1], bits // 8
    held = file.stat().st_size - _SURF_HEADER - comment - private
    _check_held(file, held, plane.values.size * width, nx * width)
    raw = np.fromfile(file, f"<i{width}", plane.values.size, offset=_SURF_HEADER + comment + private)
    beyond = int(np.count_nonzero((raw < low) | (raw > high)))
    missing = int(np.count_nonzero(np.isnan(plane.values)))
    if beyond > missing:
        yield f"its header contradicts itself: {beyond - missing} heights beyond its lowest and highest ({low}, {high})"


def _picoview(file: Path, meta: Meta, plane: Plane) -> Iterator[str]:
    content = file.read_bytes()
    end = re.search(rb"\ndata\s+(BINARY(?:_32)?)\s*?\n", content)
    if end is None:
        return  # as text
    width = 4 if end[1] == b"BINARY_32" else 2
    buffers = len(re.findall(rb"\nbufferLabel\s", content[: end.end()]))
    nx = plane.values.shape[1]
    _check_held(file, len(content) - end.end(), buffers * width * plane.values.size, nx * width)
    yield from ()


_CHECKS: dict[str, Callable[[Path, Meta, Plane], Iterator[str]]] = {
    "ibw": _igor, "ezd": _nanosurf, "mi": _picoview, "sur": _digital_surf,
}  # fmt: skip
