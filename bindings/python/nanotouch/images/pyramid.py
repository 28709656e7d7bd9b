# SPDX-License-Identifier: BSD-3-Clause
"""An image at half, a quarter, ... of its resolution, so that a view draws no more than it can show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from ..errors import InvalidValue
from .topography import Topography


@dataclass(frozen=True, eq=False)
class MipLevel:
    """One level of a pyramid: each pixel stands for 2^level x 2^level pixels of the image.

    Where the image's side is no multiple of that, the last row or column stands for fewer.

    Attributes
    ----------
    level : int
        0 for the image itself.
    mean : ndarray, shape (ny, nx)
        Mean height of the measured pixels [m]; of the filled ones where none was measured.
    highest : ndarray, shape (ny, nx)
        Highest of them [m]: what a tip could touch.
    mask : ndarray, shape (ny, nx), bool
        True where no pixel was measured.
    pixel_size : tuple of float
        ``(dy, dx)`` [m].
    """

    level: int
    mean: Floats
    highest: Floats
    mask: NDArray[np.bool_]
    pixel_size: tuple[float, float]


def mip_levels(topography: Topography, smallest: int = 4) -> tuple[MipLevel, ...]:
    """The image and its halvings, as long as both sides keep `smallest` pixels. Level 0 shares the image's memory."""
    if smallest < 1:
        raise InvalidValue(f"smallest: {smallest} pixels, expected 1 or more")
    z, (dy, dx) = topography.heights, topography.pixel_size
    found = [MipLevel(0, z, z, topography.mask, (dy, dx))]
    weight: Floats | None = None if topography.masked_pixels == 0 else (~topography.mask).astype(np.float64)
    mean, highest = z, z
    while max(mean.shape) > 1 and all((n + 1) // 2 >= smallest for n in mean.shape):
        if weight is None and any(n % 2 for n in mean.shape):
            weight = np.full(mean.shape, 4.0 ** (len(found) - 1))
        if weight is None:
            mean = np.asarray(0.25 * np.sum(_quarters(mean), axis=0))
            highest = np.maximum.reduce(_quarters(highest))
            mask = np.zeros(mean.shape, bool)
        else:
            mean, highest, weight = _weighted(mean, highest, weight)
            mask = weight == 0.0
        level = len(found)
        found.append(MipLevel(level, mean, highest, mask, (dy * 2**level, dx * 2**level)))
    return tuple(found)


def _quarters(values: Floats) -> list[Floats]:
    """The four pixels of every 2 x 2 block."""
    return [values[j::2, i::2] for j in (0, 1) for i in (0, 1)]


def _weighted(mean: Floats, highest: Floats, weight: Floats) -> tuple[Floats, Floats, Floats]:
    """One halving where pixels stand for different numbers of measured ones; sides are made even by weight 0."""
    odd = tuple((0, n % 2) for n in mean.shape)
    mean, highest = np.pad(mean, odd, mode="edge"), np.pad(highest, odd, mode="edge")
    weight = np.pad(weight, odd)
    quarters, highs, weights = _quarters(mean), _quarters(highest), _quarters(weight)
    total = np.sum(weights, axis=0)
    measured = total > 0
    weighted = np.sum([q * w for q, w in zip(quarters, weights, strict=True)], axis=0)
    half = np.where(measured, weighted / np.where(measured, total, 1.0), np.mean(quarters, axis=0))
    counted = [np.where((w > 0) | ~measured, h, -np.inf) for h, w in zip(highs, weights, strict=True)]
    return half, np.maximum.reduce(counted), total
