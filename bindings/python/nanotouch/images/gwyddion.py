# SPDX-License-Identifier: BSD-3-Clause
"""Channels of a Gwyddion file that SurfaceTopography leaves out: no heights, without a lateral unit, or broken.

The format is Gwyddion's own (User guide, "Gwyddion Native Format"): named components, one after another, little endian;
an object is its name, its length and its components. Channel number n is ``/n/data`` with its title ``/n/data/title``
and its mask ``/n/mask``. Units are SI without prefix.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ReadError
from .channel import Channel, Plane, other_kind, si_unit
from .checks import LENGTHS, check_shape

MAGIC = b"GWYP"
_PLAIN = {b"b": 1, b"c": 1, b"i": 4, b"q": 8, b"d": 8}
_ARRAYS = {b"C": 1, b"I": 4, b"Q": 8, b"D": 8}
_NUMBERS = {b"i": "<i", b"q": "<q", b"d": "<d"}
_DEPTH = 8  # of objects in objects
_NEEDED = {"xres", "yres", "xreal", "yreal", "data"}


def channels(file: Path) -> list[Channel]:
    """Those with a unit that is no length, of the values or of the sides."""
    found = []
    for name, (_, field) in _fields(_content(file), file).items():
        size = (field["yreal"], field["xreal"]) if _unit(field, "xy") == "m" else None
        unit = _unit(field, "z") or None
        kind = other_kind(name) or ("height" if unit in LENGTHS else "other")
        found.append(Channel(name, _shape(field, file), size, unit, kind, False))
    return found


def broken(file: Path) -> tuple[str, ...]:
    """A note for each channel that lacks its numbers or its size."""
    found = []
    for key, value in _content(file).items():
        match = re.fullmatch(r"/(\d+)/data", key)
        if match and not (isinstance(value, dict) and set(value) >= _NEEDED):
            lacks = ", ".join(sorted(_NEEDED - set(value))) if isinstance(value, dict) else "everything"
            found.append(f"channel {match[1]} left out: broken, it lacks {lacks}")
    return tuple(found)


def currents(file: Path) -> frozenset[int]:
    """Numbers of the channels in ampere, whose A SurfaceTopography takes for the ångström."""
    numbers = (number for number, field in _fields(_content(file), file).values() if _unit(field, "z") == "ampere")
    return frozenset(numbers)


def read(file: Path, channel: str) -> Plane:
    """One of :func:`channels`; what its mask covers is missing."""
    content = _content(file)
    found = {name.casefold(): (name, *rest) for name, rest in _fields(content, file).items()}
    if channel.casefold() not in found:
        raise ReadError(f"{file}: no channel {channel!r}; beside heights it holds {', '.join(found) or 'none'}")
    name, number, field = found[channel.casefold()]
    values = _pixels(field, file)
    mask = content.get(f"/{number}/mask")
    if isinstance(mask, dict) and "data" in mask:
        values[_pixels(mask, file) > 0.5] = np.nan
    ny, nx = values.shape
    pixel_size = (abs(field["yreal"]) / ny, abs(field["xreal"]) / nx) if _unit(field, "xy") == "m" else None
    return Plane(name, values, _unit(field, "z") or None, pixel_size, "nanotouch/gwy")


def _fields(content: dict[str, Any], file: Path) -> dict[str, tuple[int, dict[str, Any]]]:
    """By their titles; repeated ones are numbered."""
    found: list[tuple[str, int, dict[str, Any]]] = []
    for key, value in content.items():
        match = re.fullmatch(r"/(\d+)/data", key)
        if match is None or not isinstance(value, dict) or not set(value) >= _NEEDED:
            continue
        if _unit(value, "z") not in LENGTHS or _unit(value, "xy") not in LENGTHS:
            title = content.get(f"{key}/title")
            found.append((title if isinstance(title, str) else f"channel {match[1]}", int(match[1]), value))
    names = [name for name, _, _ in found]
    return {
        name if names.count(name) == 1 else f"{name}#{names[: i + 1].count(name)}": (number, field)
        for i, (name, number, field) in enumerate(found)
    }


def _unit(field: dict[str, Any], axis: str) -> str:
    unit = field.get(f"si_unit_{axis}")
    text = unit.get("unitstr", "") if isinstance(unit, dict) else ""
    return si_unit(text) if isinstance(text, str) else ""


def _shape(field: dict[str, Any], file: Path) -> tuple[int, int]:
    shape = int(field["yres"]), int(field["xres"])
    check_shape(file, shape)
    return shape


def _pixels(field: dict[str, Any], file: Path) -> np.ndarray[Any, np.dtype[np.float64]]:
    """Row 0 at the lower edge."""
    shape, data = _shape(field, file), field["data"]
    if not isinstance(data, memoryview) or len(data) != 8 * shape[0] * shape[1]:
        raise ReadError(f"{file}: its numbers are not {shape[1]} x {shape[0]} pixels (damaged?)")
    return np.array(np.frombuffer(data, "<f8").reshape(shape)[::-1], order="C")


def _content(file: Path) -> dict[str, Any]:
    raw = memoryview(file.read_bytes())
    if bytes(raw[:4]) != MAGIC:
        raise ReadError(f"{file}: no Gwyddion file")
    name, at = _text(raw, 4)
    (length,) = struct.unpack_from("<I", raw, at)
    if name != "GwyContainer" or at + 4 + length > len(raw):
        raise ReadError(f"{file}: it is cut off or damaged")
    try:
        content = _once(_components(raw[at + 4 : at + 4 + length], _DEPTH))
    except _Twice as error:
        raise ReadError(f"{file}: {error}") from None
    for key, field in content.items():
        if re.fullmatch(r"/\d+/data", key) and isinstance(field, dict):
            for side in ("xreal", "yreal"):
                if isinstance(field.get(side), float) and not field[side] > 0.0:
                    raise ReadError(f"{file}: {key}: {side} is {field[side]:g}, expected a positive length")
    return content


class _Twice(ValueError):
    """One name for two components that differ."""


def _once(components: Iterator[tuple[str, Any]]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in components:
        if name in found and found[name] != value:
            told = f": {found[name]!r} and {value!r}" if isinstance(value, (int, float, str)) else ""
            raise _Twice(f"it holds two components {name!r} that differ{told[:80]}")
        found[name] = value
    return found


def _components(raw: memoryview, depth: int) -> Iterator[tuple[str, Any]]:
    at = 0
    while at < len(raw):
        name, at = _text(raw, at)
        kind, at = bytes(raw[at : at + 1]), at + 1
        value: Any = None
        if kind in _PLAIN:
            end = at + _PLAIN[kind]
            value = struct.unpack_from(_NUMBERS[kind], raw, at)[0] if kind in _NUMBERS else None
        elif kind == b"s":
            value, end = _text(raw, at)
        elif kind == b"o" and depth > 0:
            _, inside = _text(raw, at)
            end = inside + 4 + struct.unpack_from("<I", raw, inside)[0]
            value = _once(_components(raw[inside + 4 : end], depth - 1)) if end <= len(raw) else None
        elif kind in _ARRAYS:
            end = at + 4 + _ARRAYS[kind] * struct.unpack_from("<I", raw, at)[0]
            value = raw[at + 4 : end]
        elif kind in (b"S", b"O"):
            end = _past_many(raw, at, kind)
        else:
            raise ReadError(f"component {name!r} of the unknown kind {kind!r} (damaged?)")
        if end > len(raw):
            raise ReadError(f"component {name!r} is cut off (damaged?)")
        yield name, value
        at = end


def _past_many(raw: memoryview, at: int, kind: bytes) -> int:
    """Past an array of texts or objects, which are not looked at."""
    (count,) = struct.unpack_from("<I", raw, at)
    at += 4
    for _ in range(count):
        _, at = _text(raw, at)
        at += 4 + struct.unpack_from("<I", raw, at)[0] if kind == b"O" else 0
        if at > len(raw):
            break
    return at


def _text(raw: memoryview, at: int) -> tuple[str, int]:
    """Up to the zero byte, and where it goes on."""
    end = at
    for start in range(at, len(raw), 4096):
        found = bytes(raw[start : start + 4096]).find(b"\0")
        if found >= 0:
            end = start + found
            return bytes(raw[at:end]).decode("utf-8", "replace"), end + 1
    raise ReadError("a text that does not end (damaged?)")
