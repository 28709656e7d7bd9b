# SPDX-License-Identifier: BSD-3-Clause
"""A layer bonded to rigid ground, in contact: against the integral equation of Lebedev and Ufliand (1958), solved apart
from the library, and the series of Dimitriadis et al. (2002)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from nanotouch import Scene
from nanotouch.errors import InvalidValue
from scipy.integrate import simpson

RADIUS, MODULUS = 1e-6, 1e6


class Contact(NamedTuple):
    """Of a rigid paraboloid on a layer, without other forces."""

    indentation: float
    force: float
    peak: float


def weights(x: np.ndarray) -> np.ndarray:
    """Simpson's, of an even grid."""
    return (x[1] - x[0]) / 3.0 * np.where(np.arange(len(x)) % 2, 4.0, 2.0 - np.isin(np.arange(len(x)), (0, len(x) - 1)))


def contact(a: float, thickness: float, nu: float) -> Contact:
    """q + int M q ds = E*(delta - t^2/R)/2 on 0 .. a by Nystroem's method; delta is where q(a) = 0. Under the apex the
    pressure is -2/pi int q'/t dt."""
    modulus = MODULUS / (1.0 - nu**2)
    k = np.linspace(0.0, 30.0, 3001)
    top = (3.0 - 4.0 * nu) * np.sinh(2.0 * k) - 2.0 * k
    bottom = (3.0 - 4.0 * nu) * np.cosh(2.0 * k) + 2.0 * k**2 + 5.0 - 12.0 * nu + 8.0 * nu**2
    y, w = np.polynomial.legendre.leggauss(40)
    t, w = np.append(0.5 * a * (1.0 + y), a), np.append(0.5 * a * w, 0.0)
    waves = np.cos(np.outer(t, k / thickness))
    missing, x = (top / bottom - 1.0) * 2.0 / np.pi, k / thickness
    M = simpson(waves[:, None, :] * waves[None, :, :] * missing, x=x)
    solved = np.linalg.solve(np.eye(len(t)) + M * w, np.stack([np.ones_like(t), -(t**2) / RADIUS], axis=1))
    delta = -solved[-1, 1] / solved[-1, 0]
    q = 0.5 * modulus * (delta * solved[:, 0] + solved[:, 1])
    steeper = np.sin(np.outer(t, x)) * x / t[:, None] @ (missing * (waves.T @ (w * q)) * weights(x))
    return Contact(delta, 4.0 * w @ q, 2.0 / np.pi * (w @ (modulus / RADIUS - steeper)))


def layered(thickness: float, nu: float) -> Scene:
    """Touched through a double layer that is hardly felt, but which makes the sample deform."""
    return Scene(
        tip={"radius": RADIUS, "youngs_modulus": 1e13, "surface_potential": -3e-3},
        sample={"youngs_modulus": MODULUS, "poisson_ratio": nu, "thickness": thickness, "surface_potential": -3e-3},
        medium={"kind": "liquid", "ionic_strength": 100.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        range={"maximum_load": 80e-9},
    )


def test_the_integral_equation_has_the_series_as_its_limit() -> None:
    """Where a/t is small. Their alpha is a fit: 0.5 % off what it stands for at these Poisson ratios, 6 % at 0."""
    for nu in (0.3, 0.5):
        alpha = -(1.2876 - 1.4678 * nu + 1.3442 * nu**2) / (1.0 - nu)
        found = contact(0.1e-6, 2e-6, nu)
        chi = np.sqrt(RADIUS * found.indentation) / 2e-6
        hertz = 4.0 / 3.0 * MODULUS / (1.0 - nu**2) * np.sqrt(RADIUS) * found.indentation**1.5
        first = -2.0 * alpha / np.pi * chi
        assert found.force / hertz == pytest.approx(1.0 + first + first**2, abs=0.006 * first + 2.0 * chi**3)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0, 3.0])
