# SPDX-License-Identifier: BSD-3-Clause
"""Objects that a tip moves (docs/manipulation.md)."""

from __future__ import annotations

from .lever import Lever, LeverPath
from .particle import Particle, ParticleContact, ParticlePath, ParticlesState, ParticleState, latex
from .particles import Laid, Particles, ParticlesPath
from .pushing import Bench, Lost, Pushed, Track, arrange, push
from .recorded import Recorded
from .rod import Rod, RodPath, RodState, nanowire, turning_point

__all__ = [
    "Bench",
    "Laid",
    "Lever",
    "LeverPath",
    "Lost",
    "Particle",
    "ParticleContact",
    "ParticlePath",
    "ParticleState",
    "Particles",
    "ParticlesPath",
    "ParticlesState",
    "Pushed",
    "Recorded",
    "Rod",
    "RodPath",
    "RodState",
    "Track",
    "arrange",
    "latex",
    "nanowire",
    "push",
    "turning_point",
]
