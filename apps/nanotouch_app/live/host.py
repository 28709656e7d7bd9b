# SPDX-License-Identifier: BSD-3-Clause
"""The session that a person touches, at wall pace, and what its front ends may ask of it. A front end asks by a
message, a dict with "do"; what it is told are messages, too. Frames go through shared memory
(:mod:`nanotouch.touch.frames`).
"""

from __future__ import annotations

import itertools
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import record
from nanotouch.errors import Error
from nanotouch.touch.scratch import Scratch
from nanotouch.touch.session import settings_for_path

from nanotouch_app.live import files, places, refusals
from nanotouch_app.live.hand import Hand, felt_scale, rig_of, settings_of
from nanotouch_app.live.left import Left, Pushes, keeps
from nanotouch_app.live.remote import Lease
from nanotouch_app.live.subject import Subject, of_preset
from nanotouch_app.live.tasks import Tasks

SPEEDS = (0.01, 0.03, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0)
REWIND, PATIENCE = 5.0, 0.2  # [s]; until it shows
STEP_TICKS = 10  # of a single step of a paused session: 1 ms
INDENTATION_SHARE = 1.5  # limit of the indentation over that of the largest load
FREE = {"stop", "ready", "pause", "step", "slower", "faster"}  # asked without the lease
Message = dict[str, Any]
_NUMBERS = itertools.count(1)  # of the sessions of this process


