# SPDX-License-Identifier: BSD-3-Clause
"""A task beside a session: it is given each frame, its changes are made, and the window is told how it stands."""

from __future__ import annotations

import time
from collections.abc import Callable
from datetime import datetime
from pathlib import Path
from typing import Any

import nanotouch as nt
from nanotouch.errors import Error, InvalidValue

from nanotouch_app.training import Exercise, Facts, Result, named
from nanotouch_app.training.lesson_texts import TEXTS

TOLD = 0.2  # how it stands is told so often [s]
Message = dict[str, Any]


class Trainer:
    """One task on one session, from now on."""

    def __init__(
        self, name: str, world: Message, change: Callable[[str, str, float], None], tell: Callable[[Message], None],
        folder: Path | None = None, seed: int | None = None,
    ) -> None:  # fmt: skip
        self.change, self.tell, self.folder = change, tell, folder
        self.exercise: Exercise = named(name)(Facts.of(world), time.time_ns() % 2**32 if seed is None else seed)
        self.observer = nt.frames.attach(world["name"])
        self.told, self.saved = 0.0, ""
        self.shown: Message | None = None
        self.look()
        self.report()

    @property
    def result(self) -> Result | None:
        """Once it is done."""
        return self.exercise.result

    def look(self) -> None:
        """The frames since the last look; what the task then asks for is done."""
        done = self.result
        self.exercise.see(self.observer.read())
        self._show()
        self._change()
        if self.result is not done or time.monotonic() - self.told > TOLD:
            self.report()

    def _show(self) -> None:
        shown = self.exercise.shown
        if shown is not None and shown != self.shown:
            self.shown = shown
            self.tell({"tell": "particles", **shown})

    def _change(self) -> None:
        while self.exercise.changes:
            what, field, value = self.exercise.changes.pop(0)
            try:
                self.change(what, field, value)
            except Error as error:
                self.tell({"tell": "refused", "why": str(error), "field": field})

    def choose(self, number: int) -> None:
        """One of the choices, from 0."""
        offered = len(self.exercise.choices)
        if offered and not 0 <= number < offered:
            raise InvalidValue(f"choice {number + 1}: valid is 1 .. {offered}")
        self.exercise.choose(number)
        self._change()
        self.report()

    def say(self, text: str) -> None:
        """The number that the task asks for."""
        self.exercise.say(text)
        self.report()

    def report(self) -> None:
        """Tell the window; keep the result as a file once."""
        self.told, exercise = time.monotonic(), self.exercise
        message: Message = {
            "tell": "task", "name": exercise.name, "title": exercise.title, "words": exercise.words,
            "now": exercise.now, "choices": list(exercise.choices), "asked": exercise.asked,
            "hides": sorted(exercise.hides),
        }  # fmt: skip
        if exercise.result is not None:
            follows = [TEXTS["next"]] if exercise.follows else []
            message |= {
                "hides": [],
                "choices": follows,
                "asked": "",
                "words": "",
                "passed": exercise.result.passed,
                "score": exercise.result.score,
                "now": exercise.result.said,
                "saved": self._save(),
            }
        self.tell(message)

    def _save(self) -> str:
        if not self.saved and self.folder is not None and self.result is not None:
            path = self.folder / f"nanotouch-{self.exercise.name}-{datetime.now():%Y-%m-%dT%H-%M-%S}.csv"
            try:
                self.result.to_csv(path)
                self.saved = str(path)
            except (OSError, Error) as error:
                self.saved = f"not saved: {error}"
        return self.saved

    def close(self) -> None:
        """End it; the session goes on."""
        self.observer.close()
        if self.shown is not None:
            self.tell({"tell": "particles", "radius": 0.0, "places": [], "targets": [], "events": []})
        self.tell({"tell": "task", "name": ""})
