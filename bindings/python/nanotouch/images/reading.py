# SPDX-License-Identifier: BSD-3-Clause
"""Read AFM images: pick the reader, check that what it says is plausible, hand over metres the right way up."""

from __future__ import annotations

import importlib
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from .. import guard
from .._arrays import as_floats
from .._io import worker
from .._io.files import checked_path, guarded, refuse_traps
from .._io.readers import head_of, registered_for
from .._io.words import printable
from ..errors import InvalidValue, ReadError
from ..formats import HDF5, refusal
from .channel import Channel, Plane
from .checks import LENGTHS, check_scale, check_shape, filled, unusual
from .topography import Topography

#: our readers, asked in this order where a file begins with one of these; loaded then, as to list a file needs one
READERS: tuple[tuple[str, tuple[bytes, ...]], ...] = (
    ("hdf5", (HDF5,)),
    ("jpk_movie", (HDF5,)),
    ("topostats", (HDF5,)),
    ("nanonis", (b":NANONIS_VERSION:",)),
    ("gsf", (b"Gwyddion Simple Field",)),
    ("ntmdt", (b"\x01\xb0\x93\xff",)),
    ("nanoscope", (b"\\*", b"?*")),
    ("wsxm", (b"WSxM file copyright",)),
    ("asylum", (b"\5\0", b"\0\5")),
    ("park", (b"II*\0",)),
)


def channels(path: str | PathLike[str], *, untrusted: bool | None = None) -> list[Channel]:
    """List the two-dimensional channels of an image file.

    Parameters
    ----------
    path : str or path
        The image file.
    untrusted : bool, optional
        Open it in a guarded worker process, see :func:`read`.

    Raises
    ------
    ReadError
        If it is not an AFM image.
    """
    file = checked_path(path)
    if guard.wanted(untrusted):
        return worker.ask("images.channels", file, {}, list[Channel])
    name, reader = reader_of(file)
    with guarded(file, name):
        found: list[Channel] = reader.channels(file)
        return found


def read(
    path: str | PathLike[str],
    channel: str | None = None,
    *,
    pixel_size: float | tuple[float, float] | None = None,
    z_unit: str | None = None,
    untrusted: bool | None = None,
) -> Topography:
    """Read one channel of an AFM image, in any format of :mod:`nanotouch.formats`, chosen by content.

    Parameters
    ----------
    path : str or path
        The image file.
    channel : str, optional
        Name as :func:`channels` lists it (case does not matter). Without it the height channel is taken: a measured
        height before a piezo voltage, trace before retrace.
    pixel_size : float or (float, float), optional
        ``(dy, dx)`` [m], 1e-12 .. 1e-3, in place of what the file states, or for files that state nothing.
    z_unit : str, optional
        Unit of the heights (``"m"``, ``"mm"``, ``"um"``, ``"nm"``, ``"A"``, ``"pm"``) for files that state none.
    untrusted : bool, optional
        True: open the file in a confined process (Linux only), for files from elsewhere (docs/security.md). By default
        the ``nanotouch`` command does so, Python does not.

    Returns
    -------
    Topography
        Heights (ny, nx) [m]. Up to 90 % missing pixels are filled from their neighbours and masked; `notes` tells
        where they are more than 1 %, and what else reading supplied or found unusual.

    Raises
    ------
    ReadError
        If the file is missing, empty, damaged or not an image. If it has no height channel or no unit, or more than
        90 % missing pixels. If its size or height is not that of an AFM image.
    InvalidValue
        If `pixel_size` or `z_unit` is not valid.
    """
    file = checked_path(path)
    given_pixel = checked_pixel_size(pixel_size)
    if z_unit is not None and z_unit not in LENGTHS:
        raise InvalidValue(f"z_unit: {z_unit!r}, expected one of {', '.join(LENGTHS)}")
    if guard.wanted(untrusted):
        options: dict[str, Any] = {"channel": channel, "pixel_size": given_pixel, "z_unit": z_unit}
        topography = worker.ask("images.read", file, options, Topography)
        with guarded(file, topography.source):
            check_scale(topography, file)  # the worker is not believed
        return topography
    name, reader = reader_of(file)
    with guarded(file, name):
        plane: Plane = reader.read(file, channel)
        with guarded(file, plane.source):
            return _checked(plane, file, given_pixel, z_unit)


def reader_of(file: Path) -> tuple[str, Any]:
    """The reader that takes a file, and its name."""
    head = head_of(file)
    refuse_traps(file, head)
    registered = registered_for(file, head, "images")
    if registered is not None:
        return registered
    refused = refusal(file, head, "images")
    if refused is not None:
        raise ReadError(f"{file}: {refused}")
    for module, marks in READERS:
        if not head.startswith(marks):
            continue
        own = _loaded(module)
        with guarded(file, own.NAME):
            recognised = own.recognises(file, head)
        if recognised:
            return own.NAME, own
    others = _loaded("surfacetopography")
    return others.NAME, others


def _loaded(module: str) -> Any:
    return importlib.import_module(f"{__package__}.{module}")


def _checked(plane: Plane, file: Path, given_pixel: tuple[float, float] | None, z_unit: str | None) -> Topography:
    check_shape(file, plane.values.shape)
    pixel_size = plane.pixel_size if given_pixel is None else given_pixel
    if pixel_size is None:
        raise ReadError(f"{file}: channel {plane.name!r} {plane.no_size}; give the pixel size")
    if not all(0.0 < side < np.inf for side in pixel_size):
        raise ReadError(f"{file}: pixels of {pixel_size[1]:g} x {pixel_size[0]:g} m (damaged header?)")
    heights, mask = filled(plane.values * _height_scale(plane, z_unit, file), file)
    if plane.mask is not None:
        mask |= plane.mask
    topography = Topography(heights, pixel_size, printable(file.name), plane.name, plane.source, mask)
    check_scale(topography, file)
    return replace(topography, notes=tuple(map(printable, plane.notes)) + unusual(topography))


def _height_scale(plane: Plane, given: str | None, file: Path) -> float:
    """Metres per stored height. A unit given against a stated one is refused, as one of the two must be wrong."""
    stated, name = plane.unit, plane.name
    if given is None:
        if stated is None:
            raise ReadError(f"{file}: the height unit of channel {name!r} is not stated; give the height unit (z unit)")
        if stated not in LENGTHS:
            raise ReadError(
                f"{file}: channel {name!r} is in {stated!r}, not a length ({', '.join(LENGTHS)}), so it holds no "
                "heights; give another channel"
            )
        return LENGTHS[stated]
    if stated is not None and LENGTHS.get(stated) != LENGTHS[given]:
        raise ReadError(f"{file}: states {stated!r} for channel {name!r}, which contradicts the z unit {given!r} given")
    return LENGTHS[given]


def checked_pixel_size(pixel_size: float | tuple[float, float] | None) -> tuple[float, float] | None:
    """(dy, dx) [m] in its range."""
    if pixel_size is None:
        return None
    pair = np.atleast_1d(as_floats(pixel_size, "pixel_size"))
    if pair.shape not in ((1,), (2,)) or not ((pair >= 1e-12) & (pair <= 1e-3)).all():
        raise InvalidValue(f"pixel_size: {pixel_size!r} m, expected one or two lengths of 1e-12 .. 1e-3 m")
    return float(pair[0]), float(pair[-1])
