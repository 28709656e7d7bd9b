# SPDX-License-Identifier: BSD-3-Clause
"""Soft spheres that attract and repel, against closed forms of the problems of the literature. No expected number comes
from a solver of ours. The integrals are written out here, since of the papers only the abstracts were at hand.

Attard and Parker, Phys. Rev. A 46 (1992) 7959: surface forces of finite range on an elastic half-space, solved
together;
displacement prior to contact, and Hertz as the limit of a short-ranged repulsion. Greenwood, Proc. R. Soc. Lond. A 453
(1997) 1277: pull-off of the Lennard-Jones sphere between Bradley's 2 pi R w and JKR's 3/2 pi R w over Tabor's mu. Feng,
Colloids Surf. A 172 (2000) 175: jumps appear with mu.
"""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import Scene, reference
from nanotouch.reference import Deformation

R, E, A = 10e-6, 1e9, 1e-19
"""radius, modulus E*, Hamaker constant, of the size of Attard and Parker's examples"""


def van_der_waals() -> reference.Pressure:
    return reference.power(-A / (6.0 * math.pi), 3.0)


@pytest.mark.parametrize("gap", [10e-9, 20e-9, 40e-9])
def test_displacement_prior_to_contact_by_van_der_waals(gap: float) -> None:
    """u(0) = (2/E*) Int p dr of the undeformed gap: -A sqrt(2 R)/(16 E* h^(5/2)). It errs by its own square."""
    found = Deformation(van_der_waals(), R, E).at(gap)
    expected = -A * math.sqrt(2.0 * R) / (16.0 * E * gap**2.5)
    assert found.displacement == pytest.approx(expected, rel=4.0 * abs(expected) / gap + 1e-5)
    assert found.force == pytest.approx(-A * R / (6.0 * gap**2), rel=8.0 * abs(expected) / gap + 1e-5)


@pytest.mark.parametrize("gap", [2e-9, 5e-9])
def test_displacement_prior_to_contact_by_an_exponential(gap: float) -> None:
    """The same integral: u(0) = P sqrt(2 pi R l) e^(-h/l)/E*."""
    pressure, length = 1e7, 1e-9
    found = Deformation(reference.exponential(pressure, length), 1e-6, 1e11).at(gap)
    expected = pressure * math.sqrt(2.0 * math.pi * 1e-6 * length) * math.exp(-gap / length) / 1e11
    assert found.displacement == pytest.approx(expected, rel=3.0 * expected / length + 1e-6)


@pytest.mark.parametrize("load", [1e-6, 1e-5])
def test_hertz_is_the_limit_of_a_short_ranged_repulsion(load: float) -> None:
    """At one load the tip goes as deep as Hertz', less the gap that is left, which is of the order of the range."""
    modulus, length = 1e9, 0.1e-9
    found = Deformation(reference.exponential(1e9, length), 1e-6, modulus).at_force(load, 5e-9)
    hertz = (9.0 * load**2 / (16.0 * modulus**2 * 1e-6)) ** (1.0 / 3.0)
    assert abs(-found.gap - hertz) < 4.0 * length
    assert -found.gap == pytest.approx(hertz, rel=4.0 * length / hertz)


def scene_of(tabor: float, **adhesion: Any) -> Scene:
    """Of Tabor's mu = (R w^2/(E*^2 z0^3))^(1/3), dry."""
    w, z0, radius = 0.05, 0.3e-9, 100e-9
    modulus = math.sqrt(radius * w**2 / (tabor * z0) ** 3)
    scene = Scene(
        tip={"radius": radius, "youngs_modulus": 1e13, "poisson_ratio": 0.0}, medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": w, "equilibrium_distance": z0, "hamaker_constant": 0.0, **adhesion},
        range={"maximum_load": 3.0 * math.pi * w * radius},
    )  # fmt: skip
    scene.sample.poisson_ratio = 0.0
    scene.sample.youngs_modulus = 1.0 / (1.0 / modulus - 1.0 / 1e13)
    return scene


#: Greenwood's and Johnson's map: pull-off over pi w R of the Lennard-Jones sphere, from Bradley's 2 to JKR's 3/2
LIMITS = [(0.01, 2.0, 0.02), (8.0, 1.5, 0.02)]


@pytest.mark.parametrize(("tabor", "pull_off", "within"), LIMITS)
def test_pull_off_goes_from_bradley_to_jkr(tabor: float, pull_off: float, within: float) -> None:
    plan = scene_of(tabor).plan(1e-3)
    assert plan.pull_off_force / (math.pi * 0.05 * 100e-9) == pytest.approx(pull_off, rel=within)


def test_pull_off_falls_with_tabors_number() -> None:
    """Monotonically, as in Greenwood's figure of pull-off over mu; Dugdale's is within 6 % of Lennard-Jones'."""
    found = [scene_of(mu).plan(1e-3).pull_off_force for mu in (0.05, 0.2, 0.5, 1.0, 2.0, 4.0)]
    assert np.all(np.diff(found) < 0.0)
    # Lennard-Jones at mu = 0.5 and 1, by a boundary element solution of others: 1.787, 1.671
    for mu, told in ((0.5, 1.787), (1.0, 1.671)):
        assert scene_of(mu).plan(1e-3).pull_off_force / (math.pi * 0.05 * 100e-9) == pytest.approx(told, rel=0.06)


@pytest.mark.parametrize("tabor", [2.0, 4.0])
def test_the_attracted_surface_jumps_where_the_rigid_one_would_still_hold(tabor: float) -> None:
    """With all of w in the tail, H = 16 pi w z0^2 (Lennard-Jones' at large gaps), van der Waals alone makes the surface
    jump at h_j = 2.641 mu^(3/7) z0; its scaling, (H sqrt(R)/E*)^(2/7), is that of test_reference_deformation.py."""
    w, z0, radius = 0.05, 0.3e-9, 100e-9
    modulus = math.sqrt(radius * w**2 / (tabor * z0) ** 3)
    law = reference.power(-16.0 * math.pi * w * z0**2 / (6.0 * math.pi), 3.0)
    jump = Deformation(law, radius, modulus).jump_in(z0, 10.0 * z0)
    assert jump.gap > z0 * tabor ** (3.0 / 7.0) * 2.5
    assert jump.force < -16.0 * math.pi * w * z0**2 * radius / (6.0 * jump.gap**2)  # it pulls more than a rigid one


def test_jumps_appear_with_tabors_number() -> None:
    """Feng: none at small mu under a stiff spring, hysteresis at large. Force over gap: a step at capture."""
    soft, stiff = (nt.Interaction(scene_of(mu).plan(1e-3)).plan.explain() for mu in (5.0, 0.1))
    assert soft["release_gap"] > 1.5 * soft["capture_gap"]
    assert stiff["release_gap"] < 1.05 * stiff["capture_gap"]
