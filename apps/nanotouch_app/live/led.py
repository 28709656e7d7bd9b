# SPDX-License-Identifier: BSD-3-Clause
"""A session of another program as a hand needs to know it: what it says of itself, and how it is asked to move."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import SimpleNamespace
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch.touch.operator import Hold

from nanotouch_app.live.hand import Hand
from nanotouch_app.live.reel import demand_of

AIM, PATH, HAND = 1, 0, 1  # nt_event_kind of session.h, and its fields
Post = Callable[[int, int, tuple[float, float, float, float]], Any]


class Led:
    """Takes the place of a :class:`~nanotouch.Session` in a :class:`~nanotouch_app.live.hand.Hand`."""

    def __init__(self, about: Mapping[str, Any], frame: Any, post: Post) -> None:
        self.scene, self.rig = nt.Scene(**about["scene"]), nt.Rig(**about["rig"])
        self.settings = nt.Settings(**about["settings"])
        self.plan = self.scene.plan(demand_of(about))
        self.path = [tuple(map(float, about["start"]))]
        self.clearance = float(about["clearance"])
        size = about.get("size")
        self.surface = None if size is None else SimpleNamespace(size=size)
        held = float(frame["master_position"][2])
        self.core = SimpleNamespace(master_start=held, start_height=float(frame["tip_position"][2]))
        self._post = post

    def aim(self, to: Hold) -> None:
        """Ask for a place of the hand; of the tip, too, where the master does not lead it sideways."""
        x, y, z = (float(part) for part in np.atleast_1d(to.master_position))
        if self.rig.master.axes == 3.0:
            self._post(AIM, HAND, (x, y, z, to.duration))
            return
        self._post(AIM, HAND, (0.0, 0.0, z, to.duration))
        if self.rig.stage.axes == 3.0:
            scale = float(self.settings.gains.alpha_p)
            self._post(AIM, PATH, (self.path[0][0] + scale * x, self.path[0][1] + scale * y, to.duration, 0.0))


def hand_of(about: Mapping[str, Any], frame: Any, post: Post) -> Hand:
    """A hand that begins where master and tip are."""
    led = Led(about, frame, post)
    hand = Hand(led)
    sideways = (np.asarray(frame["tip_position"][:2]) - led.path[0]) / led.settings.gains.alpha_p
    if led.rig.master.axes == 3.0:
        sideways = np.asarray(frame["master_position"][:2])
    if led.rig.stage.axes == 1.0:  # nothing moves it sideways
        sideways = np.zeros(2)
        hand.ends[0][:2] = hand.ends[1][:2] = 0.0
    hand.place[:2] = np.where(np.isfinite(sideways), sideways, 0.0)
    force = float(frame["tip_force"][2])
    hand.height -= force / hand.stiffness if math.isfinite(force) else 0.0
    return hand
