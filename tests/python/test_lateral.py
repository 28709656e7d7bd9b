# SPDX-License-Identifier: BSD-3-Clause
"""Lateral measurements against balances of forces, a bent beam and simulated loops."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import friction, lateral
from nanotouch.errors import InvalidValue
from scipy.integrate import quad


def balance(slope: float, mu: float, load: float, adhesion: float, way: float) -> float:
    """Lateral force of the lever on a tip that slides up (+1) or down (-1): both components of the balance, solved."""
    s, c = math.sin(slope), math.cos(slope)
    rows = [[c, -way * mu], [s, -1.0]]  # across the slope, and into it; unknown: push of the lever, normal force
    return float(np.linalg.solve(rows, [load * s, -load * c - adhesion])[0])


def test_forces_on_a_slope_balance() -> None:
    rng = np.random.default_rng(1)
    for _ in range(200):
        slope, adhesion = rng.uniform(0.1, 1.0), rng.uniform(0.0, 2.0)
        mu = rng.uniform(0.02, min(0.5, 0.95 * math.sqrt(math.cos(slope) / (math.cos(slope) + adhesion))))
        up, down = (balance(slope, mu, 1.0, adhesion, way) for way in (1.0, -1.0))
        width, offset = lateral.slope_forces(slope, mu, 1.0, adhesion=adhesion)
        assert width == pytest.approx(0.5 * (up - down), rel=1e-9)
        assert offset == pytest.approx(0.5 * (up + down), rel=1e-9)
        found = lateral.wedge(slope, (width / 3.0, 0.0), (offset / 3.0, 0.0), load=(1.0, 0.0), adhesion=(adhesion, 0.0))
        assert found.factor == pytest.approx(3.0, rel=1e-9)
        assert found.coefficient == pytest.approx(mu, rel=1e-9)


def test_the_sigma_of_a_calibration_is_its_scatter() -> None:
    """2000 noisy measurements: 68.3 % lie within a sigma, by 4 standard errors of that share (0.042) on either side."""
    rng, slope, sigma = np.random.default_rng(5), 0.62, (2e-4, 3e-4, 1e-10, 0.5e-10)
    width, offset = lateral.slope_forces(slope, 0.15, 20e-9, adhesion=5e-9)
    truth = np.array([width / 2e-7, offset / 2e-7, 20e-9, 5e-9])
    inside = []
    for _ in range(2000):
        seen = truth + np.array(sigma) * rng.normal(size=4)
        half, off_centre, load, adhesion = ((float(value), s) for value, s in zip(seen, sigma, strict=True))
        found = lateral.wedge(slope, half, off_centre, load=load, adhesion=adhesion)
        off = found.factor - 2e-7, found.coefficient - 0.15
        inside.append([abs(off[0]) < found.factor_sigma, abs(off[1]) < found.coefficient_sigma])
    assert np.mean(inside, axis=0) == pytest.approx([0.683, 0.683], abs=0.042)


@pytest.mark.parametrize("seed", range(20))
def test_the_half_width_of_a_simulated_loop_is_friction(seed: int) -> None:
    """Within 5 %, with sticking turns, an offset, a slope and noise of a tenth."""
    rng = np.random.default_rng(seed)
    law = nt.Friction(
        friction.effective_shear_modulus(135e9, 0.35, 3e9, sample_poisson_ratio=0.4), 0.05, shear_strength=20e6
    )
    x = np.linspace(0.0, rng.uniform(5e-9, 100e-9), 256)
    ways = np.concatenate([x, x[::-1], x, x[::-1]])
    force = -law.run(ways, 0.0, 3e-9, 0.0).force_x
    limit = 20e6 * math.pi * 9e-18
    noise = rng.normal(0.0, 0.1 * limit, (2, 256))
    trace, retrace = force[512:768] + 0.7 * limit + noise[0], force[:767:-1] + 0.7 * limit + noise[1]
    found = lateral.loop(x, trace, retrace)
    assert found.half_width == pytest.approx(limit, rel=0.05)
    assert found.offset == pytest.approx(0.7 * limit, abs=5.0 * found.offset_sigma)
    assert abs(found.half_width - limit) < 5.0 * found.half_width_sigma + 0.01 * limit


def test_friction_along_the_lever_reads_as_load() -> None:
    """Euler's beam, clamped at 0: curvature M/EI integrated by scipy, for a load at the end and for a moment F h."""
    length, height = 225e-6, 14e-6

    def bent(moment: object, of: str) -> float:
        weight = (lambda x: length - x) if of == "deflection" else (lambda x: 1.0)
        return float(quad(lambda x: moment(x) * weight(x), 0.0, length, epsrel=1e-12)[0])  # type: ignore[operator]

    for measured in ("deflection", "angle"):
        load, rubbed = bent(lambda x: length - x, measured), bent(lambda _: height, measured)
        assert lateral.seen_as_load(1.0, height, length, measured=measured) == pytest.approx(rubbed / load, rel=1e-10)  # type: ignore[arg-type]


