# SPDX-License-Identifier: BSD-3-Clause
"""Margins behind a virtual coupling: against eigenvalues of the whole sampled loop, built here from the continuous
models by matrix exponentials, in every hand that is declared."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import margins

linalg = pytest.importorskip("scipy.linalg")
Floats = Any
RELEASED = 0.1  # a handle that was let go [kg]


def held(mass: float, damping: float, stiffness: float, period: float) -> tuple[Floats, Floats]:
    """Exact transition of (x, v) and of a held force."""
    a = np.zeros((3, 3))
    a[0, 1] = 1.0
    a[1] = [-stiffness / mass, -damping / mass, 1.0 / mass]
    e = linalg.expm(a * period)
    return e[:2, :2], e[:2, 2]


def notch(rig: nt.Rig, settings: nt.Settings) -> tuple[list[float], list[float]]:
    """Zeros on the sampled poles of the stage, poles of the wanted damping, gain 1 at rest."""
    angle = 2.0 * math.pi * rig.stage.resonance / settings.gains.rate
    if angle >= math.pi:
        return [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]
    bare, wanted = (
        np.poly(np.exp(angle * np.roots([1.0, 2.0 * zeta, 1.0]))).real
        for zeta in (0.5 / rig.stage.quality, settings.gains.stage_damping)
    )
    return list(bare * wanted.sum() / bare.sum()), list(wanted)


def radius(rig: nt.Rig, settings: nt.Settings, reflected: float, hand: tuple[float, float, float] | None) -> float:
    """Spectral radius of one period: master in a hand (mass, damping, stiffness; None: held still), virtual tool and
    stage, on a contact of stiffness alpha_f alpha_p k_eff = reflected."""
    gains = settings.gains
    period, delay, gain = 1.0 / gains.rate, int(gains.delay), gains.force_gain
    hand_mass, hand_damping, hand_stiffness = hand or (0.0, 0.0, 0.0)
    mass, damping = rig.master.mass + hand_mass, rig.master.damping + hand_damping
    wn = 2.0 * math.pi * rig.stage.resonance
    master, push = held(mass, damping, hand_stiffness, period)
    stage, drive = held(1.0 / wn**2, 1.0 / (wn * rig.stage.quality), 1.0, period)
    b, a = notch(rig, settings)
    low_pass = -math.expm1(-2.0 * math.pi * gains.force_filter * period)
    spring, drag = gains.coupling_stiffness, gains.coupling_damping / period

    def step(state: Floats) -> Floats:
        x, v, xs, vs, w0, w1, correction, smooth, acting, stretch, before = state[:11]
        motor, command = list(state[11 : 11 + delay]), list(state[11 + delay :])
        if hand is None:
            x = v = before = acting = 0.0
        acceleration = (acting - damping * v - hand_stiffness * x) / mass
        felt_by_gauge = -(hand_mass * acceleration + hand_damping * v + hand_stiffness * x)
        smooth += low_pass * (felt_by_gauge - smooth)
        stretch = (drag * (stretch + x - before) + reflected * xs) / (spring + drag)
        target = x - stretch
        correction += gains.stage_integral * period * (target - xs)
        if gains.stage_integral == 0.0:
            correction = 0.0  # no root at 1 of a state that nothing uses
        into = target + correction
        out = b[0] * into + w0
        motor.append(-(1.0 + gain) * spring * stretch + gain * smooth)
        command.append(out)
        now, to = motor.pop(0), command.pop(0)
        moved, driven = master @ [x, v] + push * now, stage @ [xs, vs] + drive * to
        if hand is None:
            moved, now, motor, smooth = np.zeros(2), 0.0, [0.0] * delay, 0.0
        memory = [b[1] * into - a[1] * out + w1, b[2] * into - a[2] * out]
        return np.array([*moved, *driven, *memory, correction, smooth, now, stretch, x, *motor, *command])

    matrix = np.array([step(row) for row in np.eye(11 + 2 * delay)]).T
    return float(np.max(np.abs(np.linalg.eigvals(matrix))))


def drawn(seed: int) -> tuple[nt.Rig, nt.Settings]:
    """Rate, delay, stage, coupling, K_f and hand at random."""
    random = np.random.default_rng(seed)
    rig = nt.Rig()
    rig["stage.resonance"], rig["stage.quality"] = 10 ** random.uniform(2.3, 3.4), 10 ** random.uniform(0.0, 1.5)
    rig["master.mass"], rig["master.damping"] = 10 ** random.uniform(-1.3, 0.0), 10 ** random.uniform(1.3, 2.3)
    settings = nt.Settings.for_rig(rig)
    gains = settings.gains
    gains.rate, gains.delay = 10 ** random.uniform(2.9, 4.3), float(random.integers(0, 4))
    gains.force_gain = random.choice([0.0, 10 ** random.uniform(-1.0, 0.7)])
    gains.stage_integral = random.choice([0.0, random.uniform(1.0, 30.0)])
    reflected = gains.alpha_f * gains.alpha_p * rig.probe.spring_constant
    gains.coupling_stiffness = reflected * 10 ** random.uniform(-0.7, 0.7)
    gains.coupling_damping = random.choice([0.0, reflected * 10 ** random.uniform(-4.0, -2.0)])
    if seed % 2:
        rig["hand.damping"], rig["hand.stiffness"] = random.uniform(0.5, 5.0), random.uniform(100.0, 2000.0)
    if seed % 3 == 0:
        rig["hand.mass"] = random.uniform(1e-3, 0.2)
    return rig, settings


def hands_of(rig: nt.Rig) -> list[tuple[float, float, float]]:
    """That of the rig, none, and a released handle."""
    hand = rig.hand
    return [(hand.mass, hand.damping, hand.stiffness), (0.0, 0.0, 0.0), (RELEASED, 0.0, 0.0)]


@pytest.mark.parametrize("seed", range(24))
def test_the_limits_are_those_of_the_eigenvalues(seed: int) -> None:
    """Below the limit every hand is calm, above it one is not; the same of tool and stage alone."""
    rig, settings = drawn(seed)
    found = margins.compute(rig, settings, math.inf)
    reflected = settings.gains.alpha_f * settings.gains.alpha_p * rig.probe.spring_constant
    alone = found.coupling_margin * reflected
    assert radius(rig, settings, 0.9999 * alone, None) < 1.0 < radius(rig, settings, 1.0001 * alone, None)
    limit = found.exact_limit / found.loop_stiffness * reflected
    for fraction in (0.03, 0.3, 0.7, 0.9999) if limit > 0.0 else ():
        assert all(radius(rig, settings, fraction * limit, hand) < 1.0 + 1e-12 for hand in hands_of(rig))
    if limit < math.inf:
        over = max(1.0001 * limit, 1e-6 * reflected)
        assert max(radius(rig, settings, over, hand) for hand in hands_of(rig)) > 1.0
    assert found.least <= min(found.coupling_margin, found.exact_limit / found.loop_stiffness)


def test_a_stiff_coupling_is_none() -> None:
    """A spring that gives nowhere: the limit is that of the bare loop in the worst of the hands."""
    rig = nt.Rig()
    settings = nt.Settings.for_rig(rig)
    settings.gains.force_gain = 0.0
    bare = margins.compute(rig, settings, math.inf)
    settings.gains.coupling_stiffness = 1e9
    stiff = margins.compute(rig, settings, math.inf)
    assert math.isinf(bare.coupling_margin)
    assert stiff.exact_limit <= bare.exact_limit * (1.0 + 1e-3)  # the spring gives by 1.3e-4 of the contact
    rig["hand.mass"] = RELEASED
    settings.gains.coupling_stiffness = 0.0
    released = margins.compute(rig, settings, math.inf)
    assert stiff.exact_limit == pytest.approx(min(bare.exact_limit, released.exact_limit), rel=1e-3)
