# SPDX-License-Identifier: BSD-3-Clause
"""Contact of tips that are not paraboloids, and what a contact law is worth where it is used.

A :class:`Shape` is a rigid tip; :func:`evaluate` presses it into an elastic half-space without adhesion (Galin's and
Sneddon's integrals in closed form), :func:`jkr` with adhesion of zero range. :func:`validity` says whether a law is
inside its range. :func:`stage_displacement` solves the paper's Eq. 5-8. All SI; docs/geometry.md has the equations,
sources and measured errors.
"""

from __future__ import annotations

import enum
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, LawValue, as_floats, as_law, check_between, plain
from nanotouch.contact import BRANCHES, Branch, Contact
from nanotouch.errors import InvalidValue

Kind = Literal["paraboloid", "sphere", "cone", "punch", "blunted", "truncated"]
KINDS: tuple[Kind, ...] = get_args(Kind)

LAMBDA_PER_TABOR: float = _core.lambda_per_tabor
"""Maugis' lambda over Tabor's mu: 32/(9 sqrt(3)) (9/(16 pi))^(1/3) = 1.157."""


@dataclass(frozen=True)
class Shape:
    """A rigid tip.

    Parameters
    ----------
    kind : str
        ``"paraboloid"`` and ``"sphere"`` (radius), ``"cone"`` (half_angle), ``"punch"`` (radius of its flat end),
        ``"blunted"`` (a cone that ends in a paraboloid cap: radius of the cap, half_angle, transition), ``"truncated"``
        (a cone that ends in a flat: radius of the flat, half_angle).
    radius : float
        Of the cap, sphere or flat end [m], 1e-10 to 1.
    half_angle : float
        Between axis and flank, for pyramids between axis and face [rad], 0.01 to 1.56.
    sides : int
        0 for round cones, 3 or 4 for regular pyramids, treated as the cone of :func:`pyramid_equivalent_angle`.
    transition : float
        Radius at which cap and flank of ``"blunted"`` meet [m], at most radius/tan(half_angle), where they are
        tangent; 0 means that.
    """

    kind: Kind
    radius: float = 0.0
    half_angle: float = 0.0
    sides: int = 0
    transition: float = 0.0

    def __post_init__(self) -> None:
        _ = self._law  # the C library checks the values

    @property
    def _law(self) -> _core.Shape:
        if self.kind not in KINDS:
            raise InvalidValue(f"kind {self.kind!r}: valid are {', '.join(KINDS)}")
        if self.sides not in (0, 3, 4):
            raise InvalidValue(f"sides = {self.sides}: it must be 0 (round), 3 or 4")
        return _core.Shape(KINDS.index(self.kind), self.sides, self.radius, self.half_angle, self.transition)


def _pair(first: ArrayLike, name: str, second: ArrayLike, second_name: str) -> tuple[Floats, Floats]:
    """Two arrays, broadcast against each other."""
    pair = np.broadcast_arrays(as_floats(first, name), as_floats(second, second_name))
    return np.ascontiguousarray(pair[0]).reshape(pair[0].shape), np.ascontiguousarray(pair[1]).reshape(pair[1].shape)


def _with_modulus(values: ArrayLike, name: str, effective_modulus: ArrayLike) -> tuple[Floats, Floats]:
    if not np.all(as_floats(effective_modulus, "effective_modulus") > 0.0):
        raise InvalidValue(f"effective_modulus = {effective_modulus!r} Pa: it must be above 0 Pa")
    return _pair(values, name, effective_modulus, "effective_modulus")


def evaluate(shape: Shape, indentation: ArrayLike, effective_modulus: ArrayLike) -> LawValue:
    """Energy [J], force [N], stiffness [N/m], contact radius [m] at an indentation [m], without adhesion.

    With the profile f(r) of the shape: delta = a Int f'/sqrt(a^2 - r^2) dr, F = 2 E* Int r^2 f'/sqrt(a^2 - r^2) dr,
    k = 2 E* a. Sphere: delta = a/2 ln((R + a)/(R - a)) (Sneddon 1965). Cone: F = 2/pi E* tan(psi) delta^2. Pyramid:
    F = C E* tan(psi) delta^2, C = 0.73762 (4 sides), 0.87960 (3); its a is that of the round contact of the same
    stiffness. Blunted, truncated: Briscoe, Sebastian, Adams 1994. All 0 for delta <= 0. Range: :func:`validity`.

    Parameters
    ----------
    shape : Shape
    indentation, effective_modulus : array_like, shape (...)
        delta [m] and E* [Pa], broadcast against each other.

    Returns
    -------
    LawValue
        Four arrays of shape (...), or floats.
    """
    return as_law(shape._law.eval(*_with_modulus(indentation, "indentation", effective_modulus)))


