# SPDX-License-Identifier: BSD-3-Clause
"""Training: tasks with a score, a trace and a CSV; and a lesson. It needs frames of a session, and no window."""

from __future__ import annotations

from nanotouch.errors import InvalidValue

from nanotouch_app.training.dent import Dent, Scratch
from nanotouch_app.training.exercise import Exercise as Exercise
from nanotouch_app.training.exercise import Result as Result
from nanotouch_app.training.facts import Facts as Facts
from nanotouch_app.training.find import Find
from nanotouch_app.training.lesson import LESSON
from nanotouch_app.training.pull_off import PullOff
from nanotouch_app.training.push import Pattern, Push
from nanotouch_app.training.steady import Steady
from nanotouch_app.training.stiffer import Stiffer
from nanotouch_app.training.trace import Trace
from nanotouch_app.training.wire import Wire

TASKS: dict[str, type[Exercise]] = {
    task.name: task for task in (Find, PullOff, Trace, Steady, Stiffer, Dent, Scratch, Push, Pattern, Wire)
}


def named(name: str) -> type[Exercise]:
    """The task of that name; "lesson" begins with its first page, "lesson-3" with its third."""
    known: dict[str, type[Exercise]] = {**TASKS, "lesson": LESSON[0], **{page.name: page for page in LESSON}}
    if name not in known:
        raise InvalidValue(f"task {name!r}: valid are {', '.join(TASKS)}, lesson, lesson-2 .. lesson-{len(LESSON)}")
    return known[name]
