# SPDX-License-Identifier: BSD-3-Clause
"""The reader of most image formats, SurfaceTopography, under the contract of :mod:`nanotouch._io.readers`.

SurfaceTopography returns ``heights[x, y]`` with y counted from the top of the picture; ``imshow(heights.T)`` shows it
as Gwyddion does. Ours is ``heights[y, x]`` with y counted from the bottom, hence ``heights.T[::-1]``. Two kinds of
file differ, see :func:`_upright`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._io.files import guarded
from ..errors import ReadError, require
from . import dataset, gwyddion, headers, text_table
from .channel import Channel, Plane, chosen, other_kind, with_default
from .checks import LENGTHS, PIXELS_PER_SIDE, check_shape

NAME = "SurfaceTopography"
_BARE = ("npy", "npz", "h5")
#: Readers that recognise nothing in a file and take any bytes of a fitting number for an image (elevation maps, NMS).
_CREDULOUS = ("hgt", "nms")

#: Any TIFF is JPK's to SurfaceTopography, which lists those of its channels that are lengths.
_NO_HEIGHTS_IN_TIFF = (
    "a TIFF without a channel in a unit of length (a plain picture, or a JPK image without heights); export the "
    "heights as .gsf or .gwy, or save them as .npy and give the pixel size and the height unit (z unit)"
)


def channels(file: Path) -> list[Channel]:
    """The two-dimensional channels of a file."""
    with _opened(file) as (reader, plain):
        found, left_out = _images_in(reader, file)
        return _listed(found, left_out, file, str(reader.format()), plain)


def read(file: Path, channel: str | None) -> Plane:
    """One channel, the height channel if none is named."""
    with _opened(file) as (reader, plain):
        found, left_out = _images_in(reader, file)
        listed = _listed(found, left_out, file, str(reader.format()), plain)
        number = chosen(listed, channel, file)
        broken = gwyddion.broken(file) if reader.format() == "gwy" else ()
        if number >= len(found):
            return replace(gwyddion.read(file, listed[number].name), notes=broken)
        info = found[number]
        check_shape(file, info.nb_grid_pts)
        unsized = info.physical_sizes is None
        loaded = info.topography(physical_sizes=info.nb_grid_pts if unsized else None)
        lateral, vertical = _units(loaded.unit if loaded.unit is not None else info.unit)
        stored = np.ma.asarray(loaded.heights())
        if stored.dtype.kind not in "fiu":
            raise ReadError(f"{file}: its numbers are {stored.dtype}, expected real ones")
        raw = np.ma.filled(stored.astype(np.float64), np.nan)
        if raw.shape != tuple(info.nb_grid_pts):
            raise ReadError(f"{file}: {raw.shape} values, but its header states {tuple(info.nb_grid_pts)} pixels")
        values, kind = _upright(raw, reader.format()), _kind(info)
        if kind != "height":
            vertical = _units(info.data_unit)[1]
        name, source = str(info.channel_id), f"{NAME}/{reader.format()}"
        if reader.format() == "h5":
            facts = dataset.facts_of(file, str(info.name))
            return Plane(name, facts.of(values), facts.unit, facts.pixel_size, source)
        no_size = "states no scan size"
        if not unsized and lateral not in LENGTHS:
            no_size = "states no lateral unit" if lateral is None else f"states the lateral unit {lateral!r}"
        notes = broken + plain.notes
        stated = plain.sizes.get(name) if vertical is None else None
        if stated is not None:
            pixel_size = stated[0] / values.shape[0], stated[1] / values.shape[1]
            return Plane(name, values, vertical, pixel_size, source, notes=notes)
        if unsized or lateral not in LENGTHS:
            return Plane(name, values, vertical, None, source, no_size, notes=notes)
        lx, ly = (float(s) * LENGTHS[lateral] for s in loaded.physical_sizes)
        plane = Plane(name, values, vertical, (ly / values.shape[0], lx / values.shape[1]), source, notes=notes)
        told = headers.cross_check(file, str(reader.format()), info.info.get("raw_metadata") or {}, plane)
        return replace(plane, notes=notes + told)


@contextmanager
def _opened(file: Path) -> Iterator[tuple[Any, text_table.Plain]]:
    with guarded(file, NAME), text_table.plain_form(file) as plain:
        _check_array(file)
        io: ModuleType = require("SurfaceTopography.IO", "images")
        try:
            reader = io.open_topography(str(plain.file))
        except io.CannotDetectFileFormat:
            reader = None
        if reader is None or reader.format() in _CREDULOUS:
            raise ReadError(f"{file}: not an AFM image in any format that {NAME} recognises by content")
        with reader, guarded(file, f"{NAME}/{reader.format()}"):
            if reader.format() in ("asc", "xyz"):
                text_table.check_text(file)
            yield reader, plain


def _check_array(file: Path) -> None:
    """Refuse what numpy's file holds that is no picture of real numbers; a reader may take it for one."""
    with file.open("rb") as stream:
        if stream.read(6) != b"\x93NUMPY":
            return
        stream.seek(0)
        version = np.lib.format.read_magic(stream)
        header = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        shape, _, dtype = header(stream)
    if dtype.kind not in "fiu" or len(shape) != 2:
        raise ReadError(f"{file}: an array of {dtype} of the shape {shape}; images are real numbers in two dimensions")


