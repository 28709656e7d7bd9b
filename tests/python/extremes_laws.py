# SPDX-License-Identifier: BSD-3-Clause
"""The laws of the matrix of extremes and their energies in mpmath, written from the textbooks' equations. Force and
stiffness are differences of the energy at 150 digits."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable
from typing import Any, NamedTuple

import mpmath
from mpmath import mpf
from nanotouch import contact, forces
from nanotouch.contact import geometry, reduced
from nanotouch.forces import LawValue

EPSILON, BOLTZMANN = mpf("8.8541878128e-12"), mpf("1.380649e-23")
DIGITS, LIMIT_DIGITS = 150, 1600
Numbers = dict[str, float]


class Law(NamedTuple):
    """A law beside its own energy."""

    name: str
    call: Callable[..., Any]
    energy: Callable[..., Any]
    """of the same arguments as mpf; at the gap or indentation ``at``"""
    usual: Numbers
    units: dict[str, str]
    at: str = "gap"
    hold: str = ""
    """the argument below which the force stays what it is there"""
    folds: Callable[[Numbers], list[Numbers]] = lambda usual: [usual | {"gap": usual["minimum_gap"]}]
    tolerance: float = 1e-9
    """of eps0 and k_B by their digits, and of arithmetic"""
    is_state: bool = False
    """``energy`` gives a state, three numbers, to be compared as they are"""


def scale(unit: str, length: float, energy: float) -> float:
    """Of a quantity, where all lengths and energies are scaled. Potentials and charges follow from eps0."""
    powers = {
        "m": (1, 0), "m2": (2, 0), "J": (0, 1), "J/m2": (-2, 1), "Pa": (-3, 1), "V": (-0.5, 0.5), "C": (0.5, 0.5),
        "K": (0, 1), "": (0, 0),
    }  # fmt: skip
    along, of_energy = powers[unit]
    return float(length**along * energy**of_energy)


def truths(law: Law, point: Numbers) -> list[tuple[float, float, float]]:
    """U, F, k as doubles; at zeros and infinities their limits, none where there is none, two at a fold."""
    if all(math.isfinite(value) and value != 0.0 for value in point.values()):
        usual = 80 if law.is_state else DIGITS
        tiny = 700 if law.is_state else LIMIT_DIGITS
        with mpmath.workdps(usual if min(map(abs, point.values())) > 1e-100 else tiny):
            return [_rounded(_derived(law, {name: mpf(value) for name, value in point.items()}))]
    found = []
    digits, powers = (400, (120, 130)) if law.is_state else (LIMIT_DIGITS, (600, 660))
    for side in (1, -1) if point[law.at] == 0.0 else (1,):
        with contextlib.suppress(ArithmeticError, ValueError, TypeError), mpmath.workdps(digits):
            one, other = (
                _rounded(_derived(law, {n: _near(v, power, side if n == law.at else 1) for n, v in point.items()}))
                for power in powers
            )
            if all(map(_alike, one, other)):
                found.append(other)
    return found


def _near(value: float, power: int, side: int) -> Any:
    if math.isinf(value):
        return mpf(10) ** power * (1 if value > 0 else -1)
    return mpf(value) if value != 0.0 else side * mpf(10) ** -power


def _alike(one: float, other: float) -> bool:
    return one == other or abs(one - other) <= 1e-12 * abs(other) + 1e-290


def _rounded(values: Any) -> Any:
    return tuple(float(value) for value in values)


def _derived(law: Law, point: dict[str, Any]) -> tuple[Any, Any, Any]:
    """Energy, force and stiffness; the sign of the force is + repulsive, that of the stiffness dF/d(indentation)."""
    if law.is_state:
        return law.energy(**point)  # type: ignore[no-any-return]
    sign = -1 if law.at == "gap" else 1
    at = point[law.at]
    held = law.hold and at < point[law.hold]
    middle = point[law.hold] if held else at
    step = abs(middle) * mpf(10) ** -40

    def energy(x: Any) -> Any:
        return law.energy(**(point | {law.at: x}))

    below, here, above = energy(middle - step), energy(middle), energy(middle + step)
    slope, curvature = (above - below) / (2 * step), (above - 2 * here + below) / step**2
    if held:
        return here + slope * (at - middle), sign * slope, mpf(0)
    return here, sign * slope, curvature


def _sphere(s: Any, R: Any) -> Any:
    return R / s + R / (s + 2 * R) - mpmath.log1p(2 * R / s)


def _vdw(gap: Any, radius: Any, hamaker_constant: Any, roughness: Any, minimum_gap: Any) -> Any:
    return -hamaker_constant / 6 * _sphere(gap + roughness / 2, radius)


def _derjaguin(gap: Any, radius: Any, hamaker_constant: Any, roughness: Any, minimum_gap: Any) -> Any:
    return -hamaker_constant * radius / (6 * (gap + roughness / 2))


def _hudlet(gap: Any, radius: Any, potential: Any, minimum_gap: Any) -> Any:
    return -mpmath.pi * EPSILON * potential**2 * radius * mpmath.log1p(radius / gap)


def _plate(gap: Any, area: Any, potential: Any, minimum_gap: Any) -> Any:
    return -EPSILON * area * potential**2 / (2 * gap)


def _charge(gap: Any, radius: Any, charge: Any, minimum_gap: Any) -> Any:
    return -(charge**2) * radius / (8 * mpmath.pi * EPSILON * gap * (gap + 2 * radius))


def _lennard_jones(gap: Any, radius: Any, work_of_adhesion: Any, equilibrium_distance: Any, minimum_gap: Any) -> Any:
    x = equilibrium_distance / gap
    return 2 * mpmath.pi * radius * work_of_adhesion * equilibrium_distance / 3 * (x**7 / 7 - 4 * x)


def _hydration(gap: Any, radius: Any, amplitude: Any, decay_length: Any, minimum_gap: Any) -> Any:
    return 2 * mpmath.pi * radius * amplitude * decay_length * mpmath.exp(-gap / decay_length)


def _steric(gap: Any, radius: Any, thickness: Any, spacing: Any, temperature: Any, minimum_gap: Any) -> Any:
    """Twice the integral of (T/h)^(9/4) - (h/T)^(3/4), from h to T."""
    x = gap / thickness
    if x >= 1:
        return mpf(0)
    rise, bend = x ** mpf("-0.25") - 1, 1 - x ** mpf("2.75")
    whole = mpf(16) / 5 * rise + mpf(16) / 77 * bend - mpf(48) / 35 * (1 - x)
    return 2 * mpmath.pi * radius * BOLTZMANN * temperature / spacing**3 * thickness**2 * whole


def _hogg(sign: int) -> Callable[..., Any]:
    """Hogg, Healy, Fuerstenau 1966: constant potentials (1); Usui 1973: constant charges (-1)."""

    def energy(
        gap: Any, radius: Any, debye_length: Any, tip_potential: Any, sample_potential: Any, relative_permittivity: Any,
        minimum_gap: Any,
    ) -> Any:  # fmt: skip
        x = mpmath.exp(-gap / debye_length)
        both = 2 * tip_potential * sample_potential * (mpmath.log1p(x) - mpmath.log1p(-x))
        alike = (tip_potential**2 + sample_potential**2) * mpmath.log1p(-(x**2))
        return mpmath.pi * EPSILON * relative_permittivity * radius * (both + sign * alike)

    return energy


def _hertz(indentation: Any, radius: Any, effective_modulus: Any) -> Any:
    return mpf(8) / 15 * effective_modulus * mpmath.sqrt(radius) * max(indentation, 0) ** mpf("2.5")


def _cone(indentation: Any, effective_modulus: Any, half_angle: Any) -> Any:
    return 2 / (3 * mpmath.pi) * effective_modulus * mpmath.tan(half_angle) * max(indentation, 0) ** 3


def _punch(indentation: Any, effective_modulus: Any, radius: Any) -> Any:
    return effective_modulus * radius * max(indentation, 0) ** 2


def _jkr(indentation: Any, radius: Any, effective_modulus: Any, work_of_adhesion: Any) -> Any:
    """Johnson, Kendall, Roberts 1971: elastic energy less w times the area, where a^2/R - sqrt(2 pi w a/E*) = delta."""
    E, w, d = effective_modulus, work_of_adhesion, indentation
    if d < mpf(-3) / 4 * (mpmath.pi**2 * w**2 * radius / E**2) ** (mpf(1) / 3):
        return mpf(0)
    a = _largest_root([1 / radius, 0, 0, -mpmath.sqrt(2 * mpmath.pi * w / E), -d]) ** 2
    return E * (d**2 * a - 2 * d * a**3 / (3 * radius) + a**5 / (5 * radius**2)) - mpmath.pi * a**2 * w


def _cone_adhesive(indentation: Any, effective_modulus: Any, work_of_adhesion: Any, half_angle: Any) -> Any:
    """Maugis and Barquins 1981: the same, where pi a/(2 tan psi) - sqrt(2 pi w a/E*) = delta."""
    E, w, d = effective_modulus, work_of_adhesion, indentation
    slope, size = mpmath.pi / (2 * mpmath.tan(half_angle)), mpmath.sqrt(2 * mpmath.pi * w / E)
    if size**2 + 4 * slope * d < 0:
        return mpf(0)
    a = ((size + mpmath.sqrt(size**2 + 4 * slope * d)) / (2 * slope)) ** 2
    return E * (d**2 * a - d * slope * a**2 + slope**2 * a**3 / 3) - mpmath.pi * a**2 * w


def _largest_root(coefficients: list[Any]) -> Any:
    """Real, of a polynomial that is convex beyond its fold: Newton's method from far above."""
    lead = coefficients[0]
    far = 2 * max(abs(c / lead) ** (mpf(1) / n) for n, c in enumerate(coefficients) if n and c != 0)
    for _ in range(2000):
        value = slope = mpf(0)
        for coefficient in coefficients:
            value, slope = value * far + coefficient, slope * far + value
        if slope <= 0:
            break
        nearer = far - value / slope
        if abs(nearer - far) <= abs(far) * mpf(10) ** (10 - mpmath.mp.dps):
            return nearer
        far = nearer
    return far


