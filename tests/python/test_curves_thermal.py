# SPDX-License-Identifier: BSD-3-Clause
"""Thermal tune: spectra of a known oscillator, whose mean square is integrated numerically."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("scipy")

from nanotouch import curves
from nanotouch.errors import InvalidValue

K, F_R, T, FLOOR = 0.2, 20e3, 300.0, 1e-27  # N/m, Hz, K, m^2/Hz


def spectrum(quality: float) -> tuple[np.ndarray, np.ndarray]:
    """Mean square k_B T/K over all frequencies, and white noise."""
    wide = np.linspace(0.1, 200 * F_R, 4_000_001)

    def shape(f: np.ndarray) -> np.ndarray:
        return 1.0 / ((1.0 - (f / F_R) ** 2) ** 2 + (f / F_R / quality) ** 2)

    area = float(shape(wide).sum() * (wide[1] - wide[0]))
    f = np.linspace(2e3, 60e3, 3000)
    density = 1.380649e-23 * T / K / area * shape(f) + FLOOR
    return f, density


@pytest.mark.parametrize("quality", [3.0, 50.0, 200.0])
def test_an_exact_spectrum_gives_the_spring_constant(quality: float) -> None:
    f, density = spectrum(quality)
    found = curves.thermal_tune(f, density, averages=10**9, temperature=T, correction=1.0)
    assert found.spring_constant == pytest.approx(K, rel=1e-4)  # the numerical integral
    assert found.resonance == pytest.approx(F_R, rel=1e-6)
    assert found.quality_factor == pytest.approx(quality, rel=1e-6)
    assert found.floor == pytest.approx(FLOOR, rel=1e-4)


@pytest.mark.parametrize("order", ["falling", "shuffled"])
def test_the_order_of_frequencies_does_not_matter(order: str) -> None:
    """In falling order the resonance was taken for one of negative width: a spring constant of 1e-9 of the true one."""
    f, density = spectrum(50.0)
    f, density = np.append(0.0, f), np.append(1e-20, density)
    way = np.arange(f.size)[::-1] if order == "falling" else np.random.default_rng(2).permutation(f.size)
    found = curves.thermal_tune(f[way], density[way], averages=10**9, temperature=T, correction=1.0)
    assert found.spring_constant == pytest.approx(K, rel=1e-4)


def test_pulls_have_the_width_that_sigma_says() -> None:
    f, density = spectrum(50.0)
    rng, pulls = np.random.default_rng(1), []
    for _ in range(60):
        noisy = density * rng.gamma(30, 1.0 / 30, f.size)
        found = curves.thermal_tune(f, noisy, averages=30, temperature=T, correction=1.0)
        truth = {"spring_constant": K, "resonance": F_R, "quality_factor": 50.0}
        pulls.append([(getattr(found, name) - value) / found.sigma[name] for name, value in truth.items()])
    # 60 draws: the standard deviation of 1 is known to 0.09, the mean of 0 to 0.13; four of each
    assert np.all(np.abs(np.std(pulls, axis=0) - 1.0) < 0.37)
    assert np.all(np.abs(np.mean(pulls, axis=0)) < 0.52)


def test_one_periodogram_has_its_bias_taken_off() -> None:
    f, density = spectrum(50.0)
    rng = np.random.default_rng(4)
    ratio = []
    for _ in range(40):
        noisy = density * rng.exponential(1.0, f.size)
        found = curves.thermal_tune(f, noisy, averages=1, temperature=T, correction=1.0)
        ratio.append(found.spring_constant / K)
    # The mean of ln of an exponential variable is -0.577: 78 % too stiff if it were forgotten. One spectrum gives 14 %,
    # the mean of 40 gives 2.2 %; four of that.
    assert abs(np.log(ratio).mean()) < 0.09


def test_an_optical_lever_reads_softer_and_nonsense_is_refused() -> None:
    f, density = spectrum(50.0)
    found = curves.thermal_tune(f, density, averages=10**9, temperature=T)
    assert found.spring_constant == pytest.approx(0.817 * K, rel=1e-3)
    with pytest.raises(InvalidValue, match="positive, finite"):
        curves.thermal_tune(f, -density, averages=1)
    with pytest.raises(InvalidValue, match="temperature"):
        curves.thermal_tune(f, density, averages=1, temperature=0.0)
