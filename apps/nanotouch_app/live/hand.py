# SPDX-License-Identifier: BSD-3-Clause
"""The hand of a person who has no haptic device: it moves a point, the proxy, and physics lets the tip follow through
a spring, the virtual coupling. What lies between the two is what would be felt.

Such a hand is a master without a motor: no loop closes through it. Its moves are lengths at the tip, scaled up by
1/alpha_p here. It yields as an arm would: where the force comes near the limit it gives way by itself."""

from __future__ import annotations

import math
from typing import Any, Protocol

import nanotouch as nt
import numpy as np
from nanotouch import margins
from nanotouch.touch.operator import Hold

SEEN = 0.93  # of a plan's pull-off that a loop shows at least
LATERAL_REACH = 1.5  # travel of the master over the size of the surface
DOWN_REACH = 1.5  # and over what lies below where it starts
COUPLING = 0.25  # spring between proxy and tip over the lever's
SETTLING = 2e-3  # of the virtual tool [s], times the lever's spring over its own
LOAD_SHARE = 0.8  # of the force limit: nearer to it the hand goes no further
PRESS_SHARE = 0.5  # of the largest load: the steady force of the space bar
GLIDE = 0.03  # the master goes to a new place within this [s]
STEPS = 80  # of the wheel from first touch to the largest load
APPROACH = 12.0  # far from the surface a step of the wheel is at least this part of the gap


def rig_of(rig: nt.Rig, settings: nt.Settings, extent: float, way_down: float) -> nt.Rig:
    """The rig with a hand that has no motor, moves on three axes, and reaches over a surface of an extent [m] and down
    from the clearance to the deepest place [m], with the springs between pressed to the force limit."""
    soft = COUPLING / (1.0 + COUPLING) * rig.probe.spring_constant
    reach = max(LATERAL_REACH * extent, DOWN_REACH * (way_down + settings.limits.force / soft))
    made = rig.copy()
    made["master.motor"], made["master.gauge"], made["master.axes"] = "no", "no", 3.0
    made["master.travel"] = min(10.0, max(rig.master.travel, 2.0 * reach / settings.gains.alpha_p))
    made["master.resolution"] = 1e-7
    return made


def felt_scale(rig: nt.Rig, usual: nt.Settings, pull_off_force: float, load: float) -> float:
    """alpha_f at which a pull-off [N] would be clearly felt (:func:`nanotouch.touch.margins.felt_alpha_f`); no loop
    closes that could be less than calm. The browser's is the same (apps/page/src/host.js)."""
    wanted = margins.CLEARLY_FELT / (SEEN * pull_off_force) if pull_off_force > 0.0 else math.inf
    full = margins.heuristic_alpha_f(rig, margins.ForceRange(-pull_off_force, load))
    return max(float(usual.gains.alpha_f), min(wanted, full))


def settings_of(settings: nt.Settings, rig: nt.Rig) -> nt.Settings:
    """The settings with the spring between proxy and tip."""
    made = settings.copy()
    scale = made.gains.alpha_p * made.gains.alpha_f
    made["gains.force_gain"] = 0.0  # no gauge hears the hand
    made["gains.coupling_stiffness"] = COUPLING * rig.probe.spring_constant * scale
    made["gains.coupling_damping"] = made["gains.coupling_stiffness"] * SETTLING / COUPLING
    return made


class Touch(Protocol):
    """What a hand needs to know of a session, and to ask of it."""

    rig: nt.Rig
    clearance: float
    surface: Any
    core: Any

    @property
    def scene(self) -> nt.Scene:
        """That holds."""

    @property
    def settings(self) -> nt.Settings:
        """That hold."""

    @property
    def plan(self) -> nt.Plan:
        """What is computed."""

    @property
    def path(self) -> Any:
        """Where the tip started [m]."""

    def aim(self, to: Hold) -> None:
        """The hand goes there."""


def _ends(session: Touch) -> tuple[Any, Any]:
    """Where the hand may be: within the master's travel, and over the surface."""
    reach = 0.5 * session.rig.master.travel
    low, high = np.full(3, -reach), np.full(3, reach)
    if session.surface is not None:
        for axis, (start, side) in enumerate(zip(session.path[0], session.surface.size, strict=True)):
            low[axis] = max(low[axis], -start / session.settings.gains.alpha_p)
            high[axis] = min(high[axis], (side - start) / session.settings.gains.alpha_p)
    return low, high


def _known(gap: Any) -> float:
    """0 where nobody knows it."""
    return float(gap) if math.isfinite(gap) else 0.0


