# SPDX-License-Identifier: BSD-3-Clause
"""Push particles to where they shall lie, by hand: one, or five into a pattern. They stick, slide, roll and spin by the
law of :mod:`nanotouch.manipulation`; the tip goes where the hand leads it."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import nanotouch as nt
import numpy as np
from nanotouch.errors import Error
from nanotouch.manipulation import latex
from numpy.typing import NDArray

from nanotouch_app.quantity import digits
from nanotouch_app.training.exercise import Exercise
from nanotouch_app.training.task_texts import TEXTS

RADIUS = 500e-9  # of the particles [m]
ALLOWED = 100e-9  # final error of each [m]
WORST = 5.0  # so many times that scores nothing
LOSS = 2.0  # of the score, for each loss of contact on the way
STEP = 4e-9  # of the tip between two points that a particle is told [m]
NEAR = 1.3  # a particle is told from this distance on, over the two radii
Floats = NDArray[np.float64]


class Pushed:
    """One particle: where it lies, and what the tip does to it."""

    def __init__(self, particle: nt.Particle, place: Floats) -> None:
        self.particle = particle
        self.place = np.array([*place, particle.radius])
        self.state: Any = None  # None: the tip is far away
        self.force = np.zeros(3)
        self.touched = False
        self.losses = 0

    def reach(self, height: float) -> float:
        """From the middle to the apex of a tip that touches with its flank, at a height [m]."""
        of = self.particle
        up = of.radius - of.tip_radius - height
        return (of.radius + of.tip_radius + up * math.sin(of.tip_half_angle)) / math.cos(of.tip_half_angle)

    def follow(self, tips: Floats) -> str:
        """The tip goes along; "snap" where it touches, "tear" where it loses contact."""
        near = np.linalg.norm(tips[:, :2] - self.place[:2], axis=1) < NEAR * self.reach(float(tips[:, 2].min()))
        if not near.any():
            self.state, self.force = None, np.zeros(3)
            return self._touches(False)
        try:
            if self.state is None:
                first = tips[max(int(np.argmax(near)) - 1, 0)]
                x, y = (float(part) for part in self.place[:2])
                self.state = self.particle.place(x, y, (float(first[0]), float(first[1]), float(first[2])))
            path = self.particle.run(*tips.T, state=self.state)
        except Error:  # the tip stands in it when the task begins, or has leapt into it: it lies until the tip is out
            self.state, self.force = None, np.zeros(3)
            return self._touches(False)
        self.state, self.place, self.force = path.state, path.position[-1], path.force[-1]
        return self._touches(bool(path.contact_radius[-1, 1] > 0.0))

    def _touches(self, now: bool) -> str:
        before, self.touched = self.touched, now
        self.losses += int(before and not now)
        return "" if before == self.touched else "snap" if self.touched else "tear"


class Push(Exercise):
    """From its place to a ring that is drawn."""

    name, title, preset = "push", TEXTS["push.title"], "latex_on_glass"
    starts: ClassVar[tuple[tuple[float, float], ...]] = ((0.35, 0.5),)  # over the width
    targets: ClassVar[tuple[tuple[float, float], ...]] = ((0.15, 0.5),)

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        tip_radius = float(self.facts.scene.tip.radius)
        particle = latex(RADIUS, tip_radius, float(self.facts.scene.tip.half_angle))
        self.goals = np.array(self.targets) * self.facts.width
        self.particles = [Pushed(particle, np.array(start) * self.facts.width) for start in self.starts]
        self.last: Floats | None = None
        self.events: list[str] = []
        self.largest = 0.0

    @property
    def words(self) -> str:
        return TEXTS[f"{self.name}.words"].format(radius=digits(RADIUS, "m"), allowed=digits(ALLOWED, "m"))

    @property
    def errors(self) -> Floats:
        """Of each target, the distance of the nearest particle [m]."""
        places = np.array([one.place[:2] for one in self.particles])
        return np.asarray(np.linalg.norm(self.goals[:, None] - places[None], axis=2).min(axis=1))

    @property
    def losses(self) -> int:
        """How often the tip has lost contact."""
        return sum(one.losses for one in self.particles)

    @property
    def now(self) -> str:
        force = float(np.linalg.norm(sum(one.force for one in self.particles)))
        return TEXTS["push.now"].format(off=digits(float(self.errors.max()), "m"), force=digits(force, "N", 2))

    @property
    def choices(self) -> list[str]:
        return [TEXTS["push.choice"]]

    @property
    def shown(self) -> dict[str, Any]:
        """What a picture needs."""
        events, self.events = self.events, []
        return {"radius": RADIUS, "places": [one.place.tolist() for one in self.particles],
                "targets": self.goals.tolist(), "events": events}  # fmt: skip

    def judge(self, frames: Any) -> None:
        """Each particle follows the tip."""
        tips = np.asarray(frames["tip_position"], dtype=float)
        if self.last is not None:
            tips = np.concatenate([self.last[None], tips])
        gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(tips, axis=0), axis=1))])
        if self.last is not None and gone[-1] < STEP:
            return
        kept = np.flatnonzero(np.diff(np.floor(gone / STEP), prepend=-1.0))
        tips, self.last = tips[kept], tips[kept[-1]]
        tips[:, 2] = np.maximum(tips[:, 2], 0.0)  # pressed into the glass by less than a nanometre
        for one in self.particles:
            if event := one.follow(tips):
                self.events.append(event)
            self.largest = max(self.largest, float(np.linalg.norm(one.force)))

    def choose(self, number: int) -> None:
        """They lie where they shall."""
        if any(one.touched for one in self.particles):
            raise self.early(TEXTS["push.touches"])
        errors, losses = self.errors, self.losses
        extra = max(losses - len(self.particles), 0)  # the last one of each is no loss
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
