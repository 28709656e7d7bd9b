# SPDX-License-Identifier: BSD-3-Clause
"""All that a session prints, against what was met: the one place where an adversary's runs are judged (adversary.py).

A change under a pressed tip makes another promise: the old one goes on to hold, too, until the tip has come below the
new limit (force), or has left the sample (sideways, indentation)."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from adversary_ground import Ground

TOUCHED = 0.5
"""a run counts for the tightness of a bound where the tip was pressed with this share of the force limit"""
FADED = 50e-3
"""after a stop the motor's force is gone by then, or by what is printed for the largest [s]"""
TARE = 0.5
"""time between the tare and the first tick, at most [s]"""
LIES = {"gain", "drift", "noise", "slip"}
FAILURES = ("deflection read wrong", "deflection sensor dead", "slip of stage or surface", "stage runs or turns")


def failure_of(fault: Any) -> str:
    """Which of the printed failures a fault is (tests/c/failure_of.h); "": the first number holds."""
    if fault is None:
        return ""
    name, channel = fault[0], fault[1]
    if name in ("jump", "limit"):
        return FAILURES[2]
    if channel == "stage":
        return FAILURES[3]
    if channel == "deflection" and name in LIES | {"stuck"}:
        return FAILURES[0] if name in LIES else FAILURES[1]
    if channel == "stage_position" and name in LIES | {"stuck"}:
        return FAILURES[3]
    return ""


class Met(NamedTuple):
    """One number of the promise, and what came closest to it."""

    what: str
    met: float
    promised: float
    time: float
    """in the session [s]"""

    @property
    def share(self) -> float:
        return self.met / self.promised if self.promised > 0.0 else (math.inf if self.met > 0.0 else 0.0)


