# SPDX-License-Identifier: BSD-3-Clause
"""Sphere, three-sided pyramid and layers against laws of their own: ``layer_oracle.py``."""

from __future__ import annotations

import layer_oracle as oracle
import nanotouch as nt
import numpy as np
import pytest
from nanotouch import _fit
from nanotouch.errors import InvalidValue

E, R, T, ANGLE = 3e3, 2.5e-6, 2e-6, 0.6
SHAPES = {"sphere": (R, 1e-6), "pyramid3": (ANGLE, 8e-6), "layer": (R, 5e-4), "layer_cone": (ANGLE, 6e-4)}


def law_of(model: str, depth: np.ndarray, thickness: float = T) -> np.ndarray:
    """The library's force at indentations."""
    options = _fit.Options(model)
    options.radius, options.half_angle = R, ANGLE
    value = np.full(8, np.nan)
    value[[0, 4, 5, 6, 7]] = E, 0.0, 0.0, 0.0, 1.0
    if model.startswith("layer"):
        value[3] = thickness
    force, _, held = _fit.evaluate(options, value, depth)
    assert held.all()
    return np.asarray(force)


@pytest.mark.parametrize("model", SHAPES)
def test_law(model: str) -> None:
    size, tolerance = SHAPES[model]
    depth = np.linspace(0.005, 1.0, 60) * (1.3e-6 if model == "layer" else 3e-6 if model == "layer_cone" else R)
    assert law_of(model, depth) == pytest.approx(oracle.force(model, depth, E, size, T), rel=tolerance)


@pytest.mark.parametrize(("model", "thick"), [("layer", "hertz"), ("layer_cone", "cone")])
def test_thick_layer_is_a_half_space(model: str, thick: str) -> None:
    depth = np.linspace(1e-8, 1e-6, 20)
    assert law_of(model, depth, 1.0) == pytest.approx(law_of(thick, depth), rel=1e-5)


def test_published_series() -> None:
    """Garcia and Garcia 2018 and Dimitriadis 2002 against the integral equation (docs/evidence/fit.md)."""
    depth = np.geomspace(1e-3, 0.6**2, 40)  # R = t = 1: a = 0.8 t
    q = np.sqrt(depth)
    exact = oracle.force("layer", depth, 1.0, 1.0, 1.0) / (4.0 / 3.0 * depth**1.5)
    garcia = 1 + 1.133 * q + 1.497 * q**2 + 1.469 * q**3 + 0.755 * q**4
    dimitriadis = 1 + 1.133 * q + 1.283 * q**2 + 0.769 * q**3 + 0.0975 * q**4
    assert garcia == pytest.approx(exact, rel=0.02)
    assert dimitriadis[q < 0.26] == pytest.approx(exact[q < 0.26], rel=0.02)
    assert dimitriadis[-1] < 0.9 * exact[-1]


@pytest.mark.parametrize("model", SHAPES)
@pytest.mark.parametrize("seed", range(3))
def test_curve_comes_back(model: str, seed: int) -> None:
    size, _ = SHAPES[model]
    rng = np.random.default_rng(seed)
    depth = 0.5e-6 if model in ("sphere", "layer") else 1e-6
    noise = 1e-11 * rng.standard_normal(3000)
    curve = oracle.measured(lambda d: oracle.force(model, d, E, size, T), 0.05, depth, rng, (1.0, 1.0), noise)
    tip = {"half_angle": ANGLE} if model in ("pyramid3", "layer_cone") else {"radius": R}
    layer = {"thickness": T, "poisson_ratio": 0.5} if model.startswith("layer") else {}
    exact = nt.fit.Uncertainties(sensitivity=0.0)
    result = nt.fit.fit_curve(curve, model, uncertainties=exact, **tip, **layer)
    assert result.status == "ok"
    assert abs(result.values["effective_modulus"] - E) < 4.0 * result.sigma["effective_modulus"] + 1e-3 * E
    assert result.sigma["effective_modulus"] < 0.05 * E
    if layer:
        assert result.values["youngs_modulus"] == pytest.approx(0.75 * result.values["effective_modulus"])
        assert nt.fit.fit_curve(curve, uncertainties=exact, **tip, **layer, model="auto").model == model


