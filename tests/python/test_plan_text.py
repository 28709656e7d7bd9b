# SPDX-License-Identifier: BSD-3-Clause
"""A plan in words and as data: every sentence is true, in units that suit; what a refusal says to be valid is."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import get_args

import numpy as np
import pytest
import random_scenes
from nanotouch import Plan, Scene, Surface, presets
from nanotouch.errors import InvalidValue
from nanotouch.scene import Quantity, _plan_text

PRESETS = random_scenes.PRESETS


def test_explanation_is_ones_own() -> None:
    """What is done to it does not reach the plan."""
    plan = Scene().plan()
    said, facts = str(plan), plan.explain()
    assert facts["terms"][0]["name"] == "contact"
    assert facts["terms"][1] == plan.terms[1]._asdict()
    facts["terms"].clear()
    facts["rivals"]["jkr"] = 0.0
    facts["warnings"].append("")
    assert str(plan) == said
    assert plan.explain()["rivals"]["jkr"] > 0.0


def lines_of(plan: Plan) -> dict[str, str]:
    return dict(line.split(": ", 1) for line in str(plan).splitlines() if ": " in line and "warning" not in line)


def test_words_name_what_the_bound_is_measured_by() -> None:
    """Scale and unit are those of the quantity; what the quantity does not know is told so."""
    scene = presets.paper_gold()[0]
    force = str(scene.plan())
    assert re.search(
        r"force within 0.\d+ % of the larger of itself and 27.29 nN, the pull-off; folds within 0.\d+ pm", force
    )
    floor = str(scene.plan(relative_accuracy=0.01, force_floor=2e-9))
    assert "of the larger of itself and 200 nN;" in floor
    stiffness = scene.plan(relative_accuracy=0.1, quantity="stiffness")
    assert f"of the larger of itself and {stiffness.scale:.4g} N/m;" in str(stiffness)
    radius = scene.plan(relative_accuracy=0.1, quantity="radius")
    assert f"of the larger of itself and {radius.scale * 1e9:.4g} nm;" in str(radius)
    assert lines_of(radius)["van der Waals"].endswith("no part of the contact radius")
    folds = str(scene.plan(relative_accuracy=0.1, quantity="folds"))
    assert re.search(r"\nfolds within 0.\d+ pm; cost", folds)
    hertz = force.split("Hertz would err by ")[1].split(" %")[0]
    for plan in (stiffness, radius):  # of the force, whatever is demanded
        assert f"in force Hertz would err by {hertz} %" in str(plan)


RADIUS_UNDER_LOAD: dict[str, Callable[[float, float], float]] = {
    "punch": lambda F, E: 20e-9,
    "cone": lambda F, E: math.sqrt(2.0 * F * math.tan(0.3) / (math.pi * E)),  # F = pi/2 E* a^2 cot psi
    "paraboloid": lambda F, E: (0.75 * F * 20e-9 / E) ** (1.0 / 3.0),
}


@pytest.mark.parametrize("shape", list(RADIUS_UNDER_LOAD))
def test_scale_of_a_radius_is_that_at_the_largest_load(shape: str) -> None:
    scene = Scene(
        tip={"shape": shape}, medium={"kind": "vacuum"}, adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0}
    )
    plan = scene.plan(relative_accuracy=0.1, quantity="radius")
    expected = RADIUS_UNDER_LOAD[shape](scene.range.maximum_load, plan.explain()["effective_modulus"])
    assert plan.scale == pytest.approx(expected, rel=1e-9)
    assert f"of the larger of itself and {plan.scale * 1e9:.4g} nm;" in str(plan)


def test_words_of_what_is_not_there() -> None:
    far = str(Scene(range={"minimum_gap": 5e-9}).plan())
    assert "no folds" in far
    assert "in contact, which is not visited" in far
    assert "jump" not in far
    assert "warning" not in far
    soft = str(presets.cell_in_liquid()[0].plan())
    assert "no folds" in soft
    assert "\nno pull-off; " in soft
    dry = Scene(medium={"relative_humidity": 0.0}, adhesion={"work_of_adhesion": 0.0})
    assert "100 % of the pull-off" in str(dry.plan(bound="exact"))  # not 1e+02 %
    dry.adhesion.hamaker_constant = 0.0
    assert "no pull-off; no jump-in; stiffest contact 657 N/m" in str(dry.plan())
    unfelt = str(Scene().plan(force_floor=1e-6))
    assert "no adhesion that could be felt" in unfelt
    assert "folds within 1.1 nm" in unfelt


def test_facts_without_effect_are_told() -> None:
    scene = Scene(sample={"conducting": "no"}, adhesion={"contact_potential": 3.0, "pull_off_force": 12e-9})
    said = str(scene.plan())
    assert "warning: contact potential, which does not act between these bodies: 3 V\n" in said
    assert "warning: measured pull-off force, not used: the adhesion is given otherwise: 12 nN" in said


def test_folds_that_are_not_known_are_no_number() -> None:
    """Strong laws on a gel move its folds by more than their own gap: a warning, not metres in the sentence."""
    scene = Scene(sample={"youngs_modulus": 3e3}, adhesion={"work_of_adhesion": 0.01, "contact_potential": 0.3})
    said = str(scene.plan(relative_accuracy=0.1))
    assert "where the folds are is not known;" in said
    assert "warning: where the folds are is not known, and no bound holds nearer to them than: " in said
    scene.sample.youngs_modulus = 1e9
    assert "not known" not in str(scene.plan(relative_accuracy=0.1))


@pytest.mark.parametrize("quantity", get_args(Quantity))
def test_what_is_said_to_be_valid(quantity: Quantity) -> None:
    """Least accuracy, least budget, largest Hamaker constant: taken as printed, they do."""
    for name in PRESETS:
        scene = getattr(presets, name)()[0]
        for limit, ask in (
            ("relative_accuracy", lambda value, scene=scene: scene.plan(relative_accuracy=value, quantity=quantity)),
            ("budget", lambda value, scene=scene: scene.plan(relative_accuracy=5e-3, budget=value, quantity=quantity)),
        ):
            with pytest.raises(InvalidValue, match=limit) as refusal:
                ask(1e-18 if limit == "relative_accuracy" else 0.5)
            ask(float(re.findall(r"valid is (\S+) \.\.", str(refusal.value))[0]))
    scene = Scene(medium={"relative_humidity": 0.0}, adhesion={"hamaker_constant": 1e-17})
    with pytest.raises(InvalidValue, match="hamaker_constant") as refusal:
        scene.plan()
    scene.adhesion.hamaker_constant = float(re.findall(r"\.\. (\S+) J", str(refusal.value))[0])
    scene.plan(relative_accuracy=0.3)


def test_a_shift_beyond_the_folds_own_gaps_is_told_as_not_known() -> None:
    facts = Scene().plan(0.01).explain()
    gap = max(facts["release_gap"], facts["capture_gap"])
    assert "not known" not in _plan_text._folds(facts | {"fold_shift": 0.9 * gap})
    assert "where the folds are is not known" in _plan_text._folds(facts | {"fold_shift": 1.1 * gap})


def test_curvature_that_tables_of_a_deforming_sample_follow_is_not_told_as_left_out() -> None:
    scene = Scene(
        tip={"radius": 1e-6}, sample={"youngs_modulus": 1e8}, range={"maximum_load": 2e-9},
        medium={"kind": "liquid", "hydration_energy": 1e-4, "hydration_length": 2e-9},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
    )  # fmt: skip
    y, x = np.mgrid[0:24, 0:24] * 50e-9
    heights = 5e-9 * np.sin(x / 190e-9) * np.cos(y / 190e-9)
    plan = scene.plan(0.05, surface=Surface.touched_by(scene, heights, pixel_size=50e-9))
    assert plan.explain()["deforms"]
    assert "surface: curved, effective radius" in str(plan)
    assert "left out" not in str(plan).split("surface:")[1].split("\n")[0]
