# SPDX-License-Identifier: BSD-3-Clause
"""A tip on a lever that pushes a particle: beside the tip that is held, springs in series, a pull-off in closed form,
and the work summed from forces and ways alone."""

from __future__ import annotations

import itertools
import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.manipulation import Lever, latex

ROUND = latex(500e-9)
LOW = 0.3e-6


def sticky(step: float = 0.2e-9) -> nt.Particle:
    """Held by the glass ten times as much as by the tip."""
    glass = nt.ParticleContact(3.63e9, 0.85e9, 0.1, shear_strength=12e6, rolling_distance=4e-9)
    tip = nt.ParticleContact(3.63e9, 0.85e9, 0.05, shear_strength=12e6, rolling_distance=1e-9)
    return nt.Particle(500e-9, glass, tip, tip_radius=50e-9, step=step)


def test_a_stiff_lever_is_a_tip_that_is_held() -> None:
    x = np.linspace(-0.75e-6, -0.5e-6, 126)
    held = ROUND.run(x, 0.0, LOW)
    led = Lever((1e5, 1e5, 1e5)).run(ROUND, x, 0.0, LOW)
    largest = np.abs(held.force).max()
    far = slice(90, None)  # beyond the landing, where one step is a jump
    np.testing.assert_allclose(led.force[far], held.force[far], atol=1e-3 * largest)
    np.testing.assert_allclose(led.position[far], held.position[far], atol=1e-12)
    assert not led.lost.any()


@pytest.mark.parametrize("k", [4.0, 20.0])
def test_springs_in_series(k: float) -> None:
    """Base and tip differ by F/k; a particle that rolls steadily resists as without a lever, and lags by as much."""
    x = np.linspace(-0.75e-6, -0.45e-6, 151)
    held = ROUND.run(x, 0.0, LOW)
    led = Lever((k, k, k)).run(ROUND, x, 0.0, LOW)
    base = np.stack(np.broadcast_arrays(x, 0.0, LOW), axis=-1)
    np.testing.assert_allclose(k * (led.tip - base), led.force, rtol=1e-5, atol=1e-5 * np.abs(led.force).max())
    assert led.force[-1] == pytest.approx(held.force[-1], rel=1e-4, abs=1e-14)
    up = led.force[-1, 2] / k / math.tan(0.0 + 0.5 * math.pi - ROUND.tip_half_angle)  # the cone rises: a wider flank
    lag = held.position[-1, 0] - led.position[-1, 0]
    assert lag == pytest.approx(-led.force[-1, 0] / k + up, rel=0.02)


def test_a_pull_off_is_felt_as_the_lever_springs_back() -> None:
    """Off the top of a particle: the lever carries 1.5 pi w R, then the tip leaps by that over k, and it is told."""
    of, k = sticky(), 0.5
    reduced = 1.0 / (1.0 / 500e-9 + 1.0 / 50e-9)
    top, pull = 1e-6, 1.5 * math.pi * 0.05 * reduced
    way = np.concatenate([np.linspace(20e-9, -4e-9, 40), np.linspace(-4e-9, 40e-9, 200)]) + top
    path = Lever((20.0, 20.0, k)).run(of, 0.0, 0.0, way)
    (lost,) = np.flatnonzero(path.lost)
    assert -path.force[:, 2].min() == pytest.approx(pull, rel=0.02)
    assert -path.force[lost - 1, 2] == pytest.approx(pull, rel=0.03)
    assert path.force[lost, 2] == 0.0
    assert path.tip[lost, 2] - path.tip[lost - 1, 2] == pytest.approx(pull / k, rel=0.05)
    heat = path.dissipated[lost] - path.dissipated[lost - 1]
    assert heat == pytest.approx(0.5 * pull**2 / k, rel=0.1)  # nearly all that the lever held


def test_energy_is_kept_on_random_ways_of_the_base() -> None:
    """stored + dissipated = work; heat never falls; and work is that of the forces that are felt on the base's way."""
    rng = np.random.default_rng(2)
    for _ in range(2):
        lever = Lever(tuple(10 ** rng.uniform(0, 2, 3)))
        points = [np.array([-0.62e-6, 0.0, LOW])]
        for _ in range(4):
            points.append(points[-1] + np.array([0.08e-6, 0.05e-6, 0.02e-6]) * rng.standard_normal(3) + [4e-8, 0, 0])
        share = np.linspace(0.0, 1.0, 60)[1:, None]
        base = np.concatenate([points[0][None], *(a + share * (b - a) for a, b in itertools.pairwise(points))])
        path = lever.run(ROUND, *base.T)
        turnover = float(np.abs(np.diff(path.work)).sum())
        np.testing.assert_allclose(path.stored + path.dissipated, path.work, atol=1e-9 * turnover + 1e-30)
        assert (np.diff(path.dissipated) >= 0.0).all()
        means = -0.5 * (path.force[1:] + path.force[:-1])
        summed = float(np.sum(means * np.diff(base, axis=0)))
        assert summed == pytest.approx(path.work[-1], abs=0.03 * turnover)


def test_a_path_goes_on_from_its_state() -> None:
    lever, x = Lever((20.0, 20.0, 10.0)), np.linspace(-0.65e-6, -0.55e-6, 40)
    whole = lever.run(ROUND, x, 0.0, LOW)
    half = lever.run(ROUND, x[:20], 0.0, LOW)
    for _ in range(2):
        rest = lever.run(ROUND, x[20:], 0.0, LOW, state=half.state)
        np.testing.assert_allclose(rest.force, whole.force[20:], rtol=1e-5, atol=1e-14)
        np.testing.assert_allclose(rest.work[-1], whole.work[-1], rtol=1e-6)


def test_what_is_no_lever_is_refused() -> None:
    with pytest.raises(InvalidValue, match="valid are three"):
        Lever((1.0, 1.0))  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="stiffness = 0"):
        Lever((1.0, 0.0, 1.0))
    with pytest.raises(InvalidValue, match="valid are numbers"):
        Lever((1.0, 1.0, 1.0)).run(ROUND, math.nan, 0.0, LOW)
