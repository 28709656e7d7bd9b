# SPDX-License-Identifier: BSD-3-Clause
"""curves.sader: the hydrodynamic function and the spring constant of a rectangular cantilever."""

from __future__ import annotations

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue

pytest.importorskip("scipy.special")
mpmath = pytest.importorskip("mpmath")

BEAM = {"length": 197e-6, "width": 29e-6, "resonance": 69.87e3, "quality_factor": 136.0}


@pytest.mark.parametrize("reynolds", [1e-3, 0.1, 1.0, 30.0, 1e3])
def test_circular_part_agrees_with_high_precision_bessel_functions(reynolds: float) -> None:
    """Gamma over Sader's rational correction is the circular cylinder's, 40 digits here; 1e-13 of rounding."""
    with mpmath.workdps(40):
        root = mpmath.sqrt(1j * mpmath.mpf(reynolds))
        circular = 1 + 4j * mpmath.besselk(1, -1j * root) / (root * mpmath.besselk(0, -1j * root))
    found = complex(nt.curves.hydrodynamic_function(reynolds)) / correction(np.log10(reynolds))
    assert found == pytest.approx(complex(circular), rel=1e-12)


def correction(tau: float) -> complex:
    """Omega of Sader 1998, Eq. 21, once more, in Horner's form."""

    def horner(*coefficients: float) -> float:
        total = 0.0
        for coefficient in reversed(coefficients):
            total = total * tau + coefficient
        return total

    real = horner(0.91324, -0.48274, 0.46842, -0.12886, 0.044055, -0.0035117, 0.00069085) / horner(
        1.0, -0.56964, 0.48690, -0.13444, 0.045155, -0.0035862, 0.00069085
    )
    imaginary = horner(-0.024134, -0.029256, 0.016294, -0.00010961, 0.000064577, -0.000044510) / horner(
        1.0, -0.59702, 0.55182, -0.18357, 0.079156, -0.014369, 0.0028361
    )
    return complex(real, imaginary)


def test_limits_of_the_hydrodynamic_function() -> None:
    """Fast: the added mass of a thin plate in a perfect fluid, rho pi b^2/4, Gamma_r -> 1, and boundary layers that
    thin as Re^-1/2. Slow: Stokes' drag on any cross section, Gamma_i ~ -4/(Re ln sqrt(Re)), to the logarithm."""
    fast = nt.curves.hydrodynamic_function([1e3, 1e4])
    assert fast[1].real == pytest.approx(1.0, abs=0.05)
    assert fast[0].imag / fast[1].imag == pytest.approx(np.sqrt(10.0), rel=0.15)
    slow = nt.curves.hydrodynamic_function(1e-5)
    assert slow.imag == pytest.approx(4.0 / (1e-5 * -np.log(np.sqrt(1e-5))), rel=0.35)


def test_spring_constant_and_its_uncertainty() -> None:
    """k = 0.1906 rho b^2 L Q Gamma_i omega^2 written out; 2000 draws know sigma to 1.6 %: 8 % is five."""
    value, sigma = nt.curves.sader(**BEAM)
    omega = 2 * np.pi * BEAM["resonance"]
    reynolds = 1.18 * omega * BEAM["width"] ** 2 / (4 * 1.86e-5)
    gamma = nt.curves.hydrodynamic_function(reynolds).imag
    assert value == pytest.approx(
        0.1906 * 1.18 * BEAM["width"] ** 2 * BEAM["length"] * BEAM["quality_factor"] * gamma * omega**2
    )
    assert sigma == 0.0
    spread = {"width": 0.5e-6, "length": 2e-6, "quality_factor": 3.0, "resonance": 20.0, "viscosity": 0.02e-5}
    _, sigma = nt.curves.sader(**BEAM, sigma=spread)
    rng = np.random.default_rng(2)
    centre = BEAM | {"viscosity": 1.86e-5}
    draws = [
        nt.curves.sader(**(centre | {name: centre[name] + s * rng.standard_normal() for name, s in spread.items()}))[0]
        for _ in range(2000)
    ]
    assert sigma == pytest.approx(np.std(draws), rel=0.08)


def test_agrees_with_the_thermal_tune_of_the_same_beam() -> None:
    """A silicon beam of known stiffness: Q from its own hydrodynamic damping gives the stiffness back to 3 %, through
    k = M_e rho_s b h L (2 pi f_vacuum)^2 with M_e = 0.2427 and Sader's Eqs. 4 and 5 for f_r and Q."""
    length, width, thickness, density, modulus = 225e-6, 35e-6, 1.0e-6, 2330.0, 169e9
    stiffness = modulus * width * thickness**3 / (4 * length**3)
    vacuum = np.sqrt(stiffness / (0.2427 * density * width * thickness * length))  # rad/s
    omega = vacuum
    for _ in range(30):
        gamma = complex(nt.curves.hydrodynamic_function(1.18 * omega * width**2 / (4 * 1.86e-5)))
        ratio = np.pi * 1.18 * width / (4 * density * thickness)
        omega = vacuum / np.sqrt(1 + ratio * gamma.real)
    quality = (1 / ratio + gamma.real) / gamma.imag
    found, _ = nt.curves.sader(length=length, width=width, resonance=omega / (2 * np.pi), quality_factor=quality)
    assert found == pytest.approx(stiffness, rel=0.03)


@pytest.mark.parametrize(
    "changes",
    [{"length": 50e-6}, {"width": 0.0}, {"quality_factor": -1.0}, {"resonance": np.nan}, {"sigma": {"mass": 1.0}},
     {"resonance": 1e12}],
)  # fmt: skip
def test_nonsense_is_refused(changes: dict[str, float]) -> None:
    with pytest.raises(InvalidValue):
        nt.curves.sader(**(BEAM | changes))  # type: ignore[arg-type]
