# SPDX-License-Identifier: BSD-3-Clause
"""A surface that is made of something else at each place: bounds against an oracle that puts the contact of each place
together by itself, closed paths that give no energy, sessions that feel it, words of refusals."""

from __future__ import annotations

import pickle
from typing import Any

import cycles
import nanotouch as nt
import numpy as np
import pytest
import random_scenes
from nanotouch import Interaction, Scene, Surface, Topography, presets
from nanotouch.errors import Error, InvalidValue


def stripes(pixels: int = 32, size: float = 320e-9) -> tuple[Topography, np.ndarray, np.ndarray]:
    """Level; on the left soft and sticky, on the right stiff and not: E [Pa], w [J/m2]."""
    x = np.broadcast_to(np.arange(pixels), (pixels, pixels))
    right = x >= pixels // 2
    flat = Topography(np.zeros((pixels, pixels)), (size / pixels, size / pixels))
    return flat, np.where(right, 10e9, 1e9), np.where(right, 0.02, 0.1)


def dry() -> Scene:
    scene = Scene()
    scene.medium.relative_humidity = 0.0
    scene.adhesion.hamaker_constant = 1e-20
    scene.range.maximum_load = 100e-9
    return scene


@pytest.mark.parametrize("seed", range(16))
def test_bounds_hold_at_random_places_of_random_materials(seed: int) -> None:
    """Force, stiffness, radius, folds; the long run is tests/heavy/plans.py."""
    rng = np.random.default_rng(seed)
    scene = random_scenes.near_preset(rng)
    scene.tip.shape = "paraboloid"
    accuracy, quantity = 10.0 ** rng.uniform(-5.0, -0.6), random_scenes.QUANTITIES[seed % 4]
    try:
        body = cycles.made_of(scene, cycles.bumpy(scene, seed), seed)
    except Error:
        return  # no such scene either
    outcome = random_scenes.compare_over(scene, body, accuracy, rng, quantity)
    if not isinstance(outcome, Error):
        assert outcome.error <= outcome.plan.bound
        assert random_scenes.keeps(outcome.plan, accuracy)
        assert outcome.folds_hold


@pytest.mark.parametrize("name", ["silicon_in_air", "silicone_rubber"])
def test_closed_paths_give_no_energy_and_what_they_take_is_booked(name: str) -> None:
    scene, _ = getattr(presets, name)()
    body = cycles.made_of(scene, cycles.bumpy(scene, 1), 1, contrast=(5.0, 5.0))
    plan = scene.plan(surface=body)
    balance = cycles.random_laps(plan, scene, body, np.random.default_rng(2), 100)
    assert balance.net_out <= 1e-8
    assert balance.imbalance <= 1e-8
    assert balance.dissipated.max() > 1e-6 * balance.scale


def test_the_force_along_a_level_edge_is_the_slope_of_the_energy() -> None:
    """On a flat all of it is due to what the sample is made of."""
    scene, (flat, modulus, work) = dry(), stripes()
    body = Surface.touched_by(scene, flat, youngs_modulus=modulus, work_of_adhesion=work)
    contact = Interaction(scene.plan(1e-4, surface=body), "retract")
    x = np.linspace(120e-9, 200e-9, 4001)
    value = contact.eval(np.column_stack([x, np.full_like(x, 150e-9), np.full_like(x, -0.3e-9)]))
    slope = -np.gradient(value.U, x)
    assert np.abs(value.Fx).max() > 0.05 * np.abs(value.Fz).max()
    np.testing.assert_allclose(value.Fx[5:-5], slope[5:-5], atol=2e-5 * np.abs(value.Fx).max())
    np.testing.assert_allclose(value.Fy, 0.0, atol=1e-18)


def test_properties_between_pixels_are_their_mean_by_the_spline() -> None:
    rng = np.random.default_rng(4)
    flat, modulus, work = stripes(12)
    modulus = modulus * rng.uniform(0.1, 1.0, modulus.shape)
    body = Surface(flat, youngs_modulus=modulus, work_of_adhesion=work)
    for x, y in rng.uniform(30e-9, 250e-9, (50, 2)):
        made = body.properties(x, y)
        assert made.youngs_modulus == pytest.approx(random_scenes.mean_at(modulus, body, x, y), rel=1e-12)
        assert made.work_of_adhesion == pytest.approx(random_scenes.mean_at(work, body, x, y), rel=1e-12)
    assert Surface(flat).properties(1e-9, 1e-9) == (None, None)


