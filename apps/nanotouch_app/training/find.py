# SPDX-License-Identifier: BSD-3-Clause
"""Find the surface below a force."""

from __future__ import annotations

import math
from typing import Any

from nanotouch_app.common.quantity import digits
from nanotouch_app.training.exercise import Exercise, touching
from nanotouch_app.training.task_texts import TEXTS

SHARE = 0.05  # of the largest load: the force that is allowed
HELD = 1.0  # the contact is kept for so long [s]


class Find(Exercise):
    """The largest force until the tip has lain on the sample for a second."""

    name, title = "find", TEXTS["find.title"]

    @property
    def limit(self) -> float:
        """[N]"""
        return SHARE * self.facts.load

    @property
    def words(self) -> str:
        return TEXTS["find.words"].format(held=f"{HELD:g}", limit=digits(self.limit, "N"))

    @property
    def now(self) -> str:
        return TEXTS["find.now"].format(largest=digits(max(self.largest, 0.0), "N"))

    largest, since = 0.0, math.inf

    def judge(self, frames: Any) -> None:
        """It begins anew when contact is lost."""
        self.largest = max(self.largest, float(frames["tip_force"][:, 2].max()))
        for when, touches in zip(frames["time"], touching(frames), strict=True):
            if not touches:
                self.since = math.inf
            elif self.since == math.inf:
                self.since = float(when)
            elif when - self.since >= HELD:
                passed = self.largest <= self.limit
                said = TEXTS["find.said"].format(largest=digits(self.largest, "N"), limit=digits(self.limit, "N"))
                self.end(passed, 100.0 * self.limit / max(self.largest, 1e-15), said,
                         {"largest force": (self.largest, "N"), "limit": (self.limit, "N")})  # fmt: skip
                return
