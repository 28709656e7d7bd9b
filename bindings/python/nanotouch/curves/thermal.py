# SPDX-License-Identifier: BSD-3-Clause
"""Spring constant, resonance and quality factor from the thermal motion of a cantilever."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._arrays import as_floats, check_between
from ..errors import InvalidValue, require
from .calibration import SPRING_CONSTANT_RANGE

TEMPERATURES = (77.0, 1000.0)  # [K]
ZERO_CELSIUS = 273.15  # [K]
BOLTZMANN = 1.380649e-23  # J/K, exact
#: k_c/(2 pi f_r)^2 [kg]: levers in vacuum from 1e-15, tuning forks up to 1e-7, what moves with a soft one in water 1e-9
EFFECTIVE_MASS = (1e-17, 1e-6)
#: First mode of a rectangular beam seen by an optical lever that was calibrated by pressing: 0.971/1.09^2 (Butt and
#: Jaschke 1995; Hutter 2005).
OPTICAL_LEVER = 0.817


@dataclass(frozen=True)
class ThermalTune:
    """What a thermal spectrum says.

    Attributes
    ----------
    spring_constant, resonance, quality_factor : float
        k_c [N/m], f_r [Hz], Q.
    floor : float
        White noise of the detector [m^2/Hz].
    sigma : dict
        Standard uncertainties of the first three: statistical, without those of temperature and sensitivity.
    """

    spring_constant: float
    resonance: float
    quality_factor: float
    floor: float
    sigma: dict[str, float]


def check_temperature(kelvin: float) -> None:
    """Refuse what is no temperature of a lever, and above all one in degrees Celsius."""
    low, high = TEMPERATURES
    if low <= kelvin <= high:
        return
    celsius = -ZERO_CELSIUS < kelvin < low
    hint = f"; {kelvin:g} degrees Celsius are {kelvin + ZERO_CELSIUS:.5g} K" if celsius else ""
    raise InvalidValue(f"temperature: {kelvin:g} K, valid is {low:g} to {high:g} K{hint}")


def thermal_tune(
    frequency: ArrayLike,
    density: ArrayLike,
    *,
    averages: int,
    temperature: float = 295.0,
    correction: float = OPTICAL_LEVER,
) -> ThermalTune:
    """Fit a harmonic oscillator and white noise to a spectrum, and the spring constant by equipartition.

    S(f) = A f_r^4 / ((f^2 - f_r^2)^2 + (f f_r/Q)^2) + B has the mean square A pi f_r Q/2 about B, and k_c is
    `correction` k_B T over it. The logarithm is fitted, whose scatter is the same everywhere, with its known mean.

    Parameters
    ----------
    frequency : array_like, shape (n,)
        Of the first resonance and what surrounds it [Hz], in any order. A value at 0 Hz, the mean, is left out.
    density : array_like, shape (n,)
        One-sided power spectral density of the deflection [m^2/Hz].
    averages : int
        How many periodograms it is the mean of.
    temperature : float
        [K], 77 .. 1000; room temperature is 295, not 22.
    correction : float
        0.971 for a true deflection of the end, 0.817 for an optical lever.

    Raises
    ------
    InvalidValue
        If what comes out is no lever's spring constant (1e-4 .. 1e4 N/m) or mass: densities in pm^2/Hz or V^2/Hz,
        amplitudes in m/sqrt(Hz), frequencies in kHz.
    """
    f, S = as_floats(frequency, "frequency"), as_floats(density, "density")
    if f.ndim == 1 and f.shape == S.shape:
        f, S = f[f != 0.0], S[f != 0.0]
    if f.ndim != 1 or f.shape != S.shape or f.size < 16:
        raise InvalidValue(f"frequency, density: shapes {f.shape} and {S.shape}, expected one of at least 16 points")
    for name, values, unit in (("frequency", f, "Hz"), ("density", S, "m^2/Hz")):
        bad = np.flatnonzero(~(np.isfinite(values) & (values > 0.0)))
        if bad.size:
            raise InvalidValue(f"{name}: {values[bad[0]]:g} {unit} at [{bad[0]}], expected positive, finite values")
    rising = np.argsort(f, kind="stable")
    f, S = f[rising], S[rising]
    check_temperature(temperature)
    check_between("averages", averages, "", above=0)
    special, optimize = require("scipy.special", "curves"), require("scipy.optimize", "curves")
    level = np.log(S) - (float(special.digamma(averages)) - np.log(averages))
    peak = int(np.argmax(S))
    floor = float(np.quantile(S, 0.1))
    width = max(float(np.count_nonzero(0.5 * S[peak] < S)), 1.0) * float(np.median(np.diff(f)))
    Q = max(float(f[peak]) / width, 1.0)
    start = np.log([float(S[peak]) / Q**2, float(f[peak]), Q, floor])

    def residual(x: NDArray[np.float64]) -> NDArray[np.float64]:
        A, f_r, quality, B = np.exp(x)
        ratio = f / f_r
        return np.asarray(np.log(A / ((ratio**2 - 1.0) ** 2 + (ratio / quality) ** 2) + B) - level)

    found = optimize.least_squares(residual, start, x_scale=[1.0, 1.0 / Q, 1.0, 1.0], xtol=1e-12, ftol=1e-12)
    A, f_r, quality, B = (float(value) for value in np.exp(found.x))
    covariance = float(special.polygamma(1, averages)) * np.linalg.pinv(found.jac.T @ found.jac)
    stiffness = correction * BOLTZMANN * temperature / (0.5 * np.pi * A * f_r * quality)
    _check_lever(stiffness, f_r)
    of_product = np.array([1.0, 1.0, 1.0, 0.0])
    sigma = {
        "spring_constant": stiffness * float(np.sqrt(of_product @ covariance @ of_product)),
        "resonance": f_r * float(np.sqrt(covariance[1, 1])),
        "quality_factor": quality * float(np.sqrt(covariance[2, 2])),
    }
    return ThermalTune(stiffness, f_r, quality, B, sigma)


def _check_lever(stiffness: float, resonance: float) -> None:
    """Refuse what a wrong unit makes of a spectrum."""
    (soft, stiff), (light, heavy) = SPRING_CONSTANT_RANGE, EFFECTIVE_MASS
    if not soft <= stiffness <= stiff:
        raise InvalidValue(
            f"density: a spring constant of {stiffness:.3g} N/m follows, expected {soft:g} .. {stiff:g} N/m; is the "
            "density in m^2/Hz (not pm^2/Hz, V^2/Hz or m/sqrt(Hz))?"
        )
    mass = stiffness / (2.0 * np.pi * resonance) ** 2
    if not light <= mass <= heavy:
        raise InvalidValue(
            f"frequency: a lever of {stiffness:.3g} N/m with its resonance at {resonance:.4g} Hz has a mass of "
            f"{mass:.3g} kg, expected {light:g} .. {heavy:g} kg; is the frequency in Hz (not kHz or rad/s)?"
        )
