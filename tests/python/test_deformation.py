# SPDX-License-Identifier: BSD-3-Clause
"""Plans of samples that deform under forces before contact, against the self-consistent half-space and layer."""

from __future__ import annotations

import functools
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from nanotouch import Interaction, Plan, Scene, Surface, Topography, presets, reference
from nanotouch.errors import InvalidValue

sys.path.insert(0, str(Path(__file__).parents[1] / "heavy"))

import deformation


def gap_at(plan: Plan, force: float) -> float:
    low, high = -4e-6, 0.45e-6
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if plan.force(middle) > force else (low, middle)
    return high


def gel() -> Scene:
    """Under a double layer of 1 mM."""
    return Scene(
        tip={"shape": "sphere", "radius": 2.5e-6, "surface_potential": -0.06},
        sample={"youngs_modulus": 500.0, "poisson_ratio": 0.5, "surface_potential": -0.06},
        medium={"kind": "liquid", "ionic_strength": 1.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        range={"maximum_load": 2e-9},
    )


def test_a_softer_cell_gives_more() -> None:
    gaps = []
    for modulus in (100.0, 1e3, 1e5, 1e7):
        scene, _ = presets.cell_in_liquid()
        scene.sample.youngs_modulus = modulus
        gaps.append(gap_at(scene.plan(1e-4), 1e-9))
    np.testing.assert_allclose(gaps, [-1320.7e-9, -261.5e-9, 38.1e-9, 44.1e-9], atol=0.15e-9)


def test_a_gel_gives_under_a_double_layer() -> None:
    soft, plan = gel(), gel().plan(1e-3)
    hard = gel()
    hard.sample.youngs_modulus = 1e12
    assert plan.explain()["deforms"]
    assert gap_at(hard.plan(1e-3), 0.2e-9) - gap_at(plan, 0.2e-9) == pytest.approx(240e-9, abs=2e-9)
    gap = gap_at(plan, 0.2e-9)
    truth = float(reference.deformed_force(soft, [gap])[0])
    assert abs(float(plan.force(gap)) - truth) <= plan.bound * truth


@pytest.mark.parametrize("seed", [12, 33, 48, 2007, 2088, 2091])  # of force, stiffness and radius
def test_random_soft_scenes_keep_the_bound(seed: int) -> None:
    kind, error, bound = deformation.compare(seed, count=3)
    assert kind.split(",")[0] in ("deforms", "rigid")
    assert error <= bound


def test_force_is_the_derivative_of_energy() -> None:
    plan = gel().plan(1e-3)
    for gap in np.linspace(0.4e-6, -0.8e-6, 60):
        step = 1e-12
        law = plan.run(gap + step * np.array([1.0, 0.0, -1.0]))
        assert (law.U[2] - law.U[0]) / (2.0 * step) == pytest.approx(law.F[1], rel=1e-4)
        assert (law.F[2] - law.F[0]) / (2.0 * step) == pytest.approx(law.k[1], rel=1e-3)


def test_a_plan_says_whether_its_sample_deforms() -> None:
    assert "sample: deforms under all forces together, elastic number" in str(gel().plan())
    stiff = gel()
    stiff.sample.youngs_modulus = 1e12
    assert "sample: does not deform before contact" in str(stiff.plan(0.3))


def test_what_neither_form_keeps_is_refused() -> None:
    with pytest.raises(InvalidValue, match="relative_accuracy"):
        gel().plan(1e-7)
    pointed = gel()
    pointed.tip.shape, pointed.tip.half_angle = "cone", 0.3
    with pytest.raises(InvalidValue):
        pointed.plan(1e-3)


def sticky(modulus: float, hamaker: float = 6e-20) -> Scene:
    """A tip of 20 nm over what van der Waals draws up."""
    return Scene(
        sample={"youngs_modulus": modulus, "poisson_ratio": 0.5},
        medium={"relative_humidity": 0.0, "film_thickness": 0.0},
        adhesion={"work_of_adhesion": 0.044, "hamaker_constant": hamaker},
        range={"maximum_load": 5e-9},
    )


@functools.cache
def truth_of(modulus: float, tolerance: float) -> reference.DeformedScene:
    return reference.deformed_scene(sticky(modulus), tolerance=tolerance)


def errors_of(scene: Scene, plan: Plan, truth: reference.DeformedScene, history: str) -> np.ndarray:
    """At gaps beside the folds and far from them, over the larger of force and scale."""
    capture, release = plan.explain()["capture_gap"], plan.explain()["release_gap"]
    gaps = np.array([8.0 * capture, 2.0 * capture, 1.05 * capture, 0.95 * capture, -capture, 0.9 * release])
    gaps = np.sort(gaps)[::-1]
    force = truth.force(gaps, history)  # type: ignore[arg-type]
    planned = Interaction(plan, history).eval(np.column_stack([0.0 * gaps, 0.0 * gaps, gaps])).Fz  # type: ignore[arg-type]
    return np.asarray(np.abs(planned - force) / np.maximum(np.abs(force), plan.scale))


@pytest.mark.parametrize(("modulus", "jumps"), [(1e6, True), (3e8, True), (1.2e10, False)])
def test_a_surface_bulges_and_jumps_towards_the_tip(modulus: float, jumps: bool) -> None:
    """From soft to where the tail goes on into contact: forces within the bound, the jump within its distance."""
    scene = sticky(modulus)
    plan, truth = scene.plan(5e-3), truth_of(modulus, 1e-5)
    facts = plan.explain()
    assert facts["deforms"]
    assert truth.jumps == jumps
    assert facts["capture_gap"] == pytest.approx(truth.capture_gap, abs=max(plan.fold_shift_m, 1e-18))
    for history in ("approach", "retract"):
        assert np.all(errors_of(scene, plan, truth, history) <= plan.bound)


@pytest.mark.parametrize("modulus", [3e10, 1e12])
def test_beyond_what_a_table_keeps_the_finest_one_is_taken(modulus: float) -> None:
    """With its own bound, far below what a rigid sample errs by, and a warning."""
    scene = sticky(modulus)
    plan, truth = scene.plan(1e-7), truth_of(modulus, 1e-8)
    assert plan.explain()["deforms"]
    assert 1e-7 < plan.bound < 0.01 * plan.explain()["rigid_error"]
    assert any("more than demanded" in warning.text for warning in plan.warnings)
    for history in ("approach", "retract"):
        assert np.all(errors_of(scene, plan, truth, history) <= plan.bound)


@pytest.mark.parametrize("name", presets.FELT)
@pytest.mark.parametrize("quantity", ["force", "stiffness", "radius", "folds"])
def test_a_stricter_demand_has_no_looser_bound(name: str, quantity: str) -> None:
    """But by the next coarser table, of twice the tolerance, where a finer one does not come to an end."""
    scene, last = getattr(presets, name)()[0], np.inf
    for demand in (0.3, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8):
        try:
            bound = scene.plan(demand, quantity=quantity).bound  # type: ignore[arg-type]
        except InvalidValue:
            continue
        assert bound <= demand or bound <= 2.0 * last
        last = bound


@pytest.mark.parametrize("modulus", [1e11, 1e12])
def test_with_no_demand_a_stiff_sample_is_rigid(modulus: float) -> None:
    """Beside contact the tail pulls more than that, and less than the bound."""
    scene = sticky(modulus)
    plan, truth = scene.plan(bound="exact"), truth_of(modulus, 1e-8)
    capture = plan.explain()["capture_gap"]
    gaps = capture * np.array([3.0, 1.5, 1.1])
    error = np.abs([plan.force(gap) for gap in gaps] - truth.force(gaps, "approach")) / plan.scale
    assert not plan.explain()["deforms"]
    assert 0.0 < error.max() <= plan.bound


@pytest.mark.parametrize("demand", [1e-6, 0.0])
def test_the_bound_of_a_surface_with_properties_is_that_of_its_softest_place(demand: float) -> None:
    """The tail over the soft half, solved with its deformation."""
    soft, stiff = 2e10, 1e12
    flat = Topography(np.zeros((16, 16)), (10e-9, 10e-9))
    modulus = np.full((16, 16), stiff)
    modulus[:, :8] = soft
    scene = sticky(stiff)
    surface = Surface.touched_by(scene, flat, youngs_modulus=modulus)
    plan = scene.plan(demand, surface=surface) if demand else scene.plan(bound="exact", surface=surface)
    truth = truth_of(soft, 1e-8)
    gaps = plan.explain()["capture_gap"] * np.array([3.0, 1.5, 1.1])
    at = np.column_stack([np.full(3, 40e-9), np.full(3, 80e-9), gaps])
    error = np.abs(Interaction(plan, "approach").eval(at).Fz - truth.force(gaps, "approach")) / plan.scale
    assert demand < error.max() <= plan.bound


def test_a_surface_that_would_jump_is_refused_in_words() -> None:
    flat = Topography(np.zeros((16, 16)), (10e-9, 10e-9))
    scene = sticky(1e12)
    surface = Surface.touched_by(scene, flat, youngs_modulus=np.linspace(1e6, 1e12, 256).reshape(16, 16))
    with pytest.raises(InvalidValue, match=r"deforms under van der Waals before contact\) = 0\.01: none is known"):
        scene.plan(0.01, surface=surface)


def test_in_contact_all_of_w_is_maugis_dugdale() -> None:
    """What van der Waals pulls is part of w: pull-off, release and force in contact do not know of it."""
    plan, bare = sticky(1e6).plan(1e-3), sticky(1e6, 0.0).plan(1e-3)
    assert plan.pull_off_force == pytest.approx(bare.pull_off_force, rel=1e-6)
    assert plan.explain()["release_gap"] == pytest.approx(bare.explain()["release_gap"], rel=1e-9)
    assert plan.force(-5e-9) == pytest.approx(bare.force(-5e-9), rel=1e-3)


@pytest.mark.parametrize("modulus", [1e6, 3e8, 1.2e10])
def test_a_cycle_loses_what_its_jumps_lose(modulus: float) -> None:
    """Work of the tip over a cycle is the energy of both jumps, none of which gives any out."""
    plan = sticky(modulus).plan(5e-3)
    facts = plan.explain()
    capture, release = facts["capture_gap"], facts["release_gap"]
    inwards = np.concatenate([np.geomspace(50.0 * release, capture * (1.0 + 1e-9), 20000)])
    approach = Interaction(plan, "approach").eval(np.column_stack([0.0 * inwards, 0.0 * inwards, inwards]))
    outwards = np.linspace(capture, release * (1.0 - 1e-9), 20000)
    contact = Interaction(plan, "retract").eval(np.column_stack([0.0 * outwards, 0.0 * outwards, outwards]))
    away = inwards[inwards > release][::-1]
    back = Interaction(plan, "approach").eval(np.column_stack([0.0 * away, 0.0 * away, away]))
    lost = -sum(float(np.trapezoid(value.Fz, value.gap)) for value in (approach, contact, back))
    assert facts["capture_energy"] > 0.0 or modulus > 1e10
    assert facts["release_energy"] >= 0.0
    assert lost == pytest.approx(facts["capture_energy"] + facts["release_energy"], rel=2e-3)


def test_contact_under_a_double_layer_is_solved_with_it() -> None:
    """In contact and apart, where it takes hold and lets go; the sum of both is off by far more."""
    scene = Scene(
        tip={"radius": 1e-6, "surface_potential": -0.03},
        sample={"youngs_modulus": 1e6, "poisson_ratio": 0.5, "surface_potential": -0.03},
        medium={"kind": "liquid", "ionic_strength": 1.0},
        adhesion={"work_of_adhesion": 1e-3, "hamaker_constant": 0.0},
        range={"maximum_load": 2e-8},
    )
    plan, truth = scene.plan(1e-3), reference.deformed_scene(scene, 1e-5)
    facts, around = plan.explain(), truth.surrounded
    assert facts["deforms"]
    assert around is not None
    assert around.release is not None
    assert facts["capture_gap"] == pytest.approx(truth.capture_gap, abs=plan.fold_shift_m)
    assert facts["release_gap"] == pytest.approx(around.release.gap, abs=plan.fold_shift_m)
    gaps = np.array([10e-9, -5e-9])
    value = Interaction(plan, "retract").eval(np.column_stack([0.0 * gaps, 0.0 * gaps, gaps]))  # type: ignore[arg-type]
    true = [around.at(gap) for gap in gaps]
    assert np.all(np.abs(value.Fz - [t.force for t in true]) <= plan.bound * plan.scale)
    np.testing.assert_allclose(value.a, [t.contact_radius for t in true], rtol=1e-2)
    assert float(plan.force(10e-9)) == pytest.approx(truth.force([10e-9])[0], abs=plan.bound * plan.scale)


def test_contact_at_a_potential_has_all_of_w() -> None:
    """In vacuum, with van der Waals as a part of w: taken out of w, release would be 0.23 nm nearer."""
    scene = Scene(
        tip={"radius": 150e-9},
        sample={"youngs_modulus": 350e6, "poisson_ratio": 0.3},
        medium={"kind": "vacuum"},
        adhesion={"work_of_adhesion": 38e-3, "hamaker_constant": 4.6e-20, "contact_potential": 0.34},
        range={"maximum_load": 3e-8},
    )
    plan, truth = scene.plan(0.01), reference.deformed_scene(scene, 1e-5)
    facts, around = plan.explain(), truth.surrounded
    assert facts["deforms"]
    assert around is not None
    assert around.release is not None
    assert facts["capture_gap"] == pytest.approx(truth.capture_gap, abs=plan.fold_shift_m)
    assert facts["release_gap"] == pytest.approx(around.release.gap, abs=plan.fold_shift_m)
    held = around.touching(1.6 * around.release.contact_radius)
    value = Interaction(plan, "retract").eval([0.0, 0.0, held.gap])
    assert float(value.Fz) == pytest.approx(held.force, abs=plan.bound * max(plan.scale, abs(held.force)))


def test_folds_in_a_liquid_are_those_of_all_of_w() -> None:
    """With a tail and nothing else around it, contact is Maugis-Dugdale's, whatever is demanded."""
    scene = sticky(300e6)
    scene.medium.kind, scene.medium.ionic_strength = "liquid", 0.0
    whole = scene.copy()
    whole.adhesion.hamaker_constant = 0.0
    release = whole.plan(0.01, quantity="folds").explain()["release_gap"]
    for quantity in ("force", "radius", "folds"):
        facts = scene.plan(0.01, quantity=quantity).explain()  # type: ignore[arg-type]
        assert facts["deforms"]
        assert facts["release_gap"] == pytest.approx(release, rel=1e-9)


def test_beside_a_neck_a_law_acts_in_full() -> None:
    """A contact that is pulled out: there the sum errs by 0.8 % of the pull-off, more than in deep contact. The bound
    also counts what a shift does where the contact pulls."""
    scene = Scene(
        tip={"radius": 623e-9, "surface_potential": -0.0168},
        sample={"youngs_modulus": 2.63e6, "poisson_ratio": 0.3, "surface_potential": -0.0168},
        medium={"kind": "liquid", "ionic_strength": 21.2},
        adhesion={"work_of_adhesion": 17.5e-3, "hamaker_constant": 0.0},
        range={"maximum_load": 5.4e-8},
    )
    plan = scene.plan(0.1)
    assert not plan.explain()["deforms"]
    around = reference.deformed_scene(scene, 1e-4).surrounded
    assert around is not None
    assert around.release is not None
    pulled = around.touching(1.45 * around.release.contact_radius)
    assert pulled.gap < plan.explain()["release_gap"] - plan.fold_distance_m
    value = Interaction(plan, "retract").eval([0.0, 0.0, pulled.gap])
    error = abs(float(value.Fz) - pulled.force) / plan.scale
    assert 0.1 * plan.bound < error <= plan.bound


def watery(modulus: float, radius: float, load: float, work: float = 0.0, **medium: float) -> Scene:
    return Scene(
        tip={"radius": radius},
        sample={"youngs_modulus": modulus, "poisson_ratio": 0.3},
        medium={"kind": "liquid", **medium},
        adhesion={"work_of_adhesion": work, "hamaker_constant": 0.0, "equilibrium_distance": 70e-12},
        range={"maximum_load": load},
    )


def test_what_a_stricter_demand_is_planned_for_a_looser_one_is() -> None:
    """At 1e-2 the coarse tables do not come to an end, and a finer one does."""
    scene = watery(39e6, 60e-9, 1e-9, hydration_energy=2e-6, hydration_length=0.7e-9)
    for demand in (1e-2, 1e-3, 1.1e-4):
        assert scene.plan(demand).bound <= demand


@pytest.mark.parametrize(("modulus", "length"), [(4.2e3, 4e-9), (144e3, 0.23e-9)])
def test_a_refusal_names_the_law_where_no_accuracy_can_be_planned(modulus: float, length: float) -> None:
    """A surface that jumps to a pull has no table at all."""
    scene = watery(modulus, 13e-9, 14e-15, hydration_energy=-0.028, hydration_length=length)
    with pytest.raises(InvalidValue, match="hydration"):
        scene.plan(1e-6)


@pytest.mark.parametrize("modulus", [500.0, 1e5])
@pytest.mark.parametrize("accuracy", [0.3, 0.01, 1e-4])
def test_a_lone_attraction_is_planned_as_its_refusal_says(modulus: float, accuracy: float) -> None:
    """Without adhesion nothing is known beyond the jump: the refusal names a gap before it, and what to give."""
    scene = watery(modulus, 2.5e-6, 1e-9)
    scene.adhesion.hamaker_constant = 1e-21
    with pytest.raises(InvalidValue, match="pulled by van der Waals") as found:
        scene.plan(accuracy)
    (named,) = re.findall(r"range\.minimum_gap .* valid is (\S+) \.\.", str(found.value))
    away = scene.copy()
    away.range.minimum_gap = float(named)
    plan = away.plan(accuracy)
    assert plan.bound <= accuracy or any("no finer table" in warning.text for warning in plan.warnings)
    assert plan.bound < 5e-4 or accuracy > 1e-4  # what a table may cost ends before
    jump = (0.5955 * 1e-21 * 2.5e-6**0.5 * 0.75 / modulus) ** (2 / 7)  # of 1/g^3, by centres z0 apart
    assert 0.5 < (float(named) + scene.adhesion.equilibrium_distance) / jump < 6
    scene.adhesion.work_of_adhesion = 1.1 * 1e-21 / (12 * np.pi * scene.adhesion.equilibrium_distance**2)
    assert scene.plan(max(accuracy, 0.02)).bound <= max(accuracy, 0.05)
