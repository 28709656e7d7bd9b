# SPDX-License-Identifier: BSD-3-Clause
"""Forces between a tip and a flat at a gap [m]: in air (paper, Eq. 1, with the errata corrected) and in liquid.

Each law returns a :class:`LawValue` of arrays (or floats): energy, force (- attractive), stiffness, and a contact
radius of 0; F = -dU/dh, k = -dF/dh. Gap and parameters broadcast against each other; all are SI. Below the minimum gap
the force stays as it is there. docs/forces.md says what each law leaves out and how it was checked.
"""

from __future__ import annotations

from typing import Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core, ufuncs
from nanotouch._arrays import LawValue, as_floats, as_law, as_operand, check_between, law_over
from nanotouch.errors import InvalidValue

Boundary = Literal["potential", "charge"]
BOUNDARIES: tuple[Boundary, ...] = get_args(Boundary)


def _evaluate(law: str, gap: ArrayLike, **parameters: ArrayLike) -> LawValue:
    """A law over the gaps; its parameters in the order of its ufunc, which broadcasts them.

    A function whose signature has that order hands on ``locals()``, all of what it was given."""
    operands = [as_operand(value, name) for name, value in {"gap": gap, **parameters}.items()]
    return law_over(lambda value: getattr(ufuncs, f"{law}_{value}" if value else law), operands)


def vdw(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    hamaker_constant: ArrayLike,
    roughness: ArrayLike = 0.0,
    minimum_gap: ArrayLike = 0.2e-9,
) -> LawValue:
    """Van der Waals, exact Hamaker sphere: -2 H R^3/(3 s^2 (s + 2R)^2), s = max(gap, minimum_gap) + roughness/2."""
    return _evaluate("vdw", **locals())


def vdw_derjaguin(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    hamaker_constant: ArrayLike,
    roughness: ArrayLike = 0.0,
    minimum_gap: ArrayLike = 0.2e-9,
) -> LawValue:
    """Van der Waals, the paper's form -H R/(6 s^2), for s << R only: +36 % at 10 nm for R = 30 nm (erratum E1)."""
    return _evaluate("vdw_derjaguin", **locals())


def vdw_tip(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    hamaker_constant: ArrayLike,
    half_angle: ArrayLike,
    height: ArrayLike,
    roughness: ArrayLike = 0.0,
    minimum_gap: ArrayLike = 0.2e-9,
) -> LawValue:
    """Van der Waals of a whole tip, a cone (half-angle [rad], height [m]) rounded by a sphere: Hamaker's sum, exact.

    A cone without end is Argento and French, J. Appl. Phys. 80 (1996) 6081.
    """
    return _evaluate("vdw_tip", **locals())


def capillary(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    surface_tension: ArrayLike = 0.072,
    meniscus_radius: ArrayLike,
    film_thickness: ArrayLike = 0.0,
) -> LawValue:
    """Force of a standing meniscus: -4 pi gamma R [1 - (gap - 2e)/(2 r1)], the bracket held in 0..1 (erratum E3)."""
    return _evaluate("capillary", **locals())


class CapillaryPath(NamedTuple):
    """The capillary force along a path of gaps."""

    law: LawValue
    """at every gap; nothing where there is no bridge"""
    bridged: bool
    """whether a bridge stands after the last gap"""


def capillary_path(
    gap: ArrayLike,
    *,
    radius: float,
    surface_tension: float = 0.072,
    meniscus_radius: float,
    film_thickness: float = 0.0,
    bridged: bool = False,
) -> CapillaryPath:
    """Capillary force along gaps in the order in which they are visited.

    The bridge forms where the films touch, at a gap of 2e, and ruptures beyond 2e + 2 r1; ``bridged`` says whether
    there is one before the first gap. A NaN gap gives NaN and changes no bridge.
    """
    parameters = np.array([[radius, surface_tension, meniscus_radius, film_thickness]])
    columns, stands = _core.capillary_trace(as_floats(gap, "gap"), parameters, bridged)
    return CapillaryPath(as_law(columns), stands)


def electrostatic(
    gap: ArrayLike, *, radius: ArrayLike, potential: ArrayLike, minimum_gap: ArrayLike = 0.2e-9
) -> LawValue:
    """Conducting sphere at a potential [V] against a plane: -pi eps0 U^2 R^2/(h (h + R)) (Hudlet; erratum E5)."""
    return _evaluate("electrostatic", **locals())


def electrostatic_plate(
    gap: ArrayLike, *, area: ArrayLike, potential: ArrayLike, minimum_gap: ArrayLike = 0.2e-9
) -> LawValue:
    """Parallel plates of an area [m^2], -eps0 S U^2/(2 h^2): the paper's form, whose S = 4 pi R r1 is E5's mistake."""
    return _evaluate("electrostatic_plate", **locals())


def electrostatic_tip(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    half_angle: ArrayLike,
    height: ArrayLike,
    potential: ArrayLike,
    minimum_gap: ArrayLike = 0.2e-9,
) -> LawValue:
    """Apex sphere and cone, of half-angle [rad] and height [m], at a potential [V] (Hudlet et al. 1998).

    In place of :func:`electrostatic`; the cone's integral is taken over its finite height.
    """
    return _evaluate("electrostatic_tip", **locals())


