# SPDX-License-Identifier: BSD-3-Clause
"""Leave a dent of a depth that is asked for, in a sample that yields; and scratch a groove."""

from __future__ import annotations

import math
from typing import Any

from nanotouch import plasticity
from nanotouch.errors import InvalidValue
from nanotouch.plasticity import Imprint

from nanotouch_app.common.quantity import digits
from nanotouch_app.training.exercise import Exercise, touching
from nanotouch_app.training.task_texts import TEXTS

SHARES = 0.3, 0.8  # of the largest load: between these lies the one that makes what is asked for
ALLOWED = 0.15  # error of the residual depth, relative
GROOVE, LONG = 0.3, 0.1  # of the width: the groove's length; its error, relative


class Dent(Exercise):
    """The depth that stays is what counts: less than how far the tip went down."""

    name, title, preset = "dent", TEXTS["dent.title"], "soft_gold"

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        scene = self.facts.scene
        if scene.sample.dents != "yes":
            raise InvalidValue(f"task {self.name!r}: this sample keeps no dents; lay soft_gold")
        facts = scene.plan(relative_accuracy=self.facts.accuracy).explain()
        law = plasticity.Indentation(facts["radius"], facts["effective_modulus"], float(scene.sample.yield_strength))
        self.asked_depth = float(law.at_load(self.rng.uniform(*SHARES) * self.facts.load).residual_depth)
        self.deepest = self.largest = 0.0

    @property
    def words(self) -> str:
        return TEXTS["dent.words"].format(depth=digits(self.asked_depth, "m", 2))

    @property
    def imprint(self) -> Imprint | None:
        """The newest dent; of a scratch, the newest groove."""
        made = [dent.imprint for dent in self.dents if self.counts(dent.imprint)]
        return made[-1] if made else None

    @staticmethod
    def counts(imprint: Imprint) -> bool:
        """Whether it is what was asked for."""
        return imprint[:2] == imprint[2:4]

    @property
    def now(self) -> str:
        made = self.imprint
        return TEXTS["dent.none"] if made is None else TEXTS["dent.now"].format(depth=digits(made.depth, "m"))

    @property
    def choices(self) -> list[str]:
        return [TEXTS["dent.choice"]]

    def judge(self, frames: Any) -> None:
        """How far and how hard it was pressed."""
        pressed = frames[touching(frames)]
        self.deepest = max(self.deepest, float(-pressed["tip_position"][:, 2].min(initial=0.0)))
        self.largest = max(self.largest, float(frames["tip_force"][:, 2].max()))

    def choose(self, number: int) -> None:
        """Measure what there is."""
        if self.touches:
            raise self.early(TEXTS["dent.touches"])
        made = self.imprint
        if made is None:
            raise self.early(TEXTS["dent.none"])
        error = abs(made.depth - self.asked_depth) / self.asked_depth
        said = TEXTS["dent.said"].format(depth=digits(made.depth, "m"), asked=digits(self.asked_depth, "m"),
                                         reached=digits(self.deepest, "m"))  # fmt: skip
        self.finish(made, error, said)

    def finish(self, made: Imprint, error: float, said: str) -> None:
        """Of a dent the depth alone."""
        self.end(error <= ALLOWED, 100.0 * (1.0 - error), said, self.figures(made, error))

    def figures(self, made: Imprint, error: float) -> dict[str, tuple[float, str]]:
        """What was measured."""
        return {"residual depth": (made.depth, "m"), "asked": (self.asked_depth, "m"), "error": (error, ""),
                "depth reached": (self.deepest, "m"), "largest force": (self.largest, "N")}  # fmt: skip


class Scratch(Dent):
    """A groove of a depth and a length."""

    name, title = "scratch", TEXTS["scratch.title"]

    @property
    def length(self) -> float:
        """[m]"""
        return GROOVE * self.facts.width

    @property
    def words(self) -> str:
        return TEXTS["scratch.words"].format(length=digits(self.length, "m", 2), depth=digits(self.asked_depth, "m", 2))

    @staticmethod
    def counts(imprint: Imprint) -> bool:
        """A groove ends elsewhere than it begins."""
        return imprint[:2] != imprint[2:4]

    def finish(self, made: Imprint, error: float, said: str) -> None:
        """Depth and length; the worse of the two is the score."""
        length = math.hypot(made.end_x - made.start_x, made.end_y - made.start_y)
        off = abs(length - self.length) / self.length
        said += TEXTS["scratch.said"].format(length=digits(length, "m"), asked=digits(self.length, "m"))
        figures = {**self.figures(made, error), "length": (length, "m"), "error of the length": (off, "")}
        self.end(error <= ALLOWED and off <= LONG, 100.0 * (1.0 - max(error, off)), said, figures)
