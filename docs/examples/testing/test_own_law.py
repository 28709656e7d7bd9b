# SPDX-License-Identifier: BSD-3-Clause
"""A student's own force law, tested by itself and in a touch: a repulsion that decays with the gap, as of a brush."""

import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import testing


def force(gap, strength, decay):
    return strength * math.exp(-max(gap, 0.0) / decay)


def energy(gap, strength, decay):
    return decay * force(gap, strength, decay)


def stiffness(gap, strength, decay):
    return force(gap, strength, decay) / decay


@pytest.fixture
def scene():
    parameters, units = {"strength": 20e-9, "decay": 10e-9}, {"strength": "N", "decay": "m"}
    nt.scene.register("brush", energy=energy, force=force, stiffness=stiffness, bound=force,
                      parameters=parameters, units=units)  # fmt: skip
    found = nt.Scene()
    found.add_term("brush")
    return found


def test_the_force_is_the_slope_of_the_energy():
    step = 1e-13
    for gap in np.linspace(1e-9, 60e-9, 20):
        slope = (energy(gap - step, 20e-9, 10e-9) - energy(gap + step, 20e-9, 10e-9)) / (2.0 * step)
        assert force(gap, 20e-9, 10e-9) == pytest.approx(slope, rel=1e-6)


def test_the_plan_has_it(scene):
    with_brush, without = scene.plan(), nt.Scene().plan()
    for gap in (5e-9, 20e-9):
        more = with_brush.force(gap) - without.force(gap)
        assert more == pytest.approx(force(gap, 20e-9, 10e-9), rel=0.02, abs=1e-12)  # 1 % is the plan's accuracy


def test_it_is_felt_before_contact(nt_session, scene):
    session = nt_session(scene)
    touch = session.run(operator=testing.scripted_hand(session, (1.0, 0.5)))
    testing.assert_runs(touch)
    testing.assert_guarantee_kept(session, touch)
    row = np.argmax(touch.gap < 10e-9)  # on the way down
    assert touch.tip_force[row] == pytest.approx(force(touch.gap[row], 20e-9, 10e-9), rel=0.02)
