# SPDX-License-Identifier: BSD-3-Clause
"""Contact laws from Python, in SI at the nanometre: closed forms, mpmath, energy, branches, refusals."""
# ruff: noqa: SIM300 (law.F is no constant)

from __future__ import annotations

import math
from typing import Any

import mpmath as mp
import nanotouch as nt
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nanotouch import contact
from nanotouch.contact import BRANCHES, MODELS, Branch, Contact, Model, evaluate
from nanotouch.errors import Error, InvalidValue

# silicon on silicon under water, as in the paper
R, E, W, H0 = 20e-9, 76.9e9, 0.144, 1.2e-9
SILICON = Contact(radius=R, effective_modulus=E, work_of_adhesion=W, cohesive_range=H0)

radii = st.floats(1e-9, 1e-6)
moduli = st.floats(1e5, 1e12)
works = st.floats(1e-4, 1.0)


@given(radii, moduli, st.floats(1e-3, 1.0))
def test_hertz_closed_form(radius: float, modulus: float, part: float) -> None:
    delta = part * radius
    law = evaluate("hertz", delta, Contact(radius, modulus))
    # three roundings and a sqrt: a few ulp
    assert law.F == pytest.approx(4 / 3 * modulus * math.sqrt(radius) * delta**1.5, rel=1e-14)
    assert law.k == pytest.approx(2 * modulus * math.sqrt(radius * delta), rel=1e-14)
    assert law.a == pytest.approx(math.sqrt(radius * delta), rel=1e-14)
    assert law.U == pytest.approx(8 / 15 * modulus * math.sqrt(radius) * delta**2.5, rel=1e-14)


@given(radii, moduli, works, st.floats(0.0, 1.0))
def test_dmt_is_hertz_shifted(radius: float, modulus: float, work: float, part: float) -> None:
    made = Contact(radius, modulus, work)
    hertz = contact.force("hertz", part * radius, made)
    pull_off = 2 * math.pi * radius * work
    assert contact.force("dmt", part * radius, made) == pytest.approx(hertz - pull_off, rel=1e-14, abs=1e-15 * pull_off)
    assert contact.pull_off_force("dmt", made) == pytest.approx(pull_off, rel=1e-15)


@pytest.mark.parametrize("model", MODELS)
def test_without_adhesion_every_model_is_hertz(model: Model) -> None:
    delta = np.linspace(-1e-9, 3e-9, 9)
    made = Contact(R, E)
    np.testing.assert_array_equal(evaluate(model, delta, made), evaluate("hertz", delta, made))
    assert contact.pull_off_force(model, made) == 0.0


def test_jkr_against_mpmath() -> None:
    """delta(a), P(a) of the textbook at 50 digits, solved for a at a given delta."""
    with mp.workdps(50):
        K = mp.mpf(4) / 3 * E
        for delta in (-0.05e-9, 0.0, 0.3e-9, 2e-9):  # the fold lies at -0.066 nm
            start = mp.sqrt(max(delta, 1e-10) * R)
            a = mp.findroot(lambda a, d=delta: a**2 / R - mp.sqrt(8 * mp.pi * W * a / (3 * K)) - d, start)
            P = K * a**3 / R - mp.sqrt(6 * mp.pi * W * K * a**3)
            law = evaluate("jkr", delta, SILICON)
            assert law.a == pytest.approx(float(a), rel=1e-12)  # solver's bound, away from the fold
            # the difference of two terms cancels up to 20-fold here
            assert law.F == pytest.approx(float(P), rel=1e-11)


def mpmath_maugis(delta: float, c_over_a: float) -> tuple[Any, Any, Any]:
    """a and P of the Maugis-Dugdale equations in their original m = c/a form, at 50 digits."""
    K = mp.mpf(4) / 3 * E
    lam = 2 * (mp.mpf(W) / H0) * mp.cbrt(R / (mp.pi * W * K**2))
    length, depth = mp.cbrt(mp.pi * W * R**2 / K), mp.cbrt((mp.pi * W) ** 2 * R / K**2)

    def equations(a: Any, m: Any) -> tuple[Any, Any]:
        root, sec = mp.sqrt(m * m - 1), mp.acos(1 / m)
        one = lam * a**2 / 2 * (root + (m * m - 2) * sec) + 4 * lam**2 * a / 3 * (root * sec - m + 1) - 1
        two = a**2 - 4 * lam * a * root / 3 - mp.mpf(delta) / depth
        return one, two

    a, m = mp.findroot(equations, (mp.mpf(R * max(delta, 1e-10)) ** 0.5 / length, mp.mpf(c_over_a)))
    P = a**3 - lam * a**2 * (mp.sqrt(m * m - 1) + m * m * mp.acos(1 / m))
    return a * length, P * mp.pi * W * R, m


