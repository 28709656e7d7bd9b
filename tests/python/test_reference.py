# SPDX-License-Identifier: BSD-3-Clause
"""The Lennard-Jones sphere: its solver against closed forms and limits, its table against the solver and others."""

from __future__ import annotations

import math
import re
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from nanotouch import Contact, contact, reference
from nanotouch.errors import InvalidValue

special = pytest.importorskip("scipy.special")

TOOL = Path(__file__).resolve().parents[2] / "tools" / "lennard_jones"


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    sys.path.insert(0, str(TOOL))
    import generate

    return generate


@pytest.fixture(scope="module")
def sphere(tool: ModuleType) -> ModuleType:
    return sys.modules["sphere"]


# --- the solver ---


def test_displacement_under_a_parabolic_pressure(sphere: ModuleType) -> None:
    """p = 1 - r^2 in r < 1 displaces by 16/(9 pi) ((2 - r^2) E(r^2) - (1 - r^2) K(r^2)/2) there: two Abel integrals."""
    mesh = sphere.build_mesh(np.concatenate([np.linspace(0.0, 1.0, 6), np.geomspace(1.2, 10.0, 5)]))
    inside = mesh.nodes < 1.0
    k2 = mesh.nodes[inside] ** 2
    exact = 16.0 / (9.0 * np.pi) * ((2.0 - k2) * special.ellipe(k2) - (1.0 - k2) * special.ellipk(k2) / 2.0)
    pressure = np.where(inside, 1.0 - mesh.nodes**2, 0.0)
    assert np.allclose((mesh.influence @ pressure)[inside], exact, rtol=0.0, atol=1e-11)
    assert mesh.centre @ pressure == pytest.approx(4.0 / 3.0, rel=1e-12)


def test_displacement_under_hertz_pressure(sphere: ModuleType) -> None:
    """sqrt(1 - r^2) displaces by pi/4 (2 - r^2); its root at the edge is resolved by small panels, not to rounding."""
    edges = np.concatenate([1.0 - np.geomspace(1.0, 1e-6, 30), [1.0, 2.0]])
    mesh = sphere.build_mesh(edges)
    displacement = mesh.influence @ np.sqrt(np.maximum(0.0, 1.0 - mesh.nodes**2))
    inside = mesh.nodes < 1.0
    assert np.allclose(displacement[inside], np.pi / 4.0 * (2.0 - mesh.nodes[inside] ** 2), rtol=0.0, atol=1e-7)


def test_rigid_limit_is_bradley(sphere: ModuleType) -> None:
    """Without deforming, P is the integral of the wall's law over the paraboloid, -2 at its lowest."""
    gaps = np.array([30.0, 10.0, 3.0, 1.5, 1.2, 1.0, 0.95])
    loads = [point.P for point in sphere.curve(1e-5, gaps)]  # deforms by mu^1.5 = 3e-8
    assert np.allclose(loads, 2.0 / 3.0 * gaps**-8 - 8.0 / 3.0 * gaps**-2, rtol=0.0, atol=2e-6)  # the mesh ends at 100


@pytest.mark.parametrize("mu", [0.2, 1.5])
def test_force_is_the_slope_of_the_energy(sphere: ModuleType, tool: ModuleType, mu: float) -> None:
    """The energy, elastic and of attraction, is an integral of its own: nothing but truth makes P = dU/dD."""
    gaps = np.array([5.0, *(tool.centre_gap(q, mu) for q in np.linspace(-0.3, 0.6, 6))])
    for point in list(sphere.curve(mu, gaps, sphere.COARSE))[1:]:
        step = 1e-5 * point.centre_gap
        there = [
            sphere.solve(point.mesh, mu, point.centre_gap + s, point.gap + s * point.tangent) for s in (step, -step)
        ]
        slope = (there[0].U - there[1].U) / (2.0 * step)
        assert slope == pytest.approx(point.P * point.D_slope, rel=1e-5, abs=1e-7)  # of finite differences