def force(shape: Shape, indentation: ArrayLike, effective_modulus: ArrayLike) -> Any:
    """Force [N] at an indentation [m]: :func:`evaluate` for the force alone."""
    return evaluate(shape, indentation, effective_modulus).F


def indentation(shape: Shape, force: ArrayLike, effective_modulus: ArrayLike) -> Any:
    """Indentation [m] at a force [N], without adhesion; NaN for negative forces."""
    return plain(shape._law.indentation(*_with_modulus(force, "force", effective_modulus))[0])


def pyramid_equivalent_angle(sides: int, half_angle: float) -> float:
    """Half angle [rad] of the cone that obeys a pyramid's law, tan(psi_eq) = (pi/2) C tan(psi).

    C = 0.73762 (4 sides), 0.87960 (3 sides): our numerical solution of the contact, to 1e-4. Bilodeau (1992) gave
    0.7453 and 0.887 approximately; the cone of equal cross-section would be 0.7184 and 0.8187.
    """
    return _core.pyramid_equivalent_angle(Shape("cone", half_angle=half_angle, sides=sides).sides, half_angle)


def _adhesive(shape: Shape, effective_modulus: float, work_of_adhesion: float) -> _core.JkrShape:
    if shape.kind not in ("paraboloid", "cone", "punch") or (shape.kind == "cone" and shape.sides):
        raise InvalidValue(
            f"JKR holds for paraboloid, round cone and punch, not for {shape.kind} of {shape.sides} sides"
        )
    return _core.JkrShape(shape._law, effective_modulus, work_of_adhesion)


def jkr(
    shape: Shape,
    indentation: ArrayLike,
    effective_modulus: float,
    *,
    work_of_adhesion: float,
    branch: Branch = "stable",
) -> LawValue:
    """JKR adhesion of a paraboloid, cone (Maugis, Barquins 1983) or punch (Kendall 1971) at an indentation [m].

    delta = delta_0(a) - s, F = F_0(a) - 2 E* a s, s = sqrt(2 pi w a/E*). Branches as in :mod:`nanotouch.contact`; NaN
    where there is none.
    """
    made = _adhesive(shape, effective_modulus, work_of_adhesion)
    return as_law(made.eval(as_floats(indentation, "indentation"), _number(branch)))


def jkr_indentation(
    shape: Shape, force: ArrayLike, effective_modulus: float, *, work_of_adhesion: float, branch: Branch = "stable"
) -> Any:
    """Indentation [m] at a force [N] with JKR adhesion; NaN below minus the pull-off force."""
    made = _adhesive(shape, effective_modulus, work_of_adhesion)
    return plain(made.indentation(as_floats(force, "force"), _number(branch)))


def jkr_pull_off_force(shape: Shape, effective_modulus: float, work_of_adhesion: float) -> float:
    """Pull-off force under a dead load, positive [N].

    Cone 54 w^2 tan(psi)^3/(pi E*), punch sqrt(8 pi E* w a^3), paraboloid 1.5 pi w R.
    """
    return _adhesive(shape, effective_modulus, work_of_adhesion).pull_off_force


def jkr_pull_off_indentation(shape: Shape, effective_modulus: float, work_of_adhesion: float) -> float:
    """Last indentation that grips hold, negative [m]: cone -w tan(psi)/E*, punch -sqrt(2 pi w a/E*)."""
    return _adhesive(shape, effective_modulus, work_of_adhesion).pull_off_indentation


def _number(branch: Branch) -> int:
    if branch not in BRANCHES:
        raise InvalidValue(f"branch {branch!r}: valid are {', '.join(BRANCHES)}")
    return BRANCHES.index(branch)


class Outside(enum.IntFlag):
    """What is outside its range."""

    RADIUS_RATIO = 1
    """a/R of a paraboloid above 0.3: the sphere's force is then 0.9 % lower"""
    SLOPE = 2
    """slope of the tip's surface at the edge above 0.5: sideways motion of the surface, up to some 10 % of the force"""
    STRAIN = 4
    """representative strain above 0.1: linear elasticity"""
    THICKNESS = 8
    """a/t above 0.1: a bonded incompressible layer is then 13 % stiffer (Dimitriadis et al. 2002)"""


class Validity(NamedTuple):
    """How a contact stands to the assumptions of its law; arrays, or floats and an :class:`Outside` for scalars."""

    radius_ratio: Any
    """a/R [-]; 0 for shapes without a radius"""
    slope: Any
    """of the tip's surface at the edge of the contact [-]"""
    strain: Any
    """representative strain [-]: 0.2 slope (0.2 a/R for spheres), punch ``0.3 |delta|/a``"""
    thickness_ratio: Any
    """a/t [-]"""
    outside: Any
    """:class:`Outside` flags, for arrays as integers; 0: within range"""


