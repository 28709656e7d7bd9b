# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch.fit: known curves give their parameters back, and what a curve cannot tell is said."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.curves import ForceCurve, Segment
from nanotouch.errors import InvalidValue, MissingExtra

scipy_optimize = pytest.importorskip("scipy.optimize")
_fit = pytest.importorskip("nanotouch._fit", reason="built without Ceres")

RADIUS, MODULUS, WORK, STIFFNESS, CONTACT = 20e-9, 5e6, 0.05, 0.5, 3e-7


def force_over_z(law: Any, z: Any, stiffness: float = STIFFNESS) -> Any:
    """What a cantilever measures on retraction: delta and F of the law, z = contact - delta - F/k_c, inverted by
    interpolation in a fine table; apart beyond the z of the lowest force. Nothing of the fit's own solver is used."""
    model, contact = law
    adhesion = nt.contact.pull_off_force(model, contact)
    lowest = nt.contact.indentation(model, -adhesion, contact) if adhesion else 0.0
    delta = lowest + np.linspace(0.0, 1.0, 20_001) ** 2 * 2e-7  # dense where the law bends
    force = nt.contact.evaluate(model, delta, contact).F
    force[0] = -adhesion
    height = CONTACT - delta - force / stiffness
    inside = z <= height[0]
    return np.where(inside, np.interp(z, height[::-1], force[::-1]), 0.0)


def curve_of(
    model: str = "jkr",
    *,
    modulus: float = MODULUS,
    noise: float = 0.0,
    seed: int = 1,
    stiffness: float = STIFFNESS,
    sensitivity_error: float = 1.0,
    points: int = 2000,
) -> ForceCurve:
    """A synthetic curve with offset and tilt; the detector shows sensitivity_error times the true deflection."""
    rng = np.random.default_rng(seed)
    contact = nt.Contact(RADIUS, modulus, 0.0 if model == "hertz" else WORK, cohesive_range=2e-9)
    z = np.linspace(CONTACT - 6e-8, CONTACT + 4.5e-7, points)

    def segment(role: Any, heights: Any) -> Segment:
        force = sensitivity_error * force_over_z((model, contact), heights, stiffness)
        force = force + 1e-9 + 1e-4 * (heights - CONTACT) + noise * rng.standard_normal(heights.size)
        return Segment(role, np.full(heights.size, np.nan), heights, "height (measured)", force, force / stiffness)

    return ForceCurve(
        (segment("approach", z[::-1]), segment("retract", z)), {"spring constant": stiffness}, "synthetic"
    )


def fit(curve: ForceCurve, model: Any = "jkr", **options: Any) -> Any:
    known = {"radius": RADIUS} | ({"cohesive_range": 2e-9} if model == "maugis" else {})
    return nt.fit.fit_curve(curve, model, **(known | options))


@pytest.mark.parametrize("model", ["hertz", "dmt", "jkr", "maugis"])
def test_recovers_a_curve_without_noise(model: str) -> None:
    result = fit(curve_of(model), model, uncertainties=nt.fit.Uncertainties(sensitivity=0.0))
    assert result.converged
    # 1e-4: the table's interpolation, and the baseline that is found from the curve itself
    assert result.values["effective_modulus"] == pytest.approx(MODULUS, rel=1e-4)
    assert result.values["contact_point"] == pytest.approx(CONTACT, abs=2e-12)
    if model != "hertz":
        assert result.values["work_of_adhesion"] == pytest.approx(WORK, rel=1e-3)
        assert result.measured_pull_off_force == pytest.approx(result.pull_off_force, rel=0.01)


def test_pulls_have_the_width_that_sigma_says() -> None:
    """(value - truth)/sigma over 40 seeds: standard deviation 1 +- 0.11, so 0.65 .. 1.35 is three of its errors; every
    value within 4 sigma."""
    truth = {"effective_modulus": MODULUS, "work_of_adhesion": WORK, "contact_point": CONTACT}
    results = [
        fit(curve_of(noise=30e-12, seed=s), uncertainties=nt.fit.Uncertainties(sensitivity=0.0)) for s in range(40)
    ]
    for name, value in truth.items():
        pulls = np.array([(r.values[name] - value) / r.sigma[name] for r in results])
        assert 0.65 < pulls.std() < 1.35, name
        assert np.abs(pulls).max() < 4.0, name


