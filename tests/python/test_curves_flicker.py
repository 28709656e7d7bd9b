# SPDX-License-Identifier: BSD-3-Clause
"""White and 1/f noise told apart, against the scatter of many records made here."""

from __future__ import annotations

import layer_oracle as oracle
import nanotouch as nt
import numpy as np
import pytest
from nanotouch import curves
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
    """30 coefficients (of 250 points) know its variance to 26 %, 62 (of 1600) to 18 %; what flicker noise they cannot
    exclude widens the sigma of the record's mean by a third in the typical record of 250 points."""
    rng = np.random.default_rng(0)
    found = [split_noise(without_line(2.0 * rng.standard_normal(count)), 2.0) for _ in range(400)]
    white = [noise.white for noise in found]
    assert min(white) == 4.0  # no less than what the scatter of single points says
    assert np.median(white) == pytest.approx(4.0, rel=0.05)
    assert np.std(white) < (1.2 if count == 250 else 0.8)
    wider = np.sqrt(1.0 + np.median([count * noise.flicker / noise.white for noise in found]))
    assert 1.0 < wider < 1.35


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
    """To a third and a half: a record tells no more."""
    rng = np.random.default_rng(2)
    found = [split_noise(without_line(rng.standard_normal(1600) + 0.3 * flicker(rng, 1600)), 0.0) for _ in range(100)]
    assert np.median([noise.white for noise in found]) == pytest.approx(1.0, rel=0.3)
    assert np.median([noise.flicker for noise in found]) == pytest.approx(0.6 * 2.0 * np.log(2.0) * 0.09, rel=0.5)


def test_smeared_noise_is_white_with_the_variance_of_its_mean() -> None:
    """Means of 8 points, the finest that count, still lack a fifth of the variance of noise smeared over five."""
    rng = np.random.default_rng(3)
    found = [split_noise(np.convolve(rng.standard_normal(1604), np.full(5, 0.2), "valid"), 0.0) for _ in range(100)]
    assert np.median([noise.white for noise in found]) == pytest.approx(0.85, rel=0.15)
    assert np.median([1600 * noise.flicker / noise.white for noise in found]) < 0.8


def test_nothing_is_nothing() -> None:
    assert split_noise(np.zeros(500), 0.0) == (0.0, 0.0)
    assert split_noise(np.ones(20), 3.0) == (9.0, 0.0)  # too few points: what the scatter says


def two_branches(noise: list[np.ndarray]) -> curves.ForceCurve:
    """A stiff contact without adhesion; the second noise is the retraction's."""
    z = np.linspace(1.5e-6, -5e-8, noise[0].size)
    parts, time = [], np.full(z.size, np.nan)
    for role, at, own in (("approach", z, noise[0]), ("retract", z[::-1], noise[1])):
        force = np.where(at < 0.0, -0.05 * at, 0.0) + own
        parts.append(curves.Segment(role, time, at, "height (measured)", force))  # type: ignore[arg-type]
    return curves.ForceCurve(tuple(parts), {"spring constant": 0.05}, "two branches")


def test_both_branches_tell_the_noise_of_both() -> None:
    """Together they know flicker noise better than one: its spread over records falls by a quarter at least (half of
    the variance: 0.71). A branch whose noise is another, as that of a tip that is still held, keeps its own."""
    rng, alone, shared = np.random.default_rng(4), [], []
    for _ in range(100):
        noise = [15e-12 * (rng.standard_normal(1500) + 0.2 * flicker(rng, 1500)) for _ in range(2)]
        report = curves.analyse(two_branches(noise))
        found = [report.branches[role].baseline.noise.flicker for role in ("approach", "retract")]
        assert found[0] == found[1]
        shared.append(found[0])
        line = curves.analyse(two_branches(noise), baseline="line")
        alone.append(line.branches["approach"].baseline.noise.flicker)
    assert np.std(shared) < 0.8 * np.std(alone)
    other = [15e-12 * rng.standard_normal(1500), 15e-12 * (rng.standard_normal(1500) + 0.7 * flicker(rng, 1500))]
    branches = curves.analyse(two_branches(other)).branches
    assert branches["retract"].baseline.noise.flicker > 30.0 * branches["approach"].baseline.noise.flicker


@pytest.mark.parametrize("points", [150, 1500])
def test_the_foot_of_a_soft_contact_is_no_baseline(points: int) -> None:
    """A three-sided pyramid by its own law: with the foot in its baseline its contact point lay one sigma too low, and
    the interval held 76 % (150 points). 60 curves know a mean pull to 0.13, 95 % to 2.8 %."""
    pulls = []
    for seed in range(60):
        rng = np.random.default_rng([seed, 6])
        law = lambda depth: oracle.force("pyramid3", depth, 3e3, 0.6)  # noqa: E731
        curve = oracle.measured(law, 0.05, 0.8e-6, rng, (1.0, 1.0), 15e-12 * rng.standard_normal(2 * points), points)
        result = nt.fit.fit_curve(curve, "pyramid3", half_angle=0.6)
        pulls.append((result.values["contact_point"] - curve.meta["truth"]) / result.sigma["contact_point"])
    assert abs(np.mean(pulls)) < 0.4
    assert np.mean(np.abs(pulls) < 1.96) > 0.89
