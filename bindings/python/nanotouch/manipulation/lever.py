# SPDX-License-Identifier: BSD-3-Clause
"""A tip on a lever that pushes a particle: the base is led, the tip follows through springs, and what it loses is felt.

After each step of the base the tip goes to where the springs balance the particle's force. It creeps there without
inertia, along the force that is left. What a tip that snaps or slips sets free is heat: the hand gets nothing from it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch._arrays import Floats, as_floats, check_between
from nanotouch.errors import Error, InvalidValue

from .particle import Particle, ParticlePath, ParticleState

_ROUNDS, _HALVINGS = 2000, 40
_EXACT, _FAINT = 1e-6, 1e-14  # of the forces; [N]
_PROBE = 1e-3  # of a step: for the stiffness of what is pushed


class LeverState(NamedTuple):
    """Where base, tip and particle are: enough to go on from."""

    base: Floats
    """where the tip would be without a force: x, y, z [m]"""
    particle: ParticleState
    dissipated: float
    """heat so far, with that of the tip's jumps [J]"""
    work: float
    """done on the base so far [J]"""


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
    state: LeverState
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
        self, particle: Particle, x: ArrayLike, y: ArrayLike, z: ArrayLike, *, state: LeverState | None = None
    ) -> LeverPath:
        """Lead the base along points [m], straight from one to the next; it and the tip begin together, apart from the
        particle, which rests at x = y = 0."""
        columns = [np.atleast_1d(as_floats(value, name)) for name, value in zip("xyz", (x, y, z), strict=True)]
        bases = np.stack(np.broadcast_arrays(*columns), axis=-1)
        if bases.ndim != 2 or not len(bases) or not np.isfinite(bases).all():
            raise InvalidValue("x, y, z: valid are numbers in one dimension, one point at least")
        if state is None:
            first = bases[0]
            state = LeverState(first, particle.place(0.0, 0.0, (first[0], first[1], first[2])), 0.0, 0.0)
        moving = _Moving(particle, np.array(self.stiffness), state)
        rows = []
        for base in bases:
            way, start, touched = base - moving.base, moving.base, moving.touches
            steps = max(1, math.ceil(float(np.linalg.norm(way)) / particle.step))
            for number in range(1, steps + 1):
                moving.lead(base if number == steps else start + way * (number / steps))
            rows.append((*moving.row(), touched and not moving.touches))
        tip, position, force, stored, dissipated, work, lost = (np.array(part) for part in zip(*rows, strict=True))
        end = LeverState(moving.base, moving.path.state, float(dissipated[-1]), float(work[-1]))
        return LeverPath(tip, position, force, stored, dissipated, work, lost, end)


class _Moving:
    """Base, tip and particle on their way."""

    def __init__(self, particle: Particle, stiffness: Floats, state: LeverState) -> None:
        self.particle, self.k, self.base = particle, stiffness, state.base
        self.dissipated, self.work = state.dissipated, state.work
        self.tip = np.array(state.particle.tip)
        self.path = self._to(self.tip, state.particle)

    def _to(self, tip: Floats, state: ParticleState) -> ParticlePath:
        return self.particle.run(*(float(part) for part in tip), state=state)

    @property
    def touches(self) -> bool:
        """Whether the tip does."""
        return bool(self.path.contact_force[-1, 1] != 0.0 or self.path.contact_radius[-1, 1] > 0.0)

    def row(self) -> tuple[Floats, Floats, Floats, float, float, float]:
        """All of it now."""
        path = self.path
        stored = float(path.stored[-1]) + self._in_lever(self.tip)
        return self.tip, path.position[-1], path.force[-1], stored, self.dissipated, self.work

    def _in_lever(self, tip: Floats) -> float:
        return 0.5 * float(self.k @ (self.base - tip) ** 2)

    def lead(self, base: Floats) -> None:
        """The base goes on, then the tip to where forces balance."""
        before, way, begun = self.k * (self.base - self.tip), base - self.base, self._energies()
        self.base = base
        for _ in range(_ROUNDS):
            pull, force = self.k * (base - self.tip), self.path.force[-1]
            left = pull + force
            size = float(np.abs(pull).max() + np.abs(force).max())
            if float(np.abs(left).max()) <= _EXACT * size + _FAINT or not self._creep(left):
                break
        left = self.k * (base - self.tip) + self.path.force[-1]
        if not float(np.abs(left).max()) <= 1e-3 * size + 1e-12:
            raise Error("lever: its force and the particle's do not balance; a smaller step may help")
        self._account(begun, (float(before @ way), float((self.k * (base - self.tip)) @ way)))

    def _energies(self) -> tuple[float, float]:
        return float(self.path.stored[-1]) + self._in_lever(self.tip), float(self.path.dissipated[-1])

    def _account(self, begun: tuple[float, float], works: tuple[float, float]) -> None:
        """Work lies between the forces at both ends times the way; what is missing was set free in a jump."""
        stored, heat = self._energies()
        slipped = heat - begun[1]
        kept = stored - begun[0] + slipped
        jump = max(min(works) - kept, 0.0)
        self.dissipated += slipped + jump
        self.work += kept + jump

    def _creep(self, left: Floats) -> bool:
        """Along what is left, no further than to where it would turn back. False: no way is left."""
        way = np.linalg.solve(np.diag(self.k) + self._resists(), left)
        way *= min(1.0, self.particle.step / float(np.linalg.norm(way)))
        for _ in range(_HALVINGS):
            tip = self.tip + way
            path = self._to(tip, self.path.state)
            then = self.k * (self.base - tip) + path.force[-1]
            if float(then @ way) >= -1e-9 * float(left @ way):
                self.tip, self.path = tip, path
                return True
            way = 0.5 * way
        return False

    def _resists(self) -> Floats:
        """Stiffness of what is pushed, from small ways; never below 0."""
        probe = _PROBE * self.particle.step
        columns = [
            (self.path.force[-1] - self._to(self.tip + probe * unit, self.path.state).force[-1]) / probe
            for unit in np.eye(3)
        ]
        whole = np.array(columns)
        values, vectors = np.linalg.eigh(0.5 * (whole + whole.T))
        return np.asarray(vectors @ np.diag(np.maximum(values, 0.0)) @ vectors.T)
