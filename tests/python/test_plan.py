# SPDX-License-Identifier: BSD-3-Clause
"""Plans: what is computed, its bound against the reference, its cost; refusals; the plan in words and as data."""

from __future__ import annotations

import copy
import json
import math
import pickle

import draws
import numpy as np
import pytest
import random_scenes
from hypothesis import given
from hypothesis import strategies as st
from nanotouch import Demand, Plan, Rig, Scene, Session, Surface, presets, reference, surface
from nanotouch.errors import Error, InvalidValue

PRESETS = random_scenes.PRESETS


def test_plan_of_the_default_scene() -> None:
    plan = Scene().plan()
    assert isinstance(plan, Plan)
    facts = plan.explain()
    assert facts["adhesion_source"] == "meniscus"
    # w = 2 gamma_L less what the tail pulls where the films touch (E5b), 0.3936 nN over 2 pi R
    assert facts["work_of_adhesion"] == pytest.approx(2 * 0.072 - 0.3936e-9 / (2 * math.pi * 20e-9), rel=1e-5)
    assert plan.pull_off_force == pytest.approx(2 * math.pi * 0.144 * 20e-9, rel=0.01)  # lambda = 0.04: nearly DMT
    assert [(term.name, term.form) for term in plan.terms] == [("contact", "table"), ("vdw", "derjaguin")]
    assert plan.omitted == []  # there is nothing else in this scene
    assert 0.0 < plan.bound < 0.01
    assert plan.cost <= 4.0
    assert "Maugis-Dugdale table, lambda 0.0401" in str(plan)
    assert "JKR would err by 26 %" in str(plan)
    assert repr(plan).startswith("Plan(contact: table, vdw: derjaguin; bound 0.001")
    json.dumps(facts)


def test_validity_is_of_the_largest_load() -> None:
    """Hertz: a = (3 F R/(4 E*))^(1/3); a paraboloid's slope at the edge is a/R, Tabor's strain a fifth of it."""
    dry = Scene(medium={"relative_humidity": 0.0}, adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0})
    dry.sample.thickness = 100e-9
    R, F, E = 20e-9, dry.range.maximum_load, 135e9 / (2.0 * (1.0 - 0.35**2))
    a = (0.75 * F * R / E) ** (1 / 3)
    expected = {"radius_ratio": a / R, "slope": a / R, "strain": 0.2 * a / R, "thickness_ratio": a / 100e-9}
    assert dry.plan().explain()["validity"] == pytest.approx(expected, rel=1e-9)


def test_plans_are_copied_and_pickled() -> None:
    scene, rig = presets.paper_polyester()
    plan = scene.plan(relative_accuracy=1e-4, rig=rig)
    assert copy.copy(plan) is plan
    assert copy.deepcopy([plan])[0] is plan  # immutable
    again = pickle.loads(pickle.dumps(plan))
    scene.tip.radius = 40e-9  # a plan is of the scene as it was
    later = pickle.loads(pickle.dumps(plan))
    for made in (again, later):
        assert made.explain() == plan.explain()
        np.testing.assert_array_equal(made.force([1e-9, -1e-9]), plan.force([1e-9, -1e-9]))


def test_plan_over_a_surface_is_pickled() -> None:
    body = Surface(surface.dots(pixels=32), tip_radius=20e-9)
    plan = Scene().plan(surface=body)
    assert str(pickle.loads(pickle.dumps(plan))) == str(plan)


def test_rig_is_a_rig() -> None:
    with pytest.raises(TypeError, match="rig must be a Rig, not float"):
        Scene().plan(rig=8.0)  # type: ignore[arg-type]


