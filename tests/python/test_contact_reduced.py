# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch.contact.reduced against Maugis' printed equations, published limits and itself in other tiers."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mpmath import acos, acot, findroot, mp, mpf, sqrt
from nanotouch.contact import reduced
from nanotouch.errors import InvalidValue

LAMBDAS = [1e-6, 0.01, 0.3, 0.9, 1.0, 5.8, 1e3, 1e9]


def printed(lam: float, m: str) -> tuple[float, float, float]:
    """a, P, d of Maugis (1992) at m = c/a; 60 digits."""
    with mp.workdps(60):
        lam_, m_ = mpf(lam), mpf(m)
        root, angle = sqrt(m_ * m_ - 1), acos(1 / m_)
        square = lam_ / 2 * (root + (m_ * m_ - 2) * angle)
        linear = mpf(4) / 3 * lam_**2 * (root * angle - m_ + 1)
        a = 2 / (linear + sqrt(linear**2 + 4 * square))
        return (
            float(a),
            float(a**3 - lam_ * a**2 * (root + m_ * m_ * angle)),
            float(a**2 - mpf(4) / 3 * lam_ * a * root),
        )


@pytest.mark.parametrize("lam", [0.01, 0.3, 0.95, 2.0, 5.8, 40.0])
def test_printed_equations(lam: float) -> None:
    for m in ("1.001", "1.01", "1.1", "1.5", "2", "3"):
        a, P, d = printed(lam, m)
        at = reduced.at_radius(lam, a)
        # a double of a and one of d: some roundings each
        assert at.load == pytest.approx(P, rel=1e-12, abs=1e-13)
        assert at.indentation == pytest.approx(d, rel=1e-12, abs=1e-13)
        if a > 1.2 * max(reduced.folds(lam).pull_off_radius, 0.3):
            assert reduced.force(lam, d) == pytest.approx(P, rel=1e-12, abs=1e-12)
            assert reduced.radius(lam, d) == pytest.approx(a, rel=1e-12)
            assert reduced.indentation(lam, P) == pytest.approx(d, rel=1e-12, abs=1e-12)


def test_exact_load_is_right_to_8_ulp() -> None:
    """Of the larger of load and pull-off load, on the stable contact branch from its start on, from DMT to JKR."""
    rng = np.random.default_rng(5)
    for _ in range(150):
        lam = 10 ** rng.uniform(-3.0, 3.0)
        folds = reduced.folds(lam)
        start = folds.grip_indentation if folds.grip_kind == "contact" else reduced.at_radius(lam, 0.0).indentation
        d = float(start + 10 ** rng.uniform(-2.0, 2.5))
        state = reduced.evaluate(lam, d)
        with mp.workdps(40):

            def branch(y: Any, lam_: float = lam) -> tuple[Any, Any]:
                t = acot(y)
                square, linear = lam_ / 2 * (y + (1 - y * y) * t), mpf(4) / 3 * lam_**2 * (t - sqrt(1 + y * y) + y)
                b = 2 / (linear + sqrt(linear**2 + 4 * square))
                return (b * y) ** 2 - mpf(4) / 3 * lam_ * b, (b * y) ** 3 - lam_ * b * b * (y + (1 + y * y) * t)

            a = mpf(state.radius)
            y = findroot(lambda y, d=d: branch(y)[0] - d, a / ((a * a - d) * 3 / (4 * mpf(lam))), tol=1e-40)
            error = abs(mpf(state.load) - branch(y)[1]) / max(abs(branch(y)[1]), mpf(1.5))
        assert error < 8 * 2.0**-52


def test_folds_from_dmt_to_jkr() -> None:
    folds = reduced.folds(LAMBDAS)
    assert folds.pull_off_load[0] == pytest.approx(-2.0, abs=1e-8)
    assert folds.pull_off_load[-1] == pytest.approx(-1.5, abs=1e-15)
    assert folds.pull_off_radius[-1] == pytest.approx(1.5 ** (1 / 3), rel=1e-12)
    assert folds.grip_load[-1] == pytest.approx(-5 / 6, rel=1e-12)
    assert folds.grip_indentation[-1] == pytest.approx(-3 * 6 ** (-2 / 3), rel=1e-14)
    assert folds.zero_load_radius[-1] == pytest.approx(6 ** (1 / 3), rel=1e-14)
    assert list(folds.grip_kind) == ["non-contact"] * 4 + ["contact"] * 4
    one = reduced.folds(1.0)
    assert one.grip_kind == "contact"
    assert isinstance(one.pull_off_load, float)
    # independent of the library, 110 digits
    assert one.pull_off_load == pytest.approx(-1.600734911, abs=1e-9)
    assert one.grip_indentation == pytest.approx(-0.991725, abs=1e-6)
    assert one.zero_load_radius == pytest.approx(1.636090, abs=1e-6)
    assert one.zero_load_indentation == pytest.approx(1.129894, abs=1e-6)


@pytest.mark.parametrize("lam", LAMBDAS)
def test_folds_are_where_the_branches_turn(lam: float) -> None:
    folds = reduced.folds(lam)
    assert reduced.indentation(lam, folds.pull_off_load) == pytest.approx(folds.pull_off_indentation, abs=1e-7)
    assert math.isnan(reduced.indentation(lam, folds.pull_off_load * (1 + 1e-14)))
    assert reduced.force(lam, folds.zero_load_indentation) == pytest.approx(0.0, abs=1e-13)
    below = folds.grip_indentation * (1 + 1e-12)
    assert reduced.force(lam, below) == 0.0
    assert reduced.force(lam, folds.grip_indentation) == pytest.approx(folds.grip_load, abs=1e-6)


