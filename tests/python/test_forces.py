# SPDX-License-Identifier: BSD-3-Clause
"""Forces without contact from Python: closed forms, Fig. 6 of the paper with its errata, energy, refusals."""
# ruff: noqa: SIM300 (law.F is no constant)

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from nanotouch import forces
from nanotouch.errors import InvalidValue

# Fig. 6
R, H, A0, FILM, MENISCUS, TENSION, POTENTIAL = 30e-9, 2.03e-19, 1.98e-10, 5e-9, 1.06e-9, 0.072, 0.25
EPSILON_0 = 8.8541878128e-12


def vdw(gap: Any) -> Any:
    return forces.vdw(gap, radius=R, hamaker_constant=H, minimum_gap=A0)


def capillary(gap: Any) -> Any:
    return forces.capillary(gap, radius=R, surface_tension=TENSION, meniscus_radius=MENISCUS, film_thickness=FILM)


def electrostatic(gap: Any) -> Any:
    return forces.electrostatic(gap, radius=R, potential=POTENTIAL, minimum_gap=A0)


@given(st.floats(0.2e-9, 1e-6))
def test_vdw_closed_form(gap: float) -> None:
    assert vdw(gap).F == pytest.approx(-2 * H * R**3 / (3 * gap**2 * (gap + 2 * R) ** 2), rel=1e-13)


def test_vdw_is_derjaguin_close_by() -> None:
    """-HR/(6 h^2), too strong by h/R for h << R."""
    assert vdw(0.3e-9).F == pytest.approx(-H * R / (6 * 0.3e-9**2), rel=0.3e-9 / R * 1.05)


def test_vdw_holds_below_the_minimum_gap() -> None:
    assert vdw(0.0).F == vdw(-1e-9).F == vdw(A0).F


def test_vdw_roughness_moves_the_surface_away() -> None:
    rough = forces.vdw(1e-9, radius=R, hamaker_constant=H, roughness=0.6e-9, minimum_gap=A0)
    assert rough.F == pytest.approx(vdw(1.3e-9).F, rel=1e-14)


@given(st.floats(0.2e-9, 1e-6))
def test_electrostatic_closed_form(gap: float) -> None:
    expected = -math.pi * EPSILON_0 * POTENTIAL**2 * R**2 / (gap * (gap + R))
    assert electrostatic(gap).F == pytest.approx(expected, rel=1e-9)  # digits of eps0 (CODATA 2018 and 2022)


def test_capillary_bracket_is_held() -> None:
    """4 pi gamma R up to the films' touch, nothing beyond the bridge: never repulsive (erratum E3)."""
    full = 4 * math.pi * TENSION * R
    np.testing.assert_allclose(capillary([-1e-9, 0.0, 2 * FILM]).F, -full, rtol=1e-14)
    assert capillary(2 * FILM + MENISCUS).F == pytest.approx(-full / 2, rel=1e-12)
    np.testing.assert_array_equal(capillary([2 * FILM + 2.001 * MENISCUS, 15e-9, 40e-9]).F, 0.0)


def test_figure_6() -> None:
    """Capillary > van der Waals > electrostatic below 12 nm, as the paper's text says."""
    gap = np.array([0.3e-9, 1e-9, 5e-9, 11e-9])
    assert (capillary(gap).F < vdw(gap).F).all()
    assert (vdw(gap).F < electrostatic(gap).F).all()
    assert (electrostatic(gap).F < 0.0).all()


@pytest.mark.parametrize("law", [vdw, capillary, electrostatic])
@given(gap=st.floats(0.25e-9, 60e-9))
def test_force_and_stiffness_are_derivatives(law: Callable[[Any], Any], gap: float) -> None:
    """F = -dU/dh and k = -dF/dh, by central differences: the third derivative leaves some 1e-7, a kink more."""
    step = 1e-4 * gap
    around = law(gap + step * np.array([-1.0, 0.0, 1.0]))
    if law is capillary and any(abs(gap - kink) <= step for kink in (2 * FILM, 2 * FILM + 2 * MENISCUS)):
        return
    noise = 4e-16 * np.abs(around.U).max() / step
    assert -(around.U[2] - around.U[0]) / (2 * step) == pytest.approx(around.F[1], rel=1e-6, abs=noise)
    noise = 4e-16 * np.abs(around.F).max() / step
    assert -(around.F[2] - around.F[0]) / (2 * step) == pytest.approx(around.k[1], rel=1e-6, abs=noise)
    np.testing.assert_array_equal(around.a, 0.0)


def test_kelvin_radius() -> None:
    """gamma V/(R T ln(1/RH)): 1.06 nm at 61 %, the r1 of Fig. 6 (erratum E4); 0.52 nm V/T's own at 1/e."""
    assert forces.kelvin_radius(0.61) == pytest.approx(1.06e-9, rel=0.01)
    expected = 0.072 * 1.8e-5 / (8.31446261815324 * 298.15)
    assert forces.kelvin_radius(math.exp(-1.0)) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("humidity", [0.0, 1.0, 40.0, -0.1, math.nan])
def test_humidity_out_of_range(humidity: float) -> None:
    with pytest.raises(InvalidValue, match=r"relative_humidity = .*between 0 and 1"):
        forces.kelvin_radius(humidity)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: forces.vdw(0.0, radius=-1.0, hamaker_constant=H), "radius = -1 m"),
        (lambda: forces.vdw(0.0, radius=R, hamaker_constant=math.nan), "hamaker_constant = nan J"),
        (lambda: forces.vdw(0.0, radius=R, hamaker_constant=H, minimum_gap=0.0), "minimum_gap = 0 m"),
        (lambda: forces.capillary(0.0, radius=R, meniscus_radius=0.0), "meniscus_radius = 0 m"),
        (lambda: forces.capillary(0.0, radius=R, meniscus_radius=1e-9, film_thickness=-1.0), "film_thickness = -1 m"),
        (lambda: forces.electrostatic(0.0, radius=R, potential=math.inf), "potential = inf V"),
    ],
)
def test_bad_parameters_are_named(call: Callable[[], Any], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        call()
