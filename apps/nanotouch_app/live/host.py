# SPDX-License-Identifier: BSD-3-Clause
"""The session that a person touches, at wall pace, and what its front ends may ask of it by a message, a dict with
"do". What a hand, sliders, tasks and words are is the C library's (host.h, docs/host.md); here are the session itself,
its recording, its pace, and who may lead it. Frames go through shared memory (:mod:`nanotouch.touch.frames`).
"""

from __future__ import annotations

import itertools
import json
import math
import os
import time
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import record
from nanotouch.errors import Error
from nanotouch.plasticity import Dent, dents_of
from nanotouch.touch import host as c_host
from nanotouch.touch.scratch import Scratch
from nanotouch.units import parse_quantity

from nanotouch_app.live import files, places
from nanotouch_app.live.remote import Lease
from nanotouch_app.live.subject import Subject, of_preset

SPEEDS = (0.01, 0.03, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0)
REWIND, PATIENCE = 5.0, 0.2  # [s]; until it shows
STEP_TICKS = 10  # of a single step of a paused session: 1 ms
LOOKED = 0.1  # for new dents so often [s]
FREE = {"stop", "ready", "pause", "step", "slower", "faster", "device"}  # asked without the lease
VALUES = ("way", "steps", "on", "number", "value", "lay", "seed")  # of a message, in the order in which C has them
ASKED = {task["name"]: task["asked"] for task in c_host.tasks()}
Message = dict[str, Any]
_NUMBERS = itertools.count(1)  # of the sessions of this process


