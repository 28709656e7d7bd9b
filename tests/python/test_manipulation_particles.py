# SPDX-License-Identifier: BSD-3-Clause
"""Particles that push each other, beside a model of its own in one dimension; a hand of three axes feels them."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.manipulation import Lever, arrange, latex, push
from nanotouch.manipulation.lever import give
from scipy.optimize import brentq

ROUND = latex(500e-9)
R, LOW = 500e-9, 0.3e-6


def jkr_radius(load: float) -> float:
    """Of a ball on glass (Johnson 1985, Eq. 5.47)."""
    K, w = 4.0 / 3.0 * 3.63e9, 3.0 * math.pi * 0.06 * R
    return float(np.cbrt(R / K * (load + w + math.sqrt(2.0 * w * load + w * w))))


def rolling(load: float) -> float:
    """Torque at which it rolls, over R: 4 F_c (a/a0)^1.5 xi / R."""
    return 4.0 * 1.5 * math.pi * 0.06 * R * (jkr_radius(load) / jkr_radius(0.0)) ** 1.5 * 0.0084


@pytest.mark.parametrize("friction", [0.0, 1e5, 12e6])
def test_two_in_a_row_beside_balances_of_their_own(friction: float) -> None:
    """Both roll towards +x, so that their faces rub, with f = tau pi a^2: it lifts the first, presses on the second,
    and turns both back. P is the push on the first, N what they press each other with: P R = M1 + N R + f R and
    N R = M2 + f R."""
    between = nt.ParticleContact(1.85e9, 0.3647e9, shear_strength=friction, model="hertz")
    smooth = nt.ParticleContact(3.63e9, 0.85e9)
    particle = nt.Particle(R, ROUND.substrate, smooth, tip_radius=50e-9, step=1e-9)
    set_ = nt.Particles(particle, between)
    state = set_.place([(0.0, 0.0), (2.0 * R + 2e-9, 0.0)], (-0.75e-6, 0.0, LOW))
    path = set_.run(np.linspace(-0.75e-6, -0.35e-6, 401), 0.0, LOW, state=state)
    down = float(path.force[-1, 2])
    a_of = lambda force: float(np.cbrt(0.75 * force * 0.5 * R / 1.85e9))  # noqa: E731

    def open_balance(N: float) -> float:
        f = friction * math.pi * a_of(N) ** 2
        return N - rolling(f) - f

    N = brentq(open_balance, 1e-12, 1e-6)
    f = friction * math.pi * a_of(N) ** 2
    P = rolling(down - f) + N + f
    assert -path.force[-1, 0] == pytest.approx(P, rel=2e-3)
    assert path.happened("roll")[-1].all()


def test_the_neighbour_goes_as_far_as_the_one_that_pushes_it() -> None:
    set_ = nt.Particles(ROUND)
    state = set_.place([(0.0, 0.0), (1.1e-6, 0.0), (0.0, 3e-6)], (-0.75e-6, 0.0, LOW))
    path = set_.run(np.linspace(-0.75e-6, -0.1e-6, 326), 0.0, LOW, state=state)
    touching = path.position[:, 1, 0] > 1.1e-6 + 1e-9
    assert touching[-1]
    apart = path.position[touching, 1, 0] - path.position[touching, 0, 0]
    np.testing.assert_allclose(apart, 1e-6, atol=1.5e-9)
    np.testing.assert_array_equal(path.position[:, 2, :2], np.broadcast_to([0.0, 3e-6], (326, 2)))
    np.testing.assert_allclose(path.stored + path.dissipated, path.work, atol=1e-9 * path.work[-1])
    assert (np.diff(path.dissipated) >= 0.0).all()
    assert path.touched[-1].tolist() == [True, False, False]


def test_a_lever_is_used_where_it_matters() -> None:
    """Its give is the push over its stiffness: a stiff one is left out, a soft one lags by it."""
    soft, stiff = Lever((1.0, 1.0, 0.5)), Lever((200.0, 200.0, 40.0))
    force = np.abs(ROUND.run(np.linspace(-0.75e-6, -0.4e-6, 176), 0.0, 0.3 * R).force[-1])
    assert give(soft, ROUND) == pytest.approx(max(force[0] / 1.0, force[2] / 0.5), rel=0.02)
    assert give(stiff, ROUND) < 0.1e-9
    held, led = (push(ROUND, (0.4e-6, 0.0), seed=3, lever=lever) for lever in (None, stiff))
    assert led.error == held.error
    hung = push(ROUND, (0.4e-6, 0.0), seed=3, lever=soft)
    assert hung.error != held.error
    assert hung.error < 100e-9
    lag = np.abs(hung.track.force[:, 0]).max()
    assert lag == pytest.approx(force[0], rel=0.2)


def test_a_neighbour_in_the_way_is_moved_by_the_operator() -> None:
    """Refused by plan where ways are not clear; where they are, the others stay where they lie."""
    starts = [(0.0, 0.0), (0.0, 2.2e-6)]
    done = arrange(ROUND, starts, [(1e-6, 0.0), (1e-6, 2.2e-6)], seed=1)
    assert [one.error < 100e-9 for one in done] == [True, True]
    assert done[0].position == pytest.approx([1e-6, 0.0], abs=100e-9)


def test_a_hand_of_three_axes_feels_the_push_and_its_loss() -> None:
    """A master with motors: along x it pushes back with alpha_f times the rolling resistance, and with nothing once the
    ball is lost."""
    scene = nt.Scene(
        tip={"radius": 50e-9, "half_angle": 0.26}, sample={"youngs_modulus": 70e9, "poisson_ratio": 0.22},
        medium={"relative_humidity": 0.0}, adhesion={"work_of_adhesion": 0.01, "hamaker_constant": 3e-20},
        range={"maximum_load": 100e-9},
    )  # fmt: skip
    rig = nt.Rig(probe={"spring_constant": 10.0, "lateral_stiffness": 100.0}, master={"axes": 3.0})
    ball = nt.Particles(latex(R, 50e-9))
    session = nt.Session(scene, rig, clearance=LOW, particles=ball, minimum_margin=0.0, path=[(0.0, 0.0)],
                         gains={"alpha_p": 1e-4})  # fmt: skip
    session.lay(0, (0.9e-6, 0.0))
    gains, start = session.settings.gains, session.core.master_start
    hold = nt.touch.operator.Hold
    pushed = session.advance(2.0, hold((0.6e-6 / gains.alpha_p, 0.0, start), math.nan, math.nan, 1.8))
    assert session.particles.positions[0, 0] > 1e-6
    truth, motor = pushed["tip_force"], pushed["motor_force"]
    felt = float(np.mean(pushed["motor_force_x"][-500:]))
    there = float(np.mean(pushed["tip_force_x"][-500:]))
    assert there == pytest.approx(-5.9e-9, rel=0.1)
    assert felt == pytest.approx(gains.alpha_f * there, rel=0.05)
    assert np.isfinite(truth).all()
    assert np.isfinite(motor).all()
    back = session.advance(1.0, hold((0.0, 0.0, start), math.nan, math.nan, 0.8))
    assert session.particles.losses == [1]
    assert abs(back["motor_force_x"][-1]) < 1e-3 * abs(felt)
    kinds = [name for _, name, _ in session.metadata()["events"]]
    assert kinds.count("pushed") == 1


def test_what_is_no_set_is_refused() -> None:
    set_ = nt.Particles(ROUND)
    with pytest.raises(InvalidValue, match="valid are up to 6"):
        set_.place([(3e-6 * i, 0.0) for i in range(7)], (-1e-6, 0.0, LOW))
    with pytest.raises(nt.Error, match="neither the tip nor another"):
        set_.place([(0.0, 0.0), (0.5e-6, 0.0)], (-1e-6, 0.0, LOW))
    with pytest.raises(nt.Error, match=r"between\.effective_shear_modulus"):
        nt.Particles(ROUND, nt.ParticleContact(1e9, 1e9))
    with pytest.raises(TypeError, match=r"valid is a set, nt\.Particles"):
        nt.Session(particles=ROUND, minimum_margin=0.0)  # type: ignore[arg-type]
    scene, path = nt.Scene(medium={"relative_humidity": 0.0}), [(0.0, 0.0), (1e-6, 0.0)]
    with pytest.raises(nt.Error, match="particles in a session that taps"):
        nt.Session(scene, mode="tapping", path=path, particles=set_, minimum_margin=0.0)
    with pytest.raises(nt.Error, match="without particles"):
        nt.Session(minimum_margin=0.0).lay(0, (0.0, 0.0))
