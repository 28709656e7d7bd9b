# SPDX-License-Identifier: BSD-3-Clause
"""A scene that changes while the tip rubs: lifted afterwards, it keeps no force of contact and none of a history."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.manipulation import Particles, latex
from nanotouch.touch.operator import Input

NAN = math.nan
DRY = {"medium": {"relative_humidity": 0.0}, "adhesion": {"work_of_adhesion": 0.0, "hamaker_constant": 0.0}}
# what a person changes one after the other: laws come, go, and are left out by the plan
CHANGES = (
    ("friction.coefficient", (0.0, 0.0004, 0.04, 0.4)),
    ("friction.shear_strength", (0.0, 1e3, 2e7)),
    ("sample.youngs_modulus", (2e9, 1e10, 1.35e11)),
    ("sample.dents", ("no", "yes")),
    ("medium.relative_humidity", (0.0, 0.4)),
    ("adhesion.work_of_adhesion", (0.0, 0.05)),
    ("adhesion.hamaker_constant", (0.0, 8e-21)),
)


def rubbing(seed: int, **scene: object) -> nt.Session:
    """A tip pressed down and drawn sideways."""
    rig = nt.Rig(master={"axes": 3}, probe={"lateral_stiffness": 50.0})
    rubbed = nt.Scene(friction={"coefficient": 0.3, "shear_strength": 2e7}, **scene)  # type: ignore[arg-type]
    session = nt.Session(rubbed, rig, seed=seed, clearance=20e-9, minimum_margin=0.0, relative_accuracy=0.05)
    session.advance(0.5, Input((0.5, 0.3, 1.0), NAN, NAN, 0.1))
    return session


def lifted(session: nt.Session) -> tuple[float, float, float]:
    """Gap, force sideways and along z of a tip that is lifted and stands still."""
    session.arm(True)
    session.advance(0.6, Input((0.0, 0.0, -2.0), NAN, NAN, 0.1))
    columns = session.advance(0.05, Input((0.0, 0.0, 0.0), NAN, NAN, 0.02))
    return (
        columns["gap"][-1],
        math.hypot(columns["tip_force_x"][-1], columns["tip_force_y"][-1]),
        columns["tip_force"][-1],
    )


def planned(session: nt.Session, gap: float) -> float:
    """What the scene plans at that gap for a tip that has never touched; beside dents there is nothing else."""
    if session.scene["sample.dents"]:
        return 0.0
    return float(nt.Interaction(session.plan).eval((0.0, 0.0, gap)).Fz)


@pytest.mark.parametrize("seed", range(12))
def test_no_change_leaves_a_force(seed: int) -> None:
    rng = np.random.default_rng(seed)
    session = rubbing(seed, **DRY)
    changed = 0
    for _ in range(6):
        field, values = CHANGES[rng.integers(len(CHANGES))]
        try:
            session.change("scene", field, values[rng.integers(len(values))])
            changed += 1
        except nt.errors.Error:
            continue  # dents beside adhesion: refused, nothing changes
        session.advance(0.02)
    gap, sideways, along = lifted(session)
    assert changed > 0
    assert gap > 50e-9
    assert sideways == 0.0
    assert along == pytest.approx(planned(session, gap), rel=1e-6, abs=1e-18)


def test_a_restored_contact_holds_until_it_is_lifted() -> None:
    session = rubbing(1)
    held = session.snapshot()
    for field, value in (("friction.coefficient", 0.0), ("friction.shear_strength", 0.0)):
        session.change("scene", field, value)
    session.advance(0.05)
    for field, value in (("friction.shear_strength", 2e7), ("friction.coefficient", 0.3)):
        session.change("scene", field, value)
    session.restore(held)
    columns = session.advance(0.01)
    assert np.hypot(columns["tip_force_x"], columns["tip_force_y"])[-1] > 1e-9
    assert lifted(session)[1] == 0.0


def test_a_ball_that_is_left_holds_nothing() -> None:
    scene = nt.Scene(tip={"radius": 50e-9, "half_angle": 0.26}, sample={"youngs_modulus": 70e9},
                     friction={"coefficient": 0.3}, range={"maximum_load": 100e-9}, **DRY)  # fmt: skip
    rig = nt.Rig(probe={"spring_constant": 10.0, "lateral_stiffness": 40.0}, master={"axes": 3.0})
    balls = Particles(latex(500e-9, 50e-9))
    session = nt.Session(scene, rig, clearance=0.3e-6, particles=balls, minimum_margin=0.0, path=[(0.0, 0.0)],
                         gains={"alpha_p": 3e-4}, seed=1)  # fmt: skip
    session.lay(0, (0.7e-6, 0.0))
    start, scale = session.core.master_start, session.settings.gains.alpha_p
    hold = nt.touch.operator.Hold
    pushed = session.advance(0.5, hold((0.6e-6 / scale, 0.0, start), NAN, NAN, 0.4))
    assert abs(pushed["tip_force_x"][-1]) > 1e-10
    session.change("scene", "friction.coefficient", 0.0)
    up = session.advance(0.5, hold((0.6e-6 / scale, 0.0, start - 0.5e-6 / scale), NAN, NAN, 0.4))
    for name in ("tip_force_x", "tip_force_y", "tip_force"):
        assert up[name][-1] == 0.0