def test_what_is_no_loop_and_no_slope_is_refused() -> None:
    x = np.linspace(0.0, 1e-8, 32)
    with pytest.raises(InvalidValue, match="no loop"):
        lateral.loop(x, 0.0 * x, 0.0 * x)
    with pytest.raises(InvalidValue, match="rising"):
        lateral.loop(x[::-1], x + 1.0, x)
    with pytest.raises(InvalidValue, match=r"slope = 2 rad"):
        lateral.wedge(2.0, (1.0, 0.0), (1.0, 0.0), load=(1.0, 0.0))
    with pytest.raises(InvalidValue, match=r"offset over half-width = 0\.1"):
        lateral.wedge(0.6, (1.0, 0.0), (0.1, 0.0), load=(1.0, 0.0))
    with pytest.raises(InvalidValue, match="does not slide up"):
        lateral.slope_forces(1.4, 0.5, 1e-9)


@pytest.mark.parametrize("adhesion", [0.0, 0.4, 1.5])
def test_an_image_of_friction_is_free_of_topography(adhesion: float) -> None:
    """mu and slope of 4096 places come back from the balance of forces, solved place by place."""
    rng = np.random.default_rng(3)
    slope, mu = rng.uniform(-0.6, 0.6, (64, 64)), rng.uniform(0.02, 0.4, (64, 64))
    both = np.vectorize(balance)
    up, down = (both(slope, mu, 1.0, adhesion, way) for way in (1.0, -1.0))
    found = lateral.image(up, down, 1.0, adhesion)
    assert found.coefficient == pytest.approx(mu, rel=1e-7)
    assert found.slope == pytest.approx(slope, abs=1e-7)
    flat = lateral.image(*(both(0.0, mu, 1.0, adhesion, way) for way in (1.0, -1.0)), 1.0, adhesion)
    assert flat.half_width == pytest.approx(mu * (1.0 + adhesion), rel=1e-12)
    assert np.abs(found.half_width / flat.half_width - 1.0).max() > 0.1  # what the bare half-width errs by
    with pytest.raises(InvalidValue, match="load"):
        lateral.image(up, down, 0.0)


def test_crosstalk_comes_off() -> None:
    """Its slope scatters by its sigma over 200 sets, within 4 standard errors; what is removed, to rounding."""
    rng, matrix = np.random.default_rng(9), np.array([[1.0, 0.03], [-0.08, 1.0]])
    pressed, off = np.linspace(0.0, 2.0, 40), []
    for _ in range(200):
        seen = (
            matrix @ np.stack([pressed, np.zeros(40)])
            + np.array([[0.0], [0.7]])
            + rng.normal(0.0, [[0], [0.01]], (2, 40))
        )
        found = lateral.crosstalk(*seen, normal_per_lateral=0.03)
        off.append((found.lateral_per_normal + 0.08) / found.lateral_per_normal_sigma)
    assert np.max(np.abs(off)) < 5.0
    assert np.std(off) == pytest.approx(1.0, abs=4.0 / math.sqrt(400))
    truth = rng.normal(size=(2, 50))
    back = lateral.Crosstalk(-0.08, 0.0, 0.03).remove(*(matrix @ truth))
    assert np.stack(back) == pytest.approx(truth, abs=1e-12)


@pytest.mark.parametrize("model", ["hertz", "dmt", "jkr"])
def test_a_load_has_its_radius(model: str) -> None:
    """Against the law itself, which goes from indentation to force and radius."""
    contact = nt.Contact(radius=20e-9, effective_modulus=5e9, work_of_adhesion=0.0 if model == "hertz" else 0.05)
    law = nt.contact.evaluate(model, np.linspace(1e-11, 3e-9, 200), contact)
    assert friction.radius_under(law.F, contact, model) == pytest.approx(law.a, rel=1e-9)


