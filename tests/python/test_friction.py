# SPDX-License-Identifier: BSD-3-Clause
"""Friction beside its closed forms, scipy's integration and quadrature; what is refused."""

from __future__ import annotations

import nanotouch as nt
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad, solve_ivp

G, A, LOAD = 8e9, 2e-9, 10e-9


def friction() -> nt.Friction:
    return nt.Friction(G, lateral_compliance=0.02, shear_strength=50e6, coefficient=0.3)


def test_sticks_with_mindlin_and_the_lever() -> None:
    assert nt.friction.effective_shear_modulus(70e9, 0.25, 70e9, 0.25) == pytest.approx(G, rel=1e-14)
    assert friction().stiffness(A) == pytest.approx(1.0 / (1.0 / (8 * A * G) + 0.02), rel=1e-14)
    path = friction().run([0.0, 1e-12], 0.0, A, LOAD)
    assert path.force_x[1] == pytest.approx(-1e-12 * friction().stiffness(A), rel=1e-12)


def test_trace_and_retrace_make_a_loop() -> None:
    """Two limits wide; its area 2 F (stroke - 2 F/K) is the heat."""
    limit, stiffness, stroke = friction().limit(A, LOAD), friction().stiffness(A), 10e-9
    assert limit == pytest.approx(50e6 * np.pi * A**2 + 0.3 * LOAD, rel=1e-14)
    x = np.concatenate([np.linspace(0, stroke, 200), np.linspace(stroke, 0, 200), np.linspace(0, stroke, 200)])
    path = friction().run(x, 0.0, A, LOAD)
    assert path.force_x[399] - path.force_x[199] == pytest.approx(2 * limit, rel=1e-12)
    heat = path.dissipated[-1] - path.dissipated[199]
    assert heat == pytest.approx(2 * limit * (stroke - 2 * limit / stiffness), rel=1e-12)


def test_goes_on_from_a_state() -> None:
    x, y = np.linspace(0, 3e-9, 31), np.linspace(0, 1e-9, 31) ** 2 / 1e-9
    whole = friction().run(x, y, A, LOAD)
    first = friction().run(x[:11], y[:11], A, LOAD)
    second = friction().run(x[11:], y[11:], A, LOAD, state=first.state)
    np.testing.assert_array_equal(np.r_[first.force_y, second.force_y], whole.force_y)
    assert second.state == whole.state


def test_turns_round_a_corner_as_scipy_does() -> None:
    """On the circle dp/ds = K (n - (n.p) p/F^2), here with n along y after a slide along x."""
    limit, stiffness = friction().limit(A, LOAD), friction().stiffness(A)
    way = limit / stiffness
    solved = solve_ivp(
        lambda s, p: stiffness * (np.array([0.0, 1.0]) - p[1] * p / limit**2),
        (0.0, way), [limit, 0.0], rtol=1e-12, atol=1e-12 * limit,
    )  # fmt: skip
    path = friction().run([0.0, 1e-9, 1e-9], [0.0, 0.0, way], A, LOAD)
    assert (-path.force_x[-1], -path.force_y[-1]) == pytest.approx(tuple(solved.y[:, -1]), rel=1e-10)


points = st.tuples(st.floats(-5e-9, 5e-9), st.floats(-5e-9, 5e-9), st.floats(0, 5e-9), st.floats(0, 50e-9))


@settings(max_examples=200, deadline=None)
@given(st.lists(points, min_size=2, max_size=30))
def test_gives_no_energy(path: list[tuple[float, float, float, float]]) -> None:
    """stored + dissipated = work; the heat never falls. 1e-12 of the heat and work: some hundred roundings."""
    x, y, radius, load = np.array(path).T
    found = friction().run(x, y, radius, load)
    turnover = np.abs(np.diff(found.work, prepend=0.0)).sum()
    assert np.all(np.diff(found.dissipated) >= 0.0)
    np.testing.assert_allclose(found.stored + found.dissipated, found.work, rtol=0, atol=1e-12 * turnover + 1e-40)


