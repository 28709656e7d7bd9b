# SPDX-License-Identifier: BSD-3-Clause
"""Objects that a tip moves (docs/manipulation.md)."""

from __future__ import annotations

from .particle import Particle, ParticleContact, ParticlePath, ParticleState, latex
from .pushing import Bench, Lost, Pushed, Track, arrange, push

__all__ = [
    "Bench",
    "Lost",
    "Particle",
    "ParticleContact",
    "ParticlePath",
    "ParticleState",
    "Pushed",
    "Track",
    "arrange",
    "latex",
    "push",
]
