# SPDX-License-Identifier: BSD-3-Clause
"""Tasks of a host: begun, answered, ended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import nanotouch as nt
from nanotouch.errors import Error

from nanotouch_app.live.left import Left, Pushes
from nanotouch_app.live.subject import Subject
from nanotouch_app.live.trainer import Trainer
from nanotouch_app.training import named
from nanotouch_app.training.push import Push

ASIDE = -50e-6  # where the tip cannot go [m]
Message = dict[str, Any]


class Tasks:
    """What a host does about them."""

    subject: Subject
    session: nt.Session
    left: Left
    pushes: Pushes
    folder: Path | None
    tell: Callable[[Message], None]
    trainer: Trainer | None = None

    def world(self) -> Message:
        """All that changes only when something is changed."""
        raise NotImplementedError

    def _do_preset(self, message: Message) -> None:
        raise NotImplementedError

    def _change(self, what: str, field: str, value: float) -> None:
        raise NotImplementedError

    def _do_task(self, message: Message) -> None:
        """Begin a task, on the sample that it is meant for if "lay" says so; name "": end it."""
        self._end_task()
        if not message["name"]:
            return
        task = named(message["name"])
        lacks = issubclass(task, Push) and getattr(self.subject, task.pushes) is None
        if lacks or (
            message.get("lay") and (task.preset != self.subject.name or self.session.scene != self.subject.scene)
        ):
            self._do_preset({"name": task.preset})
        self.trainer = Trainer(
            message["name"], self.world(), self._change_for_task, self.tell, self.folder, message.get("seed")
        )
        exercise = self.trainer.exercise
        exercise.dents = self.left.dents
        if exercise.lays is not None:
            self._lay_particles(exercise.lays)

    def _lay_particles(self, places: Any) -> None:
        """Anew: those that lie there are put aside first. A rod has an angle, too, and is the only one."""
        try:
            if self.subject.rod is not None:
                self.session.lay_rod(places[0])
                places = ()
            for number in range(len(self.session.particles.losses) if len(places) else 0):
                self.session.lay(number, (ASIDE * (number + 1), ASIDE))
            for number, place in enumerate(places):
                self.session.lay(number, place)
        except Error as error:
            self._end_task()
            raise Error("the tip is where a particle shall lie, or touches one: move it away first") from error
        self.pushes.forget()

    def _look_on(self) -> None:
        """What has happened since, for the task."""
        if self.left.look() and self.trainer is not None:
            self.trainer.exercise.dents = self.left.dents
        self.pushes.look()
        if self.trainer is not None and self.trainer.exercise.lays is not None:
            self.trainer.exercise.take(self.session.particles)
        if self.trainer is not None:
            self.trainer.look()

    def _change_for_task(self, what: str, field: str, value: float) -> None:
        """A task changes the world; that is no entry of the person's history."""
        if what == "scaled":
            what, value = "settings", value * float(self.session.settings[field])
        self._change(what, field, value)
        self.tell(self.world())

    def _end_task(self) -> None:
        if self.trainer is not None:
            self.trainer.close()
            self.trainer = None

    def _do_choose(self, message: Message) -> None:
        if self.trainer is None:
            return
        follows = self.trainer.exercise.follows
        if self.trainer.result is not None and follows:
            self._do_task({"name": follows, "lay": True})
        else:
            self.trainer.choose(message["number"])

    def _do_say(self, message: Message) -> None:
        if self.trainer is not None:
            self.trainer.say(message["text"])
