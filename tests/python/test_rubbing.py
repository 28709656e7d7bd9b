# SPDX-License-Identifier: BSD-3-Clause
"""Friction as part of a scene and in a session: closed forms, energy, what the hand feels of it, replay."""

from __future__ import annotations

import copy
import pickle

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import friction
from nanotouch.scene.interaction import Interaction, Slide
from nanotouch.touch.replay import replay

SHEAR, COEFFICIENT = 50e6, 0.2


def rubbed_scene(**more: float) -> nt.Scene:
    """Without adhesion, where all is known in closed form."""
    scene = nt.Scene(friction={"shear_strength": SHEAR, "coefficient": COEFFICIENT, **more})
    scene.medium.relative_humidity = scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0
    return scene


def test_a_scene_slips_where_its_pressure_and_area_say() -> None:
    """tau0 pi R d + alpha 4/3 E* sqrt(R d^3), Hertz; the loop's area is what has become heat, by numpy's integral."""
    scene, depth = rubbed_scene(lateral_compliance=0.02), 0.2e-9
    contact = Interaction(scene.plan())
    x = 4e-9 * np.sin(np.linspace(0.0, 4.0 * np.pi, 8001))
    path = np.column_stack([x, 0.0 * x, np.full_like(x, -depth)])
    value = contact.advance(path)
    radius, modulus = scene.tip.radius, 135e9 / (1.0 - 0.35**2) / 2.0
    limit = SHEAR * np.pi * radius * depth + COEFFICIENT * 4.0 / 3.0 * modulus * np.sqrt(radius * depth**3)
    assert np.abs(value.Fx).max() == pytest.approx(limit, rel=1e-12)
    assert np.all(value.Fy == 0.0)
    area = -np.trapezoid(value.Fx[4000:], x[4000:])  # the second turn closes; 1e-5: steps of at most 6 pm in 4 nm
    assert area == pytest.approx(4.0 * limit * (8e-9 - 2.0 * limit / contact.slide.stiffness) / 2.0, rel=1e-3)
    assert contact.slide.stored + contact.slide.dissipated == pytest.approx(contact.slide.work, rel=1e-12)


def test_a_scene_rubs_as_the_law_that_stands_alone() -> None:
    """Under water and adhesion, with a load that varies: the same path given to nt.Friction, contact by contact."""
    scene = nt.Scene(friction={"shear_strength": SHEAR, "coefficient": COEFFICIENT})
    plan, rng = scene.plan(bound="exact"), np.random.default_rng(2)
    x, y = np.cumsum(rng.normal(0.0, 0.1e-9, (2, 400)), axis=1)
    z = -0.15e-9 + 0.1e-9 * np.sin(np.linspace(0.0, 20.0, 400))
    contact = Interaction(plan, "retract")
    value = contact.advance(np.column_stack([x, y, z]))
    facts = plan.explain()
    bodies = nt.Contact(*(facts[name] for name in ("radius", "effective_modulus", "work_of_adhesion")))
    bodies = nt.Contact(bodies.radius, bodies.effective_modulus, bodies.work_of_adhesion, facts["cohesive_stress"])
    law = plan.law("contact", z)
    alone = nt.Friction(
        friction.effective_shear_modulus(135e9, 0.35, 135e9, 0.35), shear_strength=SHEAR, coefficient=COEFFICIENT
    )
    path = alone.run(x - x[0], y - y[0], law.a, friction.compressive_load("maugis", law, bodies))
    largest = np.abs(path.force_x).max()
    np.testing.assert_allclose(value.Fx, path.force_x, rtol=0.0, atol=1e-9 * largest)  # of contact, polished and exact
    np.testing.assert_allclose(value.Fy, path.force_y, rtol=0.0, atol=1e-9 * largest)
    assert contact.slide.dissipated == pytest.approx(path.dissipated[-1], rel=1e-9)


def test_a_plan_says_whether_friction_matters() -> None:
    computed = rubbed_scene().plan()
    assert computed.friction.included
    assert "friction: sticks and slips, up to" in str(computed)
    slight = nt.Scene(friction={"shear_strength": 1e4}).plan()
    assert not slight.friction.included
    assert 0.0 < slight.friction.bound < 0.01
    assert "friction: left out, up to" in str(slight)
    assert slight.cost == nt.Scene().plan().cost
    none = nt.Scene().plan()
    assert "friction" not in str(none)
    assert none.friction.force == 0.0
    gone = nt.Scene(friction={"shear_strength": SHEAR}).plan(force_floor=1e-7)
    assert not gone.friction.included  # below what can be felt