def point_charge(gap: ArrayLike, *, radius: ArrayLike, charge: ArrayLike, minimum_gap: ArrayLike = 0.2e-9) -> LawValue:
    """Charge [C] trapped under a grounded sphere (image charge, exact): -q^2 R (R + h)/(4 pi eps0 (h (h + 2R))^2)."""
    return _evaluate("point_charge", **locals())


def electrostatic_lever(
    gap: ArrayLike,
    *,
    length: ArrayLike,
    width: ArrayLike,
    tilt: ArrayLike,
    tip_height: ArrayLike,
    potential: ArrayLike,
    minimum_gap: ArrayLike = 0.2e-9,
) -> LawValue:
    """Lever at a potential [V], to be added to the tip: a plate tilted by b [rad] in the field of the wedge below it.

    -eps0 U^2 w l cos(b) (sin(b)/b)^2/(2 D (D + l sin(b))), D = tip_height + gap; edges are neglected.
    """
    return _evaluate("electrostatic_lever", **locals())


def lennard_jones(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    work_of_adhesion: ArrayLike,
    equilibrium_distance: ArrayLike = 0.2e-9,
    minimum_gap: ArrayLike = 0.1e-9,
) -> LawValue:
    """Rigid sphere and half-space with the 9-3 wall: 2 pi R w/3 [(z0/h)^8 - 4 (z0/h)^2] (Bradley 1932; Derjaguin).

    ``gap`` is measured between the surface atoms: -2 pi w R at h = z0.
    """
    return _evaluate("lennard_jones", **locals())


def double_layer(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    debye_length: ArrayLike,
    tip_potential: ArrayLike,
    sample_potential: ArrayLike,
    relative_permittivity: ArrayLike = 78.5,
    boundary: Boundary = "potential",
    minimum_gap: ArrayLike = 0.2e-9,
) -> LawValue:
    """Electric double layers: U = pi eps R [A ln(1 + e^-x) + B ln(1 - e^-x)], x = gap/debye_length.

    With S = (psi_1 + psi_2)^2, D = (psi_1 - psi_2)^2 of the potentials [V] that the surfaces have when alone:
    ``boundary="potential"``, kept on approach (Hogg, Healy, Fuerstenau 1966), is A = S, B = D; ``"charge"``, kept on
    approach (Wiese, Healy 1970), is A = -D, B = -S. Potentials below some 25 mV, radius >> debye_length.
    """
    if boundary not in BOUNDARIES:
        raise InvalidValue(f"boundary {boundary!r}: valid are {', '.join(BOUNDARIES)}")
    return _evaluate(
        "double_layer_potential" if boundary == "potential" else "double_layer_charge",
        gap,
        radius=radius,
        debye_length=debye_length,
        relative_permittivity=relative_permittivity,
        tip_potential=tip_potential,
        sample_potential=sample_potential,
        minimum_gap=minimum_gap,
    )


def hydration(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    amplitude: ArrayLike,
    decay_length: ArrayLike,
    second_amplitude: ArrayLike = 0.0,
    second_decay_length: ArrayLike = 1e-9,
    minimum_gap: ArrayLike = 0.0,
) -> LawValue:
    """Hydration (amplitude > 0) or hydrophobic (< 0) force, one or two terms: 2 pi R Sum W_i exp(-h/l_i).

    Amplitudes W_i are energies of plates at gap 0 [J/m^2] (Israelachvili 2011, ch. 15).
    """
    return _evaluate("hydration", **locals())


def steric(
    gap: ArrayLike,
    *,
    radius: ArrayLike,
    thickness: ArrayLike,
    spacing: ArrayLike,
    temperature: ArrayLike = 298.15,
    minimum_gap: ArrayLike = 0.2e-9,
    exponential: bool = False,
) -> LawValue:
    """Polymer brushes (Alexander, de Gennes): 2 pi R Int_h^T p, p = kT/s^3 [(T/h)^(9/4) - (h/T)^(3/4)], 0 beyond T.

    ``thickness`` T is that of both free brushes together, ``spacing`` s the distance of chains. ``exponential``: the
    usual approximation p = 100 kT/s^3 exp(-2 pi h/T), within 24 % for 0.2 < h/T < 0.9.
    """
    return _evaluate(
        "steric_exponential" if exponential else "steric",
        gap,
        radius=radius,
        thickness=thickness,
        spacing=spacing,
        temperature=temperature,
        minimum_gap=minimum_gap,
    )


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


def debye_length(ionic_strength: float, *, relative_permittivity: float = 78.5, temperature: float = 298.15) -> float:
    """Debye length [m] of an electrolyte: sqrt(eps kT/(2 N_A e^2 I)), I in mol/m^3 (1 mM is 1); water by default."""
    check_between("ionic_strength", ionic_strength, "mol/m^3", above=0.0)
    check_between("relative_permittivity", relative_permittivity, "", above=0.0)
    check_between("temperature", temperature, "K", above=0.0)
    return _core.debye_length(ionic_strength, relative_permittivity, temperature)