LIQUID = {"kind": "liquid", "ionic_strength": 33.0, "hydration_energy": 0.01}
BARRIERS = {
    "second minimum": Scene(
        tip={"shape": "sphere", "radius": 5.6e-6, "surface_potential": 0.036},
        sample={"youngs_modulus": 6e3, "surface_potential": -0.007},
        medium=LIQUID,
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        range={"maximum_load": 3e-9},
    ),
    "second minimum of van der Waals": Scene(
        tip={"radius": 100e-9, "surface_potential": 0.02},
        sample={"surface_potential": 0.02},
        medium=LIQUID,
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 5e-20},
    ),
    "short range under a wide contact": Scene(
        tip={"shape": "sphere", "radius": 0.85e-3, "surface_potential": -0.001},
        sample={"youngs_modulus": 42.5e3, "surface_potential": 0.03},
        medium=LIQUID | {"ionic_strength": 0.39, "brush_thickness": 2.8e-9},
        adhesion={"work_of_adhesion": 0.75e-3, "hamaker_constant": 0.0},
        range={"maximum_load": 4.4e-6},
    ),
    "potential of 7 V": Scene(adhesion={"contact_potential": 7.0}),
    "dry": Scene(medium={"relative_humidity": 0.0}),
}


@pytest.mark.parametrize("name", BARRIERS)
def test_pull_off_is_the_strongest_pull_wherever_it_is(name: str) -> None:
    """In contact or, behind a barrier, out of it: 60 000 gaps on the way out, an own search without refinement."""
    plan = BARRIERS[name].plan(bound="exact")
    facts = plan.explain()
    outermost = max(facts["release_gap"], 1e-13)
    gaps = np.concatenate(
        [
            np.linspace(-facts["largest_indentation"], facts["release_gap"], 20000)[:-1],
            -np.geomspace(1e-13, facts["largest_indentation"], 20000),
            np.geomspace(1e-13, 1e-6, 20000),
            outermost * (1.0 + np.geomspace(1e-11, 1.0, 1000)),
        ]
    )
    strongest = -plan.force(np.sort(gaps), "retract").min()
    assert strongest > 1e-13
    assert plan.pull_off_force >= strongest * (1.0 - 1e-12)
    assert plan.pull_off_force <= strongest * (1.0 + 1e-3)  # between the gaps of this search


@pytest.mark.parametrize(
    "name", [*sorted(BARRIERS.keys() - {"short range under a wide contact"}), "charge under a film"]
)
def test_no_attraction_is_steeper_than_the_minimum_spring(name: str) -> None:
    """On the way in, 60 000 gaps: also where a term is held inside the range of adhesion."""
    charged = Scene(tip={"radius": 100e-9}, sample={"charge": 1e-17})
    scene = BARRIERS.get(name, charged)
    exact = scene.plan(bound="exact")
    spring = (exact if name == "second minimum" else scene.plan(0.1)).minimum_spring  # it jumps there: refused
    capture = max(exact.explain()["capture_gap"], 1e-13)
    gaps = np.concatenate(
        [
            np.linspace(-capture, capture, 20000),
            np.geomspace(1e-13, 1e-6, 20000),
            *(edge * (1.0 + np.geomspace(1e-11, 1.0, 10000)) for edge in (capture, 2e-10)),
        ]
    )
    steepest = -exact.run(np.sort(gaps)[::-1]).k.min()
    assert steepest > 0.0
    assert math.isinf(spring) or steepest * (1.0 - 1e-9) <= spring <= steepest * (1.0 + 1e-3)
    assert math.isfinite(spring)


def test_plan_without_adhesion_is_hertz() -> None:
    scene = Scene(medium={"relative_humidity": 0.0}, adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0})
    plan = scene.plan()
    assert plan.pull_off_force == 0.0
    delta, modulus = np.array([0.5e-9, 1e-9]), 135e9 / (2 * (1 - 0.35**2))
    np.testing.assert_allclose(plan.force(-delta), 4 / 3 * modulus * math.sqrt(20e-9) * delta**1.5, rtol=1e-13)
    np.testing.assert_array_equal(plan.force([0.0, 1e-9]), 0.0)
    assert str(plan).splitlines()[0] == "contact: Hertz, no adhesion"


