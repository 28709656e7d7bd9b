# SPDX-License-Identifier: BSD-3-Clause
"""Keep a constant force while the tip goes over the relief."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from nanotouch_app.common.quantity import digits
from nanotouch_app.training.exercise import Exercise
from nanotouch_app.training.task_texts import TEXTS

TARGET, BAND = 0.3, 0.25  # of the largest load; of the target
TIME, WAY = 10.0, 0.1  # [s]; of the width
NEEDED = 0.8  # share of the time within the band


class Steady(Exercise):
    """It begins when the force is first within the band, and ends after ten seconds."""

    name, title = "steady", TEXTS["steady.title"]

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.since = math.inf
        self.good = self.count = 0
        self.squares = 0.0
        self.ends = [math.inf, -math.inf]

    @property
    def target(self) -> float:
        """[N]"""
        return TARGET * self.facts.load

    @property
    def words(self) -> str:
        return TEXTS["steady.words"].format(target=digits(self.target, "N"), band=f"{100 * BAND:.0f}", time=f"{TIME:g}",
                                            way=digits(WAY * self.facts.width, "m"))  # fmt: skip

    @property
    def now(self) -> str:
        if not self.count:
            return TEXTS["steady.left"].format(target=digits(self.target, "N"))
        return TEXTS["steady.now"].format(share=f"{100 * self.good / self.count:.0f}")

    def judge(self, frames: Any) -> None:
        """Share of the ticks within the band, and the RMS error."""
        force, when = frames["tip_force"][:, 2], frames["time"]
        within = np.abs(force - self.target) <= BAND * self.target
        if self.since == math.inf:
            if not within.any():
                return
            self.since = float(when[int(np.argmax(within))])
        counted = (when >= self.since) & (when < self.since + TIME)
        self.good += int(np.sum(within & counted))
        self.count += int(np.sum(counted))
        self.squares += float(np.sum((force[counted] - self.target) ** 2))
        x = frames["tip_position"][counted, 0]
        self.ends = [min(self.ends[0], x.min(initial=math.inf)), max(self.ends[1], x.max(initial=-math.inf))]
        if when[-1] >= self.since + TIME:
            self._finish()

    def _finish(self) -> None:
        share, error = self.good / self.count, math.sqrt(self.squares / self.count) / self.target
        way = self.ends[1] - self.ends[0]
        moved = way >= WAY * self.facts.width
        said = TEXTS["steady.now"].format(share=f"{100 * share:.0f}") + ("" if moved else TEXTS["steady.still"])
        self.end(share >= NEEDED and moved, 100.0 * share * min(1.0, way / (WAY * self.facts.width)), said,
                 {"share within": (share, ""), "RMS error": (error * self.target, "N"), "target": (self.target, "N"),
                  "way": (way, "m")})  # fmt: skip
