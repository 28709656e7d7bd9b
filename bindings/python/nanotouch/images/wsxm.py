# SPDX-License-Identifier: BSD-3-Clause
"""WSxM images, ``.stp`` and ``.top``: sections of a text header, then numbers, little-endian.

The first number is the lower right corner. Floats and doubles are in the unit of ``Z Amplitude``; integers, which an
older header does not name, span it. The text is in the encoding of the computer: each line is UTF-8, else latin-1.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._arrays import Floats
from ..errors import ReadError
from .channel import Channel, Plane, chosen, other_kind, si_unit, with_default
from .checks import LENGTHS, check_shape

NAME = "nanotouch/wsxm"
SIGNATURE = b"WSxM file copyright"
_KIND = b"SxM Image file"
_END = re.compile(rb"\[Header end\]\r?\n")
_STORED = {"short": "<i2", "integer": "<i2", "float": "<f4", "double": "<f8"}
_QUANTITY = re.compile(r"\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*(\S*)")
_WITH_COMMA = re.compile(r"(-?\d+),(\d+)((?:[eE][-+]?\d+)?\s*[^\s\d.,]*)")
_WITH_POINT = re.compile(r"-?\d+\.\d+(?:[eE][-+]?\d+)?\s*[^\s\d.,]*")
_DECIDES = ("X Amplitude", "Y Amplitude", "Z Amplitude", "Number of rows", "Number of columns", "Image Data Type")
_DIFFER = 0.01  # amplitude and range of the heights, above which it is told


@dataclass(frozen=True)
class _Header:
    sections: dict[str, dict[str, str]]
    start: int  # of the numbers [byte]
    stated: int | None  # what the header says of that


def recognises(file: Path, head: bytes) -> bool:
    """Whether it begins as WSxM's images do."""
    return head.startswith(SIGNATURE) and _KIND in head.splitlines()[1:2]


def channels(file: Path) -> list[Channel]:
    """The one picture."""
    return [_listed(file, _header(file))]


def read(file: Path, channel: str | None) -> Plane:
    """The one picture."""
    header = _header(file)
    listed = _listed(file, header)
    chosen([listed], channel, file)
    assert listed.shape is not None
    ny, nx = listed.shape
    kind = _stored(file, header)
    held, needed = file.stat().st_size - header.start, ny * nx * np.dtype(kind).itemsize
    if held < needed:
        raise ReadError(f"{file}: {held} bytes of data, but its header states {needed}: it is cut off or damaged")
    if held - needed >= nx * np.dtype(kind).itemsize:
        told = f"{ny} rows and {nx} columns of the Image Data Type (by default: short) make {needed}"
        raise ReadError(f"{file}: {held} bytes of data, but in its header {told}: one of them is wrong")
    raw = np.fromfile(file, kind, ny * nx, offset=header.start).reshape(ny, nx)
    values, notes = _scaled(file, header, np.asarray(raw[:, ::-1], np.float64), integers="i" in kind)
    if header.stated not in (None, header.start):
        notes += (f"its header contradicts itself: header size {header.stated}, but its end {header.start}",)
    control = header.sections.get("Control", {})
    if listed.size is not None and "Y Amplitude" not in control:
        notes += ("its header states no Y Amplitude: taken as the X Amplitude",)
    pixel_size = None if listed.size is None else (listed.size[0] / ny, listed.size[1] / nx)
    return Plane(listed.name, values, listed.unit, pixel_size, NAME, notes=notes)


def _scaled(file: Path, header: _Header, values: Floats, integers: bool) -> tuple[Floats, tuple[str, ...]]:
    """In the unit of the amplitude, which is the range of the heights."""
    amplitude = _quantity(header.sections.get("General Info", {}).get("Z Amplitude", ""))
    spread = float(np.ptp(values[np.isfinite(values)])) if np.isfinite(values).any() else 0.0
    if integers:
        if amplitude is None:
            raise ReadError(f"{file}: integers without a Z Amplitude [length] that says what they span")
        return values * (amplitude[0] / spread if spread else 1.0), ()
    if amplitude is None or abs(amplitude[0] - spread) <= _DIFFER * max(amplitude[0], spread):
        return values, ()
    told = f"Z amplitude {amplitude[0]:.6g}, but range of the heights {spread:.6g} {amplitude[1]}"
    return values, (f"its header contradicts itself: {told}",)