@pytest.mark.filterwarnings("ignore:the session was stopped")
def test_a_session_feels_what_is_under_the_tip() -> None:
    """The simulated truth at either side is the law of that side; the run repeats itself and replays.

    The plan of the soft side alone deforms under the forces beside contact; that of a surface of several materials adds
    them on the undeformed gap and states what that errs by. There they agree within what both state, elsewhere closer.
    """
    scene, (flat, modulus, work) = dry(), stripes()
    body = Surface.touched_by(scene, flat, youngs_modulus=modulus, work_of_adhesion=work)
    deepest, pulls = [], []
    for x in (60e-9, 260e-9):
        session = nt.Session(scene, surface=body, path=[(x, 150e-9)], relative_accuracy=1e-4)
        record = session.run(2.0)
        again = nt.Session(scene, surface=body, path=[(x, 150e-9)], relative_accuracy=1e-4).run(2.0)
        assert all(np.array_equal(record.columns[name], again.columns[name], equal_nan=True) for name in record.columns)
        assert np.array_equal(record.replay().columns["stage_command"], record.columns["stage_command"])
        touching = record.columns["gap"] < -0.02e-9
        gap, force = record.columns["gap"][touching], record.columns["tip_force"][touching]
        here = scene.copy()
        made = body.properties(x, 150e-9)
        here.sample.youngs_modulus, here.adhesion.work_of_adhesion = made
        law = here.plan(bound="exact")
        expected = law.force(gap, "retract")
        if law.explain()["deforms"]:
            bound = session.plan.bound + law.bound
            assert (np.abs(force - expected) <= bound * np.maximum(np.abs(expected), session.plan.scale)).all()
        np.testing.assert_allclose(force, expected, rtol=2e-3, atol=3e-4 * np.ptp(force))
        deepest.append(-gap.min())
        pulls.append(-record.columns["tip_force"].min())
    assert deepest[0] > 2.0 * deepest[1]
    assert pulls[0] > 2.0 * pulls[1]


def test_a_scan_over_a_level_edge_is_the_law_of_each_place() -> None:
    """Nothing but the material changes along the path."""
    scene, (flat, modulus, work) = dry(), stripes()
    body = Surface.touched_by(scene, flat, youngs_modulus=modulus, work_of_adhesion=work)
    path = [(100e-9, 150e-9), (220e-9, 150e-9)]
    session = nt.Session(
        scene, surface=body, mode="scan", path=path, relative_accuracy=1e-4, probe_model="quasi-static"
    )
    columns = session.run(3.0).columns
    touching = columns["gap"] < -0.05e-9
    x, gap = columns["x"][touching], columns["gap"][touching]
    assert x.min() < 140e-9
    assert x.max() > 200e-9
    contact = Interaction(session.plan, "retract")
    law = contact.eval(np.column_stack([x, np.full_like(x, 150e-9), gap]))
    np.testing.assert_allclose(columns["tip_force"][touching], law.Fz, rtol=0.0, atol=1e-3 * np.abs(law.Fz).max())


def test_a_touch_beside_an_edge_is_pulled_sideways_as_the_law_says() -> None:
    """Of the scene's material, and of a slope."""
    scene, (_, modulus, work) = dry(), stripes()
    rise = np.broadcast_to(np.linspace(0.0, 20e-9, 32), (32, 32))
    slope = Topography(rise, (10e-9, 10e-9))
    body = Surface.touched_by(scene, slope, youngs_modulus=modulus, work_of_adhesion=work)
    rig = nt.Rig(master={"axes": 3})  # its recording has the forces in x and y, too
    session = nt.Session(
        scene, rig, surface=body, path=[(150e-9, 150e-9)], relative_accuracy=1e-4, probe_model="quasi-static"
    )
    columns = session.run(1.0).columns
    touching = columns["gap"] < -0.05e-9
    gap, height = columns["gap"][touching], columns["surface_height"][touching]
    assert len(gap) > 100
    places = np.column_stack([columns[axis][touching] for axis in ("x", "y")] + [gap + height])
    law = Interaction(session.plan, "retract").eval(places)
    least = 0.01 * np.abs(law.Fz).max()
    for name, force in (("tip_force_x", law.Fx), ("tip_force_y", law.Fy)):
        np.testing.assert_allclose(columns[name][touching], force, rtol=0.0, atol=0.1 * least)
    assert np.abs(law.Fx).max() > least