class Host:
    """One session, and what C says of it."""

    def __init__(
        self, subject: Subject, tell: Callable[[Message], None], out: str | None = None, stepped: bool = False
    ) -> None:
        self.subject, self.tell, self.out, self.stepped = subject, tell, out, stepped
        self.core = c_host.LiveHost()
        self.files = Scratch()
        self.speed, self.paused = 1.0, False
        self.writer: Any = None
        self.lease: Lease | None = None
        self.folder: Path | None = None  # of the results of tasks; None: they are not kept
        self.saved = ""  # where the last result is
        self.about: Message = {}  # the world
        self.seen, self.looked = time.monotonic(), 0.0
        self._begin(subject)
        for message in map(json.loads, self.core.tell()):  # a front end asks for it: report
            if message["tell"] == "world":
                self.about = self._named(message)

    # --- the session ---

    def _begin(self, subject: Subject) -> None:
        """Another sample: a session of its own."""
        scene = subject.scene.copy()
        opened = self._opened(subject, scene, subject.rig.copy(), None)
        self.subject, self.scene, self.rig = subject, scene, subject.rig.copy()
        self.clearance = opened.clearance
        width, height = subject.touched(scene).size if opened.surface is None else opened.surface.size
        pushed = "rod" if subject.rod is not None else "particles" if subject.particles is not None else ""
        about = {name: getattr(subject, name) for name in ("name", "title", "hint", "said")}
        self.core.lay({**about, "source": "", "width": width, "height": height, "pushed": pushed})
        self._give(opened)

    def _opened(self, subject: Subject, scene: nt.Scene, rig: nt.Rig, clearance: float | None) -> nt.Session:
        surface, relief = subject.touched(scene), subject.topography.height_range
        width, height = surface.size
        ground = {"width": width, "height": height, "relief": relief, "clearance": clearance or 0.0,
                  "keeps": clearance is not None}  # fmt: skip
        rig = rig.copy()
        settings, start = self.core.compose(scene.core, rig.core, subject.accuracy, ground)
        pushed = {"particles": subject.particles, "rod": subject.rod}
        return nt.Session(
            scene, rig, surface=surface, settings=nt.Settings.from_core(settings), mode="scan",
            path=[(0.5 * width, 0.5 * height), (0.6 * width, 0.5 * height)], clearance=start,
            recorded=self.out is not None or self._keeps(scene), relative_accuracy=subject.accuracy,
            **{name: of(scene) for name, of in pushed.items() if of is not None},  # type: ignore[arg-type]
        )  # fmt: skip

    def _give(self, session: nt.Session) -> None:
        """From now on this one is touched."""
        self.session = session
        self.name = f"live-{os.getpid()}-{next(_NUMBERS)}"
        session.publish(self.name)
        self.observer, self.frames = nt.frames.attach(self.name), nt.frames.attach(self.name)
        if self.lease is not None:
            self.lease.close()
        self.lease = Lease(self.name)
        self.known = (session.scene, session.settings)
        self.core.open(session.core)
        if self.out is not None and self.writer is None:
            self.writer = record.Writer(self.out, session.metadata())
        if not self.stepped:
            session.start("wall")
            session.set_speed(self.speed)
            session.pause(self.paused)

    def close(self) -> None:
        """End the session; what was recorded is written."""
        if self.lease is not None:
            self.lease.close()
        self.observer.close()
        self.frames.close()
        self.session.halt()
        self._drain()
        if self.writer is not None:
            self.writer.update(self.session.metadata())
            self.writer.close()
        self.files.close()

    def _drain(self) -> None:
        while self.writer is not None or self.keeps_dents:
            block = self.session.read(5000)
            if not len(block["time"]):
                return
            if self.writer is not None:
                self.writer.append(block)

    def _keeps(self, scene: nt.Scene) -> bool:
        """Whether what the tip leaves is known from the session's events alone."""
        return bool(scene.sample.dents == "yes")

    @property
    def keeps_dents(self) -> bool:
        """Whether the sample does."""
        return self._keeps(self.session.scene)

    @property
    def dents(self) -> tuple[Dent, ...]:
        """Those that there are now."""
        return dents_of(self.session.metadata()["events"])

    # --- what happens by itself ---

    def tick(self) -> None:
        """Some hundred times a second: what hand, task and recording do."""
        now = time.monotonic()
        elapsed, self.seen = min(now - self.seen, 0.1) * self.speed, now
        self._look(now - self.looked > LOOKED)
        if not self.paused and self._drives():
            self.core.follow(elapsed)
        self._drain()
        self._tell_all()

    def _look(self, at_dents: bool) -> None:
        self.core.see(self.frames.read())
        if self.keeps_dents and at_dents:
            self.looked = time.monotonic()
            rows = [[*dent.imprint, dent.load, -1 if dent.before is None else dent.before] for dent in self.dents]
            self.core.see_dents(rows)

    def _drives(self) -> bool:
        """Whether the hand may go on by itself: not while another program holds the lease."""
        if self.lease is None or not self.core.state["acts"]:
            return True
        try:
            self.lease.take()
        except Error:
            self.core.ask("release", "", (0.0, 0.0, 0.0))
            return False
        return True

    def advance(self, duration: float) -> None:
        """Of a stepped session: run for a time [s], as far as the hand looks in pieces of 10 ms."""
        for _ in range(max(1, round(100 * duration))):
            self.session.core.advance(round(0.01 * self.session.rate))
            self._look(True)
            self.core.follow(0.01)
            self._drain()
        self._tell_all()

    def _tell_all(self) -> None:
        """What C has to tell."""
        for text in self.core.tell():
            message = json.loads(text)
            if message["tell"] == "world":
                message = self.about = self._named(message)
            if message["tell"] == "task" and "passed" in message:
                message["saved"] = self._saved(message["name"])
            elif message["tell"] == "task":
                self.saved = ""
            self.tell(message)

    def _named(self, world: Message) -> Message:
        self.known = (self.session.scene, self.session.settings)
        self.scene = self.session.scene.copy()
        self.session.describe()
        lost = {key: math.inf for key in ("bound", "margin") if world[key] is None}  # JSON has no infinite number
        return {**world, **lost, "name": self.name, "measured": self.subject.measured}

    def report(self) -> None:
        """Tell all that a front end has to know, from the beginning."""
        self.core.ask("report", "", (0.0, 0.0, 0.0))
        self._tell_all()

    def world(self) -> Message:
        """All that changes only when something is changed."""
        self.report()
        return self.about

    def clock(self) -> Message:
        """How the session goes; the world, too, if another program has changed it."""
        if (self.session.scene, self.session.settings) != self.known:
            self.core.ask("learn", "", (0.0, 0.0, 0.0))
            self._tell_all()
        state = self.core.state
        return {
            "tell": "clock", "speed": self.speed, "paused": self.paused, "slowdown": self.session.progress.slowdown,
            "recorded": self.writer is not None, "height": state["height"], "undo": state["undo"],
            "energies": state["energies"], "missed": self.frames.missed, "facts": self._facts(),
            "here": places.here(self.session.surface, self.observer.newest()),
        }  # fmt: skip

    def _facts(self) -> str:
        frame, world = self.observer.newest(), self.about
        bounds = [float(world[key]) for key in ("bound", "margin", "force", "hand")]
        return "" if frame is None else c_host.facts(frame, *bounds)

    def properties(self) -> dict[str, Any]:
        """Of each place, for the picture; empty where the scene alone says them."""
        return places.properties(self.session.surface)

    def _saved(self, name: str) -> str:
        """Where the result of a task is kept, once."""
        if not self.saved and self.folder is not None:
            path = self.folder / f"nanotouch-{name}-{datetime.now():%Y-%m-%dT%H-%M-%S}.csv"
            try:
                path.write_text(self.core.result(), encoding="utf-8")
                self.saved = str(path)
            except OSError as error:
                self.saved = f"not saved: {error}"
        return self.saved

    # --- what is asked ---

    def answer(self, message: Message) -> bool:
        """Do what a message asks; what is refused is told. False: the person has left."""
        what = message["do"]
        if what == "leave":
            return False
        try:
            if what not in FREE and self.lease is not None:
                self.lease.take()
            own = getattr(self, f"_do_{what}", None)
            if own is not None:
                own(message)
            else:
                self._ask(message)
        except Error as error:
            self.core.refuse(str(error))
        self._tell_all()
        return True

    def _ask(self, message: Message) -> None:
        """Leave it to C; another session is opened where it wants one."""
        if message.get("do") == "task" and "seed" not in message:
            message = {**message, "seed": time.time_ns() % 2**32}
        given = [message.get(name) for name in VALUES if name in message]
        if message["do"] == "task":
            given = [message.get("lay", False), message["seed"]]
        values = given[0] if given and isinstance(given[0], list | tuple) else given
        values = [float(value or 0.0) for value in values][:3]
        text = str(message.get("field", message.get("name", "")))
        self._look(True)
        if not self.core.ask(message["do"], text, (*values, *[0.0] * (3 - len(values)))):
            raise Error(f"nobody knows how to {message['do'][:40]}")
        if self.core.wants is not None:
            self._lay(of_preset(self.core.wants))
        change = self.core.reopens
        if change is not None:
            self._reopen(*change)

    def _do_say(self, message: Message) -> None:
        asked = ASKED.get(self.core.state["task"], "")
        self._ask({"do": "say", "value": parse_quantity(message["text"], asked) if asked else 0.0})

    def _do_ready(self, message: Message) -> None:
        """A window is there."""

    def _do_arm(self, message: Message) -> None:
        self.session.arm(confirmed=True)
        self._ask({"do": "rest"})

    def _do_stop(self, message: Message) -> None:
        self.session.emergency_stop(True)
        self.session.emergency_stop(False)

    def _do_pause(self, message: Message) -> None:
        self.paused = not self.paused
        self.session.pause(self.paused)

    def _do_step(self, message: Message) -> None:
        if not self.paused:
            self._do_pause(message)
        self.session.step_on(STEP_TICKS)

    def _do_slower(self, message: Message) -> None:
        self._set_speed(-1)

    def _do_faster(self, message: Message) -> None:
        self._set_speed(1)

    def _set_speed(self, way: int) -> None:
        place = SPEEDS.index(self.speed) + way
        self.speed = SPEEDS[min(max(place, 0), len(SPEEDS) - 1)]
        self.session.set_speed(self.speed)

    def _do_rewind(self, message: Message) -> None:
        before = self.observer.newest()
        self.session.rewind(REWIND)
        if self.paused:
            self.session.step_on(1)  # shows where it went back to
        end = time.monotonic() + PATIENCE
        frame: Any = self.observer.newest()
        while before is not None and frame["time"] >= before["time"] and time.monotonic() < end:
            time.sleep(0.002)
            frame = self.observer.newest()
        self._ask({"do": "resume"})

    def _do_preset(self, message: Message) -> None:
        self._lay(of_preset(message["name"]))

    def _do_open(self, message: Message) -> None:
        """A file was dropped on the window: an image, a curve, a map, a scene."""
        self._lay(files.of(message["path"], told=lambda now: self.tell({"tell": "note", "text": f"{now} ..."})))

    def _check_unrecorded(self, what: str) -> None:
        if self.writer is not None:
            raise Error(f"{what} would begin another session: this one is being recorded, and a file holds one")

    def _lay(self, subject: Subject) -> None:
        self._check_unrecorded("another sample")
        before = self.session
        self._begin(subject)
        before.halt()
        self.tell({"tell": "laid", "path": self._stored()})

    def _reopen(self, what: str, field: str, value: float) -> None:
        """Lever and tip are the instrument itself: another one is mounted, and the touch begins above the surface."""
        self._check_unrecorded("another tip or lever")
        scene, rig = self.scene.copy(), self.rig.copy()
        (scene if what == "scene" else rig)[field] = value
        opened, before = self._opened(self.subject, scene, rig, self.clearance), self.session
        self.scene, self.rig = scene, rig
        self._give(opened)
        before.halt()

    def _stored(self) -> str:
        """What a picture needs of the surface, in a file."""
        topography = self.subject.topography
        path = self.files.path / f"{self.name}.npz"
        np.savez(path, heights=topography.heights, pixel_size=np.asarray(topography.pixel_size), **self.properties())
        return str(path)
