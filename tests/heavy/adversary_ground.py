# SPDX-License-Identifier: BSD-3-Clause
"""Where a relief is steep, as the tip touches it (adversary.py): there the promises are closest to be broken."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np

FINE = 161
"""points along an axis at which slopes are looked at"""
STEEP = 0.95
"""a place is among the steepest from this share of the largest slope on"""


class Ground:
    """Slopes of a surface, whose borders nothing crosses."""

    def __init__(self, surface: nt.Surface) -> None:
        x, y = (np.linspace(0.0, size, FINE) for size in surface.size)
        self.step = np.array([x[1], y[1]])
        heights = np.asarray(surface.height(*np.meshgrid(x, y)))
        self.gradient = np.stack(np.gradient(heights, y[1], x[1])[::-1])
        self.slope = np.hypot(*self.gradient)
        self.places = np.argwhere(self.slope >= STEEP * self.slope.max())[:, ::-1] * self.step

    def nearest(self, to: Any) -> Any:
        """x, y of the nearest one of the steepest places [m]"""
        return self.places[int(np.argmin(((self.places - to) ** 2).sum(axis=1)))]

    def uphill(self, place: Any) -> Any:
        """The direction in which it rises there, of length 1."""
        column, row = (place / self.step).round().astype(int)
        return self.gradient[:, row, column] / max(self.slope[row, column], 1e-300)

    def steepness(self, x: Any, y: Any) -> Any:
        """Of places, over that of the steepest one; 0 where a place is not known."""
        place = np.column_stack([x, y]) / self.step
        known = np.isfinite(place).all(axis=1)
        column, row = np.clip(np.where(known[:, None], place, 0.0).round().astype(int), 0, FINE - 1).T
        return np.where(known, self.slope[row, column] / max(self.slope.max(), 1e-300), 0.0)
