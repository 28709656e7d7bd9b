# SPDX-License-Identifier: BSD-3-Clause
"""What a plan's bound is measured by follows from the range that is visited; ordinary dry scenes are planned; two
plans of one scene never contradict each other. The forces are textbooks' formulas, written here."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from nanotouch import Scene

sys.path.insert(0, str(Path(__file__).parents[1] / "heavy"))

import plan_pairs

VACUUM, CHARGE, AVOGADRO, BOLTZMANN = 8.8541878128e-12, 1.602176634e-19, 6.02214076e23, 1.380649e-23
Z0 = 2e-10  # the scene's default distance of atoms in contact


def van_der_waals(gap, radius, hamaker):
    """Hamaker's sphere and half-space, gaps between atoms."""
    d = gap + Z0
    return -2.0 / 3.0 * hamaker * radius**3 / (d * (d + 2.0 * radius)) ** 2


def electrostatic(gap, radius, potential):
    """Hudlet et al. (1998)."""
    return -np.pi * VACUUM * potential**2 * radius**2 / (gap * (gap + radius))


def double_layer(gap, radius, salt, tip, sample):
    """Hogg, Healy, Fuerstenau (1966) at constant potentials, by Derjaguin: F = 2 pi R W."""
    permittivity = VACUUM * 78.4
    kappa = np.sqrt(2.0 * AVOGADRO * CHARGE**2 * salt / (permittivity * BOLTZMANN * 298.15))
    e = np.exp(-kappa * gap)  # 1 - coth x = -2 e^2/(1 - e^2), 1/sinh x = 2 e/(1 - e^2)
    energy = 2.0 * e * (2.0 * tip * sample - (tip**2 + sample**2) * e) / (1.0 - e**2)
    return 2.0 * np.pi * radius * 0.5 * permittivity * kappa * energy


def draw(law: str, rng: np.random.Generator):
    """A scene that stays farther out than some gap, and its force."""
    radius, nearest = 10.0 ** rng.uniform(-8.3, -6.0), 10.0 ** rng.uniform(-9.0, -7.3)
    scene = Scene(tip={"radius": radius}, range={"minimum_gap": nearest})
    scene.adhesion.work_of_adhesion, scene.adhesion.hamaker_constant = rng.choice([0.0, 0.3]), 0.0
    scene.medium.relative_humidity = 0.0
    scene.tip.youngs_modulus = scene.sample.youngs_modulus = 1e13  # these formulas are of rigid bodies
    if law == "van der Waals":
        hamaker = scene.adhesion.hamaker_constant = 10.0 ** rng.uniform(-20.5, -18.5)
        return scene, lambda gap: van_der_waals(gap, radius, hamaker)
    if law == "electrostatic":
        potential = scene.adhesion.contact_potential = rng.uniform(0.1, 10.0)
        return scene, lambda gap: electrostatic(gap, radius, potential)
    salt, tip = 10.0 ** rng.uniform(-1.0, 2.0), -rng.uniform(0.01, 0.06)
    sample = tip if law == "like double layers" else -rng.uniform(0.1, 1.0) * tip
    scene.medium.kind, scene.medium.ionic_strength = "liquid", salt
    scene.tip.surface_potential, scene.sample.surface_potential = tip, sample
    return scene, lambda gap: double_layer(gap, radius, salt, tip, sample)


