# SPDX-License-Identifier: BSD-3-Clause
"""A sphere on a flat substrate, pushed by a tip: it sticks, slides, rolls, spins, or comes off with the tip.

docs/manipulation.md has the equations, what was measured against what, and what is left out. All SI.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch import _core
from nanotouch._arrays import Floats, as_floats
from nanotouch.contact import MODELS, Model
from nanotouch.errors import InvalidValue

Side = Literal["substrate", "tip"]
Motion = Literal["slide", "roll", "spin"]
SIDES: tuple[Side, ...] = get_args(Side)
MOTIONS: tuple[Motion, ...] = get_args(Motion)
MODES = (*MOTIONS, *(f"tip {motion}" for motion in MOTIONS), "lifted", "apart")
"""names of the bits of ``ParticlePath.modes``, from the lowest"""
OF_TIP, OF_EACH = 9, 11  # columns of a set: of the tip, then of each particle


@dataclass(frozen=True)
class ParticleContact:
    """What one of the two contacts of a particle is like.

    Parameters
    ----------
    effective_modulus : float
        E* [Pa].
    effective_shear_modulus : float
        G* [Pa], see :func:`nanotouch.friction.effective_shear_modulus`; E*/6 .. E*/3.
    work_of_adhesion : float
        w [J/m^2].
    shear_strength : float
        tau, friction per contact area [Pa].
    rolling_distance : float
        xi, the way that the contact rolls before it gives way [m].
    coefficient : float
        alpha, friction per load inside the contact.
    model : str
        ``"hertz"``, ``"dmt"``, ``"jkr"`` or ``"maugis"``.
    cohesive_stress : float
        sigma0 [Pa], for ``"maugis"``.
    """

    effective_modulus: float
    effective_shear_modulus: float
    work_of_adhesion: float = 0.0
    shear_strength: float = 0.0
    rolling_distance: float = 0.0
    coefficient: float = 0.0
    model: Model = "jkr"
    cohesive_stress: float = 0.0

    def _values(self) -> list[float]:
        if self.model not in MODELS:
            raise InvalidValue(f"model {self.model!r}: valid are {', '.join(MODELS)}")
        return [
            float(MODELS.index(self.model)),
            self.effective_modulus,
            self.work_of_adhesion,
            self.cohesive_stress,
            self.effective_shear_modulus,
            self.shear_strength,
            self.coefficient,
            self.rolling_distance,
        ]


@dataclass(frozen=True)
class ParticleState:
    """Where a particle is, and what it remembers: enough to go on from."""

    _core: _core.ParticleState = field(repr=False)

    @property
    def position(self) -> tuple[float, float, float]:
        """of its centre; the substrate is z = 0 [m]"""
        row, _ = self._core.read()
        return row[0], row[1], row[2]

    @property
    def tip(self) -> tuple[float, float, float]:
        """apex of the tip [m]"""
        _, tip = self._core.read()
        return tip[0], tip[1], tip[2]


@dataclass(frozen=True)
class ParticlesState:
    """Where tip and particles are, and what they remember: enough to go on from."""

    _core: _core.ParticlesState = field(repr=False)

    @property
    def base(self) -> Floats:
        """where the tip's apex would be without a force: x, y, z [m]"""
        return np.array(self._core.base)

    @property
    def tip(self) -> Floats:
        """its apex: x, y, z [m]"""
        return np.array(self._core.read()[:3])

    @property
    def positions(self) -> Floats:
        """of their centres, one row each: x, y, z [m]"""
        return np.array(self._core.read()[OF_TIP:]).reshape(-1, OF_EACH)[:, :3]


class ParticlePath(NamedTuple):
    """What happens along a path of the tip; one row per point."""

    position: Floats
    """x, y, z of the particle's centre [m]"""
    turned: Floats
    """sum of its turns about x, y, z [rad]"""
    force: Floats
    """x, y, z, on the tip [N]"""
    stored: Floats
    """in contacts and bristles, 0 at rest [J]"""
    dissipated: Floats
    """heat since the beginning, never falling [J]"""
    work: Floats
    """done by the hand since the beginning [J]"""
    contact_force: Floats
    """of the substrate and of the tip, + presses [N]"""
    contact_radius: Floats
    """of the substrate and of the tip [m]"""
    given: Floats
    """way by which sliding, rolling, spinning at the substrate, then at the tip, gave way; turns times R [m]"""
    modes: NDArray[np.uint8]
    """bits of what happened on the way to the point, named by ``MODES``"""
    state: ParticleState
    """at the end"""

    def happened(self, mode: str) -> NDArray[np.bool_]:
        """Where a mode of ``MODES`` was on."""
        if mode not in MODES:
            raise InvalidValue(f"mode {mode!r}: valid are {', '.join(MODES)}")
        return np.asarray((self.modes >> MODES.index(mode)) & 1, dtype=np.bool_)


