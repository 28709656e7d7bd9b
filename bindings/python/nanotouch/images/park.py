# SPDX-License-Identifier: BSD-3-Clause
"""Park Systems' TIFF: beside the picture that every program shows, a header and the data in tags of its own.

The data are lines from the lower one up, ``gain (scale raw + offset)`` in the unit of the header. As Gwyddion has it, a
scale of 0 is 1, and a missing unit is the micrometre. Files of several pages are left to others.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import ReadError
from .channel import Channel, Plane, chosen, other_kind, with_default
from .checks import LENGTHS, check_shape

NAME = "nanotouch/park"
SIGNATURE = b"II*\0"
_MAGIC, _OLD, _NEW = 0x0E031301, 0x1000001, 0x1000002
_MAGIC_TAG, _VERSION_TAG, _DATA_TAG, _HEADER_TAG = 50432, 50433, 50434, 50435
_MOST_TAGS = 512
_HEADER = {_OLD: 260, _NEW: 352}  # as far as it is read [byte]
_LATERAL = 1e-6  # unit of the scan size [m]
_TYPES = ("<i2", "<i4", "<f4")
_SCAN = 0


@dataclass(frozen=True)
class _Picture:
    """What the header says."""

    name: str
    shape: tuple[int, int]
    size: tuple[float, float]  # [m]
    unit: str
    scale: float
    offset: float
    start: int  # of the data [byte]
    dtype: str


def recognises(file: Path, head: bytes) -> bool:
    """Whether it has one page, with Park's tags."""
    if not head.startswith(SIGNATURE):
        return False
    tags, more = _tags(file)
    return not more and tags.get(_MAGIC_TAG, (0, 0))[1] == _MAGIC and tags.get(_VERSION_TAG, (0, 0))[1] in _HEADER


def channels(file: Path) -> list[Channel]:
    """The one picture."""
    return _listed(_picture(file))


def read(file: Path, channel: str | None) -> Plane:
    """The values."""
    found = _picture(file)
    chosen(_listed(found), channel, file)
    check_shape(file, found.shape)
    (ny, nx), (ly, lx) = found.shape, found.size
    raw = np.fromfile(file, found.dtype, nx * ny, offset=found.start)
    values = found.scale * raw.reshape(ny, nx).astype(np.float64) + found.offset
    return Plane(found.name, values, found.unit, (ly / ny, lx / nx), NAME)


def _listed(found: _Picture) -> list[Channel]:
    kind = other_kind(found.name) or ("height" if found.unit in LENGTHS else found.name.casefold())
    return with_default([Channel(found.name, found.shape, found.size, found.unit, kind, False)])


def _tags(file: Path) -> tuple[dict[int, tuple[int, int]], int]:
    """Of the first page, count and value (or where that stands), and where the next page is; nothing of a cut file."""
    with file.open("rb") as stream:
        start = struct.unpack("<4xI", stream.read(8).ljust(8, b"\0"))[0]
        stream.seek(start)
        count = struct.unpack("<H", stream.read(2).ljust(2, b"\0"))[0]
        entries = stream.read(12 * count + 4)
    if not 0 < count <= _MOST_TAGS or len(entries) < 12 * count + 4:
        return {}, 0
    rows = (struct.unpack_from("<HHII", entries, 12 * number) for number in range(count))
    return {tag: (size, value) for tag, _, size, value in rows}, struct.unpack_from("<I", entries, 12 * count)[0]


def _picture(file: Path) -> _Picture:
    tags, _ = _tags(file)
    wanted = _HEADER[tags[_VERSION_TAG][1]]
    length, place = tags[_HEADER_TAG]
    with file.open("rb") as stream:
        stream.seek(place)
        header = stream.read(min(length, wanted))
    if len(header) < wanted:
        raise ReadError(f"{file}: its header has {len(header)} bytes, expected {wanted} or more")
    (kind,), (nx, ny) = struct.unpack_from("<I", header), struct.unpack_from("<2I", header, 100)
    (width, height), (gain, scale, offset) = (
        struct.unpack_from("<2d", header, 140),
        struct.unpack_from("<3d", header, 220),
    )
    stored = struct.unpack_from("<I", header, 348)[0] if wanted == _HEADER[_NEW] else 0
    if kind != _SCAN or stored >= len(_TYPES):
        raise ReadError(f"{file}: an image of type {kind}, with data of type {stored}; a scan, 0, of 0 .. 2 is read")
    held, start = tags[_DATA_TAG]
    needed = nx * ny * np.dtype(_TYPES[stored]).itemsize
    if held != needed or start + needed > file.stat().st_size:
        raise ReadError(f"{file}: {held} bytes of data for {nx} x {ny} pixels, which need {needed}")
    unit = _text(header, 244, 8) or "um"
    size = (_LATERAL * height, _LATERAL * width)
    return _Picture(
        _text(header, 4, 32), (ny, nx), size, unit, gain * (scale or 1.0), gain * offset, start, _TYPES[stored]
    )


def _text(header: bytes, place: int, count: int) -> str:
    """Of so many characters in UTF-16, up to a zero."""
    return header[place : place + 2 * count].decode("utf-16-le", "replace").partition("\0")[0].strip()
