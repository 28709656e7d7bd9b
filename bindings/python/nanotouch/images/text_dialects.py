# SPDX-License-Identifier: BSD-3-Clause
"""Text images with headers that the reader of text tables does not know, in the words of Gwyddion's export, which it
does: WSxM's matrices and points, and SPIP's without its hashes.

Neither of WSxM's says where its first row lies: it is taken as the upper edge of a matrix, and y of points as rising
upwards, which is told.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .._arrays import Floats
from .._io import text
from ..errors import ReadError
from .channel import si_unit
from .checks import LENGTHS, PIXELS_PER_SIDE

_WSXM = "WSxM file copyright"
_AXES = re.compile(r"\s*X\s*\[(?P<x>[^\]]+)\]\s+Y\s*\[(?P<y>[^\]]+)\]\s+(?P<name>\w+)\s*\[(?P<z>[^\]]+)\]\s*")
_AMPLITUDE = re.compile(r"\s*([XYZ]) Amplitude:\s*([-+0-9.eE]+)\s*(\S*)\s*")
_HEADER = 100  # lines
_KEYS = {key.casefold(): key for key in ("File Format", "x-pixels", "y-pixels", "x-length", "y-length", "x-unit",
                                         "y-unit", "z-unit", "Bit2nm", "Voidpixels")}  # fmt: skip
_SPIP = re.compile(rf"#?\s*({'|'.join(_KEYS)})\s*[=:]\s*(.*?)\s*", re.IGNORECASE)
_EVEN = 0.02  # of a step, by which one that was rounded may differ


def translated(file: Path, lines: Sequence[str]) -> tuple[list[str], tuple[str, ...]]:
    """The same table under a header that is known, and what was supplied; `lines` in the form of
    :func:`nanotouch._io.text.plain`."""
    if lines and lines[0].startswith(_WSXM):
        return _points(file, lines) if "XYZ" in lines[1] else _matrix(lines)
    stated = {match[1].casefold(): match[2] for line in lines[:_HEADER] if (match := _SPIP.fullmatch(line))}
    return _spip(lines, stated) if {"file format", "bit2nm"} & set(stated) else (list(lines), ())


def _spip(lines: Sequence[str], stated: dict[str, str]) -> tuple[list[str], tuple[str, ...]]:
    """With the hashes and equals signs by which it is known."""
    header = ["# File Format = ASCII"]
    for line in lines:
        match = _SPIP.fullmatch(line)
        if match is not None:
            header.append(f"# {_KEYS[match[1].casefold()]} = {match[2]}")
        else:
            header.append(line if line.startswith("#") or text.is_row(line) else f"# {line}")
    told: tuple[str, ...] = ()
    if stated.get("voidpixels", "0") != "0":
        told += (f"its header states {stated['voidpixels']} void pixels, which are not told apart",)
    if "z-unit" in stated and stated.get("bit2nm", "1") not in ("1", "1.0"):
        told += (f"its header states the unit {stated['z-unit']} and Bit2nm {stated['bit2nm']}: the unit counts",)
    return header, told


def _matrix(lines: Sequence[str]) -> tuple[list[str], tuple[str, ...]]:
    sides = {match[1]: (match[2], match[3]) for line in lines if (match := _AMPLITUDE.fullmatch(line))}
    header = ["# Channel: Topography"]
    header += [f"# {key}: {' '.join(sides[axis])}" for axis, key in (("X", "Width"), ("Y", "Height")) if axis in sides]
    unit = sides.get("Z", ("", ""))[1]
    header += [f"# Value units: {unit}"] if unit else []
    first = next((number for number, line in enumerate(lines) if text.is_row(line)), len(lines))
    return [*header, *lines[first:]], ("the first row of a WSxM matrix is taken as its upper edge",)


def _points(file: Path, lines: Sequence[str]) -> tuple[list[str], tuple[str, ...]]:
    axes = next((match for line in lines[2:] if (match := _AXES.fullmatch(line))), None)
    if axes is None or axes["x"] != axes["y"] or axes["x"] not in LENGTHS:
        raise ReadError(f"{file}: points of WSxM without 'X[nm] Y[nm] Z[nm]', one length for x and y")
    try:
        values = text.table([line for line in lines if text.is_row(line)])
    except text.NotATable as error:
        raise ReadError(f"{file}: {error}") from None
    if values.shape[1] != 3:
        raise ReadError(f"{file}: points of WSxM with {values.shape[1]} numbers in a row, expected 3")
    (xs, dx), (ys, dy) = (_raster(file, values[:, axis], "xy"[axis]) for axis in (0, 1))
    heights = np.full((ys.size, xs.size), np.nan)
    heights[ys.size - 1 - np.searchsorted(ys, values[:, 1]), np.searchsorted(xs, values[:, 0])] = values[:, 2]
    if len(values) != heights.size or np.isnan(heights).any():
        raise ReadError(
            f"{file}: {len(values)} points of WSxM at {xs.size} places along x and {ys.size} along y: no whole raster"
        )
    unit = "Å" if axes["z"] == axes["x"] == "A" else si_unit(axes["z"])
    header = ["# Channel: Topography" if axes["name"] == "Z" else f"# Channel: {axes['name']}",
              f"# Width: {xs.size * dx!r} {axes['x']}", f"# Height: {ys.size * dy!r} {axes['y']}",
              f"# Value units: {unit}"]  # fmt: skip
    rows = ["\t".join(map(repr, row)) for row in heights.tolist()]
    return header + rows, ("y of WSxM's points is taken as rising upwards",)


def _raster(file: Path, values: Floats, axis: str) -> tuple[Floats, float]:
    """The places along an axis, and their mean step."""
    places = np.unique(values)
    steps = np.diff(places)
    mean = float(steps.mean()) if steps.size else 0.0
    if places.size < PIXELS_PER_SIDE[0] or not (np.abs(steps - mean) <= _EVEN * mean).all():
        raise ReadError(f"{file}: points of WSxM at {places.size} places along {axis} that are no even raster")
    return places, mean