def test_uncertain_thickness() -> None:
    """sigma_calibration is what refitting with another thickness does."""
    rng = np.random.default_rng(1)
    law = lambda d: oracle.force("layer", d, E, R, T)  # noqa: E731
    curve = oracle.measured(law, 0.05, 0.5e-6, rng, (1.0, 1.0), 1e-11 * rng.standard_normal(3000))
    values, spread = [], 0.0
    for factor in (0.98, 1.0, 1.02):
        known = nt.fit.Uncertainties(sensitivity=0.0, thickness=0.1)
        result = nt.fit.fit_curve(curve, "layer", radius=R, thickness=factor * T, uncertainties=known)
        values.append(result.values["effective_modulus"])
        spread = result.sigma_calibration["effective_modulus"] if factor == 1.0 else spread
    assert spread == pytest.approx(0.1 * (values[2] - values[0]) / 0.04, rel=0.05)
    assert any("layer's thickness to 10 %" in line for line in result.assumptions)


def test_what_does_not_go_together() -> None:
    rng = np.random.default_rng(2)
    law = lambda d: oracle.force("layer", d, E, R, T)  # noqa: E731
    curve = oracle.measured(law, 0.05, 0.5e-6, rng, (1.0, 1.0), 1e-11 * rng.standard_normal(3000))
    with pytest.raises(InvalidValue, match="needs the thickness of the layer"):
        nt.fit.fit_curve(curve, "layer", radius=R)
    with pytest.raises(InvalidValue, match="half-space: thickness goes with layer, layer_cone"):
        nt.fit.fit_curve(curve, "hertz", radius=R, thickness=T)
    with pytest.raises(InvalidValue, match="valid is 1e-09 to 1 m"):
        nt.fit.fit_curve(curve, "layer", radius=R, thickness=0.0)
    with pytest.raises(InvalidValue, match=r"holds for 0\.5 only"):
        nt.fit.fit_curve(curve, "layer", radius=R, thickness=T, poisson_ratio=0.3)
    with pytest.raises(InvalidValue, match="not on a layer"):
        nt.fit.fit_curve(curve, "layer", radius=R, thickness=T).to_scene()
    thin = nt.fit.fit_curve(curve, "layer", radius=50 * R, thickness=T / 4)
    assert any("twice the layer's 500 nm" in note for note in thin.notes)


def test_map_of_layers() -> None:
    rng = np.random.default_rng(3)
    law = lambda d: oracle.force("layer", d, E, R, T)  # noqa: E731
    noise = 1e-11 * rng.standard_normal((3, 3000))
    curves = [oracle.measured(law, 0.05, 0.5e-6, rng, (1.0, 1.0), one) for one in noise]
    known = nt.fit.Uncertainties(sensitivity=0.0, thickness=0.1)
    data = nt.maps.fit(curves, model="layer", radius=R, thickness=T, uncertainties=known)
    single = [nt.fit.fit_curve(curve, "layer", radius=R, thickness=T, uncertainties=known) for curve in curves]
    for name in ("values", "sigma"):
        expected = [getattr(one, name)["effective_modulus"] for one in single]
        stored = data["effective_modulus" if name == "values" else "effective_modulus_sigma"].values.ravel()
        assert stored == pytest.approx(expected, rel=0.02)
    with pytest.raises(InvalidValue, match="not on a layer"):
        nt.maps.to_scene(data)


def test_sphere_is_touched() -> None:
    rng = np.random.default_rng(4)
    law = lambda d: oracle.force("sphere", d, E, R)  # noqa: E731
    curve = oracle.measured(law, 0.05, 0.5e-6, rng, (1.0, 1.0), 1e-11 * rng.standard_normal(3000))
    scene = nt.fit.fit_curve(curve, "sphere", radius=R).to_scene()
    assert (scene.tip.shape, scene.tip.radius) == ("sphere", R)
