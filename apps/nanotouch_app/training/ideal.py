# SPDX-License-Identifier: BSD-3-Clause
"""Operators that solve the tasks, so that they are known to be solvable. Each sees frames, as a person sees the window,
and asks as a person asks: by the wheel, by moves, by choices. They know nothing of the law."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from nanotouch_app.training.exercise import Exercise, touching
from nanotouch_app.training.steady import TARGET
from nanotouch_app.training.stiffer import LOAD, Stiffer

STEP = 0.02  # between two looks [s]
LONGEST = 600.0  # until the operator gives up [s]


class Rig(Protocol):
    """What an operator has before it."""

    observer: Any

    def answer(self, message: dict[str, Any]) -> bool:
        """Ask for something."""

    def advance(self, duration: float) -> None:
        """Let time pass [s]."""


class Operator:
    """Hands and eyes."""

    def __init__(self, rig: Rig, exercise: Exercise) -> None:
        self.rig, self.exercise = rig, exercise
        self.load, self.width = exercise.facts.load, exercise.facts.width
        self.time = 0.0
        self.seen: list[Any] = []

    def wait(self, duration: float = STEP) -> Any:
        """Let time pass; the newest frame."""
        self.rig.advance(duration)
        self.time += duration
        if self.time > LONGEST:
            raise TimeoutError(f"the task {self.exercise.name} is not solved within {LONGEST:g} s")
        frame = self.rig.observer.newest()
        self.seen.append(frame)
        return frame

    def wheel(self, steps: float) -> Any:
        """Down by so many steps, or up."""
        self.rig.answer({"do": "wheel", "steps": steps})
        return self.wait()

    def down_to(self, force: float) -> Any:
        """Touch, then press with a force [N]."""
        frame = self.wheel(0.0)
        while not touching(frame):
            frame = self.wheel(0.3)
        while frame["tip_force"][2] < force:
            frame = self.wheel(min(1.0, 0.1 + 20.0 * (force - frame["tip_force"][2]) / self.load))
        return frame

    def up(self) -> None:
        """Let go."""
        frame = self.wheel(-1.0)
        while touching(frame):
            frame = self.wheel(-1.0)
        for _ in range(5):
            self.wheel(-0.5)

    def hold(self, force: float, way: float = 0.0) -> None:
        """Correct the height for one look, and go on along x by a way [m]."""
        frame = self.rig.observer.newest()
        if way:
            self.rig.answer({"do": "move", "way": (way, 0.0, 0.0)})
        self.wheel(float(np.clip(40.0 * (force - frame["tip_force"][2]) / self.load, -2.0, 2.0)))


def find(operator: Operator) -> None:
    """Down by small steps until it touches, then wait."""
    operator.down_to(-np.inf)
    while operator.exercise.result is None:
        operator.wait()


def pull_off(operator: Operator) -> None:
    """Touch and tear three times; say the mean of the deepest pulls that were seen."""
    seen = []
    for _ in range(3):
        operator.down_to(0.05 * operator.load)
        operator.seen.clear()
        lowest = 0.0
        while touching(operator.wheel(-0.2)):
            lowest = min(frame["tip_force"][2] for frame in operator.seen)
        seen.append(-lowest)
        operator.up()
    operator.rig.answer({"do": "say", "text": f"{np.mean(seen):.6g}N"})


def trace(operator: Operator) -> None:
    """To the left, then to the right at a light force; the period is the mean way between two edges of a kind."""
    force, way = 0.1 * operator.load, 0.002 * operator.width
    frame = operator.down_to(force)
    while frame["tip_position"][0] > 0.1 * operator.width:
        operator.hold(force, -way)
        frame = operator.seen[-1]
    operator.seen.clear()
    while operator.rig.observer.newest()["tip_position"][0] < 0.9 * operator.width:
        operator.hold(force, way)
    x, _, z = np.array([frame["tip_position"] for frame in operator.seen]).T
    high = z > 0.5 * (z.min() + z.max())
    edges = np.flatnonzero(np.diff(high.astype(int)) != 0)
    ways = x[edges[2:]] - x[edges[:-2]]
    operator.rig.answer({"do": "say", "text": f"{ways.mean():.6g}m"})


def steady(operator: Operator) -> None:
    """Correct the height against the force."""
    target = TARGET * operator.load
    operator.down_to(0.9 * target)
    while operator.exercise.result is None:
        operator.hold(target, 0.0004 * operator.width)


def stiffer(operator: Operator) -> None:
    """Which one gives way less under the same force."""
    assert isinstance(operator.exercise, Stiffer)
    while operator.exercise.result is None:
        depth = []
        for sample in range(2):
            operator.rig.answer({"do": "choose", "number": sample})
            operator.seen.clear()
            operator.down_to(LOAD * operator.load)
            operator.wait(0.1)
            rows = np.array([(frame["tip_force"][2], -frame["gap"]) for frame in operator.seen])
            depth.append(float(np.interp(0.9 * LOAD * operator.load, *rows[np.argsort(rows[:, 0])].T)))
            operator.up()
        operator.rig.answer({"do": "choose", "number": 2 if depth[0] < depth[1] else 3})


SOLVERS: dict[str, Callable[[Operator], None]] = {
    "find": find, "pull_off": pull_off, "trace": trace, "steady": steady, "stiffer": stiffer
}  # fmt: skip
