# SPDX-License-Identifier: BSD-3-Clause
"""One contact: energy of closed paths, force as a gradient, the bound over topography, many contacts, slow changes."""

from __future__ import annotations

import copy
import math
import pickle
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import cycles
import draws
import numpy as np
import pytest
import random_scenes
from hypothesis import given, settings
from hypothesis import strategies as st
from nanotouch import Interaction, Plan, Scene, Surface, presets, surface
from nanotouch.errors import Error, InvalidValue
from nanotouch.scene.interaction import STATE_SIZE, State, step

PRESETS = random_scenes.PRESETS
# Of quadrature: 8 Gauss points on pieces that end wherever the force has a kink; what is left are the joins of the
# tables' cells and panels inside pieces, where a higher derivative of the energy jumps: up to some 1e-9 of force x way.
QUADRATURE = 1e-8


@pytest.mark.parametrize(
    "duplicate", [Interaction.copy, copy.copy, copy.deepcopy, lambda c: pickle.loads(pickle.dumps(c))]
)
def test_copies_are_independent(duplicate: Any) -> None:
    contact = Interaction(Scene().plan())
    contact.advance([0.0, 0.0, -1e-9])
    twin, before = duplicate(contact), contact.state
    assert twin.state == before
    assert before.attached
    twin.advance([0.0, 0.0, 1e-6])
    assert contact.state == before
    assert not twin.state.attached


def test_a_place_that_is_not_a_number_has_no_force() -> None:
    """On a flat, too, where the place does not matter; and no history."""
    contact = Interaction(Scene().plan())
    for pose in ([math.nan, 0.0, 0.0], [0.0, math.nan, 0.0], [0.0, 0.0, math.nan]):
        assert all(math.isnan(value) for value in contact.advance(pose))
    assert contact.state == State()


def scene_of(name: str) -> Scene:
    return getattr(presets, name)()[0]  # type: ignore[no-any-return]


@pytest.mark.parametrize("name", PRESETS)
def test_walks_of_the_gap(name: str) -> None:
    """No energy comes out, and the hysteresis area is what has been booked. 100 000 each: tests/heavy/energy.py"""
    scene = scene_of(name)
    balance = cycles.random_walks(scene.plan(), scene, np.random.default_rng(1), 1000)
    assert balance.net_out < QUADRATURE
    assert balance.imbalance < QUADRATURE
    if name not in ("silicon_on_gold", "mica_in_air", "cell_in_liquid"):  # which have no hysteresis that would show
        assert balance.dissipated.max() > 1e-6 * balance.scale


@pytest.mark.parametrize("curved", [True, False])
@pytest.mark.parametrize("name", PRESETS)
def test_laps_over_bumpy_surfaces(name: str, curved: bool) -> None:
    """The same for laps in x, y, z that jump in at one place and let go at another."""
    scene = scene_of(name)
    body = cycles.bumpy(scene, 1)
    body = body if curved else cycles.without_radii(body)
    # where the sample deforms, quadrature feels that k steps a little between the cubics of its table
    plan = scene.plan(1e-4 if name == "cell_in_liquid" else 0.01, surface=body)
    if curved and name != "cell_in_liquid":  # without adhesion a sphere has no law with a radius for each place
        assert plan.terms[0].form == "local"
    balance = cycles.random_laps(plan, scene, body, np.random.default_rng(2), 150)
    assert balance.net_out < QUADRATURE
    assert balance.imbalance < QUADRATURE


@pytest.mark.parametrize("name", PRESETS)
def test_no_step_away_from_folds(name: str) -> None:
    """A move of 1 pm changes the force by at most the stiffness times 1 pm."""
    _, ratio = cycles.largest_step(scene_of(name).plan(), np.random.default_rng(3), 20000)
    assert ratio <= 1.0 + 1e-6  # a stiffness that has its maximum inside the move


@pytest.mark.parametrize("history", ["approach", "retract"])
@pytest.mark.parametrize("name", ["silicon_in_air", "polyester", "mica_in_air"])
def test_force_is_minus_the_gradient(name: str, history: Any) -> None:
    """Central differences over h = 1e-6 of the tip's radius: truncation (h/length)^2, rounding 1e-16 U/h."""
    scene, rng = scene_of(name), np.random.default_rng(4)
    body = cycles.bumpy(scene, 2)
    plan = scene.plan(surface=body)
    facts, contact = plan.explain(), Interaction(plan, history)
    width, depth, h = body.size[0], facts["largest_indentation"], 1e-5 * facts["largest_indentation"]
    x, y = rng.uniform(0.1 * width, 0.8 * width, (2, 400))
    gap = rng.uniform(-depth, -0.1 * depth, 400)
    poses = np.column_stack([x, y, body.height(x, y) + gap])
    value = contact.eval(poses)
    for axis, force in enumerate((value.Fx, value.Fy, value.Fz)):
        move = np.eye(3)[axis] * h
        slope = (contact.eval(poses + move).U - contact.eval(poses - move).U) / (2.0 * h)
        np.testing.assert_allclose(-slope, force, atol=1e-6 * (np.abs(value.Fz).max() + plan.pull_off_force))


