# SPDX-License-Identifier: BSD-3-Clause
"""How much higher than they are heights are drawn: so that a relief is seen, and a strand of DNA stays a strand."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

MOST_PIXELS = 256  # to a side of the mesh: at most 2^17 triangles
RELIEF = 0.12  # height of the drawn relief where it has to be exaggerated, over the width of the surface
SLENDER = 2.0  # no feature is drawn higher than so many of its widths, if it is not so by itself
LADDER = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)  # of the factor, times a power of ten
HIGHEST = 0.5  # of the drawn relief that a person may choose, over the width of the surface


def coarse(heights: Floats, most: int = MOST_PIXELS) -> tuple[Floats, int]:
    """Mean heights over squares of so many pixels that at most ``most`` are left to a side; and how many."""
    size = -(-max(heights.shape) // most)
    rows, columns = (length // size * size for length in heights.shape)
    means = heights[:rows, :columns].reshape(rows // size, size, columns // size, size).mean(axis=(1, 3))
    return means, size


def feature_width(heights: Floats, spacing: tuple[float, float]) -> float:
    """Way along y or x after which heights are as good as any others: their mean square difference is the variance.

    ``spacing`` of the rows and of the columns; the width has its unit.
    """
    variance, ways = float(heights.var()), []
    for axis, step in enumerate(spacing):
        lines = np.moveaxis(heights, axis, 0)
        lag = next((lag for lag in range(1, len(lines) // 2)
                    if float(np.mean((lines[lag:] - lines[:-lag]) ** 2)) >= variance), len(lines) // 2)  # fmt: skip
        ways.append(lag * step)
    return min(ways)


def exaggeration(heights: Floats, spacing: tuple[float, float], width: float) -> float:
    """By what heights are multiplied: 1, 1.5, 2, 3, 5 or 7 times a power of ten, 1 for a steep relief.

    ``spacing`` and ``width`` of the surface in the unit of the heights.
    """
    relief = float(np.ptp(heights))
    if not relief > 0.0:
        return 1.0
    return step_below(min(RELIEF * width, SLENDER * feature_width(heights, spacing)) / relief)


def step_below(factor: float) -> float:
    """The largest step up to this factor; 1 for a smaller one."""
    if not factor > 1.0:
        return 1.0
    power = 10.0 ** math.floor(math.log10(factor))
    return max(step * power for step in LADDER if step * power <= factor * (1 + 1e-12))


def stepped(factor: float, up: bool, relief: float) -> float:
    """The next step of the factor, from 1 to where a relief (over the width of the surface) is HIGHEST."""
    if not up:
        return step_below(factor * (1 - 1e-9))
    power = 10.0 ** math.floor(math.log10(factor * (1 + 1e-9)))
    following = next(step * power for step in (*LADDER, 10.0) if step * power > factor * (1 + 1e-9))
    return following if following * relief <= HIGHEST else factor
