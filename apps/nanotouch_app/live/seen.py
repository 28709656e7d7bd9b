# SPDX-License-Identifier: BSD-3-Clause
"""What a front end knows of a session: its frames so far, the world that they belong to, and the law of that world."""

from __future__ import annotations

import time
from collections import deque
from contextlib import suppress
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import view
from nanotouch.errors import Error
from nanotouch.plasticity import Dent
from numpy.typing import NDArray

from nanotouch_app.live import dented
from nanotouch_app.live.hands.device import Feel
from nanotouch_app.live.reel import Reel, demand_of, measured

Floats = NDArray[np.float64]

HISTORY = 10.0  # of the chart over time [s]
SLICES = 400  # of it; each keeps its least and largest force
TAIL = 0.5  # of the point on the force curve [s]
DOTS = " ..."  # end a note of what is being done
TRACE = 30.0  # of the path on the surface [s]
TRACE_STEP = 0.05  # [s]
STALE = 0.1  # [s]: what is felt ends when the newest frame is older
ANSWERS = {"say", "choose", "change"}  # what was refused before one of these is past
READINGS = 0.2  # numbers in words are renewed this often [s]


PLACE = {"radius": "tip.radius", "youngs_modulus": "sample.youngs_modulus",
         "work_of_adhesion": "adhesion.work_of_adhesion"}  # fmt: skip
LOADS = (1.0, 0.5, 0.25, 0.1, 0.03)  # of the largest load, for a place
LAXER = 1.5  # than the session's plan: its surface, and each place, may err by a little more than a flat
DIFFERS, REPLACED = 0.03, 0.5  # a place is another one from this relative difference on; looked at so often [s]


def _differs(here: dict[str, float], before: dict[str, float], scene: nt.Scene) -> bool:
    """Whether a place has another law than the one that is drawn."""
    drawn = {name: before.get(name, float(scene[field])) for name, field in PLACE.items()}
    return any(abs(value - drawn[name]) > DIFFERS * abs(drawn[name]) for name, value in here.items())


