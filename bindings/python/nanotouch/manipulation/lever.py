# SPDX-License-Identifier: BSD-3-Clause
"""A tip on a lever that pushes a particle: the base is led, the tip follows through springs, and what it loses is felt.

After each step of the base particle and tip are where all forces balance. What a tip that snaps or slips sets free is
heat: the hand gets nothing from it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch import _core
from nanotouch._arrays import Floats, check_between
from nanotouch.errors import InvalidValue
from nanotouch.units import in_words

from .particle import OF_TIP, Particle, ParticleContact, ParticlesState, path_of

AHEAD = 0.2
"""of a radius: how much further than wanted the operator of a push goes at most, for what gives way"""
_FELT = 0.1  # of a tolerance: a lever that gives less is left out


class LeverPath(NamedTuple):
    """What happens along a path of the base; one row per point."""

    tip: Floats
    """x, y, z of its apex [m]"""
    position: Floats
    """x, y, z of the particle's centre [m]"""
    force: Floats
    """x, y, z, on the tip [N]: what the lever's deflection shows"""
    stored: Floats
    """in contacts, bristles and lever [J]"""
    dissipated: Floats
    """heat since the beginning, never falling [J]"""
    work: Floats
    """done on the base since the beginning [J]"""
    lost: NDArray[np.bool_]
    """whether the tip has lost the particle on the way to the point"""
    state: ParticlesState
    """at the end"""


@dataclass(frozen=True)
class Lever:
    """Springs between base and tip.

    Parameters
    ----------
    stiffness : tuple of float
        Along x, y, z [N/m]: sideways torsion and in-plane bending, up and down the spring constant.
    """

    stiffness: tuple[float, float, float]

    def __post_init__(self) -> None:
        if len(self.stiffness) != 3:
            raise InvalidValue(f"stiffness = {self.stiffness!r}: valid are three, along x, y, z")
        for value in self.stiffness:
            check_between("stiffness", value, "N/m", above=0.0)

    def run(
        self, particle: Particle, x: ArrayLike, y: ArrayLike, z: ArrayLike, *, state: ParticlesState | None = None
    ) -> LeverPath:
        """Lead the base along points [m], straight from one to the next; it and the tip begin together, apart from the
        particle, which rests at x = y = 0."""
        bases = path_of(x, y, z)
        core = core_of(particle, particle.tip, self.stiffness)  # what lies between two is not asked
        if state is None:
            first = bases[0]
            state = ParticlesState(core.lay(core.begin((first[0], first[1], first[2])), 0, (0.0, 0.0)))
        touched = state._core.read()[OF_TIP + 9] > 0.0
        last, rows = core.run(state._core, bases)
        touches = rows[:, OF_TIP + 9] > 0.0
        lost = np.concatenate([[touched], touches[:-1]]) & ~touches
        stored, dissipated, work = rows[:, 6:9].T
        ends = stored, dissipated, work, lost, ParticlesState(last)
        return LeverPath(rows[:, :3], rows[:, OF_TIP : OF_TIP + 3], rows[:, 3:6], *ends)


def core_of(particle: Particle, between: ParticleContact, lever: Sequence[float]) -> _core.Particles:
    """What lies and what pushes, made ready by the C library."""
    return _core.Particles([*particle._all(), *between._values(), *map(float, lever)])


def give(lever: Lever, particle: Particle) -> float:
    """How far a lever gives way under a push at a third of the particle's radius, at most along one axis [m]."""
    side, up, _ = _held(particle, 0.3 * particle.radius)
    return max(side / min(lever.stiffness[:2]), up / lever.stiffness[2])


def needed(lever: Lever | None, particle: Particle, left: float) -> Lever | None:
    """None where it gives less than what could matter to a push over `left`, the last one [m]; refused where that push,
    with all that the operator adds, leaves the particle where it is."""
    if lever is None or give(lever, particle) <= _FELT * left:
        return None
    (soft, _), up, length = sorted(lever.stiffness[:2]), lever.stiffness[2], left + AHEAD * particle.radius
    if _moves(soft, up, particle, length):
        return lever
    force, _, way = _held(particle, length)
    low, high = soft, 2.0 * force / max(way, 1e-3 * length)
    if not _moves(high, max(high, up), particle, length):
        return lever  # a tip that is held does not move it either
    if not _moves(high, up, particle, length):
        raise InvalidValue(
            f"lever: stiffness = {up:g} N/m along z: the tip clings to the particle and drags it back; "
            f"{high:.3g} N/m is enough"
        )
    while high > 1.01 * low:
        middle = float(np.sqrt(low * high))
        low, high = (low, middle) if _moves(middle, up, particle, length) else (middle, high)
    raise InvalidValue(
        f"lever: stiffness = {soft:g} N/m sideways: a push of {in_words(force, 'N', 3)} would bend it by "
        f"{in_words(force / soft, 'm', 3)}, and the particle stays where it is; valid is {high:.3g} N/m and above"
    )


def _moves(side: float, up: float, particle: Particle, length: float) -> bool:
    """Whether a push by a lever of stiffnesses [N/m], there and back, leaves the particle elsewhere."""
    x = np.array([-0.05 * particle.radius, length, -0.05 * particle.radius]) - reach_of(particle, low_of(particle))
    path = Lever((side, side, up)).run(particle, x, 0.0, low_of(particle))
    return bool(path.position[-1, 0] > 1e-3 * particle.radius)


def _held(particle: Particle, length: float) -> tuple[float, float, float]:
    """A push by a tip that is held: its force sideways and up [N], and how far the particle goes [m]."""
    x = np.array([-0.05 * particle.radius, length]) - reach_of(particle, low_of(particle))
    path = particle.run(x, 0.0, low_of(particle))
    side, _, up = np.abs(path.force[-1])
    return float(side), float(up), float(path.position[-1, 0])


def low_of(particle: Particle) -> float:
    """Height of a push [m]."""
    return 0.3 * particle.radius


def reach_of(particle: Particle, height: float) -> float:
    """From the middle of the particle to the apex of a tip whose flank touches, at a height [m]."""
    psi, both = particle.tip_half_angle, particle.radius + particle.tip_radius
    up = particle.radius - particle.tip_radius - height
    return float((both + up * np.sin(psi)) / np.cos(psi))
