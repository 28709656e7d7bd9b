# SPDX-License-Identifier: BSD-3-Clause
"""Asylum Research images, ``.ibw``: an Igor binary wave of version 5, x by y by channel, y upwards.

Channels stand one behind the other, so that a listing reads the header alone. Igor states a pitch, and a unit of length
for x and y. What the values are, the note says (``HeightUnit``), or Asylum's names do.
"""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._io import nanoscope_header
from ..errors import ReadError
from . import headers
from .channel import HEIGHT_NAMES, OTHER_NAMES, Channel, Plane, chosen, si_unit, with_default
from .checks import LENGTHS, check_shape

NAME = "nanotouch/asylum-image"
_VERSION = 5
_BIN, _WAVE = struct.Struct("15i"), 320  # sizes after version and check sum; length of the wave's header [byte]
_NUMBERS = {2: "f4", 4: "f8", 8: "i1", 16: "i2", 32: "i4", 72: "u1", 80: "u2", 96: "u4"}
_UNITS = {"Height": "m", "ZSensor": "m", "Deflection": "m", "Amplitude": "m", "Phase": "deg", "Current": "ampere",
          "Frequency": "Hz", "Capacitance": "F", "Potential": "V"}  # fmt: skip
_METRES = "m"  # of heights whose unit is not stated
_KINDS = {"V": "voltage", "ampere": "current", "deg": "phase"}


@dataclass(frozen=True)
class _Wave:
    """What stands before and behind the values."""

    shape: tuple[int, int, int]  # x, y, channels
    pitch: tuple[float, float]  # of x and y
    lateral: str  # unit
    data_unit: str
    dtype: str
    start: int  # of the values [byte]
    names: tuple[str, ...]
    labelled: bool
    note: Mapping[str, str]


def recognises(file: Path, head: bytes) -> bool:
    """Whether it is a wave of pictures; curves are left to others."""
    if file.suffix.lower() != ".ibw" or len(head) < 64 + _WAVE or head[:2] not in (b"\5\0", b"\0\5"):
        return False
    order = "<" if head[0] else ">"
    shape = struct.unpack_from(f"{order}4i", head, 64 + 68)
    return bool(shape[3] == 0 and (shape[2] > 0 or shape[0] == shape[1] > 0))


def channels(file: Path) -> list[Channel]:
    """All channels, by the header alone."""
    return _listed(_wave(file))


def read(file: Path, channel: str | None) -> Plane:
    """One channel, the height channel if none is named."""
    wave = _wave(file)
    listed = _listed(wave)
    number = chosen(listed, channel, file)
    nx, ny, _ = wave.shape
    check_shape(file, (ny, nx))
    dtype = np.dtype(wave.dtype)
    raw = np.fromfile(file, dtype, nx * ny, offset=wave.start + number * nx * ny * dtype.itemsize)
    if raw.size != nx * ny:
        raise ReadError(f"{file}: cut short: channel {listed[number].name!r} has {raw.size} of {nx * ny} values")
    name, unit, notes = listed[number].name, listed[number].unit, tuple[str, ...]()
    if listed[number].kind == "height" and _meaning(wave, name)[0] is None:
        notes = (f"no unit of {name!r} is stated: taken as m, in which such files hold heights",)
    values = np.array(raw.reshape(ny, nx), np.float64)
    if wave.lateral not in LENGTHS:
        told = f"states the lateral unit {wave.lateral!r}" if wave.lateral else "states no lateral unit"
        return Plane(name, values, unit, None, NAME, told, notes=notes)
    factor = LENGTHS[wave.lateral]
    plane = Plane(name, values, unit, (wave.pitch[1] * factor, wave.pitch[0] * factor), NAME, notes=notes)
    told_twice = headers.cross_check(file, "ibw", wave.note, plane)
    return Plane(name, values, unit, plane.pixel_size, NAME, notes=notes + told_twice)