def test_branches() -> None:
    lam, onset = 0.3, -2 / (np.pi * 0.3)
    grip = reduced.folds(lam).grip_indentation
    between = 0.5 * (grip + onset)
    assert reduced.force(lam, between, "approach") == 0.0
    assert reduced.force(lam, between) < reduced.force(lam, between, "unstable") < 0.0
    assert reduced.radius(lam, between) == 0.0
    assert reduced.stiffness(lam, between) < 0.0 < reduced.stiffness(lam, between, "unstable")
    assert math.isnan(reduced.force(lam, 1.0, "unstable"))
    with pytest.raises(InvalidValue, match="valid are stable, approach, unstable"):
        reduced.force(lam, 0.0, "sideways")  # type: ignore[arg-type]


@pytest.mark.parametrize(("tier", "bound"), [("table", 1.5e-6), ("polished", 1e-13)])
def test_tiers(tier: reduced.Tier, bound: float) -> None:
    d = np.linspace(-3.0, 40.0, 3001)
    for lam in LAMBDAS:
        exact, value = reduced.evaluate(lam, d), reduced.evaluate(lam, d, tier=tier)
        scale = np.maximum(np.abs(exact.load), 1.5)
        # next to a fold one rounding of d, 1e-16 d, is k times that in the load
        error = np.abs(value.load - exact.load) - 1e-15 * np.abs(exact.stiffness * d)
        assert np.max(error / scale) < bound
        assert np.max(np.abs(value.energy - exact.energy) / (1 + np.abs(exact.energy))) < 2 * bound
        assert np.max(np.abs(value.radius - exact.radius)) < 100 * bound
        assert np.array_equal(reduced.force(lam, d, tier="table"), reduced.evaluate(lam, d, tier="table").load)
    with pytest.raises(InvalidValue, match="valid are table, polished, exact"):
        reduced.force(1.0, 0.0, tier="fast")  # type: ignore[arg-type]


@pytest.mark.parametrize("tier", reduced.TIERS)
def test_broadcasting(tier: reduced.Tier) -> None:
    lam = np.array([[5.8], [0.1], [5.8], [1.0]])
    d = np.linspace(-0.4, 5.0, 7)
    table = reduced.force(lam, d, tier=tier)
    assert table.shape == (4, 7)
    for i, row in enumerate(table):
        assert np.array_equal(row, reduced.force(float(lam[i, 0]), d, tier=tier))
    assert reduced.radius(lam, d, tier=tier).shape == (4, 7)
    assert reduced.at_radius(lam, np.ones(2)).load.shape == (4, 2)
    assert reduced.folds(lam).pull_off_load.shape == (4, 1)
    assert reduced.force(lam, np.empty((4, 0))).shape == (4, 0)
    assert isinstance(reduced.force(1.0, 2.0, tier=tier), float)
    assert reduced.indentation([0.1, 5.8], 1.0).shape == (2,)


@pytest.mark.parametrize("tier", reduced.TIERS)
def test_bad_values(tier: reduced.Tier) -> None:
    many = np.full(500, np.nan)
    assert np.isnan(reduced.force(1.0, many, tier=tier)).all()
    assert np.isnan(reduced.force([1.0, np.nan], 0.5, tier=tier)).tolist() == [False, True]
    assert np.isnan(reduced.folds(np.nan).pull_off_load)
    assert reduced.folds(np.nan).grip_kind == ""
    assert np.isnan(reduced.at_radius(1.0, -1.0).load)
    with pytest.raises(InvalidValue, match="lam = -1: valid is 1e-15"):
        reduced.force(-1.0, 0.0, tier=tier)
    with pytest.raises(TypeError, match="masked"):
        reduced.force(1.0, np.ma.masked_array([1.0]))


def test_out() -> None:
    d = np.linspace(-1.0, 9.0, 4000).reshape(40, 100)
    out = np.empty_like(d)
    assert reduced.force(2.0, d, tier="table", out=out) is out
    assert np.array_equal(out, reduced.force(2.0, d, tier="table"))
    turned = np.empty((100, 40)).T  # any array that numpy lets a ufunc write to
    assert np.array_equal(reduced.force(2.0, d, tier="table", out=turned), out)
    with pytest.raises(ValueError, match="broadcast"):
        reduced.force(2.0, d, out=np.empty(3))
    with pytest.raises(TypeError, match="int64"):
        reduced.force(2.0, d, out=np.empty(d.shape, np.int64))


@given(st.floats(1e-6, 1e6), st.floats(0.0, 1e4))
def test_inverse_and_slope(lam: float, step: float) -> None:
    d = reduced.folds(lam).zero_load_indentation + step
    state = reduced.evaluate(lam, d)
    assert reduced.indentation(lam, state.load) == pytest.approx(d, rel=1e-13)
    assert reduced.at_radius(lam, state.radius).indentation == pytest.approx(d, rel=1e-12)
    h = 1e-5 * (1 + d)
    slope = (reduced.force(lam, d + h) - reduced.force(lam, d - h)) / (2 * h)
    assert state.stiffness == pytest.approx(slope, rel=1e-7)


def test_same_as_si() -> None:
    contact = nt.Contact(radius=20e-9, effective_modulus=77e9, work_of_adhesion=0.144, cohesive_range=0.2e-9)
    K, w, R = 4 / 3 * 77e9, 0.144, 20e-9
    d = np.linspace(-1e-9, 5e-9, 50)
    in_si = nt.contact.force("maugis", d, contact)
    unit = (np.pi**2 * w**2 * R / K**2) ** (1 / 3)
    assert in_si == pytest.approx(np.pi * w * R * reduced.force(contact.maugis_lambda, d / unit), rel=1e-11, abs=1e-20)
    assert nt.contact.reduced is reduced
