# SPDX-License-Identifier: BSD-3-Clause
"""Objects that a tip moves (docs/manipulation.md)."""

from __future__ import annotations

from .lever import Lever, LeverPath, LeverState
from .particle import Particle, ParticleContact, ParticlePath, ParticleState, latex
from .pushing import Bench, Lost, Pushed, Track, arrange, push
from .rod import Rod, RodPath, RodState, turning_point

__all__ = [
    "Bench",
    "Lever",
    "LeverPath",
    "LeverState",
    "Lost",
    "Particle",
    "ParticleContact",
    "ParticlePath",
    "ParticleState",
    "Pushed",
    "Rod",
    "RodPath",
    "RodState",
    "Track",
    "arrange",
    "latex",
    "push",
    "turning_point",
]
