# SPDX-License-Identifier: BSD-3-Clause
"""Measure a pull-off: touch, tear, and say how much it was."""

from __future__ import annotations

from typing import Any

from nanotouch_app.common.quantity import digits
from nanotouch_app.training.exercise import Exercise, touching
from nanotouch_app.training.task_texts import TEXTS

NEEDED = 3  # pull-offs
ALLOWED = 0.1  # error of the answer, relative


class PullOff(Exercise):
    """The law is hidden; the force over time is not. The answer is compared with the law's."""

    name, title, asked = "pull_off", TEXTS["pull_off.title"], "N"
    hides = frozenset({"law"})
    lowest = 0.0

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.measured: list[float] = []

    @property
    def words(self) -> str:
        return TEXTS["pull_off.words"].format(needed=NEEDED)

    @property
    def now(self) -> str:
        left = NEEDED - len(self.measured)
        return TEXTS["pull_off.left"].format(left=left) if left > 0 else TEXTS["pull_off.now"]

    def judge(self, frames: Any) -> None:
        """A pull-off is the deepest pull between a contact and its end."""
        touched = self.touches
        for force, touches in zip(frames["tip_force"][:, 2], touching(frames), strict=True):
            if touches:
                self.lowest = min(self.lowest, float(force)) if touched else float(force)
            elif touched:
                self.measured.append(-min(self.lowest, float(force)))
            touched = bool(touches)

    def answer(self, value: float) -> None:
        """Against the mean of what has torn, and against the law."""
        if len(self.measured) < NEEDED:
            raise self.early(TEXTS["pull_off.early"].format(left=NEEDED - len(self.measured)))
        mean = sum(self.measured) / len(self.measured)
        error = abs(abs(value) - mean) / mean if mean > 0.0 else float("inf")
        law = self.facts.pull_off
        told = {"answer": abs(value), "mean": mean, "law": law}
        said = TEXTS["pull_off.said"].format(**{name: digits(one, "N") for name, one in told.items()})
        figures = {"answer": (abs(value), "N"), "measured": (mean, "N"), "law": (law, "N"), "error": (error, "")}
        self.end(error <= ALLOWED, 100.0 * (1.0 - error), said, figures)
