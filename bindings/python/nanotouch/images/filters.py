# SPDX-License-Identifier: BSD-3-Clause
"""Smoothing that knows which pixels were measured: filled ones do not count."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .._arrays import check_between
from ..errors import InvalidValue, require
from .topography import Topography

_REACH = 4.0  # standard deviations; beyond lies 6e-5 of a Gaussian


def gaussian(topography: Topography, sigma: float) -> Topography:
    """Weighted means by a Gaussian of standard deviation `sigma` [m], over what was measured and lies in the image.

    A filled pixel gets the mean of its measured neighbours too; it stays masked.
    """
    check_between("sigma", sigma, "m", above=0.0, up_to=1e-3)
    cv2 = require("cv2", "images")
    sizes = [sigma / d for d in topography.pixel_size]
    window = tuple(2 * min(int(np.ceil(_REACH * s)), n - 1) + 1 for s, n in zip(sizes, topography.shape, strict=True))

    def blur(values: object) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
        # only the ratio of two blurs is used, so what lies outside has no weight
        return cv2.GaussianBlur(values, window[::-1], sigmaX=sizes[1], sigmaY=sizes[0], borderType=cv2.BORDER_CONSTANT)  # type: ignore[no-any-return]

    weight = (~topography.mask).astype(np.float64)
    total = blur(weight)
    known = total > 1e-12
    heights = np.where(known, blur(topography.heights * weight) / np.where(known, total, 1.0), topography.heights)
    return replace(topography, heights=heights)


def median(topography: Topography, size: int = 3) -> Topography:
    """Medians of the measured pixels in windows of size x size pixels; at the border, of the part inside.

    Parameters
    ----------
    topography : Topography
        The image.
    size : int
        Side of the window [pixel]: odd, 3 .. 31.
    """
    if size % 2 == 0 or not 3 <= size <= 31:
        raise InvalidValue(f"size: {size}, expected an odd number of 3 .. 31 pixels")
    ndimage = require("scipy.ndimage", "images")
    half = size // 2
    heights = ndimage.median_filter(topography.heights, size, mode="nearest")
    # windows with a gap, at the border or at filled pixels, by themselves
    gap = np.pad(topography.mask, half, constant_values=True)
    windows = np.lib.stride_tricks.sliding_window_view(gap, (size, size))
    if topography.masked_pixels:
        todo = ndimage.maximum_filter(topography.mask, size)
    else:
        todo = np.zeros(topography.shape, bool)
    todo[:half], todo[-half:], todo[:, :half], todo[:, -half:] = True, True, True, True
    j, i = np.nonzero(todo)
    around = np.lib.stride_tricks.sliding_window_view(np.pad(topography.heights, half), (size, size))
    values = np.where(windows[j, i], np.nan, around[j, i]).reshape(len(j), -1)
    ordered = np.sort(values, axis=1)  # NaN last
    count = np.count_nonzero(np.isfinite(ordered), axis=1)
    row = np.arange(len(j))
    middle = 0.5 * (ordered[row, np.maximum(count - 1, 0) // 2] + ordered[row, np.minimum(count // 2, size**2 - 1)])
    heights[j, i] = np.where(count > 0, middle, topography.heights[j, i])
    return replace(topography, heights=heights)