@pytest.mark.parametrize("delta", [0.1e-9, 0.5e-9, 2e-9])
def test_maugis_against_mpmath(delta: float) -> None:
    with mp.workdps(50):
        a, P, m = mpmath_maugis(delta, 1.0 + 1e-9 / delta**0.5 / 1e4)
        assert m > 1  # the root that means something
        law = evaluate("maugis", delta, SILICON)
        assert law.a == pytest.approx(float(a), rel=1e-12)
        assert law.F == pytest.approx(float(P), rel=1e-12)


def test_maugis_lambda() -> None:
    K = 4 / 3 * E
    expected = 2 * (W / H0) * (R / (math.pi * W * K**2)) ** (1 / 3)
    assert SILICON.maugis_lambda == pytest.approx(expected, rel=1e-14)


def test_pull_off_runs_from_dmt_to_jkr() -> None:
    """2 pi w R for small lambda, 1.5 pi w R for large (published limits)."""
    small = Contact(R, E, W, cohesive_range=1e3 * H0)
    large = Contact(R, E, W, cohesive_range=1e-6 * H0)
    assert contact.pull_off_force("maugis", small) == pytest.approx(2 * math.pi * W * R, rel=1e-3)
    assert contact.pull_off_force("maugis", large) == pytest.approx(1.5 * math.pi * W * R, rel=1e-3)
    assert contact.pull_off_force("jkr", SILICON) == pytest.approx(1.5 * math.pi * W * R, rel=1e-15)


@pytest.mark.parametrize("model", MODELS)
@given(delta=st.floats(0.02e-9, 5e-9), logarithm=st.floats(-1.5, 2.0))
def test_force_is_the_derivative_of_energy(model: Model, delta: float, logarithm: float) -> None:
    made = Contact(R, E, W, cohesive_range=H0 * 10**-logarithm)
    step = 1e-4 * delta
    at = delta + step * np.array([-1.0, 0.0, 1.0])
    law = evaluate(model, at, made)
    scale = abs(law.F[1]) + contact.pull_off_force(model, made)
    energy_noise = 1e-15 * np.abs(law.U).max() / step  # rounding of U over the step
    # central differences: third derivative times step^2/6, below 1e-6 of the scale
    assert (law.U[2] - law.U[0]) / (2 * step) == pytest.approx(law.F[1], abs=1e-6 * scale + energy_noise)
    assert (law.F[2] - law.F[0]) / (2 * step) == pytest.approx(law.k[1], rel=1e-5)


@pytest.mark.parametrize("model", MODELS)
@given(delta=st.floats(0.02e-9, 5e-9))
def test_indentation_inverts_force(model: Model, delta: float) -> None:
    force = contact.force(model, delta, SILICON)
    # dF/F = 1e-15 of cancelling terms near zero force: in the indentation, over the stiffness
    assert contact.indentation(model, force, SILICON) == pytest.approx(delta, rel=1e-9)


@pytest.mark.parametrize("model", MODELS)
def test_indentation_beyond_pull_off_is_nan(model: Model) -> None:
    pull_off = contact.pull_off_force(model, SILICON)
    force = np.array([-1.0001, -2.0]) * (pull_off or 1e-9)
    assert np.isnan(contact.indentation(model, force, SILICON)).all()


SOFT = Contact(1e-6, 1e6, 0.05, cohesive_range=1e-9)  # lambda > 0.94: the branches differ


@pytest.mark.parametrize("model", ["jkr", "maugis"])
def test_branches(model: Model) -> None:
    """Retraction holds on where approach has not yet touched; between them lies the unstable equilibrium."""
    delta = -0.3 * (math.pi**2 * SOFT.work_of_adhesion**2 * SOFT.radius / (4 / 3 * SOFT.effective_modulus) ** 2) ** (
        1 / 3
    )
    stable, approach, unstable = (evaluate(model, delta, SOFT, branch) for branch in BRANCHES)
    assert stable.F < unstable.F < 0.0
    assert stable.U < unstable.U
    assert stable.a > unstable.a > 0.0
    assert approach.a == 0.0
    assert evaluate(model, 1e-7, SOFT, "approach") == evaluate(model, 1e-7, SOFT, "stable")
    assert np.isnan(evaluate(model, 1e-6, SOFT, "unstable").F)
    assert evaluate(model, -1e-5, SOFT, "stable").F == 0.0