class Host(Tasks):
    """One session, its hand, its history of changes."""

    def __init__(
        self, subject: Subject, tell: Callable[[Message], None], out: str | None = None, stepped: bool = False
    ) -> None:
        self.subject = subject
        self.tell = tell
        self.scene, self.rig = subject.scene.copy(), subject.rig.copy()
        self.overrides: dict[str, float] = {}
        self.files = Scratch()
        self.done: list[tuple[str, str, Any, Any]] = []
        self.undone: list[tuple[str, str, Any, Any]] = []
        self.speed, self.paused = 1.0, False
        self.out, self.stepped = out, stepped
        self.writer: Any = None
        self.lease: Lease | None = None
        self.folder: Path | None = None  # of the results of tasks; None: they are not kept
        self.seen = time.monotonic()
        self._open()

    def _open(self) -> None:
        extent = max(self.subject.topography.size)
        surface = self.subject.touched(self.scene)
        load = float(self.scene.range.maximum_load)
        usual = settings_for_path(self.rig, self.subject.topography.height_range, load=load)
        plan = self.scene.plan(relative_accuracy=self.subject.accuracy)
        usual["gains.alpha_f"] = felt_scale(self.rig, usual, plan.pull_off_force, load)
        settings = settings_of(usual, self.rig)
        deepest = INDENTATION_SHARE * float(plan.explain()["largest_indentation"])
        way_down = self.subject.clearance() + self.subject.topography.height_range + deepest
        settings["limits.indentation"] = max(settings.limits.indentation, deepest)
        for field, value in self.overrides.items():
            settings[field] = value
        width, height = surface.size
        middle = (0.5 * width, 0.5 * height)
        self.session = nt.Session(
            self.scene, rig_of(self.rig, settings, extent, way_down), surface=surface, settings=settings, mode="scan",
            path=[middle, (0.6 * width, 0.5 * height)], clearance=self.subject.clearance(),
            recorded=self.out is not None or self._keeps(self.scene), relative_accuracy=self.subject.accuracy,
            **self._pushed(),
        )  # fmt: skip
        self.name = f"live-{os.getpid()}-{next(_NUMBERS)}"
        self.session.publish(self.name)
        self.observer = nt.frames.attach(self.name)
        if self.lease is not None:
            self.lease.close()
        self.lease = Lease(self.name)
        self.known = (self.session.scene, self.session.settings)
        self.hand = Hand(self.session)
        self.left = Left(self.session, self.tell)
        self.pushes = Pushes(self.session)
        if self.out is not None and self.writer is None:
            self.writer = record.Writer(self.out, self.session.metadata())
        if not self.stepped:
            self.session.start("wall")
            self.session.set_speed(self.speed)
            self.session.pause(self.paused)

    def _pushed(self) -> dict[str, Any]:
        made = {"particles": self.subject.particles, "rod": self.subject.rod}
        return {name: of(self.scene) for name, of in made.items() if of is not None}

    def _keeps(self, scene: nt.Scene) -> bool:
        """Whether what the tip leaves is known from the session's events."""
        return keeps(scene) or self.subject.particles is not None or self.subject.rod is not None

    def close(self) -> None:
        """End the session; what was recorded is written."""
        self._end_task()
        if self.lease is not None:
            self.lease.close()
        self.observer.close()
        self.session.halt()
        self._drain()
        if self.writer is not None:
            self.writer.update(self.session.metadata())
            self.writer.close()
        self.files.close()

    def _drain(self) -> None:
        while self.writer is not None or self._keeps(self.session.scene):
            block = self.session.read(5000)
            if not len(block["time"]):
                return
            if self.writer is not None:
                self.writer.append(block)

    # --- what happens by itself ---

    def tick(self) -> None:
        """Some hundred times a second: what hand and recording do."""
        now = time.monotonic()
        frame = self.observer.newest()
        if frame is not None and not self.paused and self._drives(frame):
            self.hand.follow(frame, min(now - self.seen, 0.1) * self.speed)
        if frame is not None:
            self.left.follow(frame)
        self.seen = now
        self._look_on()
        self._drain()

    def _drives(self, frame: Any) -> bool:
        """Whether the hand may go on by itself: not while another program holds the lease."""
        if self.lease is None or not self.hand.acts(frame):
            return True
        try:
            self.lease.take()
        except Error:
            self.hand.presses = False
            return False
        return True

    def advance(self, duration: float) -> None:
        """Of a stepped session: run for a time [s], as far as the hand looks in pieces of 10 ms."""
        for _ in range(max(1, round(100 * duration))):
            self.session.core.advance(round(0.01 * self.session.rate))
            frame = self.observer.newest()
            if frame is not None:
                self.hand.follow(frame, 0.01)
                self.left.follow(frame)
            self.left.looked = 0.0
            self._look_on()
            self._drain()

    def world(self) -> Message:
        """All that changes only when something is changed."""
        self.known = (self.session.scene, self.session.settings)
        session, plan = self.session, self.session.plan
        return {
            "tell": "world", "title": self.subject.title, "felt": self.subject.felt, "hint": self.subject.hint,
            "scene": session.scene.to_dict(), "rig": session.rig.to_dict(), "settings": session.settings.to_dict(),
            "stiffness": self.hand.stiffness, "bound": plan.bound, "law": plan.contact_law,
            "warnings": [str(warning.text) for warning in plan.warnings], "margin": session.stability_margin,
            "force": session.guarantee().force, "hand": session.guarantee().hand.force, "undo": self.undoable,
            "redo": len(self.undone), "start": list(session.path[0]), "clearance": session.clearance, "name": self.name,
            "relative_accuracy": session.relative_accuracy, "zero": self.hand.zero,
            "size": list(map(float, self.subject.topography.size)),
        }  # fmt: skip

    @property
    def undoable(self) -> int:
        """How many changes, or else dents, or else pushes can be taken back."""
        return len(self.done) or len(self.left.dents) or len(self.pushes.done)

    def clock(self) -> Message:
        """How the session goes; the world, too, if another program has changed it."""
        if (self.session.scene, self.session.settings) != self.known:
            self.session.describe()
            self.tell(self.world())
        progress = self.session.progress
        return {
            "tell": "clock", "speed": self.speed, "paused": self.paused, "slowdown": progress.slowdown,
            "recorded": self.writer is not None, "height": self.hand.height, "undo": self.undoable,
            "here": places.here(self.session.surface, self.observer.newest()),
        }  # fmt: skip

    def properties(self) -> dict[str, Any]:
        """Of each place, for the picture; empty where the scene alone says them."""
        return places.properties(self.session.surface)

    # --- what is asked ---

    def answer(self, message: Message) -> bool:
        """Do what a message asks; what is refused is told. False: the person has left."""
        what = message["do"]
        if what == "leave":
            return False
        try:
            if what not in FREE and self.lease is not None:
                self.lease.take()
            getattr(self, f"_do_{what}")(message)
        except Error as error:
            self.tell({"tell": "refused", "why": str(error), "field": message.get("field")})
        return True

    def _check_unlocked(self) -> None:
        if self.trainer is not None and self.trainer.exercise.locked:
            raise Error("first say what you expect; then you may touch")

    def _do_move(self, message: Message) -> None:
        self._check_unlocked()
        frame = self.observer.newest()
        if frame is None:
            return
        if not self.hand.move(message["way"], frame):
            self.tell({"tell": "note", "text": "The hand stops here: the force limit is near."})

    def _do_wheel(self, message: Message) -> None:
        self._check_unlocked()
        frame = self.observer.newest()
        if frame is not None:
            self.hand.presses = False
            self.hand.step_down(message["steps"], frame)

    def _do_press(self, message: Message) -> None:
        if message["on"]:
            self._check_unlocked()
        self.hand.presses = bool(message["on"])
        frame = self.observer.newest()
        if frame is not None and not self.hand.presses:  # release lifts
            self.hand.lift(frame)

    def _do_retract(self, message: Message) -> None:
        self._do_press({"on": False})

    def _do_arm(self, message: Message) -> None:
        self.session.arm(confirmed=True)
        self._rest()

    def _rest(self) -> None:
        """The hand begins anew from where the tip is."""
        frame = self.observer.newest()
        if frame is not None and np.isfinite(frame["tip_position"][2]):  # a slave that has failed does not say
            self.hand.height = float(frame["tip_position"][2])

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
        if frame is not None:
            held = frame["master_position"]
            self.hand.place[:] = held
            self.hand.height = float(frame["tip_position"][2]) - float(frame["tip_force"][2]) / self.hand.stiffness
            self.hand.move((0.0, 0.0, 0.0), frame)

    def _do_preset(self, message: Message) -> None:
        """Another sample is laid under another tip: a session of its own."""
        self._lay(of_preset(message["name"]))

    def _do_open(self, message: Message) -> None:
        """A file was dropped on the window: an image, a curve, a map, a scene."""
        self._lay(files.of(message["path"], told=lambda now: self.tell({"tell": "note", "text": f"{now} ..."})))

    def _lay(self, subject: Subject) -> None:
        self._check_unrecorded("another sample")
        self._end_task()
        before, self.subject = self.session, subject
        self.scene, self.rig = self.subject.scene.copy(), self.subject.rig.copy()
        self.overrides, self.done, self.undone = {}, [], []
        self._open()
        before.halt()
        self.tell({"tell": "laid", "path": self._stored()})
        self.tell(self.world())
        self.left.report()

    def _stored(self) -> str:
        """What a picture needs of the surface, in a file."""
        topography = self.subject.topography
        path = self.files.path / f"{self.name}.npz"
        np.savez(path, heights=topography.heights, pixel_size=np.asarray(topography.pixel_size), **self.properties())
        return str(path)

    # --- changes, and their history ---

    def _do_change(self, message: Message) -> None:
        what, field, value = message["what"], message["field"], message["value"]
        old = getattr(self.session, what)[field]
        if value != old:
            try:
                self._change(what, field, value)
            except Error as error:
                raise Error(refusals.in_words(self.session, what, field, value, error)) from error
            self.done.append((what, field, old, value))
            self.undone.clear()
        self.tell(self.world())

    def _do_undo(self, message: Message) -> None:
        if self.done:
            what, field, old, new = self.done.pop()
            self._change(what, field, old)
            self.undone.append((what, field, old, new))
        elif self.left.dents:
            self.left.undo()
        elif self.pushes.done:
            self.pushes.undo()
        self.tell(self.world())

    def _do_redo(self, message: Message) -> None:
        if self.undone:
            what, field, old, new = self.undone.pop()
            self._change(what, field, new)
            self.done.append((what, field, old, new))
        self.tell(self.world())

    def _change(self, what: str, field: str, value: float) -> None:
        if field in ("gains.alpha_p", "gains.alpha_f"):
            self.session.rescale(**{field.removeprefix("gains."): value})
        elif what == "rig" or field in ("tip.radius", "tip.half_angle"):
            self._reopen(what, field, value)
        else:
            self.session.change("scene" if what == "scene" else "settings", field, value)
            if what == "scene":
                self.scene[field] = value
            else:
                self.overrides[field] = value

    def _check_unrecorded(self, what: str) -> None:
        if self.writer is not None:
            raise Error(f"{what} would begin another session: this one is being recorded, and a file holds one")

    def _reopen(self, what: str, field: str, value: float) -> None:
        """Lever and tip are the instrument itself: another one is mounted, and the touch begins above the surface."""
        self._check_unrecorded("another tip or lever")
        if self.trainer is not None:
            raise Error("another tip or lever: not while a task runs")
        described = self.scene if what == "scene" else self.rig
        old = described[field]
        described[field] = value
        before = self.session
        try:
            self._open()
        except Error:
            described[field] = old
            raise
        before.halt()
        self.left.report()
