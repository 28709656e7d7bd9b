# SPDX-License-Identifier: BSD-3-Clause
"""Where the pixels of a NanoScope channel lie, how many lines of them there are, and how large they are.

No single line of the header is believed. ``Scan Size: 10 10 ~m`` is also written for a scan that is half as high as
wide, ``Number of lines`` for one that was stopped, and ``Bytes/pixel: 2`` over values of four bytes. So the lines are
those that the data hold, and the height of a line is the one that agrees with the aspect of the picture:

* a second size that differs from the first, over the lines that it was stated for;
* ``Slow Axis Size`` of the scan, over its lines;
* the scan's height over the scan's lines, where a square scan was stopped;
* as wide as high, where the aspect is not 1:1 and nothing else is said.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .._io import nanoscope_header as header
from .._io.nanoscope_header import Section
from ..errors import ReadError

_VERSION_32BIT = 0x09200000
_AGREE = 0.03  # of a height with the aspect, which is written with few digits
_TOLERANCE = 2e-3  # of numbers printed with few digits


@dataclass(frozen=True)
class Layout:
    """Of one channel.

    Attributes
    ----------
    offset, width : int
        Where its integers begin, and how many bytes one takes.
    stored : (int, int)
        Lines and pixels of a line as stored.
    rows, columns : slice
        Those that were measured.
    pixel_size : (float, float)
        ``(dy, dx)`` [m].
    notes : tuple of str
        Where the header contradicts itself or the data.
    """

    offset: int
    width: int
    stored: tuple[int, int]
    rows: slice
    columns: slice
    pixel_size: tuple[float, float]
    notes: tuple[str, ...] = ()

    @property
    def shape(self) -> tuple[int, int]:
        """``(ny, nx)`` of what was measured."""
        return len(range(self.stored[0])[self.rows]), len(range(self.stored[1])[self.columns])


def layout_of(file: Path, sections: list[Section], scan: Section, one: Section) -> Layout:
    """Of the channel that this section describes; ReadError where its data are not there."""
    nx, stated = _single(one, "Samps/line"), _single(one, "Number of lines")
    offset, length = _single(one, "Data offset"), _single(one, "Data length")
    if not (nx and stated and length):
        raise ReadError(f"{file}: it states {nx} samples, {stated} lines and {length} bytes of data: it is empty")
    held = file.stat().st_size
    if offset + length > held:
        raise ReadError(f"{file}: {held} bytes long, but its data end at {offset + length}: it is cut off")
    head = max(sections[0].header_end, _count(sections[0], "data length"))
    if offset < head:
        raise ReadError(f"{file}: its data are to begin at {offset}, inside of the header ({head} bytes)")
    notes = _overlaps(sections, one, offset, length)
    width = _width(file, sections, one, nx * stated)
    scale = 1.0
    other = _other_pixels(scan, one, (nx, stated), length // width)
    if other is not None:
        notes.append(f"it states {nx} x {stated} pixels, but its data are {other[0]} x {other[1]}, as the scan")
        scale = 1.0 if _same_size(scan, one) else other[0] / nx
        nx, stated = other
    lines = _lines(file, (sections, scan, one), (nx, stated, width), notes)
    rows, columns = _measured(one, (lines, nx), notes)
    sides = _Sides.of(scan, one, (nx, stated, lines), scale)
    pixel_size = sides.pixel_size(notes)
    return Layout(offset, width, (lines, nx), rows, columns, pixel_size, tuple(notes))


def _single(one: Section, key: str) -> int:
    """A whole number that is stated once, or as often as it is stated."""
    found = one.counts(key)
    if len(set(found)) > 1:
        raise ReadError(f"{one.file}: {key!r} is {one.text(key)!r}, expected one whole number")
    return found[0]


def _other_pixels(scan: Section, one: Section, stated: tuple[int, int], held: int) -> tuple[int, int] | None:
    """Samples and lines of the scan, or the valid ones, where the data hold these and not the channel's."""
    nx, lines = stated
    if held == nx * lines:
        return None
    whole, valid = _count(scan, "samps/line"), _count(one, "valid data len x")
    others = ((whole, lines), (whole, _count(scan, "lines")), (valid, lines))
    found = (other for other in others if other[0] not in (0, nx) and other[0] * other[1] == held)
    same_scan = whole == nx and held == nx * _count(scan, "lines")
    return (nx, _count(scan, "lines")) if same_scan else next(found, None)