@pytest.mark.parametrize("law", ["van der Waals", "electrostatic", "like double layers", "unlike double layers"])
def test_a_range_without_contact_has_its_own_scale(law: str) -> None:
    """Whatever the demand, the error at the smallest gap is within it: the force there is no part of a pull-off that
    is not visited. At all gaps the error is within the bound of the larger of force and scale."""
    rng = np.random.default_rng(39)
    for _ in range(40):
        scene, force = draw(law, rng)
        demand = 10.0 ** rng.uniform(-5.0, -0.6)
        plan, nearest = scene.plan(demand), scene.range.minimum_gap
        gaps = nearest * np.geomspace(1.0, 30.0, 20)
        truth = force(gaps)
        error = np.abs(plan.force(gaps) - truth)
        within = plan.bound + 1e-5 + plan.explain()["rigid_error"]  # 1e13 Pa is not quite rigid at 10 V
        assert plan.scale <= np.abs(truth).max() * 1.02  # sampled every 10 %
        assert plan.bound <= demand or plan.warnings
        assert np.all(error <= within * np.maximum(np.abs(truth), plan.scale))
        assert error[0] <= within * abs(truth[0]) * (1.0 if law != "unlike double layers" else 3.0)


def test_a_double_layer_over_a_gel_that_is_not_touched() -> None:
    """Unlike potentials over 1 MPa: left out before, 21 times what was allowed."""
    scene = Scene(
        tip={"radius": 1e-7, "surface_potential": -0.05},
        sample={"youngs_modulus": 1e6, "poisson_ratio": 0.5, "surface_potential": 0.01},
        medium={"kind": "liquid", "ionic_strength": 10.0},
        adhesion={"work_of_adhesion": 0.001, "hamaker_constant": 0.0},  # lets go at some 6 nm
        range={"minimum_gap": 15e-9},
    )
    plan, truth = scene.plan(0.05), float(double_layer(15e-9, 1e-7, 10.0, -0.05, 0.01))
    assert abs(float(plan.force(15e-9)) - truth) <= plan.bound * abs(truth)


def polymer(modulus: float, work: float = 0.05, hamaker: float = 1e-19) -> Scene:
    return Scene(
        tip={"radius": 10e-9, "youngs_modulus": 1.7e11, "poisson_ratio": 0.28},
        sample={"youngs_modulus": modulus, "poisson_ratio": 0.4},
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": work, "hamaker_constant": hamaker},
    )


@pytest.mark.parametrize("modulus", [2e9, 2.5e9, 3e9, 3.5e9, 4e9, 5e9])
@pytest.mark.parametrize("demand", [0.1, 1e-2, 1e-3])
def test_dry_polymers_are_planned(modulus: float, demand: float) -> None:
    plan = polymer(modulus).plan(demand)
    assert plan.bound <= demand
    assert any("van der Waals alone exceeds the work of adhesion" in warning.text for warning in plan.warnings)


def test_van_der_waals_is_no_more_than_the_work_of_adhesion() -> None:
    """Atoms are D0 apart, w = H/(12 pi D0^2), and the range of adhesion is that of D0. Far out the tail acts over
    h + D0; where w is larger than van der Waals at z0, z0 stays."""
    work, hamaker, gap = 0.05, 1e-19, 5e-9
    apart = np.sqrt(hamaker / (12.0 * np.pi * work))
    plan = polymer(1e13, work, hamaker).plan(1e-6)
    assert plan.explain()["length"] == pytest.approx(9.0 * np.sqrt(3.0) / 16.0 * apart, rel=1e-12)
    assert float(plan.force(gap)) == pytest.approx(van_der_waals(gap + apart - Z0, 10e-9, hamaker), rel=1e-6)
    plan = polymer(1e13, 0.07, hamaker).plan(1e-6)
    assert plan.explain()["length"] == pytest.approx(9.0 * np.sqrt(3.0) / 16.0 * Z0, rel=1e-12)
    assert not any("exceeds" in warning.text for warning in plan.warnings)


#: pairs of a rigid and a deforming plan, or of two tables, that contradicted each other
PAIRS = [23, 61, 71, 83, 86, 116, 131, 161, 167, 171, 172, 185, 235, 245, 266, 291, 319, 331]


@pytest.mark.parametrize("seed", PAIRS)
def test_two_plans_of_one_scene_do_not_contradict_each_other(seed: int) -> None:
    pair = plan_pairs.measure(seed)
    assert pair.refused == 0
    assert not pair.violated, pair
