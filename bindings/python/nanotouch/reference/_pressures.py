# SPDX-License-Identifier: BSD-3-Clause
"""What two flats press on each other with: laws in closed form, written down apart from those of the library."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from nanotouch._arrays import Floats
from nanotouch.errors import InvalidValue

LARGEST_EXPONENT = 700.0  # of e, that a double holds


@dataclass(frozen=True)
class Pressure:
    """What two flats press on each other with at a gap [m]."""

    pressure: Callable[[Floats], Floats]
    """p [Pa], + repulsive"""
    energy: Callable[[Floats], Floats]
    """W = Int_g^inf p [J/m^2]"""
    kinks: tuple[float, ...] = field(default=())
    """gaps at which p has a kink [m]"""
    diverges: bool = False
    """at gap 0: the bodies never touch"""

    def slope(self, gap: Floats) -> Floats:
        """Dp/dg [Pa/m]: central differences of fourth order, on one side of a kink."""
        step = 1e-4 * self.length(gap)
        for kink in self.kinks:
            step = np.minimum(step, np.maximum(0.4 * np.abs(gap - kink), 1e-9 * kink))
        p = self.pressure
        near = (p(gap + step) - p(gap - step)) * 8.0 - (p(gap + 2.0 * step) - p(gap - 2.0 * step))
        return near / (12.0 * step)

    def length(self, gap: Floats) -> Floats:
        """W/p, about the decay length [m]."""
        with np.errstate(divide="ignore", invalid="ignore"):
            length = np.abs(self.energy(gap) / self.pressure(gap))
        return np.where(np.isfinite(length) & (length > 0.0), np.minimum(length, 1e3 * np.abs(gap) + 1e-9), 1e-9)


def sum_of(*laws: Pressure) -> Pressure:
    """Several at once."""
    return Pressure(
        lambda g: np.sum([law.pressure(g) for law in laws], axis=0),
        lambda g: np.sum([law.energy(g) for law in laws], axis=0),
        tuple(sorted({kink for law in laws for kink in law.kinks})),
        any(law.diverges for law in laws),
    )


def exponential(pressure: float, decay_length: float) -> Pressure:
    """P = p0 exp(-g/l): hydration, a double layer far out."""
    if not decay_length > 0.0:
        raise InvalidValue(f"decay_length = {decay_length:g} m: it must be above 0")

    def share(gap: Floats) -> Floats:  # within what a double holds: a trial may lie deep inside
        shares: Floats = np.exp(np.minimum(-gap / decay_length, LARGEST_EXPONENT))
        return shares

    return Pressure(lambda g: pressure * share(g), lambda g: pressure * decay_length * share(g))


def power(constant: float, exponent: float, shift: float = 0.0) -> Pressure:
    """P = constant/(g + shift)^exponent: van der Waals is -H/(6 pi), 3."""
    return Pressure(
        lambda g: constant * (g + shift) ** -exponent,
        lambda g: constant / (exponent - 1.0) * (g + shift) ** (1.0 - exponent),
        diverges=shift == 0.0,
    )


def brush(pressure: float, thickness: float) -> Pressure:
    """Alexander and de Gennes: p = pressure [(T/g)^(9/4) - (g/T)^(3/4)] inside T; pressure = kT/s^3."""

    def p(g: Floats) -> Floats:
        x = np.clip(g / thickness, 1e-12, 1.0)
        return pressure * (x**-2.25 - x**0.75)

    def energy(g: Floats) -> Floats:
        x = np.clip(g / thickness, 1e-12, 1.0)
        return pressure * thickness * 4.0 / 35.0 * (7.0 * x**-1.25 + 5.0 * x**1.75 - 12.0)

    return Pressure(p, energy, (thickness,), True)