def _overlaps(sections: list[Section], one: Section, offset: int, length: int) -> list[str]:
    """Of other channels, that claim the same bytes."""
    others = [
        other.channel or other.name
        for other in sections
        if other is not one and _count(other, "data offset") and _count(other, "data length")
        and _count(other, "data offset") < offset + length
        and offset < _count(other, "data offset") + _count(other, "data length")
    ]  # fmt: skip
    return [f"its data overlap those of {', '.join(others)}: one of their places in the file is wrong"] * bool(others)


def _count(section: Section, key: str) -> int:
    """A whole number; 0 where none is stated."""
    word = section.get(key, "").split()
    return int(word[0]) if word and re.fullmatch("[0-9]{1,9}", word[0]) else 0


def _width(file: Path, sections: list[Section], one: Section, pixels: int) -> int:
    """Bytes of a value."""
    width = _count(one, "bytes/pixel") or 2
    if width not in (2, 4):
        raise ReadError(f"{file}: {width} bytes per value; 2 and 4 are read")
    length = one.counts("Data length")[0]
    if width == 4 or (header.version(sections) < _VERSION_32BIT and length != 4 * pixels):
        return width
    if length >= 4 * pixels:
        return 4 if header.version(sections) >= _VERSION_32BIT or _is_sign(file, one) else 2
    if length != 2 * pixels:
        return 4
    return 4 if _is_sign(file, one) else 2  # half as long as four bytes would be: two bytes, or half the lines