def test_agrees_with_scipy() -> None:
    """JKR written out in its contact radius and fitted by scipy's least squares on the same points."""
    rng = np.random.default_rng(7)
    contact = nt.Contact(RADIUS, MODULUS, WORK)
    delta = np.linspace(-2e-9, 40e-9, 150)
    force = nt.contact.evaluate("jkr", delta, contact).F + 50e-12 * rng.standard_normal(delta.size)

    def jkr(parameters: Any) -> Any:
        modulus, work, zero = np.exp(parameters[0]), np.exp(parameters[1]), 1e-9 * parameters[2]

        def at(target: float) -> float:
            def depth(a: float) -> float:
                return float(a * a / RADIUS - np.sqrt(2 * np.pi * work * a / modulus))

            fold = (np.pi * work * RADIUS**2 / (8 * modulus)) ** (1 / 3)
            a = scipy_optimize.brentq(lambda a: depth(a) - target, fold, 1e-6, xtol=1e-22, rtol=1e-14)
            return float(4 * modulus * a**3 / (3 * RADIUS) - np.sqrt(8 * np.pi * work * modulus * a**3))

        return np.array([at(d - zero) for d in delta])

    oracle = scipy_optimize.least_squares(
        lambda p: (jkr(p) - force) / 50e-12, [np.log(4e6), np.log(0.04), 0.5], xtol=1e-14, ftol=1e-14, gtol=1e-14
    )
    variance = np.linalg.inv(oracle.jac.T @ oracle.jac) * 2 * oracle.cost / (delta.size - 3)
    options = _fit.Options("jkr")
    options.radius = RADIUS
    found = _fit.run(options, delta, force)
    assert found["value"][0] == pytest.approx(np.exp(oracle.x[0]), rel=1e-5)
    assert found["value"][1] == pytest.approx(np.exp(oracle.x[1]), rel=1e-5)
    assert found["value"][4] == pytest.approx(1e-9 * oracle.x[2], abs=1e-14)
    # scipy's Jacobian is numeric: 1e-3
    assert found["sigma"][0] / found["value"][0] == pytest.approx(np.sqrt(variance[0, 0]), rel=1e-3)


def test_stiff_contact_is_not_determined() -> None:
    """Silicon at 0.5 N/m: the base moves 100 nm for 0.7 nm of indentation, in a noise of 0.2 nm."""
    result = fit(curve_of(modulus=77e9, noise=100e-12))
    assert not result.identifiable["effective_modulus"]
    assert result.identifiable["work_of_adhesion"]
    assert result.values["work_of_adhesion"] == pytest.approx(WORK, rel=0.06)  # 100 pN in 4.7 nN
    assert "not determined" in str(result)
    assert any("stiffer than the cantilever" in note for note in result.notes)


def test_wrong_sensitivity_is_suspected() -> None:
    """A stiff contact seen through half the true sensitivity looks like a soft one, but straighter than any."""
    result = fit(curve_of(modulus=77e9, noise=20e-12, sensitivity_error=0.5))
    assert not result.identifiable["effective_modulus"]
    assert any("calibration" in note for note in result.notes)


def test_wrong_model_is_said() -> None:
    curve = curve_of(noise=20e-12)
    retract = curve.segments[1]
    z = retract.z - CONTACT
    neck = np.where((z > -2e-8) & (z < 2e-7), -5e-9 - 4e-9 * np.sin(z / 2e-8), 0.0)  # as of a stretched gel
    force = np.asarray(retract.force) + neck
    torn = Segment("retract", retract.time, retract.z, retract.z_channel, force, force / STIFFNESS)
    result = fit(ForceCurve((curve.segments[0], torn), curve.meta, "torn"))
    assert not any(result.identifiable.values())
    assert any("does not describe the curve" in note for note in result.notes)


