# SPDX-License-Identifier: BSD-3-Clause
"""Statistics that outliers do not pull, and images in blocks of means: what levelling, scars and despeckling share."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats, as_mask
from ..errors import InvalidValue
from .topography import Topography

MAD = 1.4826  # standard deviation over median absolute deviation, for Gaussian noise
_ENOUGH = 1 << 13  # values; tell a median to 1.4 % of the spread


def middle(values: NDArray[Any]) -> float:
    """Median of a sample of 2^13; 0 of nothing."""
    return float(np.median(sample(values))) if values.size else 0.0


def sample(values: NDArray[Any], enough: int = _ENOUGH) -> NDArray[Any]:
    """Every n-th value of many. n is odd, so that it does not follow rows."""
    flat = values.ravel()
    return flat[:: flat.size // enough | 1]


def digit(steps: Floats, height_range: float) -> float:
    """One and a half steps of the digitiser [m]: by how much differences differ, at least, unless by a structure."""
    known = steps[np.isfinite(steps)]
    size = np.abs(known - middle(known))
    smallest = 1.5 * float(size[size > 1e-9 * height_range].min(initial=np.inf))  # less is rounding
    return smallest if smallest < 0.05 * height_range else 0.0


def pixel_noise(z: Floats) -> float:
    """Standard deviation from second differences along the rows, which slopes do not enter [m]."""
    return MAD * middle(np.abs(np.diff(z[:: len(z) // 64 | 1], 2, axis=1))) / float(np.sqrt(6.0))


def reduction(n: int, most: int = 256) -> int:
    """The power of two that brings n pixels to at most `most` blocks."""
    return 1 << max(0, (n - 1).bit_length() - most.bit_length() + 1)


def block_means(values: Floats, size: int, axis: int) -> Floats:
    """Means over blocks of `size` along an axis of a 2-D array; what does not fill a last block is left out."""
    count = values.shape[axis] // size
    if size == 1:
        return values
    if axis == 0:
        return np.asarray(values[: count * size].reshape(count, size, -1).mean(axis=1))
    rows = np.ascontiguousarray(values[:, : count * size]).reshape(-1, size)
    return np.asarray((rows @ np.full(size, 1.0 / size)).reshape(len(values), count))


def used_pixels(topography: Topography, mask: NDArray[np.bool_] | None, least: int = 1) -> NDArray[np.bool_] | None:
    """True where a pixel was measured and is not masked; None where that is everywhere."""
    if mask is None:
        used = None if topography.masked_pixels == 0 else ~topography.mask
    else:
        if np.shape(mask) != topography.shape:
            raise InvalidValue(f"mask: shape {np.shape(mask)}, expected {topography.shape}")
        used = ~(topography.mask | as_mask(mask, "mask"))
    if used is not None and np.count_nonzero(used) < least:
        raise InvalidValue(f"mask: leaves {np.count_nonzero(used)} pixels, expected at least {least}")
    return used