def test_what_is_left_out_is_named_with_its_bound() -> None:
    """Gold, as in the issue: 0.26 nN of electrostatic force beside a pull-off of 27 nN is below 1 %."""
    scene, _ = presets.silicon_on_gold()
    scene.tip.radius, scene.range.maximum_load = 30e-9, 0.11e-6
    omitted = next(term for term in scene.plan(relative_accuracy=0.02).omitted if term.name == "electrostatic")
    pull = math.pi * 8.8541878128e-12 * 0.25**2 * (30e-9) ** 2 / (1.98e-10 * (1.98e-10 + 30e-9))  # Hudlet at a0
    assert omitted.force == pytest.approx(pull, rel=1e-9)
    assert omitted.bound == pytest.approx(pull / scene.plan().pull_off_force, rel=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_plans_keep_the_bound(seed: int) -> None:
    """Scenes near presets and at the extremes, any quantity; ``make heavy`` does 20 000 (tests/heavy/plans.py)."""
    rng = np.random.default_rng(seed)
    for index in range(draws.count(8, 20)):
        scene = (random_scenes.near_preset if index % 2 else random_scenes.extreme)(rng)
        accuracy = 10.0 ** rng.uniform(-6, math.log10(0.3))
        outcome = random_scenes.compare(scene, accuracy, str(rng.choice(random_scenes.QUANTITIES)))
        if isinstance(outcome, Error):
            assert any(name in str(outcome) for name in (*scene.fields, "demand.", "on this soft sample")), outcome
            continue
        kept = outcome.error <= outcome.plan.bound and random_scenes.keeps(outcome.plan, accuracy)
        assert kept, (index, repr(outcome.plan))
        assert outcome.folds_hold, (index, repr(outcome.plan))


@pytest.mark.parametrize("quantity", ["force", "stiffness", "radius"])
@pytest.mark.parametrize("name", ["mica_in_air", "polyester", "silicone_rubber", "lambda 0.7", "lambda 0.93"])
def test_bounds_hold_beside_the_folds(name: str, quantity: str) -> None:
    """3000 gaps crowding at capture, release and first touch, where k goes to infinity or has a kink."""
    if name in PRESETS:
        scene = getattr(presets, name)()[0]
    else:
        modulus = {"lambda 0.7": 4.54e9, "lambda 0.93": 2.964e9}[name]
        hamaker = 0.0 if modulus < 4e9 else 1e-20  # a tail would be felt by the softer one
        scene = Scene(medium={"relative_humidity": 0.0}, sample={"youngs_modulus": modulus},
                      adhesion={"work_of_adhesion": 0.05, "hamaker_constant": hamaker})  # fmt: skip
    for accuracy in (1e-6, 1e-4, 1e-2):
        outcome = random_scenes.compare(scene, accuracy, quantity, count=1000)
        assert not isinstance(outcome, Error)
        plan = outcome.plan
        farthest = 0.03 if plan.explain()["deforms"] else 2e-4  # what a table errs by of w is felt farther
        assert plan.fold_distance_m - 3.0 * plan.fold_shift_m < farthest * plan.explain()["release_gap"]
        assert outcome.error <= outcome.plan.bound
        assert random_scenes.keeps(outcome.plan, accuracy)


def test_large_terms_that_cancel_lose_bits() -> None:
    """A cell without adhesion: 77, 113 and 174 nN come to 1 pN, which rounding moves by 9e-12 of the scale of 2 pN."""
    scene = random_scenes.near_preset(np.random.default_rng(5033))
    scene.tip.youngs_modulus = scene.sample.youngs_modulus = 1e13  # nothing deforms, and there is more to lose
    outcome = random_scenes.compare(scene, 1e-6)
    assert not isinstance(outcome, Error)
    assert 1e-12 < outcome.error <= outcome.plan.bound - outcome.plan.explain()["rigid_error"] < 1e-8


@pytest.mark.parametrize("name", [name for name in PRESETS if name != "cell_in_liquid"])  # which deforms
@pytest.mark.parametrize("force_floor", [1e-12, 1e-10, 1e-8, 1e-6])
def test_what_cannot_be_felt_is_left_out(name: str, force_floor: float) -> None:
    """With a floor the error is at most the larger of it and the relative share."""
    scene, _ = getattr(presets, name)()
    plan = scene.plan(relative_accuracy=0.01, force_floor=force_floor)
    gaps = random_scenes.gaps_of(plan, scene, 50)
    for history in ("approach", "retract"):
        truth = np.asarray(reference.force(scene, gaps, history=history))
        planned = np.array([plan.force(gap, history) for gap in gaps])
        # where the plan has no fold that the reference has, its two sides differ by no more than cannot be felt
        allowed = np.maximum(force_floor, 0.01 * np.maximum(np.abs(truth), plan.pull_off_force))
        assert (np.abs(planned - truth) <= allowed).all()


@pytest.mark.parametrize("accuracy", [0.3, 1e-3, 1e-7])
@pytest.mark.parametrize("name", ["silicon_in_air", "mica_in_air", "silicone_rubber"])
def test_a_probe_adds_its_noise_and_changes_nothing(name: str, accuracy: float) -> None:
    """8 N/m, 33 nm/V and 50 mV peak to peak leave 2.2 nN of noise."""
    scene, rig = getattr(presets, name)()
    plan, felt = scene.plan(relative_accuracy=accuracy), scene.plan(relative_accuracy=accuracy, rig=rig)
    facts, without = felt.explain(), plan.explain()
    assert facts.pop("probe_noise") == pytest.approx(rig.probe.spring_constant * 33e-9 * 0.05 / 6.0, rel=1e-12)
    assert without.pop("probe_noise") == 0.0
    assert json.dumps(facts) == json.dumps(without)  # NaN is one, too
    gaps = np.linspace(3e-9, -1e-9, 101)
    np.testing.assert_array_equal(felt.force(gaps), plan.force(gaps))
    assert "the probe cannot tell forces below" in str(felt)
    assert str(plan).splitlines() == [line for line in str(felt).splitlines() if "the probe" not in line]


@pytest.mark.parametrize("accuracy", [0.3, 1e-3, 1e-7])
def test_a_session_makes_the_plan_of_its_demand(accuracy: float) -> None:
    """Of the same scene up to the same load; the truth that the sample is has all its adhesion."""
    scene, rig = presets.mica_in_air()
    session = Session(scene, rig, relative_accuracy=accuracy, minimum_margin=0.0, preflight=False)
    scene.range.maximum_load = session.settings.limits.force
    assert str(session.plan) == str(scene.plan(relative_accuracy=accuracy, rig=rig))
    assert session.plan.pull_off_force > 1e-9
    assert random_scenes.keeps(session.plan, accuracy)


@pytest.mark.parametrize("quantity", ["stiffness", "radius", "folds"])
@pytest.mark.parametrize("name", ["silicon_in_air", "polyester", "silicone_rubber", "silicon_on_gold"])
def test_other_quantities(quantity: str, name: str) -> None:
    """Against everything on and exact, the bound of stiffness and radius holds; folds are where they are exactly."""
    scene, _ = getattr(presets, name)()
    plan, exact = scene.plan(relative_accuracy=0.01, quantity=quantity), scene.plan(bound="exact")  # type: ignore[arg-type]
    assert plan.quantity == quantity
    facts = plan.explain()
    gaps = np.linspace(0.99 * facts["release_gap"], -facts["largest_indentation"], 1000)
    if quantity == "folds":
        for fold in ("capture_gap", "release_gap"):
            assert facts[fold] == pytest.approx(exact.explain()[fold], rel=1e-12)
        return
    column = {"stiffness": "k", "radius": "a"}[quantity]
    planned, truth = (np.asarray(getattr(p.run(gaps, "retract"), column)) for p in (plan, exact))
    # a term that is left out of the stiffness has its largest slope just outside the gap where it is held
    error = np.abs(planned - truth) / np.maximum(np.abs(truth), plan.scale)
    assert error.max() <= plan.bound


def test_never_dearer_than_everything() -> None:
    for name in PRESETS:
        scene, _ = getattr(presets, name)()
        exact = scene.plan(bound="exact")
        for accuracy in (0.3, 0.01, 1e-4, 1e-4 if name == "cell_in_liquid" else 1e-6):
            plan = scene.plan(relative_accuracy=accuracy)
            assert plan.cost <= exact.cost
        if name != "cell_in_liquid":  # the paper's, without topography; the cell needs a full sphere and a brush
            assert scene.plan(relative_accuracy=0.01).cost <= 4.0, name


@pytest.mark.parametrize(
    ("demand", "words"),
    [
        ({"relative_accuracy": -1.0}, "demand.relative_accuracy = -1"),
        ({"relative_accuracy": math.nan}, "demand.relative_accuracy = nan"),
        ({"relative_accuracy": 1e-14}, r"demand.relative_accuracy = 1e-14: valid is 1\.\d+e-12 \.\. 0\.5"),
        ({"force_floor": -1.0}, "demand.force_floor = -1 N"),
        ({"quantity": "taste"}, "valid are force, stiffness, radius, folds"),
        ({"relative_accuracy": 1e-9, "budget": 5.0}, "demand.budget = 5: valid is"),
    ],
)
def test_bad_demands(demand: dict[str, float], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        Scene().plan(**demand)  # type: ignore[arg-type]


def test_bad_history() -> None:
    with pytest.raises(InvalidValue, match="valid are approach, retract"):
        Scene().plan().force(0.0, "sideways")  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="valid are approach, retract"):
        reference.force(Scene(), 0.0, history="sideways")  # type: ignore[arg-type]


def test_tail_stronger_than_the_adhesion_is_refused() -> None:
    scene = Scene(medium={"relative_humidity": 0.0}, adhesion={"hamaker_constant": 1e-17})
    with pytest.raises(InvalidValue, match=r"whole work of adhesion\) = 1e-17 J: valid is 0 \.\."):
        scene.plan()


def test_measured_pull_off_gives_the_work() -> None:
    """All of it, tail included, pulls what was measured, to what the tail and the contact differ where they let go."""
    for humidity in (0.0, 0.4):
        scene = Scene(
            medium={"relative_humidity": humidity},
            adhesion={"given": "pull_off_force", "pull_off_force": 20e-9, "hamaker_constant": 0.0},
        )
        assert scene.plan().pull_off_force == pytest.approx(20e-9, rel=1e-6)
    scene = Scene(adhesion={"given": "surface_energies", "tip_surface_energy": 0.04, "sample_surface_energy": 0.09})
    scene.medium.kind = "vacuum"
    plan = scene.plan()
    assert plan.explain()["adhesion_source"] == "solid"
    # w = 2 sqrt(0.04 0.09) = 0.12 J/m2, less what the tail pulls
    pulled = plan.terms[1].force / (2 * math.pi * 20e-9)
    assert plan.explain()["work_of_adhesion"] == pytest.approx(0.12 - pulled, rel=1e-12)


def test_conductors_have_a_contact_potential() -> None:
    scene = Scene(tip={"work_function": 4.6}, sample={"work_function": 5.1}, adhesion={"contact_potential": 0.0})
    by_potential = Scene(adhesion={"contact_potential": 4.6 - 5.1})
    gap = np.geomspace(1e-9, 1e-6, 20)
    np.testing.assert_array_equal(scene.plan(1e-9).force(gap), by_potential.plan(1e-9).force(gap))
    scene.sample.grounded = False
    assert "electrostatic" not in [term.name for term in scene.plan(1e-9).terms]


def test_a_material_sets_the_moduli() -> None:
    scene = Scene(tip={"material": "diamond"}, sample={"material": "gold"})
    assert (scene.tip.youngs_modulus, scene.sample.poisson_ratio) == (1143e9, 0.44)
    assert scene.adhesion.sample_surface_energy == 1.5
    assert Scene.from_tables({"sample": {"material": "PDMS"}}).sample.youngs_modulus == 2e6
    with pytest.raises(InvalidValue, match="known are"):
        Scene(tip={"material": "cheese"})


def test_far_away_there_is_no_contact() -> None:
    scene = Scene(range={"minimum_gap": 20e-9}, adhesion={"contact_potential": 1.0})
    plan = scene.plan(1e-4)
    assert "contact" not in [term.name for term in plan.terms]
    assert "contact: none within the range of gaps" in str(plan)
    gap = np.geomspace(20e-9, 1e-6, 30)
    error = np.abs(plan.force(gap) - reference.force(scene, gap))
    assert (error <= plan.bound * np.maximum(np.abs(reference.force(scene, gap)), plan.scale)).all()


def test_numbers_for_control_and_simulators() -> None:
    plan = Scene(medium={"relative_humidity": 0.0}, adhesion={"hamaker_constant": 0.0}).plan()
    assert plan.cutoff_gap() == max(plan.explain()["release_gap"], plan.explain()["capture_gap"])
    np.testing.assert_array_equal(plan.force([1.001 * plan.cutoff_gap()], "retract"), 0.0)
    assert math.isinf(Scene().plan().cutoff_gap())
    assert plan.stable_step(1e-12) == pytest.approx(2.0 * math.sqrt(1e-12 / plan.maximum_stiffness), rel=1e-12)
    assert math.isinf(Scene().plan().minimum_spring)  # the meniscus forms at once
    for value in (-1.0, math.nan):
        with pytest.raises(InvalidValue):
            plan.cutoff_gap(value)
        with pytest.raises(InvalidValue):
            plan.stable_step(value)


def test_below_the_minimum_spring_the_tip_jumps_in() -> None:
    """A spring stiffer than the steepest attraction has one equilibrium at every base height, a softer one several."""
    scene = Scene(medium={"relative_humidity": 0.0}, adhesion={"contact_potential": 3.0, "work_of_adhesion": 0.0})
    plan = scene.plan(bound="exact")
    force = plan.force(gap := np.linspace(5e-9, -0.5e-9, 20001))
    for spring, monotonous in ((1.01 * plan.minimum_spring, True), (0.5 * plan.minimum_spring, False)):
        base = gap - force / spring  # where the base has to be to hold the tip there
        assert (np.diff(base) < 0.0).all() == monotonous


@pytest.mark.parametrize("name", ["silicon_in_air", "silicon_on_gold", "polyester"])
@given(depth=st.floats(0.1e-9, 1.5e-9))
def test_force_is_the_derivative_of_energy(name: str, depth: float) -> None:
    scene, _ = getattr(presets, name)()
    plan = scene.plan()
    step = 1e-4 * depth
    law = plan.run(-(depth + step * np.array([-1.0, 0.0, 1.0])), "retract")
    assert (law.U[2] - law.U[0]) / (2 * step) == pytest.approx(
        law.F[1], abs=1e-6 * (abs(law.F[1]) + plan.pull_off_force)
    )
    assert (law.F[2] - law.F[0]) / (2 * step) == pytest.approx(law.k[1], rel=1e-5)


def test_demand_of_a_file(tmp_path: object) -> None:
    demand = Demand.from_tables({"demand": {"relative_accuracy_percent": 2, "force_floor_pN": 5, "quantity": "radius"}})
    plan = Plan.make(Scene(), demand, Rig())
    assert plan.quantity == "radius"
    with pytest.raises(InvalidValue, match=r"\[demand\] quantity = 'colour'.*valid are force, stiffness, radius"):
        Demand.from_tables({"demand": {"quantity": "colour"}})
