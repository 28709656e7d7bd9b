# SPDX-License-Identifier: BSD-3-Clause
"""Spring constant of a rectangular cantilever from its size, resonance and quality factor in a fluid.

Sader, Chon and Mulvaney (Rev. Sci. Instrum. 70 (1999) 3967), with the hydrodynamic function of Sader (J. Appl. Phys. 84
(1998) 64), good to 0.1 % for Reynolds numbers from 1e-6 to 1e4. Neither thickness nor material enters.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._arrays import as_floats, check_between
from ..errors import InvalidValue, require

AIR_DENSITY = 1.18  # kg/m^3, at 25 degrees Celsius and 1013 hPa
AIR_VISCOSITY = 1.86e-5  # Pa s
_NORMALISED_MASS = 0.1906  # of the first mode: Sader's coefficient 0.2427 pi/4
_SLENDER = 3.0  # length over width from where the theory is used

# Sader 1998, Eq. 21: correction of a circular to a rectangular cross section in tau = log10 Re.
_REAL = (0.91324, -0.48274, 0.46842, -0.12886, 0.044055, -0.0035117, 0.00069085)
_REAL_BELOW = (1.0, -0.56964, 0.48690, -0.13444, 0.045155, -0.0035862, 0.00069085)
_IMAGINARY = (-0.024134, -0.029256, 0.016294, -0.00010961, 0.000064577, -0.000044510)
_IMAGINARY_BELOW = (1.0, -0.59702, 0.55182, -0.18357, 0.079156, -0.014369, 0.0028361)


def hydrodynamic_function(reynolds: ArrayLike) -> NDArray[np.complex128]:
    """Gamma(Re) of a thin rectangular beam that moves across its width.

    Gamma = Omega (1 + 4 i K1(-i sqrt(i Re))/(sqrt(i Re) K0(-i sqrt(i Re)))), Re = rho omega b^2/(4 eta).

    Parameters
    ----------
    reynolds : array_like
        Re, 1e-6 to 1e4.
    """
    Re = as_floats(reynolds, "reynolds")
    if not bool(np.all((Re >= 1e-6) & (Re <= 1e4))):
        raise InvalidValue(f"reynolds: {reynolds!r}, valid is 1e-6 to 1e4")
    special = require("scipy.special", "curves")
    root = np.sqrt(1j * Re)
    circular = 1.0 + 4j * special.kve(1, -1j * root) / (root * special.kve(0, -1j * root))
    tau = np.log10(Re)
    rational = np.polynomial.polynomial.polyval
    correction = rational(tau, _REAL) / rational(tau, _REAL_BELOW)
    correction = correction + 1j * rational(tau, _IMAGINARY) / rational(tau, _IMAGINARY_BELOW)
    return np.asarray(correction * circular, dtype=np.complex128)


def sader(
    *,
    length: float,
    width: float,
    resonance: float,
    quality_factor: float,
    density: float = AIR_DENSITY,
    viscosity: float = AIR_VISCOSITY,
    sigma: dict[str, float] | None = None,
) -> tuple[float, float]:
    """k_c = 0.1906 rho b^2 L Q Im Gamma(omega) omega^2 of a rectangular cantilever.

    Parameters
    ----------
    length, width : float
        L, b [m]; the theory is for L much larger than b.
    resonance : float
        f_r in the fluid [Hz].
    quality_factor : float
        Q in the fluid, much larger than 1.
    density, viscosity : float
        Of the fluid [kg/m^3], [Pa s]; air by default.
    sigma : dict, optional
        Standard uncertainties of these by name, as of :func:`thermal_tune`.

    Returns
    -------
    value, sigma : float
        k_c and its standard uncertainty [N/m].
    """
    given = {"length": length, "width": width, "resonance": resonance, "quality_factor": quality_factor,
             "density": density, "viscosity": viscosity}  # fmt: skip
    for name, value in given.items():
        check_between(name, value, "SI", above=0.0)
    if length < _SLENDER * width:
        raise InvalidValue(f"length = {length:g} m: it must be at least {_SLENDER:g} times the width, {width:g} m")
    unknown = set(sigma or {}) - set(given)
    if unknown:
        raise InvalidValue(f"sigma of {', '.join(sorted(unknown))}: valid are {', '.join(given)}")
    value = _spring_constant(given)
    variance = 0.0
    for name, spread in (sigma or {}).items():
        step = 1e-4 * given[name]  # central differences: exact to 1e-8 here
        up, down = (_spring_constant(given | {name: given[name] + s}) for s in (step, -step))
        variance += ((up - down) / (2.0 * step) * spread) ** 2
    return value, float(np.sqrt(variance))


def _spring_constant(given: dict[str, float]) -> float:
    omega, width = 2.0 * np.pi * given["resonance"], given["width"]
    reynolds = given["density"] * omega * width**2 / (4.0 * given["viscosity"])
    damping = float(hydrodynamic_function(reynolds).imag)
    mass = _NORMALISED_MASS * given["density"] * width**2 * given["length"]
    return mass * given["quality_factor"] * damping * omega**2