def test_what_friction_remembers_goes_with_the_contact() -> None:
    contact = Interaction(rubbed_scene().plan())
    assert contact.slide == Slide()
    contact.advance([[0.0, 0.0, -0.1e-9], [1e-11, 2e-11, -0.1e-9]])
    kept = contact.slide
    assert kept.stored > 0.0
    for other in (copy.copy(contact), pickle.loads(pickle.dumps(contact))):
        assert other.slide == kept
    on = contact.copy().advance([1e-9, 0.0, -0.1e-9])
    contact.slide = kept
    assert contact.advance([1e-9, 0.0, -0.1e-9]) == on
    away = contact.advance([1e-9, 0.0, 2e-9])
    assert away.Fx == 0.0
    assert contact.slide.stored == 0.0


def rubbing(seed: int) -> nt.Session:
    """A press of some 50 nN along a path to and fro, with a lever of 50 N/m sideways."""
    rig = nt.Rig(probe={"lateral_stiffness": 50.0})
    scene = nt.Scene(friction={"shear_strength": 2e8})
    return nt.Session(scene, rig, mode="scan", path=[(0.0, 0.0), (2e-7, 0.0)], seed=seed)


def test_a_session_records_friction_and_replays_it_bit_by_bit() -> None:
    first, second = rubbing(1).run(2.0), rubbing(1).run(2.0)
    touching = first.columns["contact_radius"] > 0.0
    limit = 2e8 * np.pi * first.columns["contact_radius"] ** 2
    force = np.hypot(first.columns["tip_force_x"], first.columns["tip_force_y"])
    assert touching.sum() > 100
    assert np.all(force <= limit * (1.0 + 1e-12))
    assert force.max() > 1e-9
    np.testing.assert_array_equal(force[~touching], 0.0)
    measured = np.hypot(first.columns["deflection_x"], first.columns["deflection_y"]) * 50.0
    assert measured.max() == pytest.approx(force.max(), rel=1e-6)
    again = replay(first)
    for name in first.columns:
        np.testing.assert_array_equal(first.columns[name], second.columns[name])
        np.testing.assert_array_equal(first.columns[name], again.columns[name])


def test_a_recording_without_friction_is_what_it_was() -> None:
    """What presses has the same bits whether the tip rubs or not."""
    rough, rig = rubbing(4), nt.Rig(probe={"lateral_stiffness": 50.0})
    smooth = nt.Session(nt.Scene(), rig, mode="scan", path=[(0.0, 0.0), (2e-7, 0.0)], seed=4)
    assert rough.plan.friction.included
    assert not smooth.plan.friction.included
    rubbed, slid = rough.run(1.0), smooth.run(1.0)
    for name in set(rubbed.columns) - {"tip_force_x", "tip_force_y", "deflection_x", "deflection_y"}:
        np.testing.assert_array_equal(rubbed.columns[name], slid.columns[name])
    assert np.all(slid.columns["tip_force_x"] == 0.0)


def test_a_hand_of_three_axes_is_judged_and_feels_what_the_lever_shows() -> None:
    scene = nt.Scene(friction={"shear_strength": 50e6, "coefficient": 0.1})
    rig = nt.Rig(master={"axes": 3}, probe={"noise": 1e-3})  # so quiet that noise does not decide
    bare = nt.Session(scene=scene, rig=rig, seed=1)
    rig.probe.lateral_stiffness = 50.0
    felt = nt.Session(scene=scene, rig=rig, seed=1)
    assert bare.sideways().least == np.inf
    found, along_z = felt.sideways(), bare.margins()
    assert found.coupled_margin <= min(found.margin, along_z.margin)
    assert felt.margins().least == min(found.least, along_z.least)
    settings = felt.settings.copy()
    settings.gains.alpha_f *= found.least  # that of all axes is then 1, below the 1.5 that is asked for
    with pytest.raises(nt.errors.InvalidValue, match=r"all axes"):
        nt.Session(scene=scene, rig=felt.rig, settings=settings, seed=1)
    assert 0.0 < felt.guarantee().lateral_force < np.inf
    assert "sideways at most" in str(felt.guarantee())


def test_a_projection_stiffens_the_loop_of_one_axis() -> None:
    scene, rig = (
        nt.Scene(friction={"shear_strength": 50e6, "coefficient": 0.3}),
        nt.Rig(probe={"lateral_stiffness": 50}),
    )
    plain = nt.Session(scene=scene, rig=rig, seed=1)
    settings = plain.settings.copy()
    settings.gains.projection_x = -1.0
    along = nt.Session(scene=scene, rig=rig, settings=settings, seed=1)
    assert along.margins().margin < 0.99 * plain.margins().margin
    assert along.margins().margin == pytest.approx(along.core.margin, rel=1e-12)
    with pytest.raises(nt.errors.InvalidValue, match=r"lateral_stiffness"):
        nt.Session(scene=scene, settings=settings, seed=1)
