# SPDX-License-Identifier: BSD-3-Clause
"""A frame with two axes in engineering units, for charts that are drawn by hand."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from nanotouch.units import engineering
from numpy.typing import ArrayLike, NDArray

from nanotouch_app.live.look import SMALL, Palette, step_up
from nanotouch_app.live.painter import Painter

LEFT, RIGHT, TOP, BOTTOM = 58.0, 14.0, 30.0, 42.0  # around the drawn area [pixels]


def ticks(low: float, high: float, most: int) -> NDArray[np.float64]:
    """Round numbers between two ends, at most so many of them."""
    step = step_up((high - low) / most)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    places: NDArray[np.float64] = np.arange(first, last + 1).astype(np.float64) * step
    return places


class Axes:
    """Maps what is measured to pixels."""

    def __init__(self, frame: tuple[float, float, float, float], x: tuple[float, float], y: tuple[float, float]):
        left, bottom, width, height = frame
        self.left, self.bottom = left + LEFT, bottom + BOTTOM
        self.width, self.height = width - LEFT - RIGHT, height - TOP - BOTTOM
        self.x, self.y = x, y

    def at(self, x: ArrayLike, y: ArrayLike) -> NDArray[np.float64]:
        """Rows of pixels; what is not in the frame is drawn at its edge."""
        across = (np.asarray(x, dtype=float) - self.x[0]) / (self.x[1] - self.x[0])
        up = (np.asarray(y, dtype=float) - self.y[0]) / (self.y[1] - self.y[0])
        return np.stack([self.left + np.clip(across, 0, 1) * self.width,
                         self.bottom + np.clip(up, 0, 1) * self.height], axis=-1)  # fmt: skip

    def holds(self, rows: Any) -> Any:
        """Which of rows (x, y, ...) are in the frame."""
        return (rows[:, 0] >= self.x[0]) & (rows[:, 0] <= self.x[1]) & (rows[:, 1] >= self.y[0]) & (
            rows[:, 1] <= self.y[1])  # fmt: skip

    def inside(self, rows: Any) -> Any:
        """Of rows (x, y) those that are in the frame, and the first outside of it at either end."""
        good = self.holds(rows)
        if not good.any():
            return rows[:0]
        first, last = np.flatnonzero(good)[[0, -1]]
        return rows[max(first - 1, 0) : last + 2]

    def draw(self, painter: Painter, palette: Palette, names: tuple[str, str], units: tuple[str, str]) -> None:
        """Grid, ticks and titles; the units are chosen for the ends."""
        for axis, ends in enumerate((self.x, self.y)):
            prefixed, factor = engineering(units[axis], ends)
            shown = ticks(ends[0] * factor, ends[1] * factor, 6 if axis == 0 else 5)
            for tick in shown:
                label = f"{tick:g}" if abs(tick) > 1e-9 else "0"
                if axis == 0:
                    x = float(self.at(tick / factor, self.y[0])[0])
                    painter.line([[x, self.bottom], [x, self.bottom + self.height]], palette.line, 1.0)
                    painter.text(x, self.bottom - 11, label, palette.quiet, SMALL, "centre")
                else:
                    y = float(self.at(self.x[0], tick / factor)[1])
                    painter.line([[self.left, y], [self.left + self.width, y]], palette.line, 1.0)
                    painter.text(self.left - 6, y, label, palette.quiet, SMALL, "right")
            if axis == 0:
                painter.text(self.left + self.width, self.bottom - 28, f"{names[0]} ({prefixed})", palette.quiet, SMALL,
                             "right")  # fmt: skip
            else:
                painter.text(self.left - 6, self.bottom + self.height + 14, f"{names[1]} ({prefixed})", palette.quiet,
                             SMALL)  # fmt: skip
        if self.y[0] < 0.0 < self.y[1]:
            painter.line(self.at(self.x, (0.0, 0.0)), palette.quiet, 1.0)
