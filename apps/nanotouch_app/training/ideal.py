# SPDX-License-Identifier: BSD-3-Clause
"""Operators that solve the tasks, so that they are known to be solvable. Each sees frames, as a person sees the window,
and asks as a person asks: by the wheel, by moves, by choices. They know nothing of the law."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import permutations
from typing import Any, Protocol

import numpy as np
from nanotouch.manipulation import turning_point

from nanotouch_app.training.dent import Dent, Scratch
from nanotouch_app.training.exercise import Exercise, touching
from nanotouch_app.training.push import ALLOWED, Push
from nanotouch_app.training.steady import TARGET
from nanotouch_app.training.stiffer import LOAD, Stiffer
from nanotouch_app.training.wire import Wire

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


def dent(operator: Operator) -> None:
    """Press a little harder each time, in the same place, until what stays is deep enough."""
    exercise = operator.exercise
    assert isinstance(exercise, Dent)
    force = 0.1 * operator.load
    while exercise.imprint is None or exercise.imprint.depth < 0.95 * exercise.asked_depth:
        operator.down_to(force)
        operator.up()
        force *= 1.05
    operator.rig.answer({"do": "choose", "number": 0})


def scratch(operator: Operator) -> None:
    """Grooves beside each other, each under a larger force, until one is deep enough."""
    exercise = operator.exercise
    assert isinstance(exercise, Scratch)
    force, pieces = 0.08 * operator.load, 60
    while exercise.imprint is None or exercise.imprint.depth < 0.93 * exercise.asked_depth:
        operator.down_to(force)
        for _ in range(pieces):
            operator.rig.answer({"do": "move", "way": (exercise.length / pieces, 0.0, 0.0)})
            operator.wait()
        operator.up()
        operator.rig.answer({"do": "move", "way": (-exercise.length, 0.12 * operator.width, 0.0)})
        operator.wait(0.3)
        force *= 1.1
    operator.rig.answer({"do": "choose", "number": 0})


def push(operator: Operator) -> None:
    """Around a ball to its far side, against its middle, back, and look again; each ball to a ring that is near."""
    exercise = operator.exercise
    assert isinstance(exercise, Push)
    goals, count = exercise.goals, exercise.count
    far = np.linalg.norm(goals[None] - exercise.places[:, None, :2], axis=2)
    _, best = min((sum(far[range(count), order]), order) for order in permutations(range(count)))
    for one, goal in enumerate(goals[list(best)]):
        while np.linalg.norm(way := goal - exercise.places[one, :2]) > 0.5 * ALLOWED:
            length, place = float(np.linalg.norm(way)), exercise.places[one, :2]
            reach = _reach(operator)
            behind = place - 1.5 * reach * way / length
            _go_around(operator, behind, list(exercise.places[:, :2]), 1.4 * reach)
            _go(operator, place + way - reach * way / length, 10e-9)
            _go(operator, behind)
    operator.rig.answer({"do": "choose", "number": 0})


def _reach(operator: Operator) -> float:
    """From the middle of a ball or wire to the apex of a tip that touches with its flank, at its height now [m]."""
    exercise, height = operator.exercise, float(operator.rig.observer.newest()["tip_position"][2])
    assert isinstance(exercise, Push)
    tip, radius = exercise.facts.scene.tip, exercise.radius
    up = radius - tip.radius - height
    return float((radius + tip.radius + up * math.sin(tip.half_angle)) / math.cos(tip.half_angle))


def wire(operator: Operator) -> None:
    """Against its middle it goes across, half way to an end it turns about a point on the other side, against an end it
    goes along: each by what is missing, then look again."""
    exercise = operator.exercise
    assert isinstance(exercise, Wire)
    c = turning_point(2.0, 0.5)  # of half of the length
    back = (1.0 - c) / (1.0 + c)  # that goes the other end by
    while True:
        ends = exercise.places[:, :2]
        off = min((exercise.goals[list(order)] - ends for order in ((0, 1), (1, 0))),
                  key=lambda ways: float(np.linalg.norm(ways)))  # fmt: skip
        if np.linalg.norm(off, axis=1).max() < 0.7 * ALLOWED:
            break
        axis = (ends[1] - ends[0]) / exercise.length
        normal = np.array([-axis[1], axis[0]])
        (first, second), along = off @ normal, float((off @ axis).mean())
        turn = (second - first) / (1.0 + back)  # way of the second end with a push half way to it
        all_of_it = first + back * turn
        middle = ends.mean(axis=0)
        if abs(along) > max(0.4 * ALLOWED, abs(all_of_it), abs(turn)):
            _shove(operator, ends[0 if along > 0.0 else 1], np.sign(along) * axis, abs(along))
        elif abs(all_of_it) > 0.3 * ALLOWED:
            _shove(operator, middle, np.sign(all_of_it) * normal, abs(all_of_it))
        else:
            share = (c + 0.5) / (c + 1.0)
            _shove(operator, 0.5 * (middle + ends[1]), np.sign(turn) * normal, share * abs(turn))
    operator.rig.answer({"do": "choose", "number": 0})


def _shove(operator: Operator, spot: Any, way: Any, length: float) -> None:
    """By a length, where a spot of its axis lies; high up there, and back."""
    exercise = operator.exercise
    assert isinstance(exercise, Wire)
    while float(operator.wheel(-5.0)["tip_position"][2]) < 2.5 * exercise.radius:
        pass
    _go(operator, spot - 2.0 * exercise.radius * way)
    while float(operator.wheel(1.0)["tip_position"][2]) > 0.5 * exercise.radius:
        pass
    operator.wait(0.1)
    _go(operator, spot + (length - _reach(operator)) * way, 10e-9)
    _go(operator, spot - 2.0 * exercise.radius * way)


def _go(operator: Operator, to: Any, step: float = 100e-9) -> None:
    """In a straight line by steps, until the tip is there."""
    frame = operator.wait()
    while np.linalg.norm(way := to - frame["tip_position"][:2]) > 2e-9:
        way = way * min(1.0, step / float(np.linalg.norm(way)))
        operator.rig.answer({"do": "move", "way": (float(way[0]), float(way[1]), 0.0)})
        frame = operator.wait()


def _go_around(operator: Operator, to: Any, balls: list[Any], room: float) -> None:
    """Away from each ball that is near, then on."""
    frame = operator.wait()
    while np.linalg.norm(way := to - frame["tip_position"][:2]) > 20e-9:
        here = frame["tip_position"][:2]
        step = way * min(1.0, 60e-9 / float(np.linalg.norm(way)))
        for ball in balls:
            away = here + step - ball
            if (near := float(np.linalg.norm(away))) < room and float(step @ away) < 0.0:
                out = away / near
                along = np.array([-out[1], out[0]])
                step = 60e-9 * np.sign(along @ way + 1e-30) * along + max(0.0, room - near) * out
        operator.rig.answer({"do": "move", "way": (float(step[0]), float(step[1]), 0.0)})
        frame = operator.wait()


SOLVERS: dict[str, Callable[[Operator], None]] = {
    "find": find, "pull_off": pull_off, "trace": trace, "steady": steady, "stiffer": stiffer,
    "dent": dent, "scratch": scratch, "push": push, "pattern": push, "wire": wire,
}  # fmt: skip
