# SPDX-License-Identifier: BSD-3-Clause
"""Several equal particles on one substrate: the tip pushes one, which pushes those that lie in its way.

The tip is held where it is told, or hangs on a lever, whose base is led then. docs/manipulation.md has what was
measured. All SI.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch import _core
from nanotouch._arrays import Floats
from nanotouch.contact import effective_modulus
from nanotouch.errors import InvalidValue
from nanotouch.friction import effective_shear_modulus

from .lever import Lever, core_of
from .particle import MODES, OF_EACH, OF_TIP, Particle, ParticleContact, ParticlesState, path_of

MOST = 6
"""particles that a set may have"""


class ParticlesPath(NamedTuple):
    """What happens along a path; one row per point, and one column per particle where there is one of each."""

    tip: Floats
    """x, y, z of its apex [m]"""
    force: Floats
    """x, y, z, of all on the tip [N]: what a lever's deflection shows"""
    stored: Floats
    """in contacts, bristles and lever, 0 at rest [J]"""
    dissipated: Floats
    """heat since the beginning, never falling [J]"""
    work: Floats
    """done by the hand since the beginning [J]"""
    position: Floats
    """x, y, z of their centres [m]; points x particles x 3"""
    turned: Floats
    """sum of their turns about x, y, z [rad]"""
    shares: Floats
    """x, y, z, of each on the tip [N]"""
    touched: NDArray[np.bool_]
    """whether the tip touches it"""
    modes: NDArray[np.uint8]
    """bits of what happened to it on the way to the point, named by ``MODES``"""
    state: ParticlesState
    """at the end"""

    def happened(self, mode: str) -> NDArray[np.bool_]:
        """Where a mode of ``MODES`` was on."""
        if mode not in MODES:
            raise InvalidValue(f"mode {mode!r}: valid are {', '.join(MODES)}")
        return np.asarray((self.modes >> MODES.index(mode)) & 1, dtype=np.bool_)


class Laid(NamedTuple):
    """Particles of a session, or its rod; one row each."""

    positions: Floats
    """of their centres: x, y, z [m]"""
    forces: Floats
    """on the tip: x, y, z [N]"""
    touches: list[int]
    """how often the tip has touched it"""
    losses: list[int]
    """how often the tip has lost it"""
    radius: float
    """of each [m]"""
    length: float
    """of a rod, 0 of spheres [m]"""
    angles: Floats
    """of a rod's axis from x, 0 of spheres [rad]"""
    stored: float
    """in their contacts, 0 at rest [J]"""
    dissipated: float
    """heat so far [J]"""


def polystyrene() -> ParticleContact:
    """Two bodies of it that do not adhere: Hertz, tau = 12 MPa."""
    both = (3.25e9, 0.35, 3.25e9, 0.35)
    return ParticleContact(effective_modulus(*both), effective_shear_modulus(*both), shear_strength=12e6, model="hertz")


@dataclass(frozen=True)
class Particles:
    """Up to six of them, and what pushes.

    Parameters
    ----------
    particle : Particle
        What each is like, and the tip.
    between : ParticleContact, optional
        Of two of them. By default :func:`polystyrene`.
    lever : Lever, optional
        On which the tip hangs; without one it is held where it is told.
    """

    particle: Particle
    between: ParticleContact | None = None
    lever: Lever | None = None

    def __post_init__(self) -> None:
        _ = self._core  # the C library checks the values

    @cached_property
    def _core(self) -> _core.Particles:
        lever = (0.0, 0.0, 0.0) if self.lever is None else self.lever.stiffness
        return core_of(self.particle, self.between or polystyrene(), lever)

    def place(self, places: Sequence[tuple[float, float]], tip: tuple[float, float, float]) -> ParticlesState:
        """At rest at x, y each [m], apart from each other and from the apex of the tip [m]."""
        if len(places) > MOST:
            raise InvalidValue(f"{len(places)} places: valid are up to {MOST}")
        x, y, z = (float(part) for part in tip)
        state = self._core.begin((x, y, z))
        for number, (along, across) in enumerate(places):
            state = self._core.lay(state, number, (float(along), float(across)))
        return ParticlesState(state)

    def lay(self, state: ParticlesState, number: int, place: tuple[float, float]) -> ParticlesState:
        """Take a particle away from where it is, and lay it at rest at another place [m]."""
        return ParticlesState(self._core.lay(state._core, number, (float(place[0]), float(place[1]))))

    def run(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, *, state: ParticlesState) -> ParticlesPath:
        """Lead the tip, or the base of its lever, along points [m], straight from one to the next."""
        last, rows = self._core.run(state._core, path_of(x, y, z))
        each = rows[:, OF_TIP:].reshape(len(rows), -1, OF_EACH)
        stored, dissipated, work = rows[:, 6:9].T
        of_each = each[..., :3], each[..., 3:6], each[..., 6:9], each[..., 9] > 0.0, each[..., 10].astype(np.uint8)
        return ParticlesPath(rows[:, :3], rows[:, 3:6], stored, dissipated, work, *of_each, ParticlesState(last))
