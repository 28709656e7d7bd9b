# SPDX-License-Identifier: BSD-3-Clause
"""Masks of what shall not take part: above or below a height, from a picture drawn by hand, or of the particles found.

True is masked, as in ``level(mask=...)`` and ``roughness(mask=...)``.
"""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import guard
from .._arrays import Floats, check_between
from .._io import worker
from .._io.files import checked_path, guarded
from ..errors import InvalidValue, ReadError, require
from ._robust import MAD
from .particles import GrainTable
from .topography import Topography

_FLAT = 3.0  # standard deviations of the flat


def mask_above(topography: Topography, height: float | None = None, *, below: bool = False) -> NDArray[np.bool_]:
    """True where a levelled image is higher than the flat by more than `height`.

    Parameters
    ----------
    topography : Topography
        The image, levelled.
    height : float, optional
        Over the median height [m], above 0; three robust standard deviations if not given.
    below : bool
        Mask what is lower by so much in place of what is higher.
    """
    z: Floats = topography.heights - float(np.median(topography.heights[~topography.mask]))
    if height is None:
        height = _FLAT * MAD * float(np.median(np.abs(z)))
    check_between("height", height, "m", above=0.0, up_to=1.0)
    return np.asarray((-z if below else z) > height)


def mask_image(
    path: str | PathLike[str], topography: Topography, *, untrusted: bool | None = None
) -> NDArray[np.bool_]:
    """True where a picture (PNG, TIFF) of as many pixels is white, as drawn over the image; row 0 is its top.

    A pixel is white where it is brighter than half.

    Raises
    ------
    ReadError
        If it is no picture.
    InvalidValue
        If it has other pixels than the image.
    """
    file = checked_path(path)
    is_guarded = guard.wanted(untrusted)
    picture = worker.ask("images.picture", file, {}, np.ndarray) if is_guarded else picture_of(file)
    if picture.shape != topography.shape:
        (ny, nx), (my, mx) = topography.shape, picture.shape
        raise InvalidValue(f"mask {file.name}: {mx} x {my} pixels, expected those of the image, {nx} x {ny}")
    return np.asarray(picture[::-1] > 127)


def picture_of(file: Path) -> NDArray[Any]:
    """Grey values, row 0 at the top."""
    cv2 = require("cv2", "images")
    with guarded(file, "OpenCV"):
        picture: NDArray[Any] | None = cv2.imread(fspath(file), cv2.IMREAD_GRAYSCALE)
    if picture is None:
        raise ReadError(f"{file}: not a picture (PNG, TIFF) that OpenCV reads")
    return picture


def mask_grains(table: GrainTable, numbers: list[int] | None = None) -> NDArray[np.bool_]:
    """True inside the particles of a table, or those of these numbers (from 1, as in its labels)."""
    if numbers is None:
        return np.asarray(table.labels > 0)
    wrong = [n for n in numbers if not 1 <= n <= len(table)]
    if wrong:
        raise InvalidValue(f"particle {wrong[0]}: expected 1 .. {len(table)}")
    return np.isin(table.labels, numbers)
