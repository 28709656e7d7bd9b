# SPDX-License-Identifier: BSD-3-Clause
"""A hand on a session of another program: it is led as one of our own (host.h), and asks that program to move it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch.touch import host

from nanotouch_app.live.reel import demand_of

AIM, PATH, HAND = 1, 0, 1  # nt_event_kind of session.h, and its fields
Post = Callable[[int, int, tuple[float, float, float, float]], Any]


class Hand:
    """Begins where master and tip are; ``sideways``: a device leads z, and only the tip's path is asked for."""

    def __init__(self, about: Mapping[str, Any], frame: Any, post: Post, sideways: bool = False) -> None:
        scene, rig, settings = nt.Scene(**about["scene"]), nt.Rig(**about["rig"]), nt.Settings(**about["settings"])
        self.post, self.scale, self.sideways = post, float(settings.gains.alpha_p), sideways
        self.start = tuple(map(float, about["start"]))
        self.axes, self.stage_axes = int(rig.master.axes), int(rig.stage.axes)
        facts = _facts(scene, rig, settings, about, frame)
        if sideways:  # no travel of a master limits the path
            facts["travel"] = 2.0 * max(facts["width"], facts["height"]) / self.scale or facts["travel"]
        self.proxy = host.Proxy(facts)
        x, y = (np.asarray(frame["tip_position"][:2]) - self.start) / self.scale
        if self.axes == 3:
            x, y = frame["master_position"][:2]
        if self.stage_axes == 1:  # nothing moves it sideways
            x, y = 0.0, 0.0
            self.proxy.keep_sideways()
        left, low = (float(part) if math.isfinite(part) else 0.0 for part in (x, y))
        self.proxy.place = (left, low, self.proxy.place[2])
        force = float(frame["tip_force"][2])
        self.proxy.height -= force / self.proxy.stiffness if math.isfinite(force) else 0.0

    def answer(self, message: Mapping[str, Any], frame: Any) -> None:
        """Move, wheel, press or retract."""
        if message["do"] == "move":
            x, y, down = map(float, message["way"])
            self.proxy.move((x, y, 0.0 if self.sideways else down), frame)
        elif message["do"] == "wheel":
            self.proxy.wheel(float(message["steps"]), frame)
        elif message.get("on", False):
            self.proxy.presses = True
        else:
            self.proxy.lift(frame)
        self._aim()

    def follow(self, frame: Any, elapsed: float) -> None:
        """What an arm does by itself."""
        self.proxy.follow(frame, elapsed)
        self._aim()

    def _aim(self) -> None:
        """Ask for a place of the hand; of the tip, too, where the master does not lead it sideways."""
        place = self.proxy.aim()
        if place is None:
            return
        x, y, z = place
        if self.axes == 3:
            self.post(AIM, HAND, (x, y, z, host.GLIDE))
            return
        if not self.sideways:
            self.post(AIM, HAND, (0.0, 0.0, z, host.GLIDE))
        if self.stage_axes == 3:
            left, low = self.start[0] + self.scale * x, self.start[1] + self.scale * y
            self.post(AIM, PATH, (left, low, host.GLIDE, 0.0))


def _facts(scene: nt.Scene, rig: nt.Rig, settings: nt.Settings, about: Mapping[str, Any], frame: Any) -> dict[str, Any]:
    plan, gains = scene.plan(demand_of(about)), settings.gains
    deepest, limit = float(plan.explain()["largest_indentation"]), float(settings.limits.force)
    gaps = -np.linspace(0.0, 1.2, 400) * deepest
    width, height = about.get("size") or (0.0, 0.0)
    return {
        "alpha_p": gains.alpha_p, "alpha_f": gains.alpha_f, "coupling": gains.coupling_stiffness,
        "lever": rig.probe.spring_constant, "travel": rig.master.travel, "resolution": rig.master.resolution,
        "axes": int(rig.master.axes), "clearance": float(about["clearance"]), "pull_off": plan.pull_off_force,
        "load": scene.range.maximum_load, "limit": limit, "indentation": deepest,
        "sunk": float(np.interp(host.LOAD * limit, plan.force(gaps, "retract"), -gaps)),
        "start_height": float(frame["tip_position"][2]), "held": float(frame["master_position"][2]),
        "x": float(about["start"][0]), "y": float(about["start"][1]), "width": width, "height": height,
    }  # fmt: skip
