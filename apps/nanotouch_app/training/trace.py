# SPDX-License-Identifier: BSD-3-Clause
"""Trace a grating with the lights off, and say its period."""

from __future__ import annotations

from typing import Any

import numpy as np

from nanotouch_app.common.quantity import digits
from nanotouch_app.training.exercise import Exercise, touching
from nanotouch_app.training.task_texts import TEXTS

PARTS = 60  # of the width; each is touched or not
NEEDED = 0.5  # share of them
ALLOWED = 0.1  # error of the period, relative


class Trace(Exercise):
    """The surface is not drawn; height comes from the hand alone."""

    name, title, asked, preset = "trace", TEXTS["trace.title"], "m", "grating"
    hides = frozenset({"surface", "contact"})
    period = 3e-6  # of the preset [m]

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.touched = np.zeros(PARTS, dtype=bool)
        self.largest = 0.0

    @property
    def words(self) -> str:
        return TEXTS["trace.words"].format(width=digits(self.facts.width, "m"))

    @property
    def share(self) -> float:
        """Of the width that was touched."""
        return float(self.touched.mean())

    @property
    def now(self) -> str:
        left = TEXTS["trace.left"].format(share=f"{100 * self.share:.0f}")
        return TEXTS["trace.now"] if self.share >= NEEDED else left

    def judge(self, frames: Any) -> None:
        """Where the tip has touched."""
        x = frames["tip_position"][touching(frames), 0]
        self.touched[np.clip((x / self.facts.width * PARTS).astype(int), 0, PARTS - 1)] = True
        self.largest = max(self.largest, float(frames["tip_force"][:, 2].max()))

    def answer(self, value: float) -> None:
        """Against the period of the grating."""
        if self.share < NEEDED:
            raise self.early(TEXTS["trace.early"].format(share=f"{100 * self.share:.0f}"))
        error = abs(value - self.period) / self.period
        said = TEXTS["trace.said"].format(answer=digits(value, "m"), period=digits(self.period, "m"))
        self.end(error <= ALLOWED, 100.0 * (1.0 - error), said,
                 {"answer": (value, "m"), "period": (self.period, "m"), "error": (error, ""),
                  "largest force": (self.largest, "N"), "width touched": (self.share, "")})  # fmt: skip
