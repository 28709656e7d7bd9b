# SPDX-License-Identifier: BSD-3-Clause
"""Curves of a soft sample whose lever and stage ring after the turn, with a pull-off that is known.

Written apart from the library: a Hertz contact solved point by point, a hold that tears at `adhesion`, and two decaying
sinuses that begin at the turn, evenly about the force that would be there without them.
"""

from __future__ import annotations

import numpy as np
from nanotouch import curves

Array = np.ndarray
STIFFNESS = 0.03  # N/m


def _contact(above: Array, modulus: float) -> Array:
    """Hertz contact behind the lever's spring, by bisection: force [N] at the base's height above first touch [m]."""
    low, high = np.zeros(above.size), STIFFNESS * np.maximum(-above, 0.0)
    for _ in range(50):
        force = 0.5 * (low + high)
        more = modulus * np.maximum(-above - force / STIFFNESS, 0.0) ** 1.5 > force
        low, high = np.where(more, force, low), np.where(more, high, force)
    return 0.5 * (low + high)


def _ringing(time: Array, amplitude: float, rng: np.random.Generator) -> Array:
    """Of the lever (most of it) and the stage, from the turn at time 0 on [N]."""
    total = np.zeros(time.size)
    for share in (0.8, 0.2):
        frequency = rng.uniform(0.6e3, 3e3)
        decay = rng.uniform(1.0, 12.0) / frequency
        phase = rng.uniform(0.0, 2.0 * np.pi)
        total += share * amplitude * np.exp(-time / decay) * np.cos(2.0 * np.pi * frequency * time + phase)
    return total


def make(rng: np.random.Generator, amplitude: float, adhesion: float, speed: float) -> curves.ForceCurve:
    """`amplitude` [N] at the turn; `adhesion` [N] is the force that the tip is held with when it tears.

    12 000 to 40 000 samples a second, at most 6000 of a branch (slower ones are recorded at fewer a second).
    """
    noise, depth = rng.uniform(4e-12, 15e-12), rng.uniform(20e-9, 120e-9)
    travel = rng.uniform(0.8e-6, 1.6e-6)
    rate = rng.uniform(12e3, 40e3)
    points = int(min(max(travel / speed * rate, 250), 6000))
    modulus = 10.0 ** rng.uniform(0.2, 2.0)
    z = np.linspace(-depth, travel - depth, points)
    time = np.linspace(0.0, travel / speed, points)
    force = _contact(z, modulus)
    held = np.where((z > 0.0) & (z < adhesion / STIFFNESS), -STIFFNESS * z, 0.0)
    drag = rng.uniform(0.2e-6, 1.2e-6) * speed
    level, tilt = rng.uniform(-100e-12, 100e-12), rng.uniform(-5e-6, 5e-6)
    segments = []
    for role in ("approach", "retract"):
        out = role == "retract"
        shown = force + level + tilt * z + (-drag if out else drag) + noise * rng.standard_normal(points)
        if out:
            shown = shown + held + _ringing(time, amplitude, rng)
        order = slice(None) if out else slice(None, None, -1)
        segments.append(curves.Segment(role, time + (time[-1] if out else 0.0), z[order], "z", shown[order]))  # type: ignore[arg-type]
    return curves.ForceCurve(tuple(segments), {"spring constant": STIFFNESS}, "rings after the turn")