def test_contact_is_that_of_the_layer(nu: float, ratio: float) -> None:
    """Within what the double layer adds, which the integral equation does not know; a half-space is far off."""
    a = 0.2e-6
    scene = layered(a / ratio, nu)
    plan, truth = scene.plan(1e-3), contact(a, a / ratio, nu)
    scene.sample.thickness = 0.0
    half = scene.plan(1e-3)
    assert plan.explain()["deforms"]
    assert truth.force < 80e-9
    assert not any("half-space" in warning.text for warning in plan.warnings)
    assert plan.force(-truth.indentation) == pytest.approx(truth.force, rel=5e-3)
    assert half.force(-truth.indentation) < (1.0 - 0.05 * min(ratio / 0.1, 10.0)) * truth.force


@pytest.mark.parametrize("adhesion", [0.0, 1e-4])
def test_a_layer_that_is_not_solved_is_warned_of(adhesion: float) -> None:
    """Hertz' contact and one with adhesion are those of a half-space: what that errs by is warned of if felt."""
    scene = layered(1e-6, 0.3)
    scene.tip.surface_potential = scene.sample.surface_potential = 0.0
    scene.adhesion.work_of_adhesion = adhesion
    said = [warning for warning in scene.plan(1e-2).warnings if "layer taken for a half-space" in warning.text]
    assert len(said) == 1
    if adhesion == 0.0:
        truth, half = contact(0.3e-6, 1e-6, 0.3), 4.0 / 3.0 * MODULUS / 0.91 * np.sqrt(RADIUS)
        more = said[0].value * 0.3e-6 / np.sqrt(RADIUS * float(scene.plan(1e-2).explain()["largest_indentation"]))
        assert truth.force / (half * truth.indentation**1.5) - 1.0 == pytest.approx(more, rel=0.25)
    scene.sample.thickness = 1e-3
    assert not any("half-space" in warning.text for warning in scene.plan(1e-2).warnings)


def test_the_peak_grows_from_hertz_to_that_of_a_thin_layer() -> None:
    """1.5 times the mean on a half-space; on a thin layer (1 - r^2/a^2)^2 has 3 times it where the layer keeps its
    volume, and 1 - r^2/a^2 twice where it does not (Johnson 1985, Sec. 5.8)."""
    for ratio, nu, least, most in (
        (0.02, 0.3, 1.499, 1.501),
        (4.0, 0.5, 2.0, 2.3),
        (12.0, 0.5, 2.4, 3.0),
        (8.0, 0.0, 1.85, 2.0),
    ):
        found = contact(1e-6, 1e-6 / ratio, nu)
        assert least < found.peak * np.pi * 1e-12 / found.force < most


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
@pytest.mark.parametrize("ratio", [0.1, 1.0, 3.0])
def test_a_layer_yields_from_its_own_peak_pressure(nu: float, ratio: float) -> None:
    """Warned of at 1.6 Y under the apex; refused where the mean is 3 Y, which is less than two thirds of the peak."""
    truth = contact(0.2e-6, 0.2e-6 / ratio, nu)
    scene = layered(0.2e-6 / ratio, nu)
    scene.tip.surface_potential = scene.sample.surface_potential = -1.5e-3  # adds 0.7 kPa where the bodies touch
    scene.range.maximum_load = truth.force
    scene.sample.yield_strength = 0.98 * truth.peak / 1.6
    (told,) = [w for w in scene.plan(1e-3).warnings if "where the sample begins to yield" in w.text]
    assert told.value == pytest.approx(truth.peak, rel=1e-2)
    scene.sample.yield_strength = 1.02 * truth.peak / 1.6
    assert not [w for w in scene.plan(1e-3).warnings if "begins to yield" in w.text]
    mean = truth.force / (np.pi * 0.04e-12)
    scene.sample.yield_strength = 1.03 * mean / 3.0
    scene.plan(1e-3)
    scene.sample.yield_strength = 0.97 * mean / 3.0
    with pytest.raises(InvalidValue, match="mean pressure above 3 times the yield strength of the sample"):
        scene.plan(1e-3)
