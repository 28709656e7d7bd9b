# SPDX-License-Identifier: BSD-3-Clause
"""Contact of other shapes from Python: numerical solutions of one's own, broadcasting, validity, Eq. 5-8, refusals."""
# ruff: noqa: SIM300 (law.F is no constant)

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nanotouch import contact, geometry
from nanotouch._arrays import Floats
from nanotouch.contact import Contact
from nanotouch.contact.geometry import Outside, Shape
from nanotouch.errors import InvalidValue
from scipy.fft import irfft2, rfft2

E = 1e9
ROUND = [
    Shape("paraboloid", radius=20e-9),
    Shape("sphere", radius=20e-9),
    Shape("cone", half_angle=0.6),
    Shape("punch", radius=20e-9),
    Shape("blunted", radius=20e-9, half_angle=0.6),
    Shape("truncated", radius=20e-9, half_angle=0.6),
]
SHAPES = [*ROUND, Shape("cone", half_angle=0.6, sides=3), Shape("blunted", radius=20e-9, half_angle=0.6, sides=4)]


def influence(n: int, h: float) -> Floats:
    """Love (1929): surface displacement at distances of the grid by unit pressure on a square of side h, E* = 1."""
    x, y = np.meshgrid(np.arange(1 - n, n) * h, np.arange(1 - n, n) * h, indexing="ij")

    def part(p: Floats, q: Floats) -> Floats:
        return np.asarray(p * (np.arcsinh((q + h / 2) / abs(p)) - np.arcsinh((q - h / 2) / abs(p))))

    return np.asarray(part(x + h / 2, y) - part(x - h / 2, y) + part(y + h / 2, x) - part(y - h / 2, x)) / math.pi


def pressed(n: int, half: float, profile: Floats, depth: float) -> float:
    """Load of a rigid profile on a half-space, E* = 1: conjugate gradients on the pressure (Polonsky, Keer 1999)."""
    h = 2 * half / n
    kernel = np.zeros((2 * n, 2 * n))
    kernel[: 2 * n - 1, : 2 * n - 1] = influence(n, h)
    spectrum = rfft2(np.roll(kernel, (1 - n, 1 - n), (0, 1)))

    def sink(p: Floats) -> Floats:
        return np.asarray(irfft2(spectrum * rfft2(p, (2 * n, 2 * n)), (2 * n, 2 * n))[:n, :n], np.float64)

    p = np.where(profile < depth, 0.5, 0.0)
    direction, last, keep = np.zeros_like(p), 1.0, 0.0
    for _ in range(300):
        gap = sink(p) + profile - depth
        touching = p > 0
        norm = float((gap[touching] ** 2).sum())
        direction = np.where(touching, gap + keep * norm / last * direction, 0.0)
        last, response = norm, sink(direction)
        step = (gap * direction)[touching].sum() / (response * direction)[touching].sum()
        p = np.maximum(p - step * direction, 0.0)
        overlap = (p == 0.0) & (gap < 0.0)
        p[overlap] -= step * gap[overlap]
        keep = 0.0 if overlap.any() else 1.0
        if math.sqrt(norm / touching.sum()) < 1e-7:
            return float(p.sum()) * h * h
    raise AssertionError("the numerical contact did not converge")


@pytest.mark.parametrize(("sides", "half"), [(0, 0.75), (3, 1.3), (4, 1.0)])
def test_pyramids_against_a_numerical_half_space(sides: int, half: float) -> None:
    """tan(psi) = 1, delta = 1. At n = 128 the method is 1e-5 off for the cone, and 512 moves the pyramids by 1e-5."""
    n = 128
    c = (np.arange(n) + 0.5) * 2 * half / n - half
    x, y = np.meshgrid(c, c, indexing="ij")
    faces = 2 * np.pi * np.arange(sides) / max(sides, 1) + 0.1234
    profile = np.max([x * np.cos(t) + y * np.sin(t) for t in faces], axis=0) if sides else np.hypot(x, y)
    load = pressed(n, half, profile, 1.0)
    ours = geometry.force(Shape("cone", half_angle=math.pi / 4, sides=sides), 1.0, 1.0)
    assert ours == pytest.approx(load, rel=1e-4)
    published = {0: 2 / math.pi, 3: 0.887, 4: 0.7453}[sides]  # Bilodeau 1992: 1 % above
    assert published == pytest.approx(load, rel=0.0105)


