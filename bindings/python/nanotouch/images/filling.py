# SPDX-License-Identifier: BSD-3-Clause
"""Missing pixels get heights from their neighbours, so that everything else works on whole images with a mask."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._arrays import Floats
from ..errors import InvalidValue, require

_RIMS = 32  # filled one after the other [pixel]


def fill(heights: ArrayLike) -> tuple[Floats, NDArray[np.bool_]]:
    """Fill missing (not finite) pixels by the mean of their known neighbours, from the rim of each hole inwards.

    What lies more than 32 pixels inside a hole gets the height of the nearest pixel on that rim.

    Parameters
    ----------
    heights : array_like, shape (ny, nx)
        Heights [m], NaN or infinite where missing; masked arrays too.

    Returns
    -------
    heights : ndarray, shape (ny, nx)
        A whole image [m]; the array given where nothing is missing.
    mask : ndarray, shape (ny, nx), bool
        True where it was filled: ``Topography(heights, pixel_size, mask=mask)``.
    """
    values = np.asarray(np.ma.filled(np.ma.asarray(heights, dtype=np.float64), np.nan))
    missing = ~np.isfinite(values)
    if values.ndim != 2 or missing.all():
        raise InvalidValue(f"heights: shape {values.shape}, expected two dimensions and at least one finite height")
    if not missing.any():
        return values, missing
    cv2 = require("cv2", "images")
    values, todo = values.copy(), missing.copy()
    values[todo] = 0.0  # OpenCV hides NaN, so none may reach it
    for _ in range(_RIMS):
        if not todo.any():
            break
        known = (~todo).astype(np.float64)
        border = cv2.BORDER_CONSTANT
        weight = cv2.boxFilter(known, -1, (3, 3), normalize=False, borderType=border)
        total = cv2.boxFilter(values * known, -1, (3, 3), normalize=False, borderType=border)
        rim = todo & (weight > 0.5)
        values[rim] = total[rim] / weight[rim]
        todo &= ~rim
    if todo.any():
        ndimage = require("scipy.ndimage", "images")
        nearest = ndimage.distance_transform_edt(todo, return_distances=False, return_indices=True)
        values[todo] = values[tuple(nearest[:, todo])]
    return values, missing
