# SPDX-License-Identifier: BSD-3-Clause
"""A rod that lies on a flat and is pushed by a tip: it slides and turns in the plane.

Friction is spread along the line of contact: springs that give way at a limit, as those of a particle
(docs/manipulation.md). A step of the tip ends in the minimum of what they store, of what becomes heat, and of the
energy of the tip's contact. All SI.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, as_floats, check_between
from nanotouch.contact import effective_modulus
from nanotouch.errors import InvalidValue
from nanotouch.friction import effective_shear_modulus


@dataclass(frozen=True)
class Rod:
    """A straight round rod on a substrate, and the tip beside it.

    It adheres as a cylinder does (Chaudhury, Weaver, Hui, Kramer 1996): F/L = pi E* b^2/(4 R) - sqrt(2 pi E* b w), b
    half of the width of the contact. It slides, and does not roll about its axis.

    Parameters
    ----------
    length, radius : float
        L and R [m]; L is 4 R at least.
    effective_modulus, effective_shear_modulus : float
        E* and G* of rod and substrate [Pa].
    work_of_adhesion : float
        w [J/m^2].
    shear_strength : float
        tau, friction per contact area [Pa].
    tip_radius, tip_half_angle : float
        r of the tip [m] and psi of its cone [rad]; 0: it is as wide as its radius all the way up.
    tip_stiffness : float
        Of its contact with the rod, without adhesion and friction [N/m].
    lever : float
        Stiffness between base and tip along x and y [N/m]; 0: the tip is held where it is told.
    elements : int
        Pieces of the line of contact, 8 .. 400.
    step : float
        Largest step of the tip [m]; longer ways are divided.
    """

    length: float
    radius: float
    effective_modulus: float
    effective_shear_modulus: float
    work_of_adhesion: float
    shear_strength: float
    tip_radius: float = 20e-9
    tip_half_angle: float = 0.0
    tip_stiffness: float = 100.0
    lever: float = 0.0
    elements: int = 100
    step: float = 1e-9

    def __post_init__(self) -> None:
        _ = self._core  # the C library checks the values

    @cached_property
    def _core(self) -> _core.Rod:
        return _core.Rod([float(getattr(self, field.name)) for field in fields(self)])

    @property
    def half_width(self) -> float:
        """b0 of the contact without load, b0^3 = 32 R^2 w/(pi E*) [m]."""
        return self._core.half_width()

    @property
    def friction(self) -> float:
        """q = 2 b0 tau, of a length [N/m]."""
        return self._core.friction()

    @property
    def stiffness(self) -> float:
        """Of a length before it slides, pi G*/ln(L/b0) [N/m^2]: a strip on a half space, in its middle."""
        return self._core.stiffness()

    def place(self, x: float, y: float, angle: float, tip: Sequence[float]) -> RodState:
        """At rest with its middle at (x, y) [m], its axis turned by an angle from x [rad]. The tip begins beside it, at
        x and y [m], and its apex at z, or on the substrate."""
        spot = as_floats([*tip, 0.0] if len(tip) == 2 else tip, "tip")
        pose = float(x), float(y), float(angle)
        if spot.shape != (3,) or not np.isfinite([*pose, *spot]).all() or spot[2] < 0.0:
            raise InvalidValue("place and tip: valid are numbers; tip is x and y, or x, y and z >= 0 [m]")
        try:
            return _state_of(self._core.place(pose, (float(spot[0]), float(spot[1]), float(spot[2]))))
        except InvalidValue as error:
            raise InvalidValue(f"tip = ({spot[0]:g}, {spot[1]:g}) m touches the rod: begin beside it") from error

    def run(self, x: ArrayLike, y: ArrayLike, z: ArrayLike = 0.0, *, state: RodState) -> RodPath:
        """Lead the tip's apex, or the base of its lever, along points [m], straight from one to the next."""
        given = (np.atleast_1d(as_floats(values, name)) for values, name in ((x, "x"), (y, "y"), (z, "z")))
        points = np.stack(np.broadcast_arrays(*given), axis=-1)
        if points.ndim != 2 or not len(points) or not np.isfinite(points).all() or (points[:, 2] < 0.0).any():
            raise InvalidValue("x, y, z: valid are numbers in one dimension, one point at least, z >= 0 m")
        begun = np.concatenate([*state[:4], state[4:8], state.pulls.ravel()])
        last, rows = self._core.run(begun, np.ascontiguousarray(points))
        stored, dissipated, work = rows[:, 12:15].T
        return RodPath(rows[:, :2], rows[:, 2], rows[:, 9:12], rows[:, 6:9], stored, dissipated, work, _state_of(last))


