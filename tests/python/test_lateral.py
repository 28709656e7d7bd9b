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
        width, offset = lateral.slope_forces(slope, mu, 1.0, adhesion)
        assert width == pytest.approx(0.5 * (up - down), rel=1e-9)
        assert offset == pytest.approx(0.5 * (up + down), rel=1e-9)
        found = lateral.wedge(slope, (width / 3.0, 0.0), (offset / 3.0, 0.0), (1.0, 0.0), (adhesion, 0.0))
        assert found.factor == pytest.approx(3.0, rel=1e-9)
        assert found.coefficient == pytest.approx(mu, rel=1e-9)


def test_the_sigma_of_a_calibration_is_its_scatter() -> None:
    """2000 noisy measurements: 68.3 % lie within a sigma, by 4 standard errors of that share (0.042) on either side."""
    rng, slope, sigma = np.random.default_rng(5), 0.62, (2e-4, 3e-4, 1e-10, 0.5e-10)
    width, offset = lateral.slope_forces(slope, 0.15, 20e-9, 5e-9)
    truth = np.array([width / 2e-7, offset / 2e-7, 20e-9, 5e-9])
    inside = []
    for _ in range(2000):
        seen = truth + np.array(sigma) * rng.normal(size=4)
        found = lateral.wedge(slope, *((float(value), s) for value, s in zip(seen, sigma, strict=True)))
        off = found.factor - 2e-7, found.coefficient - 0.15
        inside.append([abs(off[0]) < found.factor_sigma, abs(off[1]) < found.coefficient_sigma])
    assert np.mean(inside, axis=0) == pytest.approx([0.683, 0.683], abs=0.042)


@pytest.mark.parametrize("seed", range(20))
def test_the_half_width_of_a_simulated_loop_is_friction(seed: int) -> None:
    """Within 5 %, with sticking turns, an offset, a slope and noise of a tenth."""
    rng = np.random.default_rng(seed)
    law = nt.Friction(friction.effective_shear_modulus(135e9, 0.35, 3e9, 0.4), 0.05, shear_strength=20e6)
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
        assert lateral.seen_as_load(1.0, height, length, measured) == pytest.approx(rubbed / load, rel=1e-10)  # type: ignore[arg-type]


def test_what_is_no_loop_and_no_slope_is_refused() -> None:
    x = np.linspace(0.0, 1e-8, 32)
    with pytest.raises(InvalidValue, match="no loop"):
        lateral.loop(x, 0.0 * x, 0.0 * x)
    with pytest.raises(InvalidValue, match="rising"):
        lateral.loop(x[::-1], x + 1.0, x)
    with pytest.raises(InvalidValue, match=r"slope = 2 rad"):
        lateral.wedge(2.0, (1.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    with pytest.raises(InvalidValue, match=r"offset over half-width = 0\.1"):
        lateral.wedge(0.6, (1.0, 0.0), (0.1, 0.0), (1.0, 0.0))
    with pytest.raises(InvalidValue, match="does not slide up"):
        lateral.slope_forces(1.4, 0.5, 1e-9)