class Hand:
    """Where the hand is; ``height`` of the proxy in the tip's frame [m], ``place`` in the master's own lengths."""

    def __init__(self, session: Touch) -> None:
        self.session = session
        self.ends = _ends(session)
        self.place = np.array([0.0, 0.0, session.core.master_start])
        self.height = float(session.core.start_height)
        self.zero = self.height + float(session.settings.gains.alpha_p) * float(session.core.master_start)
        """where the proxy is when the master reads 0 [m]"""
        self.presses = False
        self.aimed_at = -math.inf  # session time of the last move [s]
        self.told_apart = max(5.0 * session.rig.master.resolution, 1e-4 * session.rig.master.travel)
        load = float(session.scene.range.maximum_load)
        self.step = (float(session.plan.explain()["largest_indentation"]) + load / self.stiffness) / STEPS
        self.limit = LOAD_SHARE * float(session.settings.limits.force)
        self.press_force = PRESS_SHARE * load
        gaps = -np.linspace(0.0, 1.2, 400) * float(session.plan.explain()["largest_indentation"])
        sunk = float(np.interp(self.limit, session.plan.force(gaps, "retract"), -gaps))
        self.reach_down = sunk + self.limit / self.stiffness  # of the proxy below the surface [m]

    @property
    def stiffness(self) -> float:
        """Between proxy and tip: coupling and lever, one after the other [N/m]."""
        gains, lever = self.session.settings.gains, float(self.session.rig.probe.spring_constant)
        spring = float(gains.coupling_stiffness / (gains.alpha_p * gains.alpha_f))
        return spring * lever / (spring + lever) if spring > 0.0 else lever

    def acts(self, frame: Any) -> bool:
        """Whether it moves by itself now: it presses, or yields."""
        return self.presses or float(frame["tip_force"][2]) > 1.1 * self.limit

    def _catch_up(self, frame: Any) -> None:
        """Another program may have led the hand meanwhile: it is where the master is."""
        if frame["time"] < self.aimed_at + 2.0 * GLIDE:
            return
        way = np.asarray(frame["master_position"]) - self.place
        way[: 2 * (self.session.rig.master.axes != 3.0)] = 0.0
        if np.abs(way).max() > self.told_apart:
            self.place = self.place + way
            self.height -= float(way[2] * self.session.settings.gains.alpha_p)

    def follow(self, frame: Any, elapsed: float) -> None:
        """What an arm does by itself, some hundred times a second: it presses, yields, and stays by a stopped tip."""
        force, tip = float(frame["tip_force"][2]), float(frame["tip_position"][2])
        if not (math.isfinite(force) and math.isfinite(tip)):
            return
        if frame["state"] != 0:
            self.height, self.presses = tip - force / self.stiffness, False
        elif force > 1.1 * self.limit:
            self._shift((0.0, 0.0, -(force - self.limit) / self.stiffness), frame)
        elif self.presses:
            way = 4.0 * elapsed * (self.press_force - force) / self.stiffness
            if not frame["contact_radius"] > 0.0:
                way = elapsed * max(STEPS * self.step, 2.0 * _known(frame["gap"]))
            self.move((0.0, 0.0, way), frame)

    def lift(self, frame: Any) -> None:
        """Draw back by the clearance, and by what adhesion stretches the springs before it lets go."""
        self._catch_up(frame)
        stretch = self.session.plan.pull_off_force / self.stiffness
        up = float(frame["tip_position"][2]) + self.session.clearance + 1.2 * stretch - self.height
        self._shift((0.0, 0.0, -max(up, 0.0)), frame)

    def step_down(self, steps: float, frame: Any) -> None:
        """Go down by steps of the wheel, longer ones far away from the surface; up if below 0."""
        far = max(_known(frame["gap"]), 0.0) / APPROACH if not frame["contact_radius"] > 0.0 else 0.0
        self.move((0.0, 0.0, steps * max(self.step, far)), frame)

    def move(self, way: tuple[float, float, float], frame: Any) -> bool:
        """Move by lengths at the tip [m], the third one + down. False where the force limit has cut the way."""
        self._catch_up(frame)
        tip, force = float(frame["tip_position"][2]), float(frame["tip_force"][2])
        room = self.height - tip + _known(frame["gap"]) + self.reach_down
        if not math.isfinite(frame["gap"]):  # a real slave says only what its lever feels
            room = (self.limit - force) / self.stiffness
        down = min(way[2], max(room, 0.0)) if math.isfinite(room) else min(way[2], 0.0)
        self._shift((way[0], way[1], down), frame)
        return down == way[2]

    def _shift(self, way: tuple[float, float, float], frame: Any) -> None:
        if not np.isfinite(way).all():  # where the tip is nobody knows
            return
        self.aimed_at = float(frame["time"])
        scale = 1.0 / self.session.settings.gains.alpha_p
        before, self.place = self.place, np.clip(self.place + scale * np.asarray(way), *self.ends)
        self.height -= float(self.place[2] - before[2]) / scale  # no further than the hand has gone
        x, y, z = (float(part) for part in self.place)
        self.session.aim(Hold((x, y, z), math.nan, math.nan, GLIDE))
