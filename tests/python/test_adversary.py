# SPDX-License-Identifier: BSD-3-Clause
"""A small sample of tests/heavy/adversary.py, which takes as many runs as one likes; and that its judge can judge."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "heavy"))

from adversary import run
from adversary_judge import Judge


@pytest.mark.parametrize(
    ("door", "first"), [("session", 0), ("session", 100), ("live", 8), ("master", 0), ("slave", 0)]
)
def test_no_number_is_broken(door: str, first: int) -> None:
    """Two runs each, by the doors that take no time of the clock."""
    rows = [run(seed, door) for seed in range(first, first + 2)]
    assert not any(row.get("broken") for row in rows), rows
    assert any("worst" in row for row in rows)  # not all are refused before arming


def flat(**changed: Any) -> dict[str, Any]:
    """Ten ticks of nothing."""
    names = ("time", "tip_force", "tip_force_x", "tip_force_y", "contact_radius", "gap", "motor_force",
             "master_position", "state")  # fmt: skip
    return {name: np.zeros(10) for name in names} | {"time": np.arange(10) * 1e-4} | changed


@pytest.mark.parametrize(
    ("what", "column"), [("force", "tip_force"), ("sideways", "tip_force_x"), ("indentation", "gap"),
                         ("motor", "motor_force")]
)  # fmt: skip
def test_the_judge_finds_what_is_broken(what: str, column: str) -> None:
    """Just below and just above each promise, and what is not a number."""
    session = nt.Session(nt.Scene(friction={"shear_strength": 50e6}), nt.Rig(probe={"lateral_stiffness": 50.0}))
    promised = session.guarantee()
    limit = {
        "force": promised.force, "sideways": promised.lateral_force, "indentation": -promised.indentation,
        "motor": min(session.settings.limits.motor_force, session.rig.master.max_force),
    }[what]  # fmt: skip
    for share, breaks in ((0.99, False), (1.03, True), (np.nan, True)):
        judge = Judge(stands=True)
        judge.promise(session)
        judge.watch(flat(**{column: np.full(10, share * limit)}))
        assert (what in [one.what for one in judge.broken]) == breaks


def stop_of(session: nt.Session, motor: np.ndarray, speed: float) -> Judge:
    """Of a stop in the sixth of some ticks, while the hand goes at a speed under this force of the motor."""
    ticks = len(motor)
    columns = {name: np.zeros(ticks) for name in flat()} | {
        "time": np.arange(ticks) * 1e-4, "state": (np.arange(ticks) > 5) * 2.0, "motor_force": motor,
        "master_position": speed * np.arange(ticks) * 1e-4,
    }  # fmt: skip
    judge = Judge()
    judge.promise(session)
    judge.watch(columns)
    return judge


def test_the_judge_finds_what_the_motor_does_after_a_stop() -> None:
    session = nt.Session()
    ticks = np.arange(1000)
    fades = np.clip(1.0 - (ticks - 5) / 25.0, 0.0, 1.0)
    cases = {
        "motor after a stop": np.where(ticks == 7, 1.01, fades),
        "motor faded": np.where(ticks == 900, 0.01, fades),
        "energy to the hand": 3.0 * np.clip(1.0 - (ticks - 5) / 400.0, 0.0, 1.0),
    }
    assert not stop_of(session, fades, 0.3).broken
    for what, motor in cases.items():
        assert [one.what for one in stop_of(session, motor, 0.3).broken] == [what]


def test_the_judge_finds_a_ripple_that_grows() -> None:
    """Over the windows and the two seconds after them; noise whose windows differ does not grow."""
    session = nt.Session()
    rate, windows = 10_000, 3000
    ticks = np.arange(windows + 2 * rate)
    noise = 20e-9 * np.random.default_rng(2).standard_normal(ticks.size)
    noise[2500] *= 3.0
    for growth, force, breaks in ((0.0, 0.0, False), (1e-3, 0.0, True), (0.0, noise, False)):
        swing = force + 50e-9 * np.exp(growth * np.minimum(ticks, 20 / 1e-3)) * np.sin(0.3 * ticks)
        parts = iter(np.split(swing, [windows, windows + rate]))
        judge = Judge()
        judge.promise(session)
        judge.calm(session, lambda _, parts=parts: next(parts), next(parts))
        assert bool(judge.broken) == breaks