def test_no_state_between_curves_and_threads() -> None:
    curves = [curve_of(m, noise=30e-12, seed=s) for s, m in enumerate(("jkr", "dmt", "jkr", "hertz"))]
    alone = [fit(c).values for c in curves]
    again = [fit(c).values for c in reversed(curves)][::-1]
    with ThreadPoolExecutor(4) as pool:
        together = [r.values for r in pool.map(fit, curves)]
    assert alone == again == together


def test_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    fit(curve_of(noise=30e-12))
    fit(curve_of(modulus=77e9, noise=30e-12))
    captured = capfd.readouterr()
    assert captured.out == captured.err == ""


def test_says_what_it_assumed() -> None:
    curve = curve_of("maugis", noise=30e-12)
    result = nt.fit.fit_curve(curve, poisson_ratio=0.3)
    text = " ".join(result.assumptions)
    for part in ("tip radius 20 nm", "h0 = 0.2 nm", "sensitivity", "rigid"):
        assert part in text
    assert result.values["youngs_modulus"] == pytest.approx(result.values["effective_modulus"] * (1 - 0.09))
    assert result.covariance.shape == (len(result.free),) * 2
    assert np.sqrt(np.diag(result.covariance)) == pytest.approx([result.sigma[name] for name in result.free])
    assert result.residuals.shape == result.z.shape == result.indentation.shape


def test_compliant_tip_enters_the_modulus_of_the_sample() -> None:
    tip = nt.Scene(tip={"youngs_modulus": 1e7}).tip
    result = fit(curve_of(noise=30e-12), tip=tip, radius=None, poisson_ratio=0.3)
    compliance = 1 / result.values["effective_modulus"] - (1 - tip.poisson_ratio**2) / 1e7
    assert result.values["youngs_modulus"] == pytest.approx(0.91 / compliance)


def test_held_contact_point_window_and_bounds() -> None:
    curve = curve_of(noise=30e-12)
    held = fit(curve, contact_point=CONTACT)
    assert held.values["contact_point"] == CONTACT
    assert held.sigma["contact_point"] == 0.0
    assert "contact_point" not in held.free
    assert held.sigma["effective_modulus"] < fit(curve).sigma["effective_modulus"]
    loaded = fit(curve, window=(0.0, 1.0))
    assert loaded.force.min() >= 0.0
    bound = fit(curve, bounds={"effective_modulus": (1e6, 2e6)})
    assert bound.values["effective_modulus"] == pytest.approx(2e6)
    assert not bound.identifiable["effective_modulus"]  # it stands at its bound


@pytest.mark.parametrize(
    ("options", "part"),
    [
        ({"model": "bjerrum"}, "model"),
        ({"radius": 0.0}, "radius"),
        ({"radius": float("nan")}, "radius"),
        ({"radius": 20.0}, "radius"),
        ({"loss": "l3"}, "loss"),
        ({"branch": "sideways"}, "branch"),
        ({"poisson_ratio": 0.7}, "poisson_ratio"),
        ({"loss_scale": -1.0, "loss": "huber"}, "loss_scale"),
        ({"window": (1.0, 2.0)}, "points"),
        ({"fixed": {"modulus": 1.0}}, "parameter"),
        ({"fixed": {"effective_modulus": -1.0}}, "effective_modulus"),
        ({"cohesive_range": -1.0, "model": "maugis"}, "cohesive_range"),
    ],
)
def test_refuses_what_it_cannot_use(options: dict[str, Any], part: str) -> None:
    with pytest.raises(InvalidValue, match=part):
        nt.fit.fit_curve(curve_of(noise=30e-12, points=500), **({"radius": RADIUS, "model": "jkr"} | options))


def test_refuses_a_curve_without_spring_constant() -> None:
    curve = curve_of(noise=30e-12)
    with pytest.raises(InvalidValue, match="spring constant"):
        fit(ForceCurve(curve.segments, {}, "uncalibrated"))


def test_without_the_extension(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "nanotouch._fit", None)
    monkeypatch.delattr(nt, "_fit", raising=False)
    with pytest.raises(MissingExtra, match="libceres-dev"):
        fit(curve_of())
