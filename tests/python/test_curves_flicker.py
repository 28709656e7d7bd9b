# SPDX-License-Identifier: BSD-3-Clause
"""White and 1/f noise told apart, against the scatter of many records made here."""

from __future__ import annotations

import numpy as np
import pytest
from nanotouch.curves.flicker import split_noise


def flicker(rng: np.random.Generator, count: int) -> np.ndarray:
    """A power spectral density of h/f per sample, h = 1; Allan's variance of it is 2 ln 2."""
    size = 16 * count
    spectrum = np.fft.rfft(rng.standard_normal(size))
    frequency = np.arange(spectrum.size) / size
    spectrum[1:] /= np.sqrt(2.0 * frequency[1:])  # two-sided density of h/(2 f)
    spectrum[0] = 0.0
    return np.asarray(np.fft.irfft(spectrum)[:count])


def without_line(values: np.ndarray) -> np.ndarray:
    x = np.arange(values.size)
    return values - np.polyval(np.polyfit(x, values, 1), x)


@pytest.mark.parametrize("count", [250, 1600])
def test_white_noise_is_white(count: int) -> None:
    """22 differences (of 250 points) know its variance to 30 %, 195 (of 1600) to 10 %; flicker noise is seen once in
    20 records."""
    rng = np.random.default_rng(0)
    found = [split_noise(without_line(2.0 * rng.standard_normal(count)), 2.0) for _ in range(400)]
    white = [noise.white for noise in found]
    assert min(white) == 4.0  # no less than what the scatter of single points says
    assert np.median(white) == pytest.approx(4.0, rel=0.05)
    assert np.std(white) < (1.2 if count == 250 else 0.4)
    assert np.mean([noise.flicker > 0.0 for noise in found]) < 0.07  # 0.05 + 2 standard deviations of 400


@pytest.mark.parametrize("share", [0.2, 0.4])
def test_a_line_is_known_to_what_flicker_noise_leaves(share: float) -> None:
    """The line through the far part of a record, drawn on to the middle of the near part, misses the mean of that by
    what level and slope are said to be known to: 600 records know a standard deviation to 3 %, 20 % are allowed for
    the one number that stands for all lengths."""
    rng, count = np.random.default_rng(1), 2000
    near = int(share * count)
    x = np.arange(near, count) - 0.5 * (near + count - 1)
    reach = 0.5 * (near - 1) - 0.5 * (near + count - 1)
    missed, said = [], []
    for _ in range(600):
        record = flicker(rng, count)
        slope, level = np.polyfit(x, record[near:], 1)
        noise = split_noise(record[near:] - level - slope * x, 0.0)
        missed.append(record[:near].mean() - level - slope * reach)
        said.append(noise.white / x.size + noise.flicker + (noise.white + x.size * noise.flicker) * reach**2 / (x @ x))
    assert np.std(missed) == pytest.approx(np.sqrt(np.median(said)), rel=0.2)


def test_mixtures_are_told_apart() -> None:
    """To a third and a half: the smallest octaves are left out, and flicker noise has to be evident."""
    rng = np.random.default_rng(2)
    found = [split_noise(without_line(rng.standard_normal(1600) + 0.3 * flicker(rng, 1600)), 0.0) for _ in range(100)]
    assert np.median([noise.white for noise in found]) == pytest.approx(1.0, rel=0.3)
    assert np.median([noise.flicker for noise in found]) == pytest.approx(0.6 * 2.0 * np.log(2.0) * 0.09, rel=0.5)


def test_smeared_noise_is_white_with_the_variance_of_its_mean() -> None:
    """Means of 8 points, the finest that count, still lack a fifth of the variance of noise smeared over five."""
    rng = np.random.default_rng(3)
    found = [split_noise(np.convolve(rng.standard_normal(1604), np.full(5, 0.2), "valid"), 0.0) for _ in range(100)]
    assert np.median([noise.white for noise in found]) == pytest.approx(0.85, rel=0.15)
    assert np.median([noise.flicker for noise in found]) == 0.0


def test_nothing_is_nothing() -> None:
    assert split_noise(np.zeros(500), 0.0) == (0.0, 0.0)
    assert split_noise(np.ones(20), 3.0) == (9.0, 0.0)  # too few points: what the scatter says