def _dugdale(lam: Any, radius: Any) -> tuple[Any, Any, Any]:
    """Indentation and load of Maugis 1992 as printed, in his units: m = c/a by bisection of ln(m - 1)."""

    def parts(u: Any) -> tuple[Any, Any, Any]:
        m = 1 + mpmath.exp(u)
        return m, mpmath.sqrt(m * m - 1), mpmath.acos(1 / m)

    def griffith(u: Any) -> Any:
        m, root, angle = parts(u)
        outer = lam * radius**2 / 2 * (root + (m * m - 2) * angle)
        return outer + 4 * lam**2 * radius / 3 * (root * angle - m + 1) - 1

    low, high = mpf(-400), mpf(4000)
    for _ in range(300):
        middle = (low + high) / 2
        low, high = (low, middle) if griffith(middle) > 0 else (middle, high)
    m, root, angle = parts(low)
    load = radius**3 - lam * radius**2 * (root + m * m * angle)
    return radius**2 - mpf(4) / 3 * lam * radius * root, load, mpf(0)


def _at_radius(lam: float, radius: float) -> Any:
    state = reduced.at_radius(lam, radius)
    return LawValue(state.indentation, state.load, 0.0, state.radius)


GAP = {"gap": "m", "radius": "m", "minimum_gap": "m"}
OF_SHAPE = {"indentation": "m", "effective_modulus": "Pa", "radius": "m", "half_angle": "", "work_of_adhesion": "J/m2"}