@dataclass(frozen=True)
class Particle:
    """A sphere on a flat substrate at z = 0, and an upright tip: a sphere that runs into a cone.

    Parameters
    ----------
    radius : float
        R [m].
    substrate, tip : ParticleContact
        What its two contacts are like.
    tip_radius : float
        Of the tip where it touches [m].
    tip_half_angle : float
        Of its cone [rad].
    step : float
        Largest step of the tip [m]; longer ways are divided.
    """

    radius: float
    substrate: ParticleContact
    tip: ParticleContact
    tip_radius: float = 100e-9
    tip_half_angle: float = 0.26
    step: float = 2e-9

    def __post_init__(self) -> None:
        _ = self._core  # the C library checks the values

    @cached_property
    def _core(self) -> _core.Pushing:
        return _core.Pushing(self._all())

    def _all(self) -> list[float]:
        values = [self.radius, self.tip_radius, self.tip_half_angle, self.step]
        return [*map(float, values + self.substrate._values() + self.tip._values())]

    def pull_off(self, side: Side) -> float:
        """F_c of a contact [N]."""
        return self._core.rest(_index(SIDES, side, "side"))[0]

    def rest_radius(self, side: Side) -> float:
        """a0, of a contact without load [m]."""
        return self._core.rest(_index(SIDES, side, "side"))[1]

    def limit(self, side: Side, motion: Motion, radius: float, compressive_load: float = 0.0) -> float:
        """Where a contact of a radius [m] and a load inside it [N] gives way: slide [N], roll and spin [N m]."""
        _check_at_least_zero(radius=radius, compressive_load=compressive_load)
        which, bristle = _index(SIDES, side, "side"), _index(MOTIONS, motion, "motion")
        return self._core.limit(which, bristle, radius, compressive_load)

    def stiffness(self, side: Side, motion: Motion, radius: float) -> float:
        """Below the limit: slide [N/m], roll and spin [N m/rad]."""
        _check_at_least_zero(radius=radius)
        return self._core.stiffness(_index(SIDES, side, "side"), _index(MOTIONS, motion, "motion"), radius)

    def place(self, x: float, y: float, tip: tuple[float, float, float]) -> ParticleState:
        """At rest on the substrate, the apex of the tip where it does not touch [m]."""
        return ParticleState(self._core.place(float(x), float(y), tip))

    def run(self, x: ArrayLike, y: ArrayLike, z: ArrayLike, *, state: ParticleState | None = None) -> ParticlePath:
        """Move the apex of the tip along a path, straight from point to point.

        Parameters
        ----------
        x, y, z : array_like
            Points of the path [m], one-dimensional; z = 0 is the substrate.
        state : ParticleState, optional
            Go on from here. Without it the particle rests at x = y = 0, and the tip comes from the first point.
        """
        tips = path_of(x, y, z)
        begun = state or self.place(0.0, 0.0, (float(tips[0, 0]), float(tips[0, 1]), float(tips[0, 2])))
        last, rows = self._core.run(begun._core, tips)
        position, turned, force = rows[:, :3], rows[:, 3:6], rows[:, 6:9]
        stored, dissipated, work = rows[:, 9:12].T
        modes = rows[:, 22].astype(np.uint8)
        ends = rows[:, 12:16:2], rows[:, 13:16:2], rows[:, 16:22], modes, ParticleState(last)
        return ParticlePath(position, turned, force, stored, dissipated, work, *ends)


def path_of(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Floats:
    """Points of a path, one row each [m]."""
    columns = [np.atleast_1d(as_floats(value, name)) for name, value in zip("xyz", (x, y, z), strict=True)]
    points = np.stack(np.broadcast_arrays(*columns), axis=-1)
    if points.ndim != 2 or not len(points) or not np.isfinite(points).all():
        raise InvalidValue("x, y, z: valid are numbers in one dimension, one point at least")
    return np.ascontiguousarray(points)


def latex(radius: float, tip_radius: float | None = None, tip_half_angle: float = 0.26) -> Particle:
    """A sphere of polystyrene on glass, and a coated tip that holds it little.

    Parameters
    ----------
    radius, tip_radius : float
        [m]; without one the tip has a tenth of the particle's.
    tip_half_angle : float
        [rad].

    Notes
    -----
    Shear strength 12 MPa and rolling distances of 0.0084 radii are those of Sumer and Sitti (2008). Assumed are
    w = 60 mJ/m^2 to the glass and 10 mJ/m^2 to the tip.
    """
    tip_radius = 0.1 * radius if tip_radius is None else tip_radius
    modulus, shear = 3.63e9, 0.85e9  # E* and G* of polystyrene on glass [Pa]
    glass = ParticleContact(modulus, shear, 0.06, shear_strength=12e6, rolling_distance=0.0084 * radius)
    tip = ParticleContact(modulus, shear, 0.01, shear_strength=12e6, rolling_distance=0.0084 * tip_radius)
    return Particle(radius, glass, tip, tip_radius=tip_radius, tip_half_angle=tip_half_angle)


def _index(names: tuple[str, ...], name: str, what: str) -> int:
    if name not in names:
        raise InvalidValue(f"{what} {name!r}: valid are {', '.join(names)}")
    return names.index(name)


def _check_at_least_zero(**values: float) -> None:
    for name, value in values.items():
        if not value >= 0.0:
            raise InvalidValue(f"{name} = {value:g}: valid is 0 and above")