def validity(shape: Shape, contact_radius: ArrayLike, indentation: ArrayLike, *, thickness: float = np.inf) -> Validity:
    """Judge contacts by the radius [m] and indentation [m] that a law gave, with adhesion or without.

    ``thickness`` is that of the sample [m]. A law gives a number outside its range, too; this tells.

    >>> tip = Shape("paraboloid", radius=30e-9)
    >>> validity(tip, contact_radius=132e-9, indentation=100e-9).outside == 0  # the paper's rubber: a/R = 4.4
    False
    """
    check_between("thickness", thickness, "m", above=0.0)
    a, d = _pair(contact_radius, "contact_radius", indentation, "indentation")
    if not (np.all(np.isfinite(a)) and np.all(np.isfinite(d)) and np.all(a >= 0.0)):
        raise InvalidValue("contact_radius and indentation must be finite [m], the radius not negative")
    ratio, slope, strain, thickness_ratio, outside = shape._law.validity(a, d, thickness)
    flags = outside.astype(np.int64)
    found = plain(ratio), plain(slope), plain(strain), plain(thickness_ratio)
    return Validity(*found, flags if flags.ndim else Outside(int(flags)))


class StageDisplacement(NamedTuple):
    """Where a stage displacement goes."""

    indentation: Any
    """delta [m]"""
    deflection: Any
    """zeta of the lever [m]"""
    law: LawValue
    """the tip at that indentation"""


def stage_displacement(
    shape: Shape, displacement: ArrayLike, effective_modulus: ArrayLike, *, spring_constant: float, angle: float = 0.0
) -> StageDisplacement:
    """Indentation and deflection at a stage displacement Delta [m] beyond first touch (paper, Eq. 5-7; E6, E7).

    Solves Delta = delta + cos(alpha) P(delta)/k_c for any shape without adhesion; ``spring_constant`` k_c [N/m],
    ``angle`` alpha between lever and sample [rad]. Broadcast over displacement and modulus.
    """
    check_between("spring_constant", spring_constant, "N/m", above=0.0)
    if not 0.0 <= angle < np.pi / 2:
        raise InvalidValue(f"angle = {angle:g} rad: it must be from 0 to below pi/2")
    D, E = _with_modulus(displacement, "displacement", effective_modulus)
    delta, zeta, *columns = shape._law.stage_displacement(D, E, spring_constant, angle)
    return StageDisplacement(plain(delta), plain(zeta), as_law((columns[0], columns[1], columns[2], columns[3])))


def stage_displacement_approximate(
    displacement: ArrayLike, radius: float, effective_modulus: float, *, spring_constant: float, angle: float = 0.0
) -> Any:
    """Indentation [m] by the paper's Eq. 8: k_c Delta/(k_c + K cos(alpha) sqrt(2 Delta R)), of a sphere.

    It is 0.10 to 0.18 of the solution for silicon, k_c = 8 N/m, Delta = 1 to 20 nm (erratum E8): for comparison only.
    """
    D = as_floats(displacement, "displacement")
    return plain(_core.stage_displacement_approximate(D, radius, effective_modulus, spring_constant, angle)[0])


def effective_radius(radius: float, other_radius: float) -> float:
    """R [m] of sphere on sphere, 1/R = 1/R1 + 1/R2; a flat is ``inf``, a hollow has a negative radius."""
    return _core.effective_radius(radius, other_radius)


def tabor_mu(contact: Contact, equilibrium_distance: float) -> float:
    """Tabor's mu = (R w^2/(E*^2 z0^3))^(1/3), z0 [m]; Maugis' lambda is :data:`LAMBDA_PER_TABOR` times mu."""
    check_between("equilibrium_distance", equilibrium_distance, "m", above=0.0)
    return _core.tabor_mu(contact.radius, contact.effective_modulus, contact.work_of_adhesion, equilibrium_distance)


def cohesive_stress_of_range(work_of_adhesion: float, cohesive_range: float) -> float:
    """sigma0 = w/h0 [Pa] of an attraction that reaches a gap h0 [m]."""
    check_between("cohesive_range", cohesive_range, "m", above=0.0)
    return _core.cohesive_stress_of_range(work_of_adhesion, cohesive_range)


def cohesive_stress_laplace(surface_tension: float, meniscus_radius: float) -> float:
    """sigma0 = gamma/r1 [Pa]: Laplace pressure of a water bridge; with w = 2 gamma its range is 2 r1 (erratum E12)."""
    check_between("meniscus_radius", meniscus_radius, "m", above=0.0)
    return _core.cohesive_stress_laplace(surface_tension, meniscus_radius)