def test_sphere_against_a_numerical_half_space() -> None:
    """A whole sphere at a/R = 0.65; the rim of the contact is resolved to a cell, so the load to 1e-3 or better."""
    n, half, depth = 128, 0.8, 0.5
    c = (np.arange(n) + 0.5) * 2 * half / n - half
    r2 = np.add.outer(c**2, c**2)
    profile = np.where(r2 < 1, 1 - np.sqrt(np.maximum(1 - r2, 0)), 1.0)
    load = pressed(n, half, profile, depth)
    assert geometry.force(Shape("sphere", radius=1.0), depth, 1.0) == pytest.approx(load, rel=1e-3)
    assert contact.force("hertz", depth, Contact(1.0, 1.0)) > 1.04 * load  # F_H = F (1 + delta/(10 R) + ..)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: f"{s.kind}-{s.sides}")
@given(part=st.floats(1e-6, 3.0), modulus=st.floats(1e2, 1e13))
def test_work_is_the_energy(shape: Shape, part: float, modulus: float) -> None:
    """Int F ddelta by 40 Gauss points in sqrt(delta), where all laws are smooth but at a rim (1e-5 there)."""
    delta = part * 20e-9
    t, weights = np.polynomial.legendre.leggauss(40)
    s = 0.5 * (t + 1)
    work = float((weights * geometry.force(shape, delta * s**2, modulus) * delta * s).sum())
    law = geometry.evaluate(shape, delta, modulus)
    assert work == pytest.approx(law.U, rel=1e-5)
    assert law.k == pytest.approx(2 * modulus * law.a, rel=1e-13)
    assert geometry.indentation(shape, law.F, modulus) == pytest.approx(delta, rel=1e-13)


def test_broadcasting_and_types() -> None:
    delta = np.linspace(-1e-9, 5e-9, 4)[:, np.newaxis]
    law = geometry.evaluate(ROUND[1], delta, np.array([1e9, 2e9, 3e9]))
    assert law.F.shape == law.U.shape == law.k.shape == law.a.shape == (4, 3)
    np.testing.assert_array_equal(law.F[0], 0.0)
    np.testing.assert_allclose(law.F[2], law.F[2, 0] * np.array([1, 2, 3]), rtol=1e-15)
    assert isinstance(geometry.force(ROUND[1], 1e-9, E), float)
    assert geometry.indentation(ROUND[1], law.F, np.array([1e9, 2e9, 3e9])).shape == (4, 3)
    assert math.isnan(geometry.indentation(ROUND[1], -1e-9, E))
    with pytest.raises(TypeError, match="masked"):
        geometry.force(ROUND[1], np.ma.array([1e-9], mask=[True]), E)


def test_jkr_shapes() -> None:
    cone, w = Shape("cone", half_angle=0.6), 0.05
    last = geometry.jkr_pull_off_indentation(cone, 1e6, w)
    forces = geometry.jkr(cone, np.linspace(last, -20 * last, 20001), 1e6, work_of_adhesion=w).F
    assert forces.min() == pytest.approx(-54 * w**2 * math.tan(0.6) ** 3 / (math.pi * 1e6), rel=1e-6)
    assert -forces.min() == pytest.approx(geometry.jkr_pull_off_force(cone, 1e6, w), rel=1e-6)
    assert geometry.jkr_indentation(cone, 0.0, 1e6, work_of_adhesion=w) == pytest.approx(-8 * last, rel=1e-13)  # r = 4
    assert math.isnan(geometry.jkr(cone, 1.0, 1e6, work_of_adhesion=w, branch="unstable").F)
    paraboloid = geometry.jkr(ROUND[0], 1e-9, E, work_of_adhesion=w)
    assert paraboloid == contact.evaluate("jkr", 1e-9, Contact(20e-9, E, w))
    with pytest.raises(InvalidValue, match="not for sphere"):
        geometry.jkr(ROUND[1], 1e-9, E, work_of_adhesion=w)
    with pytest.raises(InvalidValue, match="work_of_adhesion"):
        geometry.jkr(cone, 1e-9, E, work_of_adhesion=-1.0)


