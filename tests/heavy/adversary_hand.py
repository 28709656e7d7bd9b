# SPDX-License-Identifier: BSD-3-Clause
"""The person of adversary.py: a hand that presses, roams and strikes, and what it asks for meanwhile."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
from adversary_draws import Dice, Plot
from adversary_ground import Ground
from adversary_judge import Judge
from nanotouch.touch.operator import Hold, Input

FASTEST = 1.0
"""of a hand, where its master declares nothing [m/s]"""
MODES = ("point", "point", "scan", "topography", "approach", "curve")


def fastest(rig: nt.Rig) -> float:
    """Speed of a hand that the rig is made for [m/s]."""
    return float(getattr(rig.master, "max_speed", FASTEST))


class Hand:
    """Blows of any force, or any way, as fast as a hand goes."""

    def __init__(self, session: Any, plot: Plot, d: Dice) -> None:
        self.session, self.plot, self.d = session, plot, d
        self.at = np.array([0.0, 0.0, float(session.core.master_start)])
        self.presses, self.roams = d.between(0.3, 1.0), d.between(0.0, 1.0)  # shares of its blows
        self.tip, self.gap = np.array(session.path[0], dtype=float), plot.clearance
        self.ground = None if plot.surface is None else Ground(plot.surface)

    @property
    def steep(self) -> Any:
        """Where it is steepest, as near as that is; None on a flat."""
        return None if self.ground is None else self.ground.nearest(self.tip)

    def follow(self, columns: Any) -> None:
        """Where the master is now."""
        if len(columns["time"]):
            sideways = [columns[name][-1] if name in columns else 0.0 for name in ("master_x", "master_y")]
            at = np.array([*sideways, columns["master_position"][-1]])
            self.at = np.where(np.isfinite(at), at, self.at)
            tip, gap = np.array([columns["x"][-1], columns["y"][-1]]), float(columns["gap"][-1])
            self.tip = np.where(np.isfinite(tip), tip, self.tip)
            self.gap = gap if math.isfinite(gap) else 0.0

    def place(self) -> tuple[float, float]:
        """Where an input leads the tip: with a master of three axes nowhere."""
        d, surface = self.d, self.plot.surface
        if self.plot.rig.stage.axes == 1.0 or not d.chance(self.roams):
            return math.nan, math.nan
        if surface is None:
            return d.between(-1e-6, 1e-6), d.between(-1e-6, 1e-6)
        if d.chance(0.5):
            x, y = self.steep
            return float(x), float(y)
        return d.between(0.0, surface.size[0]), d.between(0.0, surface.size[1])

    def down(self) -> Hold:
        """The first: the tip comes near, or lands."""
        alpha = self.session.settings.gains.alpha_p
        to = self.at + np.array([0.0, 0.0, self.d.between(0.7, 1.3) * self.plot.clearance / alpha])
        end = 0.49 * self.plot.rig.master.travel
        to[2] = min(to[2], end)
        return Hold(self._axes(to), math.nan, math.nan, self.d.log(5e-3, 0.05))

    def _axes(self, to: Any) -> Any:
        return tuple(map(float, to)) if self.plot.rig.master.axes == 3.0 else float(to[2])

    def strike(self, aside: bool = True) -> Hold:
        """Past the limit where it is steep, as fast as hand and stage go: what each promise has to hold against."""
        d, settings = self.d, self.session.settings
        deep = max(self.gap, 0.0) + d.log(0.5, 5.0) * settings.limits.force / float(self.plot.rig.probe.spring_constant)
        way = np.array([0.0, 0.0, deep + d.log(1e-9, 50e-9)]) / settings.gains.alpha_p
        x, y = self.place() if aside else (math.nan, math.nan)
        if aside and self.plot.rig.master.axes == 3.0 and self.steep is not None and d.chance(0.5):
            way[:2] = (self.steep - self.tip) / settings.gains.alpha_p
        return self._toward(way, x, y, d.log(1.0, 10.0))

    def assault(self) -> list[tuple[float, Hold]]:
        """Lifted, to below where it is steepest, as far as it comes in a while; then pressed down while it goes uphill,
        as fast as it may. Times [s] and what the hand does."""
        settings, lift = self.session.settings, min(self.gap, 0.0) - 5e-9
        if self.ground is None or self.plot.rig.stage.axes == 1.0:
            return [(0.01, self._lead(np.zeros(2), lift, 0.0)), (0.03, self.strike(aside=False))]
        deep = max(self.gap, 0.0) + self.d.log(1.0, 5.0) * settings.limits.force / float(
            self.plot.rig.probe.spring_constant
        )
        falls = min(0.15, 0.01 + 1.2 * deep / settings.limits.stage_speed)
        steep = self.steep
        climb = self.ground.uphill(steep) * min(falls * settings.limits.lateral_speed, 0.1 * self.plot.surface.size[0])
        way = steep - climb - self.tip
        lasts = min(0.25, 0.01 + 1.05 * float(np.hypot(*way)) / settings.limits.lateral_speed)
        return [(lasts, self._lead(way, lift, lasts)), (falls + 0.01, self._lead(1.1 * climb, deep, falls))]

    def _lead(self, aside: Any, down: float, lasts: float) -> Hold:
        """The tip sideways by a way and down [m]; inputs take that long [s]."""
        three, alpha = self.plot.rig.master.axes == 3.0, self.session.settings.gains.alpha_p
        sideways = aside / alpha if three else np.zeros(2)
        led = not three and self.plot.rig.stage.axes == 3.0 and self.ground is not None
        to = np.clip(self.tip + aside, 0.0, self.plot.surface.size) if led else np.full(2, math.nan)
        blow = self._toward(np.append(sideways, down / alpha), float(to[0]), float(to[1]), 1.0)
        return blow._replace(duration=max(lasts, blow.duration))

    def centre(self) -> Hold:
        """The master in the middle of its travel, where it can go any way."""
        return self._toward(-self.at, math.nan, math.nan, 1.0)

    def _toward(self, way: Any, x: float, y: float, slower: float) -> Hold:
        end = 0.49 * self.plot.rig.master.travel
        to = np.clip(self.at + way, -end, end)
        return Hold(self._axes(to), x, y, float(np.linalg.norm(to - self.at)) / fastest(self.plot.rig) * slower)

    def blow(self) -> Input | Hold:
        d, gains = self.d, self.session.settings.gains
        three = self.plot.rig.master.axes == 3.0
        if d.chance(0.3):
            return self.strike()
        x, y = self.place()
        if d.chance(0.5):
            full = min(8.0, gains.alpha_f * self.session.settings.limits.force)
            push = (d.log(0.3, 3.0) if d.chance(self.presses) else -d.between(0.0, 1.0)) * full
            side = [d.between(-6.0, 6.0) * self.roams if three else 0.0 for _ in range(2)]
            return Input((*side, push), x, y, d.log(1e-4, 0.05))  # type: ignore[arg-type]
        down = 1.0 if d.chance(self.presses) else -1.0
        way = np.array([d.one((-1, 1)) * d.log(1e-9, 400e-9) if three and d.chance(self.roams) else 0.0
                        for _ in range(2)] + [down * d.log(1e-9, 200e-9)]) / gains.alpha_p  # fmt: skip
        if three and self.steep is not None and d.chance(0.4):
            way[:2] = (self.steep - self.tip) / gains.alpha_p
        return self._toward(way, x, y, d.log(1.0, 30.0))


def changed(session: Any, d: Dice, judge: Judge) -> None:
    """One request of a person; what is refused stays."""
    scene, settings = session.scene, session.settings
    share = d.log(0.5, 2.0)
    what = d.one(("scene", "settings", "mode", "scale", "clutch", "stop"))
    if what == "scene":
        field = d.one(("sample.youngs_modulus", "adhesion.work_of_adhesion", "medium.relative_humidity",
                       "friction.shear_strength", "friction.coefficient"))  # fmt: skip
        value = d.between(0.0, 0.8) if field == "medium.relative_humidity" else float(scene[field]) * share
        session.change("scene", field, value)
    elif what == "settings":
        field = d.one(("limits.force", "limits.stage_speed", "limits.lateral_speed", "limits.lateral_force",
                       "limits.indentation", "gains.set_point", "limits.motor_force", "gains.force_gain"))  # fmt: skip
        session.change("settings", field, float(settings[field]) * share)
    elif what == "mode":
        session.set_mode(d.one(MODES))
    elif what == "scale":
        session.rescale(settings.gains.alpha_p * share, settings.gains.alpha_f * d.log(0.5, 2.0))
    elif what == "clutch":
        opens = d.chance(0.5)
        session.clutch(opens)
        judge.clutched = opens
    else:
        session.emergency_stop(True)
        session.emergency_stop(False)