def test_a_hand_that_may_go_anywhere_is_planned_for_the_worst_place() -> None:
    """Stiffest contact and strongest pull are those of the whole surface, wherever the touch begins."""
    scene, (flat, modulus, work) = dry(), stripes()
    body = Surface.touched_by(scene, flat, youngs_modulus=modulus, work_of_adhesion=work)
    left = nt.Session(scene, surface=body, path=[(60e-9, 150e-9)])
    soft, stiff = scene.copy(), scene.copy()
    soft.sample.youngs_modulus, soft.adhesion.work_of_adhesion = 1e9, 0.1
    stiff.sample.youngs_modulus, stiff.adhesion.work_of_adhesion = 10e9, 0.02
    assert left.plan.maximum_stiffness > stiff.plan().maximum_stiffness > 2.0 * soft.plan().maximum_stiffness
    assert left.plan.explain()["largest_pull_off_force"] > soft.plan().pull_off_force
    assert left.guarantee().force >= nt.Session(stiff, surface=Surface.touched_by(stiff, flat)).guarantee().force


def test_what_the_surface_gives_is_not_the_scenes_to_change() -> None:
    scene, (flat, modulus, _) = dry(), stripes()
    body = Surface.touched_by(scene, flat, youngs_modulus=modulus)
    session = nt.Session(scene, surface=body)
    with pytest.raises(InvalidValue, match="it stays while the session is open"):
        session.change("scene", "sample.youngs_modulus", 5e9)
    session.change("scene", "adhesion.work_of_adhesion", 0.05)


def test_words_of_the_plan_and_a_copy() -> None:
    scene, (flat, modulus, work) = dry(), stripes()
    body = Surface.touched_by(scene, flat, youngs_modulus=modulus, work_of_adhesion=work)
    text = str(scene.plan(surface=body))
    assert "Young's modulus 1 GPa to 10 GPa, w 20 mJ/m2 to 100 mJ/m2" in text
    assert "of each place" in text
    assert "softest and least adhesive place" in text
    copy = pickle.loads(pickle.dumps(body))
    assert str(scene.plan(surface=copy)) == text


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"youngs_modulus": np.nan}, r"youngs_modulus\[3, 4\] = nan Pa: it must be above 0 at each place \(1 of 1024"),
        ({"youngs_modulus": -1e9}, r"youngs_modulus\[3, 4\] = -1e\+09 Pa"),
        ({"work_of_adhesion": 0.0}, r"work_of_adhesion\[3, 4\] = 0 J/m\^2"),
        ({"work_of_adhesion": 1e-6}, r"surface.work_of_adhesion = 1e-06 J/m\^2: valid is 0.0001 .. 10"),
        ({"youngs_modulus": 1e20}, r"surface.youngs_modulus = 1e\+20 Pa: valid is 100 .. 1e\+13"),
    ],
)
def test_what_is_no_property_is_refused(given: dict[str, float], words: str) -> None:
    flat, modulus, work = stripes()
    made: dict[str, Any] = {"youngs_modulus": modulus.copy(), "work_of_adhesion": work.copy()}
    for name, value in given.items():
        made[name][3, 4] = value
    with pytest.raises(InvalidValue, match=words):
        Surface(flat, **made)


def test_shapes_that_do_not_agree_and_tips_that_have_no_law_are_refused() -> None:
    scene, (flat, modulus, work) = dry(), stripes()
    with pytest.raises(InvalidValue, match=r"youngs_modulus: shape \(31, 32\), expected that of the heights"):
        Surface(flat, youngs_modulus=modulus[1:])
    scene.tip.shape = "cone"
    body = Surface.touched_by(scene, flat, youngs_modulus=modulus, work_of_adhesion=work)
    with pytest.raises(InvalidValue, match=r"tip.shape \(adhesion on a surface with properties\)"):
        scene.plan(surface=body)
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = 0.0
    bare = Surface.touched_by(scene, flat, youngs_modulus=modulus)
    value = Interaction(scene.plan(surface=bare), "retract").eval(np.array([[60e-9, 150e-9, -2e-9]]))
    effective = 1.0 / ((1 - 0.35**2) / 135e9 + (1 - 0.35**2) / bare.properties(60e-9, 150e-9).youngs_modulus)
    assert value.Fz[0] == pytest.approx(2.0 / np.pi * effective * np.tan(scene.tip.half_angle) * 4e-18, rel=1e-9)
