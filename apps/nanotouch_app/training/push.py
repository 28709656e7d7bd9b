# SPDX-License-Identifier: BSD-3-Clause
"""Push particles to where they shall lie, by hand: one, or five into a pattern. The session lays and moves them; they
stick, slide, roll, spin and push each other by the law of :mod:`nanotouch.manipulation`."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np
from nanotouch.manipulation import Laid
from numpy.typing import NDArray

from nanotouch_app.common.quantity import digits
from nanotouch_app.training.exercise import Exercise
from nanotouch_app.training.task_texts import TEXTS

RADIUS = 500e-9  # of the particles [m]
ALLOWED = 100e-9  # final error of each [m]
WORST = 5.0  # so many times that scores nothing
LOSS = 2.0  # of the score, for each loss of contact on the way
Floats = NDArray[np.float64]


class Push(Exercise):
    """From its place to a ring that is drawn."""

    name, title, preset = "push", TEXTS["push.title"], "latex_on_glass"
    pushes = "particles"
    """what its subject has to have: particles or a rod"""
    radius = RADIUS
    """of what is pushed [m]"""
    says = "push"
    """whose words it has while it goes on"""
    starts: ClassVar[tuple[tuple[float, float], ...]] = ((0.35, 0.5),)  # over the width
    targets: ClassVar[tuple[tuple[float, float], ...]] = ((0.15, 0.5),)

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.lays = np.array(self.starts) * self.facts.width
        self.count = self.least = len(self.starts)
        self.goals = np.array(self.targets) * self.facts.width
        self.places = np.column_stack([self.lays, np.full(self.count, RADIUS)])
        self.force, self.heat = np.zeros(3), 0.0
        self.events: list[str] = []
        self.largest = 0.0
        self.counts: tuple[int, int] | None = None  # touches and losses, as the task began
        self.touches_now, self.losses = 0, 0

    def take(self, laid: Laid) -> None:
        """What the session says of them."""
        ours = range(self.count)
        self.places, self.force = laid.positions[ours], laid.forces[ours].sum(axis=0)
        self.heat = laid.dissipated
        self.largest = max(self.largest, float(np.linalg.norm(self.force)))
        touches, losses = (sum(of[one] for one in ours) for of in (laid.touches, laid.losses))
        if self.counts is None:
            self.counts = touches, losses
        touches, losses = touches - self.counts[0], losses - self.counts[1]
        before = self.touches_now + self.losses, self.losses
        self.events += ["snap"] * (touches > before[0]) + ["tear"] * (losses > before[1])
        self.touches_now, self.losses = touches - losses, losses

    @property
    def words(self) -> str:
        return TEXTS[f"{self.name}.words"].format(radius=digits(self.radius, "m"), allowed=digits(ALLOWED, "m"))

    @property
    def errors(self) -> Floats:
        """Of each target, the distance of the nearest particle [m]."""
        return np.asarray(np.linalg.norm(self.goals[:, None] - self.places[None, :, :2], axis=2).min(axis=1))

    @property
    def now(self) -> str:
        force = float(np.linalg.norm(self.force))
        return TEXTS[f"{self.says}.now"].format(off=digits(float(self.errors.max()), "m"), force=digits(force, "N", 2))

    @property
    def choices(self) -> list[str]:
        return [TEXTS[f"{self.says}.choice"]]

    @property
    def shown(self) -> dict[str, Any]:
        """What a picture needs."""
        events, self.events = self.events, []
        return {"radius": RADIUS, "places": self.places.tolist(), "targets": self.goals.tolist(), "events": events,
                "heat": self.heat}  # fmt: skip

    def judge(self, frames: Any) -> None:
        """Nothing: :meth:`take` has it all."""

    def choose(self, number: int) -> None:
        """They lie where they shall."""
        if self.touches_now:
            raise self.early(TEXTS["push.touches"])
        errors = self.errors
        extra = max(self.losses - self.least, 0)  # the last one of each is no loss
        score = float(np.clip(1.0 - np.maximum(errors - ALLOWED, 0.0) / ((WORST - 1.0) * ALLOWED), 0.0, 1.0).mean())
        said = TEXTS["push.said"].format(off=digits(float(errors.max()), "m"), allowed=digits(ALLOWED, "m"),
                                         losses=extra)  # fmt: skip
        figures = {"largest error": (float(errors.max()), "m"), "mean error": (float(errors.mean()), "m"),
                   "losses of contact": (float(extra), ""), "largest push": (self.largest, "N")}  # fmt: skip
        self.end(bool((errors <= ALLOWED).all()), 100.0 * score - LOSS * extra, said, figures)


class Pattern(Push):
    """Five particles on a circle."""

    name, title = "pattern", TEXTS["pattern.title"]
    starts = ((0.3, 0.3), (0.7, 0.3), (0.75, 0.6), (0.5, 0.8), (0.25, 0.6))
    targets = tuple(
        (0.5 + 0.3 * math.cos(math.radians(angle)), 0.5 + 0.3 * math.sin(math.radians(angle)))
        for angle in (90, 162, 234, 306, 18)
    )
