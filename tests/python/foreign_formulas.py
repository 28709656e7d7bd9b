# SPDX-License-Identifier: BSD-3-Clause
"""Published formulas as they were published, or their quadrature; nothing of the library is called."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
EPSILON = 8.8541878128e-12
NODES, WEIGHTS = np.polynomial.legendre.leggauss(40)


def image_charges(gap: Floats, radius: float, potential: float) -> Floats:
    """Sphere at a potential [V] before a grounded plane, exact (Smythe 1950; Durand 1966):
    F = 2 pi eps0 V^2 Sum_1^inf (coth a - n coth n a)/sinh n a, cosh a = 1 + h/R."""
    a = np.arccosh(1.0 + gap / radius)[:, None]
    n = np.arange(1.0, 40.0 / a.min())
    with np.errstate(over="ignore"):
        terms = (1.0 / np.tanh(a) - n / np.tanh(n * a)) / np.sinh(np.minimum(n * a, 700.0))
    return np.asarray(2.0 * math.pi * EPSILON * potential**2 * terms.sum(axis=1))


def of_flats(pressure: Callable[[Floats], Floats], gap: Floats, radius: float, length: float) -> Floats:
    """Derjaguin: 2 pi R times the energy of flats, the integral of their pressure to 40 decay lengths."""
    edges = np.geomspace(1.0, 1.0 + 40.0, 33) - 1.0
    low, high = edges[:-1, None] * length, edges[1:, None] * length
    x = (low + high + (high - low) * NODES) / 2.0
    weight = WEIGHTS * (high - low) / 2.0
    return np.array([2.0 * math.pi * radius * float(np.sum(weight * pressure(h + x))) for h in gap])


def unlike_flats(gap: Floats, potentials: tuple[float, float], length: float, permittivity: float) -> Floats:
    """Pressure of flats at two constant potentials in linear Poisson-Boltzmann theory (Parsegian, Gingell 1972)."""
    one, other = potentials
    x = gap / length
    with np.errstate(over="ignore"):
        both = 2.0 * one * other * np.cosh(x) - one**2 - other**2
        return np.asarray(EPSILON * permittivity / (2.0 * length**2) * both / np.sinh(x) ** 2)


def dimitriadis(depth: Floats, radius: float, youngs_modulus: float, thickness: float) -> Floats:
    """Sphere on a bonded incompressible layer (Dimitriadis et al. 2002, Eq. 12); E* = E/0.75, a rigid tip."""
    chi = np.sqrt(radius * depth) / thickness
    factor = 1.0 + 1.133 * chi + 1.283 * chi**2 + 0.769 * chi**3 + 0.0975 * chi**4
    return np.asarray(16.0 / 9.0 * youngs_modulus * math.sqrt(radius) * depth**1.5 * factor)


def barquins_maugis(modulus: float, angle: float, work: float, count: int = 200) -> tuple[Floats, Floats]:
    """Indentation and force of a cone with adhesion, contact radii from the fold of grips on (Maugis, Barquins 1981):
    delta = pi a/(2 tan psi) - sqrt(2 pi w a/E*), F = pi a^2 E*/(2 tan psi) - sqrt(8 pi w E* a^3)."""
    steep = math.pi / (2.0 * math.tan(angle))
    fold = math.pi * work / (2.0 * modulus * steep**2)
    a = fold * np.geomspace(1.0001, 1e4, count)
    return (
        steep * a - np.sqrt(2.0 * math.pi * work * a / modulus),
        modulus * steep * a**2 - np.sqrt(8.0 * math.pi * work * modulus * a**3),
    )


def morse(depth: float, stiffness: float, rest: float) -> dict[str, Callable[..., Any]]:
    """A law of one's own: U = D (e^(-2 x) - 2 e^(-x)), x = b (h - h0), and its slopes."""

    def energy(gap: float) -> float:
        e = math.exp(-stiffness * (gap - rest))
        return depth * (e * e - 2.0 * e)

    def force(gap: float) -> float:
        e = math.exp(-stiffness * (gap - rest))
        return 2.0 * depth * stiffness * (e * e - e)

    def slope(gap: float) -> float:
        e = math.exp(-stiffness * (gap - rest))
        return 2.0 * depth * stiffness**2 * (2.0 * e * e - e)

    def bound(gap: float) -> float:
        e = math.exp(-stiffness * (gap - rest))
        return 2.0 * depth * stiffness * (e * e + e)

    return {"energy": energy, "force": force, "stiffness": slope, "bound": bound}
