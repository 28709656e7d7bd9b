# SPDX-License-Identifier: BSD-3-Clause
"""What the calibration is worth, how it enters the results, and the 95 % interval that follows."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from math import erf, exp, pi, sqrt

import numpy as np

from nanotouch.errors import InvalidValue

_QUANTILE = 0.975
_GAUSSIAN = 1.959963984540054  # its quantile
_NEGLIGIBLE = 0.01  # part of the variance


@dataclass(frozen=True)
class Uncertainties:
    """Standard uncertainties of what a fit is given.

    Parameters
    ----------
    sensitivity : float
        Of the deflection sensitivity, relative. 0.03 is what repeated calibrations on a hard sample commonly scatter
        by. It is a datum: a curve that knows better overrules it.
    spring_constant : float
        Of k_c, relative. A thermal tune gives its own (:class:`nanotouch.curves.ThermalTune`).
    correlation : float
        Of the errors of both, -1 .. 1; 0 where they are independent. A thermal tune with the same sensitivity, and
        :class:`nanotouch.curves.Lever`, make it negative.
    radius : float
        Of the tip's radius, relative.
    half_angle : float
        Of cone and pyramid [rad].
    thickness : float
        Of a layer's, relative.
    poisson_ratio : float
        Of the sample's; enters its Young's modulus only.
    """

    sensitivity: float = 0.03
    spring_constant: float = 0.0
    radius: float = 0.0
    half_angle: float = 0.0
    thickness: float = 0.0
    poisson_ratio: float = 0.0
    correlation: float = 0.0

    def __post_init__(self) -> None:
        if not -1.0 <= self.correlation <= 1.0:
            raise InvalidValue(f"correlation of sensitivity and spring constant {self.correlation}: valid is -1 to 1")
        for name, value in asdict(self).items():
            if name == "correlation":
                continue
            if not 0.0 <= value < 1.0:
                unit = " rad" if name == "half_angle" else ""
                raise InvalidValue(f"uncertainty of {name} = {value:.4g}{unit}: valid is 0 to below 1{unit}")

    @property
    def force(self) -> float:
        """Of a force, k_c s u of the detector's volts u, relative."""
        s, k = self.sensitivity, self.spring_constant
        return sqrt(max(s**2 + k**2 + 2.0 * self.correlation * s * k, 0.0))  # below 0 by rounding only

    def assumptions(self, sharp: bool, layer: bool = False) -> list[str]:
        """What was taken for granted, in words; sharp: the tip has an angle in place of a radius."""
        named = {"deflection sensitivity": self.sensitivity, "spring constant": self.spring_constant}
        if not sharp:
            named["tip radius"] = self.radius
        if layer:
            named["layer's thickness"] = self.thickness
        known = [f"{name} to {100 * value:.3g} %" for name, value in named.items() if value > 0.0]
        if self.correlation != 0.0:
            known.append(f"errors of the first two correlated by {self.correlation:.2g}")
        exact = [name for name, value in named.items() if value == 0.0]
        if sharp and self.half_angle > 0.0:
            known.append(f"half angle to {np.degrees(self.half_angle):.3g} degrees")
        parts = ([f"known: {', '.join(known)}"] if known else []) + ([f"exact: {', '.join(exact)}"] if exact else [])
        return ["; ".join(parts)]


def quantile(sigma: float, from_step: float) -> float:
    """Half width of the 95 % interval of an error with standard deviation `sigma`.

    Part `from_step` of its variance comes from an error that is equally likely anywhere in an interval (between which
    two samples the tip was torn off), the rest is Gaussian.
    """
    if from_step < _NEGLIGIBLE or not np.isfinite(sigma):
        return _GAUSSIAN * sigma
    half = sqrt(3.0 * min(from_step, 1.0))  # of the interval, in units of sigma
    if from_step > 1.0 - _NEGLIGIBLE:
        return (2.0 * _QUANTILE - 1.0) * half * sigma
    normal = sqrt(1.0 - from_step)
    low, high = 0.0, half + 4.0 * normal
    for _ in range(50):
        middle = 0.5 * (low + high)
        if _integral(middle + half, normal) - _integral(middle - half, normal) < 2.0 * half * _QUANTILE:
            low = middle
        else:
            high = middle
    return high * sigma


def _integral(x: float, s: float) -> float:
    """Of the Gaussian's distribution function with standard deviation s, from -infinity to x."""
    return 0.5 * x * (1.0 + erf(x / (s * sqrt(2.0)))) + s / sqrt(2.0 * pi) * exp(-0.5 * (x / s) ** 2)
