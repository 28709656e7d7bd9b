# SPDX-License-Identifier: BSD-3-Clause
"""Bruker/Veeco/DI NanoScope images, each channel on its own: one that cannot be read leaves the others readable.

The integers of a channel stand at ``Data offset``, line by line from the lower edge. ``@2:Z scale: V [Sens. Zsens]
(a V/LSB) b V`` says that their whole range, 256^bytes, is b volts, and ``@Sens. Zsens: V c nm/V`` in another section
what a volt is. From version 9.2 on they take four bytes, whatever ``Bytes/pixel`` says of that range. How many lines
there are and how high they are: :mod:`nanotouch.images.nanoscope_layout`.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._arrays import Floats
from .._io import nanoscope_header as header
from .._io.nanoscope_header import Section
from ..errors import ReadError
from .channel import HEIGHT_NAMES, Channel, Plane, chosen, other_kind, with_default
from .checks import LENGTHS, check_shape
from .nanoscope_layout import Layout, layout_of

NAME = "nanotouch/nanoscope"
TEXT_SIGNATURES = (b"?*File list", b"?*Force file list")
_IMAGE_LISTS = ("ciao image list", "afm image list", "stm image list", "ncafm image list", "image list")
_SCALE = re.compile(
    r"V\s*(?:\[(?P<soft>[^\]]*)\])?\s*(?:\([^)]*(?:\([^)]*\)[^)]*)*\)?)?\s*(?P<number>[-+0-9.eE]+)\s*(?P<unit>.*)"
)
_SENSITIVITY = re.compile(r"V\s*(?P<number>[-+0-9.eE]+)\s*(?P<unit>(?![0-9,.]).*)")
_VOLTS = {"V": 1.0, "mV": 1e-3, "uV": 1e-6, "µV": 1e-6}
_WITHOUT_UNIT = ("Arb", "log(Arb)")


@dataclass(frozen=True)
class _Image:
    """What the header says of one channel; `problem` where it cannot be read."""

    section: Section
    name: str
    layout: Layout | None = None
    factor: float = 1.0
    unit: str | None = None
    notes: tuple[str, ...] = ()
    problem: str = ""


def recognises(file: Path, head: bytes) -> bool:
    """Whether it begins as NanoScope's files do."""
    return head.startswith(header.SIGNATURES + TEXT_SIGNATURES)


def channels(file: Path) -> list[Channel]:
    """All channels; those that cannot be read have no shape."""
    return _listed(_images(file))


def read(file: Path, channel: str | None) -> Plane:
    """One channel, the height channel if none is named."""
    found = _images(file)
    listed = _listed(found)
    if channel is None and not any(one.default for one in listed) and any(one.problem for one in found):
        raise ReadError(f"{file}: no channel of heights can be read: {_problems(found)}")
    image = found[chosen(listed, channel, file)]
    if image.layout is None:
        raise ReadError(f"{file}: channel {image.name!r} cannot be read: {image.problem}")
    values = _values(file, image.layout) * image.factor
    notes = image.notes + image.layout.notes
    notes += tuple(f"channel {one.name!r} left out: {one.problem}" for one in found if one.problem)
    return Plane(image.name, values, image.unit, image.layout.pixel_size, NAME, notes=notes)


def _values(file: Path, layout: Layout) -> Floats:
    ny, nx = layout.stored
    check_shape(file, (len(range(ny)[layout.rows]), len(range(nx)[layout.columns])))
    raw = np.fromfile(file, f"<i{layout.width}", ny * nx, offset=layout.offset).reshape(ny, nx)
    return np.asarray(raw[layout.rows, layout.columns], np.float64)


def _listed(found: Sequence[_Image]) -> list[Channel]:
    return with_default([_channel(image) for image in found])


def _channel(image: _Image) -> Channel:
    if image.layout is None:
        return Channel(image.name, None, None, None, "unreadable", False)
    (ny, nx), (dy, dx) = image.layout.shape, image.layout.pixel_size
    return Channel(image.name, (ny, nx), (ny * dy, nx * dx), image.unit, _kind(image), False)


def _kind(image: _Image) -> str:
    name = image.name.casefold()
    return other_kind(name) or ("height" if image.unit in LENGTHS else "other")


def _images(file: Path) -> list[_Image]:
    """What the file holds; ReadError where that is nothing."""
    with file.open("rb") as stream:
        if stream.read(len(TEXT_SIGNATURES[0])).startswith(TEXT_SIGNATURES):
            raise ReadError(f"{file}: a NanoScope file with its data as text; save it in its binary form")
    sections = header.sections(file)
    listed = [one for one in sections if one.name.casefold() in _IMAGE_LISTS]
    scan = _scan(sections)
    if not listed or scan.get("operating mode") == "Force":
        raise ReadError(f"{file}: a Bruker NanoScope file without an image (force curves: curves.read reads them)")
    if sections[0].get("start context", "").endswith("VAR") and scan.get("operating mode") != "Force Volume":
        raise ReadError(f"{file}: a Bruker NanoScope file of profiles whose points are unevenly spaced, not an image")
    names = _names(listed)
    found = [_described(file, sections, scan, one, name) for one, name in zip(listed, names, strict=True)]
    if all(image.problem for image in found):
        raise ReadError(f"{file}: none of its channels can be read: {_problems(found)}")
    return found