@pytest.mark.parametrize("seed", range(3))
def test_plans_keep_the_bound_over_topography(seed: int) -> None:
    """Random scenes near the presets over random bumps, against the exact law with the radius of each place."""
    rng = np.random.default_rng(seed)
    forms = []
    for index in range(draws.count(4, 8)):
        scene = random_scenes.near_preset(rng)
        scene.tip.shape = "paraboloid"
        scene.range.minimum_gap = min(scene.range.minimum_gap, 0.0)
        accuracy = 10.0 ** rng.uniform(-6.0, math.log10(0.3))
        quantity = random_scenes.QUANTITIES[index % 4]
        outcome = random_scenes.compare_over(scene, cycles.bumpy(scene, seed * 100 + index), accuracy, rng, quantity)
        if isinstance(outcome, Error):
            continue
        if outcome.plan.explain()[
            "deforms"
        ]:  # which the rigid oracle does not know: tests/python/test_deformation_relief.py
            continue
        forms.append(outcome.plan.terms[0].form)
        assert outcome.error <= outcome.plan.bound, (index, repr(outcome.plan))
        assert random_scenes.keeps(outcome.plan, accuracy), (index, repr(outcome.plan))
    assert "local" in forms


@pytest.mark.parametrize("name", ["silicon_in_air", "polyester"])  # lambda 0.04 and 0.4
def test_any_accuracy_over_topography(name: str) -> None:
    """The bank, a finer bank, the exact law: each within its bound, that says what it is worth to a factor of 100."""
    scene = scene_of(name)
    body = cycles.bumpy(scene, 7)
    costs = []
    for accuracy, form in ((1e-3, "local"), (1e-5, "local"), (1e-9, "local exact")):
        outcome = random_scenes.compare_over(scene, body, accuracy, np.random.default_rng(5))
        assert isinstance(outcome, random_scenes.Outcome)
        plan = outcome.plan
        assert plan.terms[0].form == form
        facts = plan.explain()
        # the reference is rigid: where a sample deforms it errs by what the rigid sum does (test_deformation_relief)
        assert outcome.error <= plan.bound + facts["deforms"] * facts["rigid_error"]
        assert random_scenes.keeps(plan, accuracy)
        # what the rigid sum errs by is no error against it
        rest = plan.bound - max(facts["rigid_error"], facts["around_error"])
        assert form == "local exact" or outcome.error > 0.01 * rest
        costs.append(plan.cost)
    assert costs == sorted(costs)
    assert costs[1] < 0.2 * costs[2]


@pytest.mark.parametrize("name", ["silicon_in_air", "polyester"])
def test_stiffness_and_radius_over_topography(name: str) -> None:
    """Against the exact law of each place, away from the fold, where stiffness is infinite."""
    scene, rng = scene_of(name), np.random.default_rng(6)
    body = cycles.bumpy(scene, 3)
    width = body.size[0]
    x, y = rng.uniform(0.1 * width, 0.8 * width, (2, 500))
    exact = Interaction(scene.plan(bound="exact", surface=body), "retract")
    for quantity in ("stiffness", "radius"):
        plan = scene.plan(1e-3, quantity=quantity, surface=body)
        assert plan.terms[0].form == "local"
        gap = rng.uniform(-plan.explain()["largest_indentation"], 0.5 * plan.explain()["release_gap"], 500)
        poses = np.column_stack([x, y, body.height(x, y) + gap])
        planned, truth = Interaction(plan, "retract").eval(poses), exact.eval(poses)
        value, true = (planned.k, truth.k) if quantity == "stiffness" else (planned.a, truth.a)
        assert np.max(np.abs(value - true) / np.maximum(np.abs(true), plan.scale)) <= plan.bound


def test_what_leaving_the_curvature_out_costs_is_said() -> None:
    """A gentle surface is taken as flat, within the bound; a rough one is not."""
    scene = Scene()
    y, x = np.mgrid[0:40, 0:40] * 5e-9
    bodies = []
    for height in (1e-13, 1e-10):
        topography = surface.Topography(height * np.sin(x / 20e-9) * np.cos(y / 17e-9), (5e-9, 5e-9))
        bodies.append(Surface(topography, scene.tip.radius))
    gentle, rough = (scene.plan(surface=body) for body in bodies)
    assert gentle.terms[0].form == "table"
    assert "surface: curvature left out" in str(gentle)
    assert 0.0 < gentle.explain()["curvature_error"] < gentle.bound
    assert rough.terms[0].form == "local"
    assert "surface: curved, effective radius" in str(rough)
    assert rough.explain()["curvature_error"] > 0.01
    outcome = random_scenes.compare_over(scene, bodies[0], 0.01, np.random.default_rng(5))
    assert not isinstance(outcome, Error)
    assert gentle.explain()["curvature_error"] * 0.01 < outcome.error <= outcome.plan.bound


def test_surface_of_another_tip_is_refused() -> None:
    with pytest.raises(InvalidValue, match=r"tip\.radius = 3e-08 m: valid is 2e-08 \.\. 2e-08 m"):
        Scene(tip={"radius": 30e-9}).plan(surface=Surface(surface.dots(pixels=32), 20e-9))