@pytest.mark.parametrize("model", ["hertz", "dmt", "jkr", "maugis"])
def test_load_inside_is_the_positive_pressure(model: nt.contact.Model) -> None:
    """Beside scipy's quadrature of Maugis' pressure, JKR as p0 s - p1/s. 1e-8: where quad stops at the kink."""
    contact = nt.Contact(20e-9, 1e9, 0.05, 50e6)
    law = nt.contact.evaluate(model, np.array([0.5e-9, 1.5e-9]), contact)
    found = nt.friction.compressive_load(model, law, contact)
    for a, force, load in zip(law.a, law.F, found, strict=True):
        hertz = 4 / 3 * 1e9 * a**3 / 20e-9
        if model in ("hertz", "dmt"):
            assert load == pytest.approx(hertz, rel=1e-12)
            continue
        q = _zone(50e6, a, hertz - force) if model == "maugis" else 0.0

        def pressure(s: float, a: float = a, force: float = force, hertz: float = hertz, q: float = q) -> float:
            rim = 1e8 / np.pi * np.arctan(q / s) if q else (hertz - force) / (2 * np.pi * a**2) / s
            return float(s * max(1.5 * hertz / (np.pi * a**2) * s - rim, 0.0))

        assert load == pytest.approx(2 * np.pi * a**2 * quad(pressure, 1e-12, 1, limit=500)[0], rel=1e-7)
        assert load > max(force, 0.0)


def _zone(stress: float, a: float, pull: float) -> float:
    """q of a Dugdale zone from what it pulls, 2 sigma0 a^2 ((1 + q^2) arctan(q) + q)."""
    from scipy.optimize import brentq

    return float(brentq(lambda q: (1 + q * q) * np.arctan(q) + q - pull / (2 * stress * a * a), 0, 1e3, xtol=1e-14))


def test_corrugation_sticks_above_its_onset() -> None:
    lattice = nt.Corrugation(energy=6.4e-20, period=0.5e-9, stiffness=1.0)
    assert lattice.onset == pytest.approx(2 * np.pi**2 * 6.4e-20 / 0.25e-18, rel=1e-14)
    assert lattice.largest_force == pytest.approx(np.pi * 6.4e-20 / 0.5e-9, rel=1e-14)
    slow, quick = lattice.mean_force([1e-9, 1e-6])
    assert 0.5 * lattice.largest_force < slow < quick < lattice.largest_force
    warm = nt.Corrugation(6.4e-20, 0.5e-9, 1.0, temperature=298.0).mean_force([1e-9, 1e-8, 1e-7])
    assert np.all(np.diff(warm) > 0.0)
    assert warm[-1] < slow


def test_what_is_refused_is_told() -> None:
    lattice = nt.Corrugation(6.4e-20, 0.5e-9, 1.0, temperature=298.0)
    with pytest.raises(nt.errors.InvalidValue, match=r"speed = 1e-05 m/s: valid is"):
        lattice.mean_force(1e-5)
    with pytest.raises(nt.errors.InvalidValue, match=r"eta .* = 0.5.*: valid is 3 .. 20"):
        nt.Corrugation(6.4e-20, 0.5e-9, 10.0, temperature=298.0).mean_force(1e-9)
    with pytest.raises(nt.errors.InvalidValue, match=r"shear_strength = -1 Pa"):
        nt.Friction(1e9, shear_strength=-1.0)
    with pytest.raises(nt.errors.InvalidValue, match=r"radius = -1e-09 m"):
        friction().run([0.0, 1e-9], 0.0, [1e-9, -1e-9])
    with pytest.raises(nt.errors.InvalidValue, match="x has values"):
        friction().run([0.0, np.nan], 0.0, A)
    with pytest.raises(TypeError, match="masked"):
        friction().run(np.ma.masked_array([0.0], [True]), 0.0, A)
