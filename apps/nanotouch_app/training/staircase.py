# SPDX-License-Identifier: BSD-3-Clause
"""Two down, one up: a staircase that settles where 70.7 % of the answers are right (Levitt, J. Acoust. Soc. Am. 49
(1971) 467)."""

from __future__ import annotations

import math

RIGHT = 0.707  # share of right answers where it settles


class Staircase:
    """Of a ratio above 1: two right answers in a row bring it nearer to 1, a wrong one takes it away."""

    def __init__(self, start: float = 3.0, least: float = 1.02, most: float = 10.0, reversals: int = 8) -> None:
        self.log, self.least, self.most = math.log(start), math.log(least), math.log(most)
        self.needed = reversals
        self.reversals: list[float] = []
        self.right_in_a_row = self.last_way = self.trials = self.at_the_floor = 0

    @property
    def ratio(self) -> float:
        """To be shown next."""
        return math.exp(self.log)

    @property
    def done(self) -> bool:
        """Enough reversals; or two pairs of right answers at the least ratio."""
        return len(self.reversals) >= self.needed or self.at_the_floor >= 2

    def take(self, right: bool) -> None:
        """One answer."""
        self.trials += 1
        self.right_in_a_row = self.right_in_a_row + 1 if right else 0
        way = 1 if not right else -1 if self.right_in_a_row == 2 else 0
        if way == 0:
            return
        self.right_in_a_row = 0
        if way == -1 and self.log <= self.least:
            self.at_the_floor += 1
        if self.last_way and way != self.last_way:
            self.reversals.append(self.log)
        self.last_way = way
        factor = 0.5 if not self.reversals else 0.75  # of the logarithm
        self.log = min(max(self.log * (factor if way < 0 else 1.0 / factor), self.least), self.most)

    @property
    def threshold(self) -> float:
        """The ratio where it settled: geometric mean of the last six reversals, or the least one shown."""
        if self.at_the_floor >= 2 or not self.reversals:
            return self.ratio
        last = self.reversals[-6:]
        return math.exp(sum(last) / len(last))