class Judge:
    """Of one session. Faults as drawn; ``stands``: nothing leads the tip sideways, so that indentation is promised."""

    def __init__(self, fault: Any = None, stands: bool = False, ground: Ground | None = None) -> None:
        self.failure, self.fault, self.stands = failure_of(fault), fault, stands
        self.ground, self.steepest = ground, ground is None  # whether the tip was pressed where it is steep
        self.worst: dict[str, Met] = {}
        self.now: Any = None
        self.warned = False  # that the limit protects nothing: a snap-in alone passes it
        self.carried = {"force": 0.0, "sideways": 0.0, "indentation": 0.0}
        self.stopped = -1.0  # since when [s]; below 0: it is in RUN
        self.clutched = False  # uncoupled by the person: an event as a stop is
        self.before = np.zeros(3)  # of the motor [N]
        self.given = 0.0  # to the hand since [J]
        self.hasty = False  # the hand has been faster since than is declared
        self.began, self.start = 0.0, np.zeros(3)  # the last tick before a stop, and where the hand was [s, m]
        self.last: Any = None

    @property
    def broken(self) -> list[Met]:
        return [one for one in self.worst.values() if not one.share <= 1.0 + 1e-9]

    def promise(self, session: Any) -> None:
        """What is printed from now on."""
        made, settings = session.guarantee(), session.settings
        if self.now is not None:
            for name, old in self._numbers().items():
                self.carried[name] = max(self.carried[name], old)
        self.now, self.limit = made, float(settings.limits.force)
        self.warned |= made.warning is not None
        self.step = 2.0 * float(session.rig.master.resolution)  # of two readings
        self.motor = min(float(settings.limits.motor_force), float(session.rig.master.max_force))

    def _numbers(self) -> dict[str, float]:
        adds = self.now.failures.get(self.failure, 0.0)
        return {"force": self.now.force + adds, "sideways": self.now.lateral_force,
                "indentation": self.now.indentation}  # fmt: skip

    def _met(self, what: str, values: Any, promised: Any, time: Any) -> None:
        """The place that comes closest; what is not a number has broken it."""
        values, promised = np.abs(np.atleast_1d(values)), np.broadcast_to(promised, np.shape(np.atleast_1d(values)))
        if not len(values):
            return
        share = np.where(np.isnan(values), np.inf, values / np.maximum(promised, 1e-300))
        i = int(np.argmax(share))
        found = Met(what, float(values[i]), float(promised[i]), float(np.atleast_1d(time)[i]))
        if what not in self.worst or not found.share <= self.worst[what].share:
            self.worst[what] = found

    def _allowed(self, name: str, let_go: Any) -> Any:
        """The promise of each tick: the old one, too, until it has let go."""
        now, old = self._numbers()[name], self.carried[name]
        free = np.flatnonzero(let_go)
        allowed = np.full(len(let_go), max(now, old))
        if len(free):
            allowed[free[0] + 1 :] = now
            self.carried[name] = 0.0
        return allowed

    def watch(self, columns: Mapping[str, Any]) -> None:
        """A block of ticks."""
        time = np.asarray(columns["time"])
        if not len(time):
            return
        force = columns["tip_force"]
        free = np.asarray(columns["contact_radius"]) <= 0.0
        most = self._allowed("force", np.abs(force) <= self.limit) + self.now.zero_drift * (time + TARE)
        self._met("force", force, most, time)
        aside = self._allowed("sideways", free)
        if "tip_force_x" in columns and not self.failure:
            self._met("sideways", np.hypot(columns["tip_force_x"], columns["tip_force_y"]), aside, time)
        hard = np.abs(force) > TOUCHED * self.limit
        if not self.steepest and self.ground is not None and hard.any():
            self.steepest = bool((self.ground.steepness(columns["x"][hard], columns["y"][hard]) > 0.7).any())
        depth = self._allowed("indentation", free)
        if self.stands and self.fault is None:
            self._met("indentation", np.maximum(-np.asarray(columns["gap"]), 0.0), depth, time)
        self._hand(columns, time)

    def _hand(self, columns: Mapping[str, Any], time: Any) -> None:
        """Motor and hand: never above the limit; after a stop it only fades, and little energy goes to the hand."""
        nothing = np.zeros(len(time))
        force = np.column_stack([columns.get("motor_force_x", nothing), columns.get("motor_force_y", nothing),
                                 columns["motor_force"]])  # fmt: skip
        place = np.column_stack([columns.get("master_x", nothing), columns.get("master_y", nothing),
                                 columns["master_position"]])  # fmt: skip
        self._met("motor", np.abs(force).max(axis=1), self.motor, time)
        hand = getattr(self.now, "hand", None)
        if hand is None or hand.force == 0.0 or (self.fault and self.fault[1] in ("motor", "master_position")):
            return  # nothing is printed, no motor acts, or what motor and hand really do is not in the columns
        self._met("hand", np.linalg.norm(force, axis=1), hand.force, time)
        stands = (np.asarray(columns["state"]) != 0) | self.clutched
        turns = np.flatnonzero((np.diff(stands) != 0) | (np.diff(time) < 0.0)) + 1
        for first, last in itertools.pairwise((0, *turns, len(time))):
            if first > 0 and time[first] < time[first - 1]:
                self.rewound(self.clutched)
            elif first > 0:
                self.last = (float(time[first - 1]), force[first - 1], place[first - 1])
            self._piece(force[first:last], place[first:last], time[first:last], bool(stands[first]), hand)
        self.last = (float(time[-1]), force[-1], place[-1])

    def rewound(self, clutched: bool = False) -> None:
        """It goes on from another moment: what was before is not known."""
        self.stopped, self.last, self.clutched = -1.0, None, clutched

    def _piece(self, force: Any, place: Any, time: Any, stands: bool, hand: Any) -> None:
        """Ticks that all stand, or all run; from where the last ones have ended."""
        if not stands or self.last is None or time[0] < self.last[0]:
            self.stopped = -1.0
            return
        if self.stopped < 0.0:
            self.stopped, self.given, self.before, self.hasty = float(time[0]), 0.0, self.last[1], False
            self.began, self.start = self.last[0], self.last[2]
        rest = 1e-6 * self.motor
        size = np.linalg.norm(force, axis=1)
        self._met("motor after a stop", size, float(np.linalg.norm(self.before)) + rest, time)
        late = time - self.stopped > max(FADED, hand.fade_time) + 2e-3
        self._met("motor faded", size[late], rest, time[late])
        way = np.diff(np.vstack([self.last[2], place]), axis=0)
        held = np.vstack([self.last[1], force[:-1]])
        given = self.given + np.cumsum(np.nan_to_num((held * way).sum(axis=1)))
        speed = np.diff(np.append(self.last[0], time)) * hand.speed + self.step
        self.hasty |= bool((np.linalg.norm(np.nan_to_num(way), axis=1) > speed).any())
        whole = np.linalg.norm(np.nan_to_num(place - self.start), axis=1)  # a step of the read-out hides a tick's speed
        self.hasty |= bool((whole > (time - self.began) * hand.speed + self.step).any())
        if not self.hasty:  # no hand is declared that goes as fast
            self._met("energy to the hand", np.maximum(given, 0.0), hand.energy + 1e-9, time)
        self.given = float(given[-1])

    def calm(self, session: Any, look_on: Callable[[float], Any], force: Any) -> None:
        """Of two windows of a hand that holds still: the ripple of the last is no more than that of the one before, by
        5 % and what noise and steps make of it, as is printed. Of noise the largest swings of short windows differ by
        a fifth, so where they do, two whole seconds are compared."""
        noise = session.calm().ripple / float(session.settings.gains.alpha_f)
        _, before, last = (_swing(piece) for piece in np.array_split(force, 3))
        if last > 1.05 * before + noise:
            before, last = _swing(look_on(1.0)), _swing(look_on(1.0))
        self._met("ripple", last, 1.05 * before + noise, 0.0)


def _swing(force: Any) -> float:
    """From the lowest to the highest value, beside a slow drift [N]."""
    ticks = np.arange(len(force)) / len(force)
    return float(np.ptp(force - np.polyval(np.polyfit(ticks, force, 2), ticks)))