def _units(usual: Numbers, **more: str) -> dict[str, str]:
    return {name: (GAP | OF_SHAPE | more)[name] for name in usual}


def _law(name: str, call: Callable[..., Any], energy: Callable[..., Any], usual: Numbers, **more: str) -> Law:
    return Law(name, call, energy, usual, _units(usual, **more), hold="minimum_gap" if "minimum_gap" in usual else "")


def _contact(model: Any) -> Callable[..., Any]:
    def call(indentation: float, radius: float, effective_modulus: float, work_of_adhesion: float = 0.0) -> Any:
        return contact.evaluate(model, indentation, contact.Contact(radius, effective_modulus, work_of_adhesion))

    return call


def _cone_jkr(indentation: float, effective_modulus: float, work_of_adhesion: float, half_angle: float) -> Any:
    return geometry.jkr(
        geometry.Shape("cone", half_angle=half_angle), indentation, effective_modulus, work_of_adhesion=work_of_adhesion
    )


_VDW = {"gap": 1e-9, "radius": 2e-8, "hamaker_constant": 1e-19, "roughness": 2e-10, "minimum_gap": 2e-10}
_PRESSED = {"indentation": 1e-9, "radius": 2e-8, "effective_modulus": 7e10}
_DOUBLE = {
    "gap": 1e-9, "radius": 2e-8, "debye_length": 3e-9, "tip_potential": 0.03, "sample_potential": -0.05,
    "relative_permittivity": 78.5, "minimum_gap": 2e-10,
}  # fmt: skip