def _listed(file: Path, header: _Header) -> Channel:
    general, control = header.sections.get("General Info", {}), header.sections.get("Control", {})
    try:
        shape = int(general["Number of rows"]), int(general["Number of columns"])
    except (KeyError, ValueError):
        raise ReadError(
            f"{file}: its header lacks Number of rows or Number of columns, or they are no numbers"
        ) from None
    check_shape(file, shape)
    width = _length(control.get("X Amplitude", ""))
    height = _length(control.get("Y Amplitude", control.get("X Amplitude", "")))
    size = None if width is None or height is None else (height, width)
    amplitude = _quantity(general.get("Z Amplitude", ""))
    unit = amplitude[1] if amplitude and amplitude[1] else None
    title = general.get("Acquisition channel", "Default")
    kind = other_kind(title) or ("height" if unit is None or unit in LENGTHS else "other")
    return with_default([Channel(title, shape, size, si_unit(unit) if unit else None, kind, False)])[0]


def _stored(file: Path, header: _Header) -> str:
    name = header.sections.get("General Info", {}).get("Image Data Type", "short")
    if name not in _STORED:
        raise ReadError(f"{file}: numbers of the type {name!r}, expected {', '.join(_STORED)}")
    return _STORED[name]


def _header(file: Path) -> _Header:
    content = file.read_bytes()
    end = _END.search(content)
    if end is None:
        raise ReadError(f"{file}: its header does not end with [Header end]")
    sections: dict[str, dict[str, str]] = {}
    facts: dict[str, str] = {}
    for raw in content[: end.start()].splitlines():
        line = _text(raw)
        if line.startswith("[") and line.rstrip().endswith("]"):
            facts = sections.setdefault(line.strip()[1:-1], {})
        elif ":" in line:
            key, _, value = line.partition(":")
            known = facts.setdefault(key.strip(), value.strip())
            if known != value.strip() and key.strip() in _DECIDES:
                raise ReadError(f"{file}: {key.strip()!r} is stated as {known!r} and as {value.strip()!r}")
    _write_points(file, sections)
    stated = re.search(rb"Image header size:\s*(\d+)", content[:200])
    return _Header(sections, end.end(), int(stated[1]) if stated else None)


def _write_points(file: Path, sections: dict[str, dict[str, str]]) -> None:
    """Decimal commas become points, where the header has no points and not all commas may stand between thousands."""
    values = [value for facts in sections.values() for value in facts.values()]
    commas = [match for value in values if (match := _WITH_COMMA.fullmatch(value))]
    if not commas:
        return
    if any(_WITH_POINT.fullmatch(value) for value in values) or all(
        len(match[2]) == 3 and match[1].lstrip("-") != "0" for match in commas
    ):
        raise ReadError(f"{file}: the comma of {commas[0][0]!r} may be a decimal one, or between thousands")
    for facts in sections.values():
        for key, value in facts.items():
            facts[key] = _WITH_COMMA.sub(r"\1.\2\3", value) if _WITH_COMMA.fullmatch(value) else value


def _text(line: bytes) -> str:
    """A program that saves a file again may write another encoding than the one before: each line has its own."""
    try:
        return line.decode("utf-8")
    except UnicodeDecodeError:
        return line.decode("latin-1").replace("\x83\xca", "µ")  # Shift-JIS's mu


def _quantity(text: str) -> tuple[float, str] | None:
    match = _QUANTITY.match(text)
    return (float(match[1]), match[2]) if match else None


def _length(text: str) -> float | None:
    found = _quantity(text)
    return found[0] * LENGTHS[found[1]] if found and found[1] in LENGTHS and found[0] > 0.0 else None
