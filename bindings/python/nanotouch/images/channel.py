# SPDX-License-Identifier: BSD-3-Clause
"""What a reader of images says a file holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class Channel:
    """One channel of an image file.

    Attributes
    ----------
    name : str
        Unique in its file: repeated names are numbered, ``"Friction#2"``.
    shape : tuple of int or None
        ``(ny, nx)`` [pixel]; None where the file tells only with the data.
    size : tuple of float or None
        Scan size ``(Ly, Lx)`` [m]; None where the file states none, or no unit.
    unit : str or None
        Unit the values are stored in; None where the file states none.
    kind : str
        What it holds: ``"height"``, ``"phase"``, ``"deflection"``, ...
    default : bool
        True for the channel that :func:`read` takes when it is not told.
    """

    name: str
    shape: tuple[int, int] | None
    size: tuple[float, float] | None
    unit: str | None
    kind: str
    default: bool


@dataclass(frozen=True, eq=False)
class Plane:
    """The values of one channel as a reader hands them over, before they are checked.

    Attributes
    ----------
    name : str
        Of the channel.
    values : ndarray, shape (ny, nx), float64
        In `unit`, row 0 at the **lower** edge of the picture; NaN where nothing was measured. May be changed in place.
    unit : str or None
        ``"m"``, ``"um"``, ``"nm"``, ...; None where the file states none.
    pixel_size : tuple of float or None
        ``(dy, dx)`` [m], scan size over the number of pixels; None where the file states no size.
    no_size : str
        Why there is no pixel size, as part of a sentence.
    mask : ndarray, shape (ny, nx), bool, optional
        True where the file says that a value was filled in, which stays as it is.
    source : str
        Reader and format, as ``"SurfaceTopography/ibw"``.
    """

    name: str
    values: NDArray[np.float64]
    unit: str | None
    pixel_size: tuple[float, float] | None
    source: str
    no_size: str = "states no scan size"
    mask: NDArray[np.bool_] | None = None