class Seen:
    """Filled from an observer by :meth:`look`, from messages by :meth:`hear`."""

    def __init__(self) -> None:
        self.world: dict[str, Any] = {}
        self.clock: dict[str, Any] = {"speed": 1.0, "paused": False, "slowdown": 1.0, "recorded": False}
        self.notes: deque[tuple[float, str, bool]] = deque(maxlen=4)
        self.waiting: set[str] = set()
        self.task: dict[str, Any] = {}
        self.dented: dented.Dented | None = None
        self.recovery: tuple[Floats, Floats] | None = None  # of a sample that relaxes: r, its surface there [m]
        self.drawn_dent = (-1.0, -1.0)
        self.place: dict[str, float] = {}
        self.placed_at = 0.0
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
        self.event = (0.0, "", "")  # when, how hard, what
        self.guide: str | None = None  # what to do next; None: the session does not say

    def hear(self, message: dict[str, Any]) -> None:
        """Take what the host tells."""
        match message["tell"]:
            case "world":
                self._settle(message)
            case "laid":
                self.forget()
                self.frame = self.reading = None
                self.world = {}
                self.dented = self.recovery = None
                self.notes.clear()
            case "clock":
                self.clock = message
                self._stand(message.get("here", {}))
            case "dents" if self.dented is not None:
                self.dented.dents = tuple(Dent.from_numbers(numbers) for numbers in message["dents"])
            case "recovery":
                r, z = np.array(message["r"]), np.array(message["z"])
                self.recovery = (r, z) if len(r) else None
            case "particles":
                self.snaps += [(self.arrived, event) for event in message["events"]]
            case "event":
                self.event = (time.monotonic(), str(message["text"]), str(message["kind"]))
            case "guide":
                self.guide = str(message["text"])
            case "task":
                self.task = message if message["name"] else {}
            case "refused":
                self.waiting.discard(str(message.get("field")))
                self._ends()
                self.notes.append((time.monotonic(), str(message["why"]), True))
            case "note":
                if not self.notes or self.notes[-1][1] != message["text"]:
                    self._ends()
                    self.notes.append((time.monotonic(), message["text"], False))

    def _ends(self) -> None:
        """What was being done is done, or has failed."""
        self.notes = deque((note for note in self.notes if not note[1].endswith(DOTS)), maxlen=self.notes.maxlen)

    def asks(self, what: str) -> None:
        """The hand asks again: no refusal of its last answer stays beside a good one."""
        if what in ANSWERS:
            self.notes = deque((note for note in self.notes if not note[2]), maxlen=self.notes.maxlen)

    def _settle(self, world: dict[str, Any]) -> None:
        """A new world: its plan is made here anew, for what is drawn."""
        fresh = {key: world[key] for key in ("scene", "rig")} != {key: self.world.get(key) for key in ("scene", "rig")}
        self.world = world
        self.waiting.clear()
        if not fresh:
            return
        self._plan_for(nt.Scene(**world["scene"]))
        self.place = {}

    def _stand(self, here: dict[str, float]) -> None:
        """Law and section are those of the place under the tip: made anew where it differs, twice a second at most."""
        now = time.monotonic()
        if not self.world or now - self.placed_at < REPLACED or not _differs(here, self.place, self.scene):
            return
        self.placed_at, self.place = now, here
        scene = nt.Scene(**self.world["scene"])
        for name, field in PLACE.items():
            if name in here and (name != "work_of_adhesion" or self.world["scene"]["adhesion"]["given"] == name):
                scene[field] = here[name]
        for share in LOADS:  # a sharp place would yield under the largest load: its law is drawn as far as it holds
            scene["range.maximum_load"] = share * self.load
            with suppress(Error):
                self._plan_for(scene)
                break

    def _plan_for(self, scene: nt.Scene) -> None:
        self.plan = scene.plan(demand_of(self.world, LAXER))
        self.scene = scene
        facts = self.plan.explain()
        self.facts = facts
        self.load = float(self.world["scene"]["range"]["maximum_load"])
        self.depth = float(facts["largest_indentation"])
        ends = [float(facts[key]) for key in ("release_gap", "capture_gap")]
        self.reach = max(3.0 * max(end for end in ends if np.isfinite(end)), 0.4 * self.depth, 3e-9)
        if self.plan.pull_off_force < 1e-3 * self.load:  # nothing holds: what repels from far away is what is felt
            self.reach = max(self.reach, min(self.plan.cutoff_gap(0.01 * self.load), 5.0 * self.depth))
        self.curve = view.curve(self.plan, -1.5 * self.depth, 11.0 * self.reach)
        law = dented.law_of(scene, self.plan)
        kept = () if self.dented is None else self.dented.dents
        self.dented = None if law is None else dented.Dented(law, self.load)
        if self.dented is not None:
            self.dented.dents = kept
            self.depth = self.dented.relief
        self.drawn_dent = (-1.0, -1.0)

    def look(self, observer: nt.frames.Observer | Reel) -> None:
        """Take the frames that have come since."""
        frames = observer.read()
        self.missed = observer.missed
        now = time.monotonic()
        self.age = 0.0 if len(frames) else now - self.arrived
        if not len(frames):
            return
        self.arrived = now
        frames = measured(frames, self.world)
        if self.frame is not None and frames["time"][0] < float(self.frame["time"]):  # rewound
            self.forget()
        self._keep(frames)
        self._yield(frames)
        self.frame = frames[-1]
        if now - self.read_at > READINGS:
            self.read_at, self.reading = now, self.frame

    def _yield(self, frames: Any) -> None:
        """The law of a sample that yields is another one with each dent."""
        if self.dented is None:
            return
        self.dented.follow(frames)
        if (now := (self.dented.began, self.dented.reached)) != self.drawn_dent:
            self.drawn_dent, self.curve = now, self.dented.curve(11.0 * self.reach)

    @property
    def is_blind(self) -> bool:
        """The gap is not known: the slave is a real one."""
        return self.frame is not None and not np.isfinite(self.frame["gap"])

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
        contact = frames["contact_radius"] > 0.0
        touched = np.flatnonzero(np.diff(contact))
        self.snaps += [(float(when[row + 1]), "snap" if contact[row + 1] else "tear") for row in touched[-4:]]
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
    def hides(self) -> set[str]:
        """What the task does not show: surface, law, contact, sliders."""
        return set(self.task.get("hides", ()))

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

    @property
    def sideways(self) -> Floats:
        """On the tip, x and y [N]; 0 where nothing may be felt, or nobody knows."""
        if self.frame is None or self.stale:
            return np.zeros(2)
        return np.asarray(np.nan_to_num(np.array(self.frame["tip_force"][:2], dtype=float)))

    def feel(self) -> Feel:
        """What a hand is to feel now; each snap and tear once. Nothing where the newest frame is too old."""
        events = [kind for _, kind in self.snaps]
        self.snaps.clear()
        if self.stale or self.clock["paused"]:
            return Feel()
        force = float(np.hypot(self.force, np.linalg.norm(self.sideways)))
        level = min(force / max(self.load, 1e-15), 1.0) if self.world else 0.0
        return Feel(level, events[-1] if events else "")

    def section(self, r: Floats) -> view.Section | None:
        """The section through the contact as it is now."""
        if self.frame is None or not np.isfinite(self.frame["gap"]):
            return None
        if self.dented is not None:
            return self.dented.section(float(self.frame["gap"]), r)
        made = view.section(self.plan, self.scene, float(self.frame["gap"]), float(self.frame["tip_force"][2]), r)
        return made if str(self.scene.rheology.kind) == "elastic" else self._relaxed(made)

    def _relaxed(self, made: view.Section) -> view.Section:
        """Of a sample that relaxes: it touches as far as the session says, and beyond is what has not yet recovered."""
        a = float(self.frame["contact_radius"])
        ground = np.zeros_like(made.r) if self.recovery is None else np.interp(made.r, *self.recovery, right=0.0)
        sample = np.where((a > 0.0) & (made.r <= a), made.rigid_tip, np.minimum(ground, made.rigid_tip))
        return made._replace(tip=made.rigid_tip, sample=sample, contact_radius=a, cohesive_radius=a,
                                   attached=a > 0.0)  # fmt: skip

    @property
    def meniscus(self) -> bool:
        """Water is what adheres."""
        return str(self.facts["adhesion_source"]) == "meniscus"