def _is_sign(file: Path, one: Section) -> bool:
    """Whether the values take four bytes of which the upper half is a sign."""
    length, offset = one.counts("Data length")[0], one.counts("Data offset")[0]
    high = np.fromfile(file, "<i2", length // 2, offset=offset)[1::2]
    return bool(((high == 0) | (high == -1)).all())


def _lines(
    file: Path, told: tuple[list[Section], Section, Section], stated: tuple[int, int, int], notes: list[str]
) -> int:
    """How many are read: those that the data hold, where the data are whole and nothing speaks against it."""
    (sections, scan, one), (nx, lines, width) = told, stated
    offset, length = one.counts("Data offset")[0], one.counts("Data length")[0]
    held, rest = divmod(length, nx * width)
    if held == lines and not rest:
        return lines
    others = {other.counts("Data offset")[0] for other in sections if "data offset" in other}
    whole = not rest and (offset + length in others or file.stat().st_size - offset - length < nx * width)
    valid = _count(one, "valid data start y") + _count(one, "valid data len y")
    if held < lines and not (whole and held):
        raise ReadError(
            f"{file}: {length} bytes of data, but its header states {nx * lines * width}: it is cut off or damaged"
        )
    halved = width == 4 and length == 2 * nx * lines and not _is_sign(file, one)  # or values of two bytes
    if whole and (valid == held or not (halved or valid == lines)):
        notes.append(f"it states {lines} lines, but its data hold {held}, which are read")
        return held
    if held > lines and valid in (0, lines) and nx == _count(scan, "samps/line"):
        notes.append(f"{length - nx * lines * width} bytes of its data lie behind the last line and are left out")
        return lines
    raise ReadError(
        f"{file}: {length} bytes of data are not {lines} lines of {nx} samples of {width} bytes, as its header states: "
        "one of these numbers is wrong"
    )


def _measured(one: Section, stored: tuple[int, int], notes: list[str]) -> tuple[slice, slice]:
    """The valid lines and samples; all where the header does not say so, or says what cannot be."""
    parts = []
    for axis, count, noun in (("Y", stored[0], "lines"), ("X", stored[1], "samples")):
        first, long = (_count(one, f"valid data {key} {axis}".lower()) for key in ("start", "len"))
        if first + long > count:
            notes.append(f"{count} {noun} are held, but 'Valid data' tells of {first} to {first + long}: all are read")
        if not 0 < long < count or first + long > count:
            parts.append(slice(0, count))
            continue
        notes.append(f"{count - long} of {count} {noun} were not measured ('Valid data len {axis}') and are left out")
        parts.append(slice(first, first + long))
    return parts[0], parts[1]


def _same_size(scan: Section, one: Section) -> bool:
    sizes = [header.size_of(section.get("scan size", "")) for section in (scan, one)]
    return all(size is not None for size in sizes) and abs(sizes[0][0] - sizes[1][0]) <= _TOLERANCE * sizes[1][0]  # type: ignore[index]


@dataclass(frozen=True)
class _Sides:
    """What the header says of the size; lengths in m, 0 where nothing is stated."""

    width: float
    height: float  # the second number of 'Scan Size'
    slow: float  # 'Slow Axis Size' of the same scan
    scan_width: float
    samples: int
    stated: int  # lines
    scan_lines: int
    aspect: float  # width over height
    scan_aspect: float
    is_square: bool  # is stated

    @classmethod
    def of(cls, scan: Section, one: Section, counts: tuple[int, int, int], scale: float) -> _Sides:
        nx, stated, _ = counts
        text = one.get("scan size", scan.get("scan size", ""))
        size = header.size_of(text)
        if size is None or not size[0] > 0.0:
            raise ReadError(f"{one.file}: 'Scan Size' is {text!r}, which is no length")
        whole = header.size_of(scan.get("scan size", ""))
        slow = header.size_of(scan.get("slow axis size", ""))
        scan_width = whole[0] if whole else 0.0
        same = abs(scan_width - size[0]) <= _TOLERANCE * size[0]
        scan_aspect = _aspect(scan.get("aspect ratio", ""))
        aspect = _aspect(one.get("aspect ratio", "")) or scan_aspect
        return cls(
            scale * size[0], scale * (size[1] or 0.0), slow[0] if slow and same else 0.0, scan_width,
            nx, stated, _count(scan, "lines"), aspect or 1.0, scan_aspect or 1.0,
            aspect == 1.0,
        )  # fmt: skip

    def pixel_size(self, notes: list[str]) -> tuple[float, float]:
        """``(dy, dx)`` [m]."""
        dx = self.width / self.samples
        if self.scan_width and self.width > self.scan_width * (1 + _TOLERANCE):
            notes.append(
                f"its header contradicts itself: image width [m] {self.width:.6g}, "
                f"but scan size [m] {self.scan_width:.6g}"
            )
        candidates = list(self._candidates(dx))
        expected = self.width / self.aspect
        if self.aspect == 1.0:
            if self.is_square and self.height and abs(self.height - expected) > _AGREE * expected:
                notes.append(
                    f"its header contradicts itself: height [m] {self.height:.6g}, but by its aspect [m] {expected:.6g}"
                )
            return candidates[0], dx
        for dy in candidates:
            if abs(dy * self.stated - expected) <= _AGREE * expected:
                return dy, dx
        dy = candidates[0]
        notes.append(
            f"its header contradicts itself: height by lines and samples [m] {dy * self.stated:.6g}, "
            f"but by its aspect [m] {expected:.6g}"
        )
        return dy, dx

    def _candidates(self, dx: float) -> Iterator[float]:
        """Heights of a line, best first."""
        square = self.aspect == 1.0
        stopped = not square and 0 < self.stated < self.scan_lines
        if self.slow:
            yield self.slow / (self.scan_lines if stopped else self.stated)
        if self.height and abs(self.height - self.width) > _TOLERANCE * self.width:
            yield self.height / self.stated
            if stopped:
                yield self.height / self.scan_lines
        if stopped and self.scan_aspect == 1.0:
            yield (self.height or self.width) / self.scan_lines
        yield (self.height or self.width) / self.stated if square else dx


def _aspect(text: str) -> float:
    """Width over height: ``2:1`` is 2, and one number is height over width; 0 where it says nothing."""
    words = text.split(":")
    if not all(header.is_number(word) for word in words) or not 1 <= len(words) <= 2:
        return 0.0
    numbers = [float(word) for word in words]
    if min(numbers) <= 0.0:
        return 0.0
    return numbers[0] / numbers[1] if len(numbers) == 2 else 1.0 / numbers[0]
