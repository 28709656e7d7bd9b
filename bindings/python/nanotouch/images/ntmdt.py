# SPDX-License-Identifier: BSD-3-Clause
"""NT-MDT files, ``.mdt``, whose pictures are stored as multidimensional arrays, as later versions of Nova do.

A file is a row of frames; those of type 106 hold an array with a calibration (unit, bias, scale, first and last index)
of every dimension and of what was measured. Two dimensions and one quantity are a picture: x first, from the bottom
line up. (Frames of type 0, of earlier versions, are read by SurfaceTopography.)
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import ReadError
from .channel import Channel, Plane, chosen, other_kind, si_unit, with_default
from .checks import LENGTHS, check_shape

NAME = "nanotouch/ntmdt"
SIGNATURE = b"\x01\xb0\x93\xff"
_FILE_HEADER, _FRAME_HEADER, _SCANNED, _ARRAY = 33, 22, 0, 106
_DTYPES = {-1: "<i1", 1: "<u1", -2: "<i2", 2: "<u2", -4: "<i4", 4: "<u4", -8: "<i8", 8: "<u8",
           -(4 + 23 * 256): "<f4", -(8 + 52 * 256): "<f8"}  # fmt: skip


@dataclass(frozen=True)
class _Axis:
    """Calibration of a dimension or of what was measured."""

    name: str
    unit: str
    bias: float
    scale: float
    count: int
    kind: int  # of the numbers

    @property
    def length(self) -> float | None:
        """[m]; None where its unit is no length."""
        return abs(self.scale) * self.count * LENGTHS[self.unit] if self.unit in LENGTHS else None


@dataclass(frozen=True)
class _Picture:
    """One frame: its title, x, y, what was measured, and where its numbers stand."""

    title: str
    x: _Axis
    y: _Axis
    z: _Axis
    start: int  # [byte]


def recognises(file: Path, head: bytes) -> bool:
    """Whether it is an NT-MDT file of arrays alone."""
    return head.startswith(SIGNATURE) and all(kind != _SCANNED for kind, _, _ in _frames(file.read_bytes()))


def channels(file: Path) -> list[Channel]:
    """Every frame that is a picture."""
    return _listed(_pictures(file, file.read_bytes()))


def read(file: Path, channel: str | None) -> Plane:
    """One picture."""
    content = file.read_bytes()
    pictures = _pictures(file, content)
    listed = _listed(pictures)
    number = chosen(listed, channel, file)
    picture = pictures[number]
    ny, nx = picture.y.count, picture.x.count
    check_shape(file, (ny, nx))
    dtype = np.dtype(_DTYPES[picture.z.kind])
    if picture.start + ny * nx * dtype.itemsize > len(content):
        raise ReadError(f"{file}: {len(content)} bytes long, but a picture ends beyond them: it is cut off")
    raw = np.frombuffer(content, dtype, ny * nx, picture.start).reshape(ny, nx)
    values = raw * picture.z.scale + picture.z.bias
    size = listed[number].size
    pixel_size = None if size is None else (size[0] / ny, size[1] / nx)
    return Plane(listed[number].name, values, picture.z.unit or None, pixel_size, NAME)


def _listed(pictures: list[_Picture]) -> list[Channel]:
    listed: list[Channel] = []
    for picture in pictures:
        ly, lx = picture.y.length, picture.x.length
        size = None if ly is None or lx is None else (ly, lx)
        kind = "height" if picture.z.unit in LENGTHS else picture.z.name.casefold() or "unknown"
        kind = other_kind(f"{picture.title} {picture.z.name}") or kind
        same = sum(channel.name.partition("#")[0] == picture.title for channel in listed)
        name = f"{picture.title}#{same + 1}" if same else picture.title
        listed.append(Channel(name, (picture.y.count, picture.x.count), size, picture.z.unit, kind, False))
    return with_default(listed)


def _frames(content: bytes) -> Iterator[tuple[int, int, int]]:
    """Type, first and last byte of every frame."""
    (last,) = struct.unpack_from("<H", content, 12) if len(content) >= _FILE_HEADER else (-1,)
    at = _FILE_HEADER
    for _ in range(last + 1):
        if at + _FRAME_HEADER > len(content):
            return
        size, kind = struct.unpack_from("<IH", content, at)
        if size < _FRAME_HEADER:
            return
        yield kind, at, at + size
        at += size


def _pictures(file: Path, content: bytes) -> list[_Picture]:
    found = []
    for kind, start, _ in _frames(content):
        if kind == _ARRAY:
            try:
                picture = _picture(content, start + _FRAME_HEADER)
            except struct.error:
                raise ReadError(f"{file}: an array ends beyond the file: it is cut off or damaged") from None
            if picture is not None:
                found.append(picture)
    if not found:
        raise ReadError(f"{file}: holds no image, only spectra or texts")
    return found


def _picture(content: bytes, start: int) -> _Picture | None:
    """The picture whose array begins there; None if the array is no picture."""
    head, _ = struct.unpack_from("<2I", content, start)
    sizes = struct.unpack_from("<8I", content, start + 44)
    name_size, comment, view, spec, source, _, data_offset, _ = sizes
    at = start + head
    title = content[at : at + name_size].decode("utf-8", "replace").strip("\0 ")
    at += name_size + comment + view + spec + source
    _, fixed, _, _, dimensions, quantities = struct.unpack_from("<2IQ3I", content, at)
    if (dimensions, quantities) != (2, 1):
        return None
    at += 8 + fixed
    axes = []
    for _ in range(3):
        axis, at = _axis(content, at)
        axes.append(axis)
    if axes[2].kind not in _DTYPES:
        return None
    return _Picture(title or axes[2].name, axes[0], axes[1], axes[2], data_offset)


def _axis(content: bytes, start: int) -> tuple[_Axis, int]:
    """A calibration, and where the next begins."""
    total, fixed, name, comment, unit = struct.unpack_from("<5I", content, start)
    bias, scale, first, last, kind, _ = struct.unpack_from("<2d2QiI", content, start + 44)
    at = start + 8 + fixed
    texts = []
    for size in (name, comment, unit):
        texts.append(content[at : at + size].decode("utf-8", "replace").strip("\0 "))
        at += size
    return _Axis(texts[0], si_unit(texts[2]), bias, scale, last - first + 1, kind), start + total