@pytest.mark.parametrize(("model", "seed"), [("jkr", 1), ("dmt", 2), ("hertz", 3)])
def test_a_fit_of_friction_covers_the_truth(model: str, seed: int) -> None:
    """2000 synthetic sets, forces from the law at indentations: 95 % intervals hold the truth in 93 to 97 %."""
    rng, truth = np.random.default_rng(seed), np.array([30e6, 0.12])
    contact = nt.Contact(radius=20e-9, effective_modulus=5e9, work_of_adhesion=0.0 if model == "hertz" else 0.05)
    law = nt.contact.evaluate(model, np.linspace(0.05e-9, 2.5e-9, 15), contact)
    clean = truth[0] * math.pi * law.a**2 + truth[1] * friction.compressive_load(model, law, contact)
    sigma, inside, chi = 0.03 * clean + 1e-11, [], []
    for _ in range(2000):
        scale = 1.0 + 0.02 * rng.normal()
        found = friction.fit(
            law.F, clean * scale + sigma * rng.normal(size=15), sigma, contact, model=model, scale_sigma=0.02
        )
        off = np.array([found.shear_strength, found.coefficient]) - truth
        inside.append(np.abs(off) < 1.95996 * np.array([found.shear_strength_sigma, found.coefficient_sigma]))
        chi.append(found.reduced_chi_square)
    share = np.mean(inside, axis=0)
    print(f"{model}: 95 % intervals hold tau0 in {share[0]:.1%}, alpha in {share[1]:.1%}")
    assert ((share > 0.93) & (share < 0.97)).all()
    assert np.mean(chi) == pytest.approx(1.0, abs=4.0 * math.sqrt(2.0 / 13.0 / 2000.0))


def test_a_fit_says_what_it_cannot() -> None:
    contact = nt.Contact(radius=20e-9, effective_modulus=5e9, work_of_adhesion=0.05)
    with pytest.raises(InvalidValue, match="holds from"):
        friction.fit([-1e-7, 1e-8], [1e-9, 2e-9], 1e-11, contact)
    with pytest.raises(InvalidValue, match="apart"):
        friction.fit([1e-8, 1e-8], [1e-9, 1e-9], 1e-11, contact)
    with pytest.raises(InvalidValue, match="sigma"):
        friction.fit([1e-8, 2e-8], [1e-9, 2e-9], 0.0, contact)
    with pytest.raises(InvalidValue, match="maugis"):
        friction.radius_under(1e-8, contact, "maugis")


def test_measured_loops_give_friction_back() -> None:
    """200 sets of 8 simulated loops, with noise of a tenth, sticking turns and an offset: loops, then the fit. 95 %
    intervals hold the truth in 95 % less 4 standard errors of that share, 0.062."""
    rng, contact = np.random.default_rng(4), nt.Contact(radius=20e-9, effective_modulus=5e9, work_of_adhesion=0.05)
    shear = friction.effective_shear_modulus(135e9, 0.35, 3e9, sample_poisson_ratio=0.4)
    truth = nt.Friction(shear, 0.02, shear_strength=30e6, coefficient=0.12)
    law = nt.contact.evaluate("jkr", np.linspace(0.05e-9, 2.5e-9, 8), contact)
    inner, x = friction.compressive_load("jkr", law, contact), np.linspace(0.0, 20e-9, 256)
    ways = np.concatenate([x, x[::-1], x, x[::-1]])
    pure = [-truth.run(ways, 0.0, a, n).force_x[512:].reshape(2, 256) for a, n in zip(law.a, inner, strict=True)]
    inside = []
    for _ in range(200):
        noisy = [p + rng.normal(0.0, 0.1 * np.ptp(p), p.shape) + 1e-9 for p in pure]
        loops = [lateral.loop(x, there, back[::-1]) for there, back in noisy]
        widths, sigmas = [loop.half_width for loop in loops], [loop.half_width_sigma for loop in loops]
        found = friction.fit(law.F, widths, sigmas, contact)
        off = np.array([found.shear_strength - 30e6, found.coefficient - 0.12])
        inside.append(np.abs(off) < 1.95996 * np.array([found.shear_strength_sigma, found.coefficient_sigma]))
    share = np.mean(inside, axis=0)
    print(f"loops: 95 % intervals hold tau0 in {share[0]:.1%}, alpha in {share[1]:.1%} of 200 sets")
    assert share == pytest.approx([0.95, 0.95], abs=0.062)