def _fold_of_jkr(usual: Numbers) -> list[Numbers]:
    """Grips let go at delta = -3/4 (pi^2 w^2 R/E*^2)^(1/3); beside it, where the square root still is one."""
    size = (math.pi**2 * usual["work_of_adhesion"] ** 2 * usual["radius"] / usual["effective_modulus"] ** 2) ** (1 / 3)
    return [usual | {"indentation": -0.75 * size * (1.0 - off)} for off in (1e-2, 1e-4, 1e-6)]


def _fold_of_cone(usual: Numbers) -> list[Numbers]:
    end = -usual["work_of_adhesion"] * math.tan(usual["half_angle"]) / usual["effective_modulus"]
    return [usual | {"indentation": end * (1.0 - off)} for off in (1e-2, 1e-4, 1e-6)]


def _touching(usual: Numbers) -> list[Numbers]:
    return [usual | {"indentation": 1e-300}]


_STEEP = {"indentation": 1e-9, "effective_modulus": 7e10, "work_of_adhesion": 0.05, "half_angle": 0.4}

LAWS = (
    _law("van der Waals", forces.vdw, _vdw, _VDW, hamaker_constant="J", roughness="m"),
    _law("van der Waals, Derjaguin", forces.vdw_derjaguin, _derjaguin, _VDW, hamaker_constant="J", roughness="m"),
    _law("electrostatic sphere", forces.electrostatic, _hudlet,
         {"gap": 1e-9, "radius": 2e-8, "potential": 0.5, "minimum_gap": 2e-10}, potential="V"),
    Law("electrostatic plate", forces.electrostatic_plate, _plate,
        {"gap": 1e-9, "area": 1e-15, "potential": 0.5, "minimum_gap": 2e-10},
        {"gap": "m", "area": "m2", "potential": "V", "minimum_gap": "m"}, hold="minimum_gap"),
    _law("point charge", forces.point_charge, _charge,
         {"gap": 1e-9, "radius": 2e-8, "charge": 1.6e-19, "minimum_gap": 2e-10}, charge="C"),
    _law("Lennard-Jones", forces.lennard_jones, _lennard_jones,
         {"gap": 1e-9, "radius": 2e-8, "work_of_adhesion": 0.05, "equilibrium_distance": 2e-10, "minimum_gap": 1e-10},
         equilibrium_distance="m"),
    _law("hydration", forces.hydration, _hydration,
         {"gap": 1e-9, "radius": 2e-8, "amplitude": 0.01, "decay_length": 3e-10, "minimum_gap": 1e-10},
         amplitude="J/m2", decay_length="m"),
    Law("steric", forces.steric, _steric,
        {"gap": 3e-9, "radius": 2e-8, "thickness": 1e-8, "spacing": 3e-9, "temperature": 298.0, "minimum_gap": 2e-10},
        {"gap": "m", "radius": "m", "thickness": "m", "spacing": "m", "temperature": "K", "minimum_gap": "m"},
        hold="minimum_gap", folds=lambda usual: [usual | {"gap": usual[end] * by} for end, by in
                                                 (("minimum_gap", 1.0), ("thickness", 0.999), ("thickness", 1.001))]),
    _law("double layer, potentials", forces.double_layer, _hogg(1), _DOUBLE, debye_length="m", tip_potential="V",
         sample_potential="V", relative_permittivity=""),
    _law("double layer, charges", lambda **point: forces.double_layer(**point, boundary="charge"), _hogg(-1), _DOUBLE,
         debye_length="m", tip_potential="V", sample_potential="V", relative_permittivity=""),
    _law("Hertz", _contact("hertz"), _hertz, _PRESSED)._replace(at="indentation", folds=_touching),
    _law("JKR", _contact("jkr"), _jkr, _PRESSED | {"work_of_adhesion": 0.05})._replace(
        at="indentation", folds=_fold_of_jkr),
    _law("cone", contact.cone, _cone, {"indentation": 1e-9, "effective_modulus": 7e10, "half_angle": 0.4})._replace(
        at="indentation", folds=_touching),
    _law("punch", contact.punch, _punch, {"indentation": 1e-9, "effective_modulus": 7e10, "radius": 2e-8})._replace(
        at="indentation", folds=_touching),
    Law("Maugis-Dugdale", _at_radius, _dugdale, {"lam": 1.0, "radius": 1.5}, {"lam": "", "radius": ""}, at="radius",
        is_state=True, folds=lambda usual: [usual | {"lam": 0.9379, "radius": at} for at in (1e-6, 1.0)]),
    _law("cone with adhesion", _cone_jkr, _cone_adhesive, _STEEP)._replace(at="indentation", folds=_fold_of_cone),
)  # fmt: skip