def test_validity_reports() -> None:
    rubber = geometry.validity(ROUND[0], contact_radius=4.4 * 20e-9, indentation=1e-8)  # erratum E13
    assert rubber.radius_ratio == pytest.approx(4.4)
    assert rubber.outside == Outside.RADIUS_RATIO | Outside.SLOPE | Outside.STRAIN
    fine = geometry.validity(ROUND[0], 2e-9, 2e-10)
    assert fine.outside == Outside(0)
    assert geometry.validity(ROUND[0], 2e-9, 2e-10, thickness=10e-9).outside is Outside.THICKNESS
    law = geometry.evaluate(ROUND[1], np.array([0.0, 1e-9, 8e-9]), E)
    report = geometry.validity(ROUND[1], law.a, [0.0, 1e-9, 8e-9])
    np.testing.assert_array_equal(report.outside > 0, [False, False, True])
    with pytest.raises(InvalidValue, match="thickness"):
        geometry.validity(ROUND[0], 1e-9, 1e-9, thickness=0.0)
    with pytest.raises(InvalidValue, match="finite"):
        geometry.validity(ROUND[0], math.nan, 1e-9)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: f"{s.kind}-{s.sides}")
def test_stage_displacement_balances(shape: Shape) -> None:
    D = np.array([-1e-9, 0.0, 1e-12, 1e-9, 20e-9])
    found = geometry.stage_displacement(shape, D, 76.9e9, spring_constant=8.0, angle=0.2)
    np.testing.assert_allclose(found.indentation + math.cos(0.2) * found.deflection, np.maximum(D, 0), rtol=1e-13)
    np.testing.assert_allclose(8.0 * found.deflection, geometry.force(shape, found.indentation, 76.9e9), rtol=1e-13)
    assert math.isnan(geometry.stage_displacement(shape, math.nan, E, spring_constant=8.0).indentation)


def test_equation_8_is_what_its_docstring_says() -> None:
    """Erratum E8, silicon, R = 30 nm: 0.18 of the solution at 1 nm, 0.10 at 20 nm."""
    tip, D = Shape("paraboloid", radius=30e-9), np.array([1e-9, 20e-9])
    solved = geometry.stage_displacement(tip, D, 76.923e9, spring_constant=8.0).indentation
    ratio = geometry.stage_displacement_approximate(D, 30e-9, 76.923e9, spring_constant=8.0) / solved
    np.testing.assert_allclose(ratio, [0.18, 0.10], atol=0.01)


def test_which_theory() -> None:
    assert geometry.effective_radius(20e-9, 20e-9) == 10e-9
    assert geometry.effective_radius(20e-9, math.inf) == 20e-9
    atomic = contact.cohesive_stress_atomic(0.144, 0.2e-9)
    made = Contact(30e-9, 76.9e9, 0.144, cohesive_stress=atomic)
    mu = geometry.tabor_mu(made, 0.2e-9)
    assert made.maugis_lambda == pytest.approx(geometry.LAMBDA_PER_TABOR * mu, rel=1e-14)
    assert geometry.LAMBDA_PER_TABOR == pytest.approx(1.157, abs=5e-4)
    film = geometry.cohesive_stress_laplace(0.072, 1.06e-9)
    assert film == pytest.approx(geometry.cohesive_stress_of_range(0.144, 2.12e-9), rel=1e-14)


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        ({"kind": "wedge"}, "wedge"),
        ({"kind": "sphere", "radius": 2.0}, "radius"),
        ({"kind": "sphere", "radius": math.nan}, "radius"),
        ({"kind": "cone", "half_angle": 1.57}, "half_angle"),
        ({"kind": "cone", "half_angle": 0.5, "sides": 5}, "sides"),
        ({"kind": "blunted", "radius": 1e-8, "half_angle": 1.2, "transition": 1e-8}, "transition"),
    ],
)
def test_refusals_name_the_field(arguments: dict[str, object], names: str) -> None:
    with pytest.raises(InvalidValue, match=names):
        Shape(**arguments)  # type: ignore[arg-type]


def test_other_refusals() -> None:
    with pytest.raises(InvalidValue, match="effective_modulus"):
        geometry.force(ROUND[0], 1e-9, 0.0)
    with pytest.raises(InvalidValue, match="spring_constant"):
        geometry.stage_displacement(ROUND[0], 1e-9, E, spring_constant=0.0)
    with pytest.raises(InvalidValue, match="angle"):
        geometry.stage_displacement(ROUND[0], 1e-9, E, spring_constant=1.0, angle=2.0)
    with pytest.raises(InvalidValue, match="branch"):
        geometry.jkr(ROUND[0], 1e-9, E, work_of_adhesion=0.1, branch="sideways")  # type: ignore[arg-type]
