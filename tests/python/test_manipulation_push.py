# SPDX-License-Identifier: BSD-3-Clause
"""A scripted operator pushes particles under drift and noise; tests/heavy/push.py has 100 seeds."""

from __future__ import annotations

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.manipulation import Bench, Lever, Lost, arrange, push, pushing

E, G = 3.63e9, 0.85e9


def latex(adhesion_to_tip: float = 0.01) -> nt.Particle:
    """Polystyrene of 500 nm on glass; the published rolling distances are 0.0084 R."""
    substrate = nt.ParticleContact(E, G, 0.06, shear_strength=12e6, rolling_distance=4.2e-9)
    tip = nt.ParticleContact(E, G, adhesion_to_tip, shear_strength=12e6, rolling_distance=0.2e-9)
    return nt.Particle(0.5e-6, substrate, tip, tip_radius=50e-9)


@pytest.mark.parametrize("seed", range(3))
def test_a_particle_goes_5_um_under_drift(seed: int) -> None:
    done = push(latex(), (3e-6, -4e-6), seed=seed)
    assert done.error < 100e-9
    assert done.error == pytest.approx(float(np.hypot(*(done.position - [3e-6, -4e-6]))))
    assert done.believed <= 30e-9
    assert done.lines == 4 * (done.pushes + 1)


def test_without_looking_for_the_drift_it_would_miss() -> None:
    """The mark is what the target is measured from: 1 nm/s over the time of the task is more than the error."""
    done = push(latex(), (5e-6, 0.0), seed=1)
    assert done.duration * 1e-9 > 5 * done.error


def test_what_is_believed_is_true_within_the_noise_of_a_look() -> None:
    """Nothing drifts, the tip is where it should be: only heights have noise, sigma/sqrt(points) of each line's fit."""
    bench = Bench(drift=0.0, position_noise=0.0, height_noise=1e-9)
    for seed in range(5):
        done = push(latex(), (1e-6, 1e-6), bench=bench, seed=seed)
        assert abs(done.error - done.believed) < 2e-9  # 4 lines of 1 nm/sqrt(100), 5 sigma


def test_same_seed_same_task() -> None:
    first, again, other = (push(latex(), (1e-6, 0.0), seed=seed) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first.looks, again.looks)
    assert not np.array_equal(first.position, other.position)


def test_five_particles_make_a_pattern() -> None:
    starts = [(0.0, 0.0), (6e-6, 1e-6), (12e-6, 0.0), (1e-6, 8e-6), (11e-6, 8e-6)]
    angles = 0.4 * np.pi * np.arange(5)
    targets = [(6e-6 + 4e-6 * float(np.cos(angle)), 4e-6 + 4e-6 * float(np.sin(angle))) for angle in angles]
    done = arrange(latex(), starts, targets, seed=0)
    assert max(one.error for one in done) < 100e-9
    places = np.array([one.position for one in done])
    assert np.linalg.norm(places[:, None] - np.array(targets), axis=2).min(axis=0).max() < 100e-9


def test_what_cannot_be_done_is_told() -> None:
    with pytest.raises(Lost, match="hangs on the tip"):
        push(nt.Particle(0.5e-6, nt.ParticleContact(E, G, 1e-3), nt.ParticleContact(E, G, 0.1)), (1e-6, 0.0))
    with pytest.raises(Lost, match="where it should be"):
        push(latex(), (1e-6, 0.0), bench=Bench(drift=2e-6))
    with pytest.raises(nt.errors.InvalidValue, match="pattern: no order"):
        arrange(latex(), [(0.0, 0.0), (5e-6, 0.0)], [(10e-6, 0.0), (10.5e-6, 0.0)])
    with pytest.raises(nt.errors.InvalidValue, match="drift = -1"):
        Bench(drift=-1.0)
    with pytest.raises(nt.errors.InvalidValue, match="2 starts, 1 targets"):
        arrange(latex(), [(0.0, 0.0), (5e-6, 0.0)], [(10e-6, 0.0)])


@pytest.mark.parametrize("up", [1.0, 0.05])
def test_a_lever_too_soft_to_lead_is_refused_and_the_least_stiffness_is_true(
    up: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A tenth above it the operator arrives; a fifth below, where it is let to try, it never does."""
    ball, way = nt.manipulation.latex(500e-9), (0.8e-6, 0.46e-6)
    with pytest.raises(
        nt.errors.InvalidValue, match=r"stiffness = 1e-06 N/m sideways: a push of 6 nN would .* 6 mm"
    ) as no:
        push(ball, way, lever=Lever((1e-6, 1.0, up)))
    least = float(str(no.value).rsplit("valid is ", 1)[1].split(" N/m")[0])
    assert push(ball, way, lever=Lever((1.1 * least, 1.1 * least, up))).believed <= 30e-9
    low = Lever((0.8 * least, 0.8 * least, up))
    for call in (lambda: push(ball, way, lever=low), lambda: arrange(ball, [(0.0, 0.0)], [way], lever=low)):
        with pytest.raises(nt.errors.InvalidValue, match=r"valid is .* N/m and above"):
            call()
    monkeypatch.setattr(pushing, "needed", lambda lever, *_: lever)
    assert push(ball, way, lever=low, most=10).believed > 40e-9