def many(count: int) -> tuple[Plan, np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """A plan over bumps, states of contacts that have lived, and poses for them."""
    scene, rng = Scene(), np.random.default_rng(6)
    body = cycles.bumpy(scene, 3)
    plan = scene.plan(surface=body)
    states = np.column_stack([rng.random(count) < 0.5, rng.uniform(0, 1e-18, count), np.zeros(count)])
    x, y = rng.uniform(0.0, body.size[0], (2, count))
    return plan, states, np.column_stack([x, y, body.height(x, y) + rng.uniform(-0.5e-9, 4e-9, count)])


def test_many_contacts_in_parts_and_threads() -> None:
    """However the arrays are cut, and in whatever thread, every contact comes out the same to the last bit."""
    plan, states, poses = many(4000)
    after, value = step(plan, states, poses)
    cuts = [slice(i, i + 613) for i in range(0, 4000, 613)]
    with ThreadPoolExecutor(4) as pool:
        parts = list(pool.map(lambda cut: step(plan, states[cut], poses[cut]), cuts))
    np.testing.assert_array_equal(np.concatenate([part[0] for part in parts]), after)
    for name in value._fields:
        np.testing.assert_array_equal(np.concatenate([getattr(part[1], name) for part in parts]), getattr(value, name))
    for index in range(0, 4000, 397):  # and one by one
        one = Interaction(plan)
        one.state = State(bool(states[index, 0]), *states[index, 1:])
        alone = one.advance(poses[index])
        assert alone == tuple(np.asarray(value)[:, index])
        assert one.state == (bool(after[index, 0]), *after[index, 1:])
    assert set(after[:, 0]) == {0.0, 1.0}


def test_a_copied_state_replays_to_the_last_bit() -> None:
    plan, _, poses = many(300)
    first = Interaction(plan)
    first.advance(poses[:100])
    copy = first.copy()
    went = first.advance(poses[100:])
    again = copy.advance(poses[100:])
    np.testing.assert_array_equal(np.asarray(went), np.asarray(again))
    assert first.state == copy.state
    assert STATE_SIZE == 24


@given(st.lists(st.floats(-1e-9, 6e-9), min_size=1, max_size=30))
@settings(max_examples=50, deadline=None)
def test_dissipation_only_grows(gaps: list[float]) -> None:
    contact = Interaction(Scene().plan())
    before = 0.0
    for gap in gaps:
        energy = contact.eval([0.0, 0.0, gap])
        value = contact.advance([0.0, 0.0, gap])
        assert contact.state.dissipated >= before
        assert pytest.approx(value.U, abs=1e-30) == energy.U or contact.state.dissipated >= before
        before = contact.state.dissipated


CHANGES: dict[str, dict[str, Any]] = {
    "wear": {"tip": {"radius": 26e-9}},
    "ageing": {"adhesion": {"work_of_adhesion": 0.09}},
    "charging": {"adhesion": {"contact_potential": 0.5}},
}


@pytest.mark.parametrize("change", CHANGES)
def test_slow_changes_are_booked_at_the_port(change: str) -> None:
    """A cycle with a change on the way and back: work out of the tip's driver + port = dissipated, to quadrature."""
    start: dict[str, Any] = {"medium": {"relative_humidity": 0.0}, "adhesion": {"work_of_adhesion": 0.06}}
    plans = [Scene(**start).plan(1e-6)]
    scene = Scene(**start)
    for section, fields in CHANGES[change].items():
        for name, value in fields.items():
            scene[f"{section}.{name}"] = value
    plans.append(scene.plan(1e-6))
    far, deep = 5e-9, -0.4e-9

    def walk(contact: Interaction, first: float, last: float) -> float:
        """Work of the force on the tip; the jumps lie between two steps of 0.1 pm, where it is not counted."""
        gaps = np.linspace(first, last, 54001)
        law = contact.run_law(gaps)
        force, energy = np.asarray(law.F), np.asarray(law.U)
        smooth = np.abs(np.diff(force)) < 0.2 * np.abs(force).max()
        work = np.where(smooth, 0.5 * (force[1:] + force[:-1]) * np.diff(gaps), force[:-1] * np.diff(gaps))
        assert np.isfinite(energy).all()
        return float(work.sum())

    contact = Interaction(plans[0])
    work = walk(contact, far, deep)
    changed = contact.change(plans[1], (0.0, 0.0, deep))
    energies = [Interaction(plan, "retract").eval((0.0, 0.0, deep)).U for plan in plans]
    assert changed.state.port == pytest.approx(energies[1] - energies[0], rel=1e-12)
    work += walk(changed, deep, far)
    back = changed.change(plans[0], (0.0, 0.0, far))
    assert not back.state.attached
    scale = plans[1].pull_off_force * (far - deep)
    assert back.state.port - work == pytest.approx(back.state.dissipated, abs=1e-4 * scale)
    assert abs(changed.state.port) > 1e-3 * scale
