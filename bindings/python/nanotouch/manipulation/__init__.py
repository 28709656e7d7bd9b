# SPDX-License-Identifier: BSD-3-Clause
"""Objects that a tip moves and marks (docs/manipulation.md)."""

from __future__ import annotations

from .particle import Particle, ParticleContact, ParticlePath, ParticleState

__all__ = ["Particle", "ParticleContact", "ParticlePath", "ParticleState"]
