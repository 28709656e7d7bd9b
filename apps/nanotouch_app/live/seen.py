# SPDX-License-Identifier: BSD-3-Clause
"""What a front end knows of a session: its frames so far, the world that they belong to, and the law of that world."""

from __future__ import annotations

import time
from collections import deque
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import view
from numpy.typing import NDArray

from nanotouch_app.live.reel import Reel

Floats = NDArray[np.float64]

HISTORY = 10.0  # of the chart over time [s]
SLICES = 400  # of it; each keeps its least and largest force
TAIL = 0.5  # of the point on the force curve [s]
TRACE = 30.0  # of the path on the surface [s]
TRACE_STEP = 0.05  # [s]
STALE = 0.1  # [s]: what is felt ends when the newest frame is older
READINGS = 0.2  # numbers in words are renewed this often [s]


class Seen:
    """Filled from an observer by :meth:`look`, from messages by :meth:`hear`."""

    def __init__(self) -> None:
        self.world: dict[str, Any] = {}
        self.clock: dict[str, Any] = {"speed": 1.0, "paused": False, "slowdown": 1.0, "recorded": False}
        self.notes: deque[tuple[float, str, bool]] = deque(maxlen=4)
        self.waiting: set[str] = set()
        self.frame: Any = None
        self.read_at = 0.0
        self.reading: Any = None
        self.arrived = time.monotonic()
        self.age = 0.0  # of the newest frame when it was last looked for [s]
        self.slices: deque[tuple[float, float, float]] = deque(maxlen=SLICES)
        self.tail: deque[tuple[float, float, float]] = deque(maxlen=400)
        self.trace: deque[tuple[float, float, float, float, float]] = deque(maxlen=int(TRACE / TRACE_STEP))
        self.peak = 0.0
        self.snaps: deque[tuple[float, str]] = deque(maxlen=8)
        self.missed = 0

    def hear(self, message: dict[str, Any]) -> None:
        """Take what the host tells."""
        match message["tell"]:
            case "world":
                self._settle(message)
            case "preset":
                self.forget()
                self.frame = self.reading = None
                self.world = {}
            case "clock":
                self.clock = message
            case "refused":
                self.waiting.discard(str(message.get("field")))
                self.notes.append((time.monotonic(), str(message["why"]), True))
            case "note":
                if not self.notes or self.notes[-1][1] != message["text"]:
                    self.notes.append((time.monotonic(), message["text"], False))

    def _settle(self, world: dict[str, Any]) -> None:
        """A new world: its plan is made here anew, for what is drawn."""
        fresh = {key: world[key] for key in ("scene", "rig")} != {key: self.world.get(key) for key in ("scene", "rig")}
        self.world = world
        self.waiting.clear()
        if not fresh:
            return
        self.scene = nt.Scene(**world["scene"])
        self.plan = self.scene.plan()
        facts = self.plan.explain()
        self.facts = facts
        self.load = float(self.scene.range.maximum_load)
        self.depth = float(facts["largest_indentation"])
        ends = [float(facts[key]) for key in ("release_gap", "capture_gap")]
        self.reach = max(3.0 * max(end for end in ends if np.isfinite(end)), 0.4 * self.depth, 3e-9)
        if self.plan.pull_off_force < 1e-3 * self.load:  # nothing holds: what repels from far away is what is felt
            self.reach = max(self.reach, min(self.plan.cutoff_gap(0.01 * self.load), 5.0 * self.depth))
        self.curve = view.curve(self.plan, -1.5 * self.depth, 11.0 * self.reach)

    def look(self, observer: nt.frames.Observer | Reel) -> None:
        """Take the frames that have come since."""
        frames = observer.read()
        self.missed = observer.missed
        now = time.monotonic()
        self.age = 0.0 if len(frames) else now - self.arrived
        if not len(frames):
            return
        self.arrived = now
        if self.frame is not None and frames["time"][0] < float(self.frame["time"]):  # rewound
            self.forget()
        self._keep(frames)
        self.frame = frames[-1]
        if now - self.read_at > READINGS:
            self.read_at, self.reading = now, self.frame

    def forget(self) -> None:
        """What came before belongs to another time."""
        for kept in (self.slices, self.tail, self.trace):
            kept.clear()

    def _keep(self, frames: Any) -> None:
        force = frames["tip_force"][:, 2]
        good = np.isfinite(force)
        if not good.any():
            return
        frames, force = frames[good], force[good]
        when = frames["time"]
        edges = np.flatnonzero(np.diff(np.floor(when / (HISTORY / SLICES)))) + 1
        for part in np.split(np.arange(len(frames)), edges):
            low, high, at = float(force[part].min()), float(force[part].max()), float(when[part[0]])
            slot = np.floor(at / (HISTORY / SLICES))
            if self.slices and np.floor(self.slices[-1][0] / (HISTORY / SLICES)) == slot:
                old = self.slices.pop()
                at, low, high = old[0], min(low, old[1]), max(high, old[2])
            self.slices.append((at, low, high))
        touched = np.flatnonzero(np.diff(frames["contact_radius"] > 0.0))
        rows = np.unique(np.concatenate([np.arange(0, len(frames), max(1, len(frames) // 12)), touched, touched + 1]))
        for row in rows:
            self.tail.append((float(when[row]), float(frames["gap"][row]), float(force[row])))
        while self.tail and self.tail[0][0] < when[-1] - TAIL:
            self.tail.popleft()
        self.peak = max(float(np.abs(force[-1])), self.peak * 0.98)
        if not self.trace or when[-1] - self.trace[-1][0] >= TRACE_STEP or when[-1] < self.trace[-1][0]:
            position = frames["tip_position"][-200:].mean(axis=0)
            x, y, z = (float(part) for part in position)
            self.trace.append((float(when[-1]), x, y, z, float(force[-1])))

    @property
    def stale(self) -> bool:
        """Nothing may be felt: the newest frame is too old, and the session is not paused."""
        return self.age > STALE and not self.clock["paused"]

    @property
    def force(self) -> float:
        """On the tip [N]; 0 where nothing may be felt."""
        if self.frame is None or self.stale:
            return 0.0
        force = float(self.frame["tip_force"][2])
        return force if np.isfinite(force) else 0.0

    def section(self, r: Floats) -> view.Section | None:
        """The section through the contact as it is now."""
        if self.frame is None or not np.isfinite(self.frame["gap"]):
            return None
        return view.section(self.plan, self.scene, float(self.frame["gap"]), float(self.frame["tip_force"][2]), r)

    @property
    def meniscus(self) -> bool:
        """Water is what adheres."""
        return str(self.facts["adhesion_source"]) == "meniscus"
