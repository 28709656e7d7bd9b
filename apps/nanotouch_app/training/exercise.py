# SPDX-License-Identifier: BSD-3-Clause
"""What all tasks have in common: they look at frames, keep a trace, offer choices, and end with a result."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
from nanotouch.errors import InvalidValue
from nanotouch.manipulation import Laid
from nanotouch.plasticity import Dent
from nanotouch.touch.record import replacing
from nanotouch.units import parse_quantity
from numpy.typing import NDArray

from nanotouch_app.training.facts import Facts

SLICE = 0.01  # of the trace [s]
TRACE = ("time [s]", "x [m]", "y [m]", "gap [m]", "least force [N]", "largest force [N]", "contact")
Change = tuple[str, str, float]
"""scene or settings, a field, and its new value; "scaled": a field of the settings, and by what it is multiplied"""


def touching(frames: Any) -> Any:
    """Whether the tip touches: a contact, or, where fur keeps the bodies apart, further down than their surfaces."""
    return (frames["contact_radius"] > 0.0) | (frames["gap"] < 0.0)


@dataclass
class Result:
    """How a task went."""

    task: str
    passed: bool
    score: float
    """0 .. 100"""
    said: str
    """in a sentence"""
    figures: dict[str, tuple[float, str]] = field(default_factory=dict)
    """what was measured: value and unit"""
    trace: list[tuple[float, ...]] = field(default_factory=list)
    """rows of TRACE"""
    trials: list[dict[str, Any]] = field(default_factory=list)
    """of a task with many of them"""

    def to_csv(self, path: str | Path) -> None:
        """The figures as ``# name [unit]: value``; then the trials, or the trace."""
        with replacing(path) as part, open(part, "w", encoding="utf-8", newline="") as file:
            file.write(f"# task: {self.task}\n# passed: {self.passed}\n# score: {self.score:.1f}\n")
            file.write(f"# said: {self.said}\n")
            for name, (value, unit) in self.figures.items():
                file.write(f"# {name}{f' [{unit}]' if unit else ''}: {value:.9g}\n")
            table = csv.writer(file, lineterminator="\n")
            if self.trials:
                table.writerow(self.trials[0])
                table.writerows(trial.values() for trial in self.trials)
            else:
                table.writerow(TRACE)
                table.writerows(self.trace)


class Exercise:
    """One task on one world. Given frames by :meth:`see`; what it asks of the session is in :attr:`changes`."""

    name: ClassVar[str] = ""
    title: ClassVar[str] = ""
    preset: ClassVar[str] = "silicon_in_air"
    """on which it is done if nothing else is named"""
    hides: ClassVar[frozenset[str]] = frozenset()
    """what a window does not show: surface, law, contact, sliders"""
    asked: ClassVar[str] = ""
    """the unit of a number that the person types at the end; "" for none"""

    follows: ClassVar[str] = ""
    """the task that comes after it"""

    def __init__(self, facts: Facts, seed: int = 1) -> None:
        self.facts = facts
        self.rng = np.random.default_rng(seed)
        self.changes: list[Change] = []
        self.trace: list[tuple[float, ...]] = []
        self.result: Result | None = None
        self.began = math.nan
        self.touches = False
        self.dents: tuple[Dent, ...] = ()
        self._slice: list[Any] = []

    # --- what a task fills in ---

    @property
    def words(self) -> str:
        """What to do."""
        raise NotImplementedError

    @property
    def now(self) -> str:
        """How it stands, in a few words."""
        return ""

    @property
    def choices(self) -> Sequence[str]:
        """What can be chosen now."""
        return ()

    @property
    def shown(self) -> dict[str, Any] | None:
        """Particles and their targets, for the picture; None for none."""
        return None

    @property
    def locked(self) -> bool:
        """Nothing may be touched yet."""
        return False

    lays: NDArray[np.float64] | None = None
    """where it wants particles, x and y [m]; None: nowhere"""

    def take(self, laid: Laid) -> None:
        """What lies there now, of a task with particles."""

    def judge(self, frames: Any) -> None:
        """Look at new frames; set the result when it is done."""
        raise NotImplementedError

    def choose(self, number: int) -> None:
        """One of the choices, from 0."""
        raise InvalidValue(f"choice {number + 1}: this task offers none")

    def answer(self, value: float) -> None:
        """The number that was asked for, in SI units."""
        raise InvalidValue("this task asks for no number")

    # --- what all do ---

    @staticmethod
    def early(why: str) -> InvalidValue:
        """What is raised where an answer comes too early."""
        return InvalidValue(f"not yet: {why}")

    def see(self, frames: Any) -> None:
        """Take new frames in their order."""
        frames = frames[np.isfinite(frames["tip_force"][:, 2])]
        if not len(frames) or self.result is not None:
            return
        if not math.isfinite(self.began):
            self.began = float(frames["time"][0])
        self._keep(frames)
        self.judge(frames)
        self.touches = bool(touching(frames[-1]))

    def say(self, text: str) -> None:
        """The number that a person has typed, with its unit."""
        if not self.asked:
            raise InvalidValue("this task asks for no number")
        self.answer(parse_quantity(text, self.asked))

    def _keep(self, frames: Any) -> None:
        slots = np.floor(frames["time"] / SLICE)
        for slot in np.unique(slots):
            part = frames[slots == slot]
            force, last = part["tip_force"][:, 2], part[-1]
            x, y, _ = last["tip_position"]
            row = (slot * SLICE, float(x), float(y), float(last["gap"]), float(force.min()), float(force.max()),
                   float(touching(last)))  # fmt: skip
            if self.trace and self.trace[-1][0] == row[0]:
                old = self.trace.pop()
                row = (*row[:4], min(row[4], old[4]), max(row[5], old[5]), row[6])
            self.trace.append(row)

    def end(self, passed: bool, score: float, said: str, figures: Mapping[str, tuple[float, str]]) -> None:
        """It is done."""
        when = self.trace[-1][0] - self.trace[0][0] if self.trace else 0.0
        self.result = Result(self.name, passed, min(max(score, 0.0), 100.0), said,
                             {**figures, "duration": (when, "s")}, self.trace)  # fmt: skip