def nanowire(
    length: float = 2e-6, radius: float = 100e-9, tip_radius: float = 20e-9, *, tip_half_angle: float = 0.26
) -> Rod:
    """A wire of zinc oxide on silica.

    Parameters
    ----------
    length, radius, tip_radius : float
        [m].
    tip_half_angle : float
        [rad].

    Notes
    -----
    Shear strength 1.05 MPa is the kinetic one of "The kinetic friction of ZnO nanowires on amorphous SiO2 and SiN
    substrates" (1.05 +- 0.28 MPa). w = 75 mJ/m^2 is that of van der Waals forces at 0.165 nm, Hamaker constants
    92 and 65 zJ. Pushed on its middle a wire of 2 um bends by q L^4/(128 E I) = 0.1 nm.
    """
    oxide, silica = (140e9, 0.33), (72e9, 0.17)  # E [Pa] and nu
    return Rod(length, radius, effective_modulus(*oxide, *silica), effective_shear_modulus(*oxide, *silica), 0.075,
               1.05e6, tip_radius, tip_half_angle)  # fmt: skip


class RodState(NamedTuple):
    """Where a rod is, and what it remembers: enough to go on from."""

    pose: Floats
    """x and y of its middle [m], angle of its axis from x [rad]"""
    base: Floats
    """x, y, z: where the tip's apex would be without a force [m]"""
    tip: Floats
    """x, y, z of the tip's apex [m]"""
    force: Floats
    """x, y, z, on the tip [N]"""
    stored: float
    """[J]"""
    dissipated: float
    """heat so far, never falling [J]"""
    work: float
    """done by the hand so far [J]"""
    resistance: float
    """-dF_z by the tip's way along z [N/m]"""
    pulls: Floats
    """of each element, x and y [N]"""


class RodPath(NamedTuple):
    """What happens along a path of the tip; one row per point."""

    position: Floats
    """x and y of the rod's middle [m]"""
    angle: Floats
    """of its axis from x [rad]"""
    force: Floats
    """x, y, z, on the tip [N]: what a lever's deflection shows"""
    tip: Floats
    """x, y, z of its apex [m]"""
    stored: Floats
    """in springs, contact and lever [J]"""
    dissipated: Floats
    """heat since the beginning, never falling [J]"""
    work: Floats
    """done by the hand since the beginning [J]"""
    state: RodState
    """at the end"""


def _state_of(row: Floats) -> RodState:
    """From one array."""
    stored, dissipated, work, resistance = (float(value) for value in row[12:16])
    pulls = row[16:].reshape(-1, 2)
    return RodState(row[:3], row[3:6], row[6:9], row[9:12], stored, dissipated, work, resistance, pulls)


def turning_point(length: float, arm: float) -> float:
    """Where a rod turns that is pushed across its axis: distance from the middle, on the other side than the push [m].

    Friction is spread evenly. Force and torque balance where c = sqrt(arm^2 + L^2/4) - arm; the push is 2 q c. A push
    on the middle does not turn it: L/2 is the limit.
    """
    check_between("length", length, "m", above=0.0)
    if not 0.0 <= arm <= 0.5 * length:
        raise InvalidValue(f"arm = {arm:g} m: valid is 0 .. {0.5 * length:g} m, half of the length")
    return _core.rod_turning_point(length, arm)