# --- the table ---


@pytest.mark.parametrize("mu", [0.06, 0.83, 2.0])  # neither in the table nor among those its error was measured at
def test_table_agrees_with_a_new_computation(tool: ModuleType, mu: float) -> None:
    between = (tool.Q[:-1] + tool.Q[1:])[::3] / 2.0
    _, truth = tool.sample(mu, tool.COARSE, between)
    curve = reference.lennard_jones(mu)
    d, P = curve.at(between)
    error = tool.distance(np.array([d, P, d, P]), truth)
    # 1e-5: what the coarse mesh is off by (docs/evidence/lennard_jones.md)
    assert error < reference.table_error().independent + 1e-5
    assert reference.table_error().independent < 1e-4


@pytest.mark.parametrize(
    ("mu", "load"),
    [(0.1, -1.96872), (0.25, -1.89432), (0.5, -1.78737), (1.0, -1.67063), (2.0, -1.58354), (4.0, -1.53487)],
)
def test_pull_off_load_of_an_independent_program(mu: float, load: float) -> None:
    """Annuli of constant pressure, 380 of them; its steps at mu = 0.25 were coarse (2.3e-4 off), elsewhere 1.2e-4."""
    assert reference.pull_off(mu) == pytest.approx(load, rel=3e-4)


@pytest.mark.parametrize(("mu", "jump_in"), [(1.0, -0.920), (2.0, -0.721), (4.0, -0.534)])
def test_jump_in_of_an_independent_program(mu: float, jump_in: float) -> None:
    assert reference.lennard_jones(mu).jump_in == pytest.approx(jump_in, abs=6e-4)  # it is printed to 3 decimals


def test_limits() -> None:
    """Bradley's -2 for small mu, JKR for large, as fast as they should: DMT's error in P_c goes like mu^1.5."""
    loads = [reference.pull_off(mu) for mu in np.geomspace(*reference.mu_range(), 30)]
    assert np.all(np.diff(loads) > 0.0)
    assert -2.0 < loads[0] < -1.98
    assert -1.53 < loads[-1] < -1.5
    rate = math.log((2.0 + reference.pull_off(0.1)) / (2.0 + reference.pull_off(0.05))) / math.log(2.0)
    assert rate == pytest.approx(1.5, abs=0.1)
    errors = [reference.model_error("jkr", mu) for mu in (0.5, 1.0, 2.0, 5.0)]
    assert np.all(np.diff(errors) < 0.0)
    assert errors[-1] < 0.015
    curve = reference.lennard_jones(5.0)
    assert curve.zero_load_indentation == pytest.approx(1.100642, rel=0.01)  # JKR
    assert curve.jump_out == pytest.approx(-0.908560, rel=0.02)


@pytest.mark.parametrize("mu", [0.05, 0.3, 0.69, 0.71, 1.5, 5.0])
def test_branches(mu: float) -> None:
    curve = reference.lennard_jones(mu)
    assert curve.hysteresis == (mu > 0.7)  # the solver turns between 0.695 and 0.7
    start = curve.jump_out if curve.hysteresis else -2.0
    d = np.linspace(start, curve.indentation(10.0), 500)
    stable, approach = curve.force(d), curve.force(d, "approach")
    both = d > (curve.jump_in if curve.hysteresis else -math.inf) + 1e-9
    assert np.array_equal(stable[both], approach[both])
    assert np.all(approach[~both] >= stable[~both])  # less attracted before the jump than after
    pushed = d > curve.pull_off_indentation
    assert np.all(np.diff(stable[pushed]) > 0.0)
    assert stable.min() == pytest.approx(curve.pull_off_load, abs=2e-4)
    assert np.allclose(curve.indentation(stable[pushed]), d[pushed], atol=1e-6)
    far = curve.force(curve.d[0] + np.array([-1e-6, 1e-6]))  # onto the tail of rigid bodies
    assert far[0] == pytest.approx(far[1], rel=2e-3)
    assert curve.force(-math.inf) == 0.0


