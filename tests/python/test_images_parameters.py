# SPDX-License-Identifier: BSD-3-Clause
"""ISO parameters, PSD and autocorrelation of surfaces whose values are known in closed form."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

stats = pytest.importorskip("scipy.stats")
library = pytest.importorskip("SurfaceTopography")

from nanotouch import images  # noqa: E402

STEP = 2e-9
A, PERIODS, SIDE = 5e-9, 8, 512


@pytest.fixture(scope="module")
def wave() -> images.Topography:
    """A sin(q x), the same in every row."""
    x = np.arange(SIDE)
    heights = A * np.sin(2 * np.pi * PERIODS * x / SIDE + 0.1) * np.ones((SIDE, 1))
    return images.Topography(heights, (STEP, STEP))


@pytest.fixture(scope="module")
def gaussian() -> images.Topography:
    """Independent Gaussian heights of 1 nm."""
    return images.Topography(1e-9 * np.random.default_rng(1).standard_normal((SIDE, SIDE)), (STEP, STEP))


def test_a_wave(wave: images.Topography) -> None:
    found = {name: parameter.value for name, parameter in images.parameters(wave).items()}
    q = 2 * np.pi * PERIODS / (SIDE * STEP)
    for name in ("Sq", "Pq"):
        assert found[name] == pytest.approx(A / np.sqrt(2), rel=1e-12)
    for name in ("Sa", "Pa"):
        assert found[name] == pytest.approx(2 * A / np.pi, rel=1e-3)
    assert found["Sku"] == pytest.approx(1.5, rel=1e-12)
    assert abs(found["Ssk"]) < 1e-12
    assert found["Sz"] == pytest.approx(found["Sp"] + found["Sv"], rel=1e-12)
    assert found["Sz"] == pytest.approx(2 * A, rel=1e-3)
    differences = 2 / STEP * np.sin(q * STEP / 2)  # what differences over a pixel see of q
    for name in ("Sdq", "Pdq"):
        assert found[name] == pytest.approx(A * differences / np.sqrt(2), rel=3e-3)
    area = np.mean(np.sqrt(1 + (A * q * np.cos(np.linspace(0, 2 * np.pi, 20001))) ** 2)) - 1
    assert found["Sdr"] == pytest.approx(area, rel=5e-3)
    assert found["Sal"] == pytest.approx(np.arccos(0.2) / q, abs=1.5 * STEP)  # cos(q r) = 0.2
    assert np.isnan(found["Str"]), "the lines leave the picture"


def test_gaussian_heights(gaussian: images.Topography) -> None:
    """The core's line is that of least squares through the quantiles from 30 to 70 % (ISO 13565-2), where the flattest
    secant lies; the rest are integrals of the normal distribution."""
    found = {name: parameter.value for name, parameter in images.parameters(gaussian).items()}
    normal, unit = stats.norm, 1e-9
    share = np.linspace(0.3, 0.7, 4001)
    core = -np.polyfit(share, normal.isf(share), 1)[0]
    top = core / 2
    tail = normal.sf(top)
    excess = normal.pdf(top) - top * tail
    assert found["Sku"] == pytest.approx(3.0, abs=0.05)
    assert found["Sk"] == pytest.approx(core * unit, rel=0.01)
    assert found["Smr1"] == pytest.approx(tail, abs=0.003)
    assert found["Smr2"] == pytest.approx(1 - tail, abs=0.003)
    for name in ("Spk", "Svk"):
        assert found[name] == pytest.approx(2 * excess / tail * unit, rel=0.03)

    def above(share: float) -> float:
        level = normal.isf(share)
        return float(normal.pdf(level) - level * share) * unit

    def below(share: float) -> float:
        return above(share) + float(normal.isf(share)) * unit

    expected = {"Vmp": above(0.1), "Vmc": above(0.8) - above(0.1), "Vvc": below(0.1) - below(0.8), "Vvv": below(0.8)}
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=0.02)


def test_an_isotropic_film_and_stripes() -> None:
    """White noise smoothed by s has the autocorrelation exp(-r^2/4 s^2): it falls to 0.2 at 2 s sqrt(ln 5)."""
    ndimage = pytest.importorskip("scipy.ndimage")
    rough = np.random.default_rng(2).standard_normal((SIDE, SIDE))
    for widths, ratio in (((6.0, 6.0), 1.0), ((24.0, 6.0), 0.25)):
        z = ndimage.gaussian_filter(rough, widths, mode="wrap")
        found = images.parameters(images.Topography(1e-9 * z / z.std(), (STEP, STEP)))
        assert found["Sal"].value == pytest.approx(2 * 6 * STEP * np.sqrt(np.log(5)), rel=0.15)
        assert found["Str"].value == pytest.approx(ratio, rel=0.3)


def test_what_is_masked_does_not_count(gaussian: images.Topography) -> None:
    spoilt = gaussian.heights.copy()
    spoilt[100:140, 200:240] += 1e-6
    mask = spoilt > 5e-7
    found = images.parameters(images.Topography(spoilt, gaussian.pixel_size), mask)
    clean = images.parameters(gaussian)
    for name, parameter in found.items():
        loose = 0.02 if name.endswith("sk") else 1e-12
        assert parameter.value == pytest.approx(clean[name].value, rel=0.05, abs=loose), name
    flat = images.parameters(images.Topography(np.zeros((16, 16)), (STEP, STEP)))
    assert flat["Sq"].value == flat["Sdr"].value == flat["Sk"].value == 0.0
    assert np.isnan(flat["Sku"].value)
    assert np.isnan(flat["Sal"].value)


def test_gradient_beside_surfacetopography(gaussian: images.Topography) -> None:
    height, width = gaussian.size
    theirs = library.Topography(gaussian.heights.T, (width, height), periodic=False)
    found = images.parameters(gaussian)
    assert found["Sdq"].value == pytest.approx(theirs.rms_gradient(), rel=0.01)
    heights = gaussian.heights
    assert found["Pdq"].value == pytest.approx(np.sqrt(np.mean((np.diff(heights, axis=1) / STEP) ** 2)), rel=1e-9)


def test_spectrum(gaussian: images.Topography, wave: images.Topography, tmp_path: Path) -> None:
    """White noise of variance s^2: C_iso = s^2 dx dy and C1D = s^2 dx at every q, A(r) = s^2; of a wave the peak lies
    at its q, and A(half a period) = A^2."""
    found = images.spectrum(gaussian)
    assert np.median(found.density) == pytest.approx(1e-18 * STEP**2, rel=0.05)
    assert np.median(found.row_density) == pytest.approx(1e-18 * STEP, rel=0.05)
    assert np.median(found.autocorrelation) == pytest.approx(1e-18, rel=0.02)
    of_wave = images.spectrum(wave)
    q = 2 * np.pi * PERIODS / (SIDE * STEP)
    assert of_wave.row_wavevector[np.argmax(of_wave.row_density)] == pytest.approx(q, rel=0.15)
    near = int(np.argmin(np.abs(of_wave.row_distance - np.pi / q)))
    r = of_wave.row_distance[near]
    assert of_wave.row_autocorrelation[near] == pytest.approx(0.5 * A**2 * (1 - np.cos(q * r)), rel=0.05)
    found.to_csv(tmp_path / "s.csv")
    values = (found.row_density, found.density, found.row_autocorrelation, found.autocorrelation)
    assert len((tmp_path / "s.csv").read_text().splitlines()) == 1 + sum(of.size for of in values)
