# SPDX-License-Identifier: BSD-3-Clause
"""Derivatives of the force by every parameter: against mpmath's of the printed equations, and against limits."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from mpmath import acot, cbrt, findroot, mp, mpf, pi, sqrt
from nanotouch import contact, ufuncs
from nanotouch.contact import Contact

R, E, W = 20e-9, 5e6, 0.05
CASES = [*itertools.product([0.01, 0.3, 1.0, 5.8, 100.0], [-0.3, 0.1, 2.0, 50.0, 1e5])]  # lambda, depth


def jkr_force(indentation: Any, radius: Any, modulus: Any, work: Any, *, start: float) -> Any:
    """The textbook, a found at the indentation."""
    K = 4 * modulus / 3
    a = findroot(lambda a: a**2 / radius - sqrt(8 * pi * work * a / (3 * K)) - indentation, mpf(start))
    return K * a**3 / radius - sqrt(6 * pi * work * K * a**3)


def maugis_force(indentation: Any, radius: Any, modulus: Any, work: Any, stress: Any, *, start: float) -> Any:
    """Maugis (1992) with y = a/sqrt(c^2 - a^2), found at the indentation; a = 0 and less: the non-contact branch."""
    K = 4 * modulus / 3
    lam = 2 * stress * cbrt(radius / (pi * work * K**2))
    unit = cbrt((pi * work) ** 2 * radius / K**2)
    if start == 0.0:
        fold = 8 * lam / (3 * pi)
        c = fold + sqrt(fold**2 + 2 * (indentation / unit + 2 / (pi * lam)))
        return -pi / 2 * lam * c**2 * pi * work * radius

    def branch(y: Any) -> tuple[Any, Any]:
        t = acot(y)
        square, linear = lam / 2 * (y + (1 - y * y) * t), 4 * lam**2 / 3 * (t - sqrt(1 + y * y) + y)
        b = 2 / (linear + sqrt(linear**2 + 4 * square))
        return b * b * y * y - 4 * lam * b / 3, (b * y) ** 3 - lam * b * b * (y + (1 + y * y) * t)

    y = findroot(lambda y: branch(y)[0] - indentation / unit, mpf(start))
    return branch(y)[1] * pi * work * radius


def differences(force: Callable[..., Any], at: tuple[float, ...]) -> list[float]:
    """Central differences at 50 digits: their own error is of the order of 1e-24."""
    found = []
    for i, value in enumerate(at):
        step = abs(mpf(value)) * mpf(10) ** -12
        above, below = ([*map(mpf, at[:i]), mpf(value) + sign * step, *map(mpf, at[i + 1 :])] for sign in (1, -1))
        found.append(float((force(*above) - force(*below)) / (2 * step)))
    return found


def assert_gradient(found: Any, expected: list[float], at: tuple[float, ...], scale: float) -> None:
    """Each derivative to 1e-10 of itself, or, where it is small, times its parameter to 1e-13 of the force."""
    for one, exact, value in zip(found, expected, at, strict=True):
        assert abs(one - exact) < 1e-10 * abs(exact) + 1e-13 * scale / abs(value)


@pytest.mark.parametrize("depth", [-9e-9, -1e-9, 2e-9, 30e-9, 5e-7])
def test_jkr_against_mpmath(depth: float) -> None:
    at = (depth, R, E, W)
    law = contact.evaluate("jkr", depth, Contact(R, E, W))
    with mp.workdps(50):
        expected = differences(lambda *values: jkr_force(*values, start=law.a), at)
    for one, exact in zip(ufuncs.jkr_gradient(*at), expected, strict=True):
        assert one == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize(("lam", "depth"), CASES)
def test_maugis_against_mpmath(lam: float, depth: float) -> None:
    K = 4 / 3 * E
    stress, unit = lam / 2 * np.cbrt(np.pi * W * K**2 / R), np.cbrt((np.pi * W) ** 2 * R / K**2)
    at = (depth * unit, R, E, W, float(stress))
    law = contact.evaluate("maugis", at[0], Contact(R, E, W, at[4]))
    length = np.cbrt(np.pi * W * R**2 / K)
    a = law.a / length
    y = a / (3 / (4 * lam) * (a * a - depth))
    with mp.workdps(50):
        expected = differences(lambda *values: maugis_force(*values, start=y), at)
    assert_gradient(ufuncs.maugis_gradient(*at), expected, at, max(abs(law.F), np.pi * W * R))


def test_unstable_branch_by_differences() -> None:
    """No printed form is needed: the force itself is tested, and its difference over 1e-6 is right to 1e-9."""
    made = Contact(R, E, W, 1e8)
    depth = 0.8 * made.law("maugis").grip_indentation
    at = np.array([depth, R, E, W, 1e8])
    for model, count in (("jkr", 4), ("maugis", 5)):
        over, gradient = getattr(ufuncs, f"{model}_force_unstable"), getattr(ufuncs, f"{model}_gradient_unstable")
        found = gradient(*at[:count])
        for i in range(count):
            step = np.zeros(count)
            step[i] = 1e-6 * at[i]
            slope = (over(*(at[:count] + step)) - over(*(at[:count] - step))) / (2 * step[i])
            assert found[i] == pytest.approx(slope, rel=1e-6, abs=1e-7 * np.pi * W * R / abs(at[i]))


def test_closed_forms() -> None:
    depth = np.array([-1e-9, 1e-9, 20e-9])
    hertz = np.maximum(4 / 3 * E * np.sqrt(R) * np.abs(depth) ** 1.5 * (depth > 0), 0.0)
    got = contact.gradient("hertz", depth, Contact(R, E))
    np.testing.assert_allclose(got.radius, hertz / (2 * R), rtol=1e-14)
    np.testing.assert_allclose(got.effective_modulus, hertz / E, rtol=1e-14)
    assert (got.work_of_adhesion == 0.0).all()
    assert (got.cohesive_stress == 0.0).all()
    dmt = contact.gradient("dmt", depth, Contact(R, E, W))
    np.testing.assert_allclose(dmt.work_of_adhesion, -2 * np.pi * R * (depth >= 0.0), rtol=1e-14)
    np.testing.assert_allclose(dmt.radius, hertz / (2 * R) - 2 * np.pi * W * (depth >= 0.0), rtol=1e-14)


@pytest.mark.parametrize("model", ["jkr", "maugis"])
def test_no_adhesion_is_the_limit_of_little(model: Any) -> None:
    """w to 0: JKR's force is Hertz less pi w R, to the next order, which is sqrt(w) smaller."""
    depths = np.array([-1e-9, 0.0, 20e-9])
    none = contact.gradient(model, depths, Contact(R, E, 0.0, 1e9))
    np.testing.assert_allclose(none.work_of_adhesion, [0.0, -4 / 3 * np.pi * R, -np.pi * R], rtol=1e-14)
    for work in (1e-12, 1e-13, 1.3e-14, 1e-14, 9e-15):  # of Hertz' force 1e-13 is left
        little = contact.gradient(model, depths, Contact(R, E, work, 1e9)).work_of_adhesion
        np.testing.assert_allclose(little, none.work_of_adhesion, rtol=3.0 * np.sqrt(work))


def test_shapes_and_what_does_not_exist() -> None:
    made = Contact(R, E, W, 1e7)
    assert isinstance(contact.gradient("maugis", 1e-9, made).cohesive_stress, float)
    assert contact.gradient("jkr", np.ones((2, 3)) * 1e-9, made).radius.shape == (2, 3)
    assert np.isnan(contact.gradient("jkr", [1e-6, np.nan], made, "unstable").radius).all()
    assert set(contact.gradient("maugis", -1e-6, made)) == {0.0}
    by_radius = ufuncs.dmt_gradient(1e-9, R * np.array([1.0, 2.0]), E, W)[1]
    assert by_radius[1] == contact.gradient("dmt", 1e-9, Contact(2 * R, E, W)).radius
    with pytest.raises(nt.errors.InvalidValue, match="radius = -1 m"):
        ufuncs.jkr_gradient(1e-9, -1.0, E, W)
