# SPDX-License-Identifier: BSD-3-Clause
"""What the bound of a plan is held to: kept, exact, any; and what a refusal says."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, Literal

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import Demand, Plan, Scene, presets
from nanotouch.errors import InvalidValue
from nanotouch_app.live.reel import demand_of, world_of


def unknown() -> Scene:
    """Van der Waals alone pulls more than the work of adhesion."""
    return Scene(medium={"relative_humidity": 0.0}, adhesion={"hamaker_constant": 1e-17})


def test_a_scene_takes_a_demand_as_plan_make_does() -> None:
    scene = presets.silicon_in_air()[0]
    demand = Demand(demand={"relative_accuracy": 1e-4, "quantity": "stiffness", "force_floor": 1e-12})
    plan, made = scene.plan(demand), Plan.make(scene, demand)
    assert str(plan) == str(made) == str(scene.plan(1e-4, 1e-12, "stiffness"))
    with pytest.raises(TypeError, match="those of the Demand"):
        scene.plan(demand, quantity="radius")


def test_an_error_of_zero_is_refused_with_the_best_that_can_be_kept() -> None:
    for scene in (Scene(), presets.mica_in_air()[0]):
        with pytest.raises(InvalidValue, match=r"demand.relative_accuracy = 0: valid is") as refusal:
            scene.plan(0.0)
        best = float(re.findall(r"valid is (\S+) \.\.", str(refusal.value))[0])
        assert 0.0 < scene.plan(best).bound < math.inf


def test_exact_has_a_bound_or_says_that_there_is_none() -> None:
    """Everything in full errs by no more than a plan that was demanded does, where a table reaches it."""
    scene = Scene(
        tip={"radius": 10e-9},
        sample={"youngs_modulus": 4.5e9, "poisson_ratio": 0.35},
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.05, "hamaker_constant": 1e-19},
    )
    assert scene.plan(bound="exact").bound <= scene.plan(1e-3).bound
    assert "inf %" not in str(scene.plan(bound="exact"))


def test_any_bound_gives_a_force_and_says_what_it_is_worth() -> None:
    scene = unknown()
    with pytest.raises(InvalidValue, match="alone pulls more than the whole work of adhesion") as refusal:
        scene.plan()
    plan = scene.plan(bound="any")
    assert math.isinf(plan.bound)
    assert "force with a bound that is not known" in str(plan)
    assert any("no bound is known" in warning.text for warning in plan.warnings)
    assert np.isfinite(plan.force(np.linspace(5e-9, -1e-9, 50))).all()
    # the change that the refusal names works
    field, value = re.findall(r"; (\S+) = (\S+) \S+ works", str(refusal.value))[0]
    scene[field] = float(value)
    assert scene.plan().bound <= 0.01
    assert scene.plan(bound="any").bound <= 0.01  # what can be kept is


def test_a_session_on_a_simulated_rig_takes_any_bound() -> None:
    session = nt.Session(unknown(), bound="any", minimum_margin=0.0)
    assert session.metadata()["bound"] == "any"
    with pytest.raises(InvalidValue, match="bound 'none'"):
        nt.Session(bound="none")  # type: ignore[arg-type]


@pytest.mark.parametrize(("said", "bound"), [({}, "exact"), ({"bound": "any"}, "any")])
def test_an_older_recording_of_accuracy_zero_is_one_of_everything_exact(
    tmp_path: Path, said: dict[str, str], bound: Literal["exact", "any"]
) -> None:
    session = nt.Session(preflight=False)
    older = session.metadata() | {"relative_accuracy": 0.0}
    del older["bound"]
    with nt.record.Writer(tmp_path / "r.mcap", older | said) as writer:
        writer.append(session.advance(0.01))
    metadata = nt.record.read(tmp_path / "r.mcap").metadata
    assert metadata["bound"] == bound
    assert world_of(metadata, "touch", "recording")["bound"] == Scene().plan(0.0, bound=bound).bound


def test_a_viewer_plans_the_world_that_it_sees() -> None:
    """Within what the host's plan is known within; and where that is not known, too."""
    for scene, known in ((Scene(), True), (unknown(), False)):
        plan = scene.plan(bound="any")
        again = scene.plan(demand_of({"relative_accuracy": 0.01, "bound": plan.bound}))
        assert math.isfinite(again.bound) == known
        np.testing.assert_allclose(again.force([1e-9]), plan.force([1e-9]))


@pytest.mark.parametrize(
    ("radius", "modulus", "work", "energy", "length"),
    [
        (20e-9, 1.3e11, 0.02, 0.005, 5e-10),
        (20e-9, 1.3e11, 0.02, 0.005, 5e-9),
        (1e-6, 1e11, 0.05, 0.01, 3e-10),
        (5e-9, 5e10, 0.05, 0.01, 1e-9),
    ],
)
def test_a_law_around_a_hard_contact_loses_less_than_the_bound(
    radius: float, modulus: float, work: float, energy: float, length: float
) -> None:
    """Hydration, to first order: its pressure on the gap beside Hertz' contact moves the tip by 1 - 2/pi asin(a/r) of
    what it moves the surface (Sneddon's flat punch, by reciprocity); adhesion acts between a and the gap h0."""
    tables: dict[str, Any] = {
        "tip": {"radius": radius, "youngs_modulus": 1e13},
        "sample": {"youngs_modulus": modulus, "poisson_ratio": 0.3},
        "adhesion": {"work_of_adhesion": work, "hamaker_constant": 0.0},
        "range": {"maximum_load": 30.0 * work * radius},
    }
    water: Any = {"kind": "liquid", "hydration_energy": energy, "hydration_length": length}
    plan = Scene(**tables, medium=water).plan(bound="exact")
    alone = Scene(**tables, medium={"kind": "liquid"}).plan(bound="exact")
    z0 = Scene(**tables).adhesion.equilibrium_distance
    h0 = 9.0 * math.sqrt(3.0) / 16.0 * z0
    assert plan.explain()["lambda"] < 0.4  # hard: the gap beside it is Hertz'
    for depth in plan.explain()["largest_indentation"] * np.array([0.05, 0.2, 0.5, 0.95]):
        a = math.sqrt(radius * depth)
        r = a + np.geomspace(1e-6, 1.0, 4000) * (a + math.sqrt(60.0 * radius * length))
        x = r / a
        gap = a**2 / (math.pi * radius) * (np.sqrt(x**2 - 1.0) + (x**2 - 2.0) * np.arccos(1.0 / x))
        pressure = np.where(gap > h0, energy / length * np.exp(-(z0 + gap - h0) / length), 0.0)
        felt = pressure * (1.0 - 2.0 / math.pi * np.arcsin(a / r)) * 2.0 * math.pi * r
        force = alone.force(-depth) + float(np.sum(0.5 * (felt[1:] + felt[:-1]) * np.diff(r)))
        error = abs(plan.force(-depth) - force) / max(abs(force), plan.scale)
        assert 0.05 * plan.bound < error < plan.bound