# --- what it is used for ---


@pytest.mark.parametrize(
    ("mu", "plain", "maugis", "dmt"),
    [
        (0.1, 0.93, 0.097, 0.14),
        (0.25, 0.26, 0.013, 0.098),
        (0.5, 0.11, 0.027, 0.124),
        (1.0, 0.053, 0.028, 0.158),
        (2.0, 0.035, 0.020, 0.192),
        (4.0, 0.018, 0.010, 0.210),
    ],
)
def test_model_errors_of_an_independent_program(mu: float, plain: float, maugis: float, dmt: float) -> None:
    """Printed to two digits: half a unit of the last digit and 5 % for its coarser curves."""
    assert reference.model_error("maugis", mu, loads=(-1.0, 10.0)) == pytest.approx(plain, rel=0.05, abs=0.001)
    assert reference.model_error("maugis", mu, rezeroed=True) == pytest.approx(maugis, rel=0.05, abs=0.001)
    assert reference.model_error("dmt", mu, rezeroed=True) == pytest.approx(dmt, rel=0.05, abs=0.001)


def test_pull_off_error_of_the_models() -> None:
    assert reference.model_error("maugis", 0.7, "pull_off") == pytest.approx(0.056, abs=0.001)
    assert reference.model_error("hertz", 1.0, "pull_off") == 1.0
    assert reference.model_error("dmt", 1.0, "pull_off") == pytest.approx(2.0 / 1.67066 - 1.0, abs=1e-4)


def test_si() -> None:
    w, z0, R, E = 0.05, 0.3e-9, 30e-9, 60e9
    tip = Contact(R, E, w, cohesive_stress=reference.PEAK_STRESS * w / z0)
    mu = (R * w**2 / (E**2 * z0**3)) ** (1.0 / 3.0)
    assert reference.tabor_mu(tip) == pytest.approx(mu, rel=1e-12)
    assert tip.maugis_lambda == pytest.approx(1.1570 * mu, rel=1e-4)
    curve = reference.lennard_jones(reference.tabor_mu(tip))
    indentation, force = curve.to_si(tip)
    assert force.min() == pytest.approx(-contact.pull_off_force("maugis", tip), rel=0.06)  # MD is worth 5.6 %
    # far away the undeformed gap z0 - delta decides alone: -4/3 pi w R z0^2 (2/h^2) of the paraboloid
    gap = z0 - indentation[0]
    assert force[0] == pytest.approx(-8.0 / 3.0 * math.pi * w * R * (z0 / gap) ** 2, rel=1e-4)
    # deep in contact Hertz decides, F = 4/3 E* sqrt(R) delta^1.5: a check of the unit of indentation
    hertz = contact.force("hertz", float(indentation[-1]), tip)
    assert hertz == pytest.approx(force[-1], rel=0.2)
    with pytest.raises(InvalidValue, match="the contact's mu is"):
        reference.lennard_jones(1.0).to_si(tip)


@pytest.mark.parametrize("mu", [0.0499, 5.01, math.nan, math.inf, -1.0])
def test_mu_out_of_range_is_refused(mu: float) -> None:
    with pytest.raises(InvalidValue, match=re.escape(f"mu = {mu}: the Lennard-Jones table holds 0.05 to 5")):
        reference.lennard_jones(mu)


def test_out_of_range_is_refused() -> None:
    curve = reference.lennard_jones(1.0)
    with pytest.raises(InvalidValue, match="indentation = 1000 "):
        curve.force(1000.0)
    with pytest.raises(InvalidValue, match="indentation = nan "):
        curve.force([0.0, math.nan])
    with pytest.raises(InvalidValue, match=r"load = -1\.7 "):
        curve.indentation(-1.7)
    with pytest.raises(InvalidValue, match="valid are stable, approach"):
        curve.force(0.0, "unstable")  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="valid are force, pull_off"):
        reference.model_error("jkr", 1.0, "radius")  # type: ignore[arg-type]