def _problems(found: Sequence[_Image]) -> str:
    return "; ".join(f"{image.name!r}: {image.problem}" for image in found if image.problem)


def _scan(sections: list[Section]) -> Section:
    wanted = ("ciao scan list", "afm list", "stm list", "nc afm list")
    return next((one for one in sections if one.name.casefold() in wanted), Section(sections[0].file, ""))


def _described(file: Path, sections: list[Section], scan: Section, one: Section, name: str) -> _Image:
    try:
        layout = layout_of(file, sections, scan, one)
        factor, unit, notes = _scale(sections, one, name)
    except ReadError as error:
        return _Image(one, name, problem=str(error).removeprefix(f"{file}: "))
    return _Image(one, name, layout, factor, unit, notes)


def _names(listed: list[Section]) -> list[str]:
    """Where several channels have one name, their direction tells them apart, then their number."""
    plain = [_plain_name(one, number) for number, one in enumerate(listed)]
    turned = [
        name if plain.count(name) == 1 else " ".join([name, *_way(one)])
        for name, one in zip(plain, listed, strict=True)
    ]
    return [
        name if turned.count(name) == 1 else f"{name}#{turned[: number + 1].count(name)}"
        for number, name in enumerate(turned)
    ]


def _way(one: Section) -> list[str]:
    direction = one.get("line direction", "").strip().casefold()
    interleaved = one.get("scan line", "").strip().casefold() == "interleave"
    return [*([direction] if direction in ("trace", "retrace") else []), *(["interleave"] if interleaved else [])]


def _plain_name(one: Section, number: int) -> str:
    """``ZSensor`` of ``S [ZSensor] "Height Sensor"``."""
    stated = one.channel or one.get("image data", "")
    match = re.search(r"\[([^\]]+)\]", stated) or re.search(r'"([^"]+)"', stated)
    return (match[1] if match else stated).strip() or f"channel {number + 1}"


def _scale(sections: list[Section], one: Section, name: str) -> tuple[float, str | None, tuple[str, ...]]:
    """Value of a count, its unit, and what was supplied."""
    keys = sorted((key for key in one if key.startswith("@") and key.endswith(":z scale")), reverse=True)
    if not keys:
        raise ReadError(f"{one.file}: its header lacks a 'Z scale' with a unit (versions before 4.3 have none)")
    stated = _SCALE.fullmatch(one[keys[0]])
    full = float(stated["number"]) if stated and header.is_number(stated["number"]) else np.nan
    if stated is None or not (np.isfinite(full) and full > 0.0):
        raise ReadError(f"{one.file}: 'Z scale' is {one[keys[0]]!r}, which states no range")
    per_count = full / 256.0 ** one.counts("Bytes/pixel")[0] if "bytes/pixel" in one else full / 65536.0
    unit = header.plain_unit(stated["unit"])
    soft = (stated["soft"] or "").strip()
    if not soft:
        return per_count, unit or None, ()
    factor, converted, notes = _soft(sections, soft, unit, name)
    return per_count * factor, converted, notes


def _soft(sections: list[Section], soft: str, unit: str, name: str) -> tuple[float, str | None, tuple[str, ...]]:
    """What one `unit` of the hard scale means: factor and unit by the sensitivity of this name."""
    file = sections[0].file
    known = header.stated_everywhere(sections, f"@{soft}")
    match = _SENSITIVITY.fullmatch(known[0]) if known else None
    if match is None or not (header.is_number(match["number"]) and float(match["number"]) > 0.0):
        raise ReadError(f"{file}: its header does not say what {soft!r} is, the scale of its values")
    notes = () if len(known) == 1 else (f"the header states {soft!r} as {' and as '.join(known)}: the first is taken",)
    value, top = float(match["number"]), header.plain_unit(match["unit"])
    top, per, below = top.rpartition("/")
    if not per:
        is_height = any(part in name.casefold() for part in HEIGHT_NAMES) and value != 1.0 and not below
        if is_height and unit in _VOLTS:
            told = f"the header states {soft!r} as {value:g} without a unit: taken as nm/V"
            return value * _VOLTS[unit], "nm", (*notes, told)
        return value, unit or None, notes
    if below not in (unit, *_WITHOUT_UNIT):
        if below not in _VOLTS or unit not in _VOLTS:
            raise ReadError(f"{file}: its values are in {unit!r}, but {soft!r} is per {below!r}")
        value *= _VOLTS[unit] / _VOLTS[below]
    return value, top.strip() or None, notes
