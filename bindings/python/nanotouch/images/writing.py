# SPDX-License-Identifier: BSD-3-Clause
"""Write an image so that others open it: Gwyddion's own format, its Simple Field, or HDF5."""

from __future__ import annotations

import os
from collections.abc import Callable
from os import PathLike, fspath
from pathlib import Path

import numpy as np

from ..errors import Error, InvalidValue, require
from . import gsf, hdf5
from .channel import Plane
from .topography import Topography

Offset = tuple[float, float] | None
Writer = Callable[[Path, Topography, str, Offset], None]


def write(
    path: str | PathLike[str],
    topography: Topography,
    *,
    title: str | None = None,
    offset: tuple[float, float] | None = None,
) -> Path:
    """Write an image as ``.gwy`` (Gwyddion; SurfaceTopography reads it too), ``.gsf`` or ``.h5`` (:mod:`.hdf5`).

    Heights, size, unit, title, offset and the mask of filled pixels are kept; all read back with :func:`read`. A
    ``.gsf`` has 24 bits a height, and NaN where the mask is. The file is whole or not there.

    Parameters
    ----------
    path : str or path
        Ends with ``.gwy``, ``.gsf``, ``.h5`` or ``.hdf5``; replaced if it exists.
    topography : Topography
        Heights (ny, nx) [m].
    title : str, optional
        Of the channel; without it the topography's channel, or its name.
    offset : (float, float), optional
        ``(y, x)`` of the picture's lower left corner in the scanner's range, y upwards [m]. Without it the picture
        stands at the origin of whatever frame the format has.

    Returns
    -------
    Path
        What was written.

    Raises
    ------
    InvalidValue
        If the ending is none of these, or `offset` is not two finite lengths.
    Error
        If the file cannot be written.
    """
    file = Path(fspath(path))
    writer = _WRITERS.get(file.suffix.lower())
    if writer is None:
        raise InvalidValue(f"{file}: images are written as {', '.join(_WRITERS)}")
    if offset is not None and not (len(offset) == 2 and np.isfinite(offset).all()):
        raise InvalidValue(f"offset: {offset!r} m, expected two finite lengths (y, x)")
    shown = title or topography.channel or topography.name or "Height"
    if "\0" in shown:
        raise InvalidValue("title: must not contain a null character")
    part = file.with_name(f".{file.name}.part-{os.getpid()}")
    try:
        writer(part, topography, shown, offset)
        part.replace(file)
    except OSError as error:
        raise Error(f"cannot write {file}: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)
    return file


def _write_gwy(file: Path, topography: Topography, title: str, offset: Offset) -> None:
    """Gwyddion's first row is the top and its y grows downwards, so the corner it wants is (-(y + Ly), x)."""
    gwyfile = require("gwyfile", "images").objects
    height, width = topography.size
    top, left = (-(offset[0] + height), offset[1]) if offset is not None else (0.0, 0.0)
    frame = {"xreal": width, "yreal": height, "xoff": left, "yoff": top, "si_unit_xy": "m"}
    heights = np.ascontiguousarray(topography.heights[::-1])
    container = gwyfile.GwyContainer()
    container["/0/data"] = gwyfile.GwyDataField(heights, si_unit_z="m", **frame)
    container["/0/data/title"] = title
    container["/0/data/visible"] = True
    if topography.mask.any():
        mask = topography.mask[::-1].astype(np.float64)
        container["/0/mask"] = gwyfile.GwyDataField(mask, si_unit_z="", **frame)
    facts = {key: value for key, value in (("Name", topography.name), ("Read by", topography.source)) if value}
    container["/0/meta"] = gwyfile.GwyContainer(facts)
    with file.open("wb") as stream:
        container.tofile(stream)


def _write_gsf(file: Path, topography: Topography, title: str, offset: Offset) -> None:
    heights = np.where(topography.mask, np.nan, topography.heights)
    gsf.write(file, Plane(title, heights, "m", topography.pixel_size, gsf.NAME), offset)


_WRITERS: dict[str, Writer] = {".gwy": _write_gwy, ".gsf": _write_gsf, ".h5": hdf5.write, ".hdf5": hdf5.write}