def _images_in(reader: Any, file: Path) -> tuple[list[Any], list[Channel]]:
    """Those that SurfaceTopography lists, and those that it leaves out."""
    found = [info for info in reader.channels if info.dim == 2]
    if reader.format() == "asc" and found and all(min(info.nb_grid_pts) < PIXELS_PER_SIDE[0] for info in found):
        columns, rows = found[0].nb_grid_pts
        raise ReadError(f"{file}: a table of {rows} rows and {columns} columns, not an image")
    left_out = []
    if reader.format() == "gwy":
        left_out, currents = gwyddion.channels(file), gwyddion.currents(file)
        found = [info for info in found if info.tags["index"] not in currents]
    if not found and not left_out:
        why = _NO_HEIGHTS_IN_TIFF if reader.format() == "jpk" else "holds no image (no two-dimensional channel)"
        raise ReadError(f"{file}: {why}")
    return found, left_out


def _kind(info: Any) -> str:
    """What a channel holds; SurfaceTopography calls a height what has no unit, or the unit of an amplitude."""
    kind, name = str(info.data_kind.value), str(info.name).casefold()
    return other_kind(name) or kind if kind == "height" else kind


def _listed(
    found: list[Any], left_out: list[Channel], file: Path, format_: str, plain: text_table.Plain
) -> list[Channel]:
    describe = _array if format_ in _BARE else _described
    listed = [describe(info, _kind(info), file) for info in found]
    listed = [
        replace(one, size=plain.sizes.get(one.name)) if one.unit is None and plain.sizes else one for one in listed
    ]
    return with_default([*listed, *left_out])


def _array(info: Any, kind: str, file: Path) -> Channel:
    """A bare array, ``[row, column]``, with what HDF5 may say of it."""
    facts, shape = dataset.facts_of(file, str(info.name)), tuple(info.nb_grid_pts)
    size = None if facts.pixel_size is None else (shape[0] * facts.pixel_size[0], shape[1] * facts.pixel_size[1])
    return Channel(str(info.channel_id), shape, size, facts.unit, kind, False)


def _described(info: Any, kind: str, _: Path) -> Channel:
    lateral, vertical = _units(info.unit)
    if kind != "height":
        vertical = _units(info.data_unit)[1]
    size = None
    if info.physical_sizes is not None and lateral in LENGTHS:
        lx, ly = (float(s) * LENGTHS[lateral] for s in info.physical_sizes)
        size = (ly, lx)
    shape = None if info.nb_grid_pts is None else (info.nb_grid_pts[1], info.nb_grid_pts[0])
    return Channel(str(info.channel_id), shape, size, vertical, kind, False)


def _units(unit: Any) -> tuple[str | None, str | None]:
    """SurfaceTopography's unit as (lateral, vertical): one string for both, or a pair."""
    return (unit[0], unit[1]) if isinstance(unit, tuple) else (unit, unit)


def _upright(values: NDArray[np.float64], format_: str) -> NDArray[np.float64]:
    """SurfaceTopography's array as a writable ``[y, x]`` with row 0 at the bottom.

    Bare arrays (numpy, HDF5) have no stated axes: they are taken as pictures, ``[row, column]`` from the top, where
    SurfaceTopography takes ``[x, y]``. Point lists (xyz) carry their own y, which rises upwards already.
    """
    if format_ in _BARE:
        return np.array(values[::-1], order="C")
    if format_ == "xyz":
        return np.array(values.T, order="C")
    return np.array(values.T[::-1], order="C")
