# SPDX-License-Identifier: BSD-3-Clause
"""Stability maps: the exact limit of the loop over rate, force gain and stiffness, and the same found by bisection on
the complete simulated rig."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import nanotouch as nt
import numpy as np
from nanotouch import margins
from nanotouch.touch.operator import Input
from numpy.typing import NDArray

Floats = NDArray[np.float64]
PRESS = 1.5
"""hand force at which the contact is tried [N]"""
KICK = 0.015
"""step of the hand whose answer must die away [N]"""
TOLERANCE = 3e-3
"""of the bisection, relative"""
LARGEST_GAIN = 9e3


class Limit(NamedTuple):
    """Where the simulated loop turns unstable."""

    rate: float
    """[Hz]"""
    force_gain: float
    """K_f; infinite if it is stable up to LARGEST_GAIN"""
    contact_stiffness: float
    """k of the contact at the load of the trial [N/m]"""
    exact: float
    """K_f at the exact limit for that stiffness"""


def ideal(rig: nt.Rig) -> nt.Rig:
    """The rig without noise, steps, friction and weak motors: what is left is the linear loop."""
    made = rig.copy()
    for name in ("probe.noise", "probe.resolution", "probe.temperature", "stage.resolution", "stage.command_resolution",
                 "stage.noise", "stage.hysteresis", "stage.creep", "master.resolution", "master.gauge_noise",
                 "master.gauge_resolution", "master.friction", "hand.random_force", "converters.adc_bits",
                 "converters.dac_bits"):  # fmt: skip
        made[name] = 0.0
    made["master.max_force"] = 1e3
    made["master.gauge_range"] = 1e3
    made["stage.max_speed"] = 1.0
    return made


def hard(modulus: float) -> nt.Scene:
    """Two dry bodies of a modulus [Pa] that do not attract each other: the contact is Hertz'."""
    return nt.Scene(
        tip={"radius": 100e-9, "youngs_modulus": modulus, "poisson_ratio": 0.3},
        sample={"youngs_modulus": modulus, "poisson_ratio": 0.3},
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
    )


def trial_settings(settings: nt.Settings, rate: float) -> nt.Settings:
    """Settings at a rate, with no limit in the way."""
    made = settings.copy()
    made["gains.rate"] = rate
    made["limits.motor_force"] = 1e3
    made["limits.motor_rate"] = 1e9
    made["limits.motor_power"] = 1e6
    made["limits.stage_speed"] = 1.0
    return made


def simulated_limit(rig: nt.Rig, settings: nt.Settings, rate: float, modulus: float = 1e13) -> Limit:
    """Bisect the force gain of the default law, between trials on the simulated rig."""
    plain, own = ideal(rig), trial_settings(settings, rate)
    stiffness = _stiffness(plain, own, modulus)
    exact = margins.compute(plain, own, stiffness).force_gain_limit
    low, high = 0.0, LARGEST_GAIN
    if not decays(plain, own, modulus, low):
        return Limit(rate, 0.0, stiffness, exact)
    if decays(plain, own, modulus, high):
        return Limit(rate, math.inf, stiffness, exact)
    while high - low > TOLERANCE * (1.0 + low):
        middle = math.sqrt((1.0 + low) * (1.0 + high)) - 1.0
        if decays(plain, own, modulus, middle):
            low = middle
        else:
            high = middle
    return Limit(rate, low, stiffness, exact)


def decays(rig: nt.Rig, settings: nt.Settings, modulus: float, force_gain: float) -> bool:
    """Press at the defaults' gain, fade to another one, kick the hand: does the answer die away?"""
    law = _Law(settings)
    session = _session(rig, settings, modulus, law)
    law.force_gain = 2.0 if force_gain > 2.0 else force_gain
    session.advance(0.6, Input(PRESS, 0.0, 0.0, 0.2))
    start = law.force_gain
    for share in np.linspace(0.0, 1.0, 21)[1:]:
        law.force_gain = start + (force_gain - start) * float(share)
        session.advance(0.005)
    first = session.advance(0.1, Input(PRESS + KICK, 0.0, 0.0, 0.0))
    session.advance(0.2)
    last = session.advance(0.1)
    early, late = float(np.ptp(first["tip_force"])), float(np.ptp(last["tip_force"]))
    in_contact = late * settings.gains.alpha_f < PRESS
    return bool(late < early and in_contact and not last["state"].any())


def _stiffness(rig: nt.Rig, settings: nt.Settings, modulus: float) -> float:
    """k of the contact where the trial presses [N/m]."""
    law = _Law(settings)
    session = _session(rig, settings, modulus, law)
    session.advance(0.6, Input(PRESS, 0.0, 0.0, 0.2))
    gap = float(session.advance(0.05)["gap"][-1])
    return float(session.plan.run(np.array([1e-9, gap])).k[-1])


def _session(rig: nt.Rig, settings: nt.Settings, modulus: float, law: _Law) -> nt.Session:
    return nt.Session(
        hard(modulus), rig, settings=settings, control=law, clearance=5e-9, minimum_margin=0.0, preflight=False,
        probe_model="quasi-static", path=[(0.0, 0.0)],
    )  # fmt: skip


class _Law:
    """The default law, whose gain a trial sets and the observer leaves alone."""

    def __init__(self, settings: nt.Settings) -> None:
        self.alpha_f = settings.gains.alpha_f
        self.force_gain = 2.0

    def __call__(self, signals: Any) -> tuple[float, float]:
        reflected = self.alpha_f * signals.slave_force
        return -reflected - self.force_gain * (reflected - signals.smooth_force), signals.target


def exact_gains(rig: nt.Rig, settings: nt.Settings, rates: Floats, stiffness: float) -> tuple[Floats, Floats]:
    """K_f at the exact limit, and at R1, over the rate; NaN where there is none above 0."""
    exact, rule = np.full(len(rates), np.nan), np.full(len(rates), np.nan)
    for row, rate in enumerate(rates):
        own = settings.copy()
        own["gains.rate"] = float(rate)
        found = margins.compute(rig, own, stiffness)
        reflected = found.loop_stiffness / (1.0 + own.gains.force_gain)
        exact[row] = found.force_gain_limit
        rule[row] = found.stability_limit / reflected - 1.0
    return np.where(exact > 0.0, exact, np.nan), np.where(rule > 0.0, rule, np.nan)


def limits(
    rig: nt.Rig, settings: nt.Settings, rates: Floats, modulus: float, progress: Callable[[float], None]
) -> list[Limit]:
    """Simulated limits at several rates."""
    found = []
    for number, rate in enumerate(rates):
        found.append(simulated_limit(rig, settings, float(rate), modulus))
        progress((number + 1) / len(rates))
    return found
