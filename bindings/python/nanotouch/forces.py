# SPDX-License-Identifier: BSD-3-Clause
"""Non-contact forces between a spherical tip and a flat at a gap [m] (paper, Eq. 1, with the errata corrected).

Each returns a :class:`Law` of arrays (or floats): energy, force (- attractive), stiffness, and a contact radius of 0.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Law, as_floats, as_law, check_between
from nanotouch.errors import InvalidValue


def vdw(
    gap: ArrayLike, *, radius: float, hamaker_constant: float, roughness: float = 0.0, minimum_gap: float = 0.2e-9
) -> Law:
    """Van der Waals, exact Hamaker sphere: -2 H R^3/(3 s^2 (s + 2R)^2), s = max(gap, minimum_gap) + roughness/2."""
    return as_law(_core.vdw_eval(as_floats(gap, "gap"), radius, hamaker_constant, roughness, minimum_gap))


def capillary(
    gap: ArrayLike,
    *,
    radius: float,
    surface_tension: float = 0.072,
    meniscus_radius: float,
    film_thickness: float = 0.0,
) -> Law:
    """Force of a standing meniscus: -4 pi gamma R [1 - (gap - 2e)/(2 r1)], the bracket held in 0..1 (erratum E3)."""
    return as_law(_core.capillary_eval(as_floats(gap, "gap"), radius, surface_tension, meniscus_radius, film_thickness))


def electrostatic(gap: ArrayLike, *, radius: float, potential: float, minimum_gap: float = 0.2e-9) -> Law:
    """Conducting sphere at a potential [V] against a plane: -pi eps0 U^2 R^2/(h (h + R)) (Hudlet; erratum E5)."""
    return as_law(_core.electrostatic_eval(as_floats(gap, "gap"), radius, potential, minimum_gap))


def kelvin_radius(
    relative_humidity: float,
    *,
    surface_tension: float = 0.072,
    molar_volume: float = 1.8e-5,
    temperature: float = 298.15,
) -> float:
    """Radius r1 of a meniscus [m] in equilibrium with a humidity (Kelvin equation); water at 25 C by default."""
    if not 0.0 < relative_humidity < 1.0:
        raise InvalidValue(f"relative_humidity = {relative_humidity:g}: it must be between 0 and 1 (0.4 for 40 %)")
    check_between("temperature", temperature, "K", above=0.0)
    return _core.kelvin_radius(surface_tension, molar_volume, temperature, relative_humidity)