def _listed(wave: _Wave) -> list[Channel]:
    nx, ny, _ = wave.shape
    factor = LENGTHS.get(wave.lateral)
    size = None if factor is None else (ny * wave.pitch[1] * factor, nx * wave.pitch[0] * factor)
    found = []
    for name in wave.names:
        unit, kind = _meaning(wave, name)
        found.append(Channel(name, (ny, nx), size, _METRES if kind == "height" and unit is None else unit, kind, False))
    return with_default(found)


def _meaning(wave: _Wave, name: str) -> tuple[str | None, str]:
    """Unit and kind of a channel."""
    unit = _unit(wave, name) if wave.note and wave.labelled else wave.data_unit or None
    by_name = unit in LENGTHS or (unit is None and wave.data_unit not in LENGTHS)
    if by_name and wave.data_unit and not _stated_unit(wave, name):
        unit = wave.data_unit  # the name says a length in m, the wave something else
    plain = name.casefold()
    other = next((part for part in OTHER_NAMES if part in plain and part != "potential"), "")
    if unit is None and not other and any(part in plain for part in HEIGHT_NAMES):
        return None, "height"
    if other:
        return unit, other
    return unit, "height" if unit in LENGTHS else _KINDS.get(unit or "", "voltage" if unit is None else "other")


def _base(name: str) -> str:
    return re.sub(r"(?:Retrace|Trace)$", "", re.sub(r"Mod[0-9]*$", "", name))


def _stated_unit(wave: _Wave, name: str) -> str | None:
    return wave.note.get(f"{_base(name)}Unit")


def _unit(wave: _Wave, name: str) -> str | None:
    """By the note, else by Asylum's names; what neither knows is not stated."""
    stated = _stated_unit(wave, name)
    if stated:
        return si_unit(nanoscope_header.plain_unit(stated))
    base = re.sub(r"^(?:DAC|Nap)", "", _base(name))
    return next((unit for start, unit in _UNITS.items() if base.startswith(start)), None)


def _wave(file: Path) -> _Wave:
    with file.open("rb") as stream:
        head = stream.read(64 + _WAVE)
        order = "<" if head[0] else ">"
        wave_size, formula, note_size, data_units, *rest = struct.unpack_from(f"{order}13i", head, 4)
        dim_units, labels = rest[:4], rest[4:8]
        (kind,) = struct.unpack_from(f"{order}h", head, 64 + 16)
        shape = struct.unpack_from(f"{order}4i", head, 64 + 68)
        pitch = struct.unpack_from(f"{order}4d", head, 64 + 84)
        (points,) = struct.unpack_from(f"{order}I", head, 64 + 12)
        if points != math.prod(n for n in shape if n):
            raise ReadError(f"{file}: its header states {points} numbers, but {' x '.join(str(n) for n in shape if n)}")
        if kind not in _NUMBERS:
            raise ReadError(f"{file}: numbers of Igor's type {kind}, which is no picture")
        stream.seek(64 + wave_size + formula)
        note = stream.read(note_size).decode("latin-1").replace("\r", "\n")
        stream.seek(data_units + sum(dim_units) + sum(labels[:2]), 1)
        words = [stream.read(32) for _ in range(labels[2] // 32)]
    count = max(shape[2], 1)
    names = [word.partition(b"\0")[0].decode("latin-1") for word in words[1:]][:count]
    names += [f"no name ({number})" for number in range(1, count - len(names) + 1)]
    facts = dict(line.split(":", 1) for line in note.splitlines() if ":" in line)
    return _Wave(
        shape=(shape[0], shape[1], count),
        pitch=(pitch[0], pitch[1]),
        lateral=_word(head, 64 + 152),
        data_unit=si_unit(_word(head, 64 + 148)),
        dtype=order + _NUMBERS[kind],
        start=64 + _WAVE,
        names=_told_apart(names),
        labelled=bool(words[1:]),
        note={key.strip(): value.strip() for key, value in facts.items()},
    )


def _word(head: bytes, at: int) -> str:
    return nanoscope_header.plain_unit(head[at : at + 4].partition(b"\0")[0].decode("latin-1"))


def _told_apart(names: list[str]) -> tuple[str, ...]:
    return tuple(
        name if names.count(name) == 1 else f"{name}#{names[: number + 1].count(name)}"
        for number, name in enumerate(names)
    )