@pytest.mark.parametrize("model", ["hertz", "dmt"])
def test_models_without_folds_have_no_unstable_branch(model: Model) -> None:
    assert np.isnan(evaluate(model, [1e-10, 1e-9], SILICON, "unstable")).all()


def test_effective_modulus() -> None:
    expected = 1 / (2 * (1 - 0.35**2) / 135e9)
    assert contact.effective_modulus(135e9, 0.35, 135e9, 0.35) == pytest.approx(expected, rel=1e-15)
    assert contact.effective_modulus(math.inf, 0.3, 1e9, 0.5) == pytest.approx(1e9 / 0.75, rel=1e-15)


def test_cohesive_stress_atomic() -> None:
    """Slope of the Lennard-Jones force at its steepest: 16/(9 sqrt 3) = 1.0264 (the paper's 1.03)."""
    assert contact.cohesive_stress_atomic(0.1, 0.2e-9) == pytest.approx(1.0264 * 0.1 / 0.2e-9, rel=1e-4)


def test_cone_and_punch() -> None:
    """Sneddon 1965."""
    delta, psi = 3e-9, 0.4
    cone = contact.cone(delta, E, psi)
    assert cone.F == pytest.approx(2 / math.pi * E * math.tan(psi) * delta**2, rel=1e-14)
    assert cone.a == pytest.approx(2 / math.pi * math.tan(psi) * delta, rel=1e-14)
    punch = contact.punch(delta, E, 5e-9)
    assert punch == pytest.approx((E * 5e-9 * delta**2, 2 * E * 5e-9 * delta, 2 * E * 5e-9, 5e-9), rel=1e-14)
    assert contact.cone(-1e-9, E, psi).F == contact.punch(-1e-9, E, 5e-9).F == 0.0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"radius": 0.0}, ["radius = 0 m", "1e-10"]),
        ({"radius": -1e-9}, ["radius = -1e-09 m"]),
        ({"radius": math.nan}, ["radius = nan m"]),
        ({"radius": 20.0}, ["radius = 20 m", ".. 1 m"]),
        ({"effective_modulus": math.inf}, ["effective_modulus = inf Pa"]),
        ({"work_of_adhesion": -0.1}, ["work_of_adhesion = -0.1 J/m^2", "0 .."]),
        ({"cohesive_range": 0.0}, ["cohesive_range = 0 m", "above 0 m"]),
        ({"cohesive_range": None, "cohesive_stress": -1.0}, ["cohesive_stress = -1 Pa"]),
        ({"cohesive_stress": 1e8}, ["cohesive_stress", "cohesive_range", "not both"]),
    ],
)
def test_bad_contacts_are_named(change: dict[str, Any], words: list[str]) -> None:
    values: dict[str, Any] = {"radius": R, "effective_modulus": E, "work_of_adhesion": W, "cohesive_range": H0} | change
    with pytest.raises(InvalidValue) as caught:
        Contact(**values)
    assert all(word in str(caught.value) for word in words), caught.value


@pytest.mark.parametrize(
    "call",
    [
        lambda: contact.force("hertzz", 0.0, SILICON),  # type: ignore[arg-type]
        lambda: contact.force("jkr", 0.0, SILICON, "up"),  # type: ignore[arg-type]
        lambda: contact.force("maugis", 0.0, Contact(R, E, W)),
        lambda: contact.cone(0.0, -1.0, 0.3),
        lambda: contact.cone(0.0, 1e9, 2.0),
        lambda: contact.cone(0.0, 1e9, math.nan),
        lambda: contact.punch(0.0, 1e9, 0.0),
        lambda: contact.effective_modulus(0.0, 0.3, 1e9, 0.3),
        lambda: contact.effective_modulus(1e9, 0.3, 1e9, 0.6),
        lambda: contact.cohesive_stress_atomic(0.1, 0.0),
    ],
)
def test_bad_arguments_are_refused(call: Any) -> None:
    with pytest.raises(InvalidValue):
        call()
    with pytest.raises(Error):
        call()
    with pytest.raises(ValueError, match=r"valid|must be|needs"):
        call()


def test_branch_names() -> None:
    branches: tuple[Branch, ...] = ("stable", "approach", "unstable")
    assert branches == BRANCHES
    assert nt.Contact is Contact
