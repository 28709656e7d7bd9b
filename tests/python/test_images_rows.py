# SPDX-License-Identifier: BSD-3-Clause
"""Offsets of rows go, gratings along the rows stay; what may be a structure is said."""

from __future__ import annotations

import itertools
import warnings

import numpy as np
import pytest
import synthetic

cv2 = pytest.importorskip("cv2")

from nanotouch import images, surface  # noqa: E402

SIDE = 10e-6


def topography(heights: synthetic.Array) -> images.Topography:
    return images.Topography(heights, (SIDE / heights.shape[0], SIDE / heights.shape[1]))


def film(shape: tuple[int, int], correlation: float, rms: float, seed: int) -> synthetic.Array:
    noise = cv2.GaussianBlur(np.random.default_rng(seed).standard_normal(shape), (0, 0), correlation)
    return np.asarray(noise / noise.std() * rms)


@pytest.mark.parametrize("along_y", [True, False], ids=["lines along y", "lines along the fast axis"])
@pytest.mark.parametrize("n", [128, 512])
@pytest.mark.parametrize("jitter", [0.0, 1e-9, 5e-9])
def test_the_grating_keeps_its_step_both_ways_while_offsets_go(along_y: bool, n: int, jitter: float) -> None:
    """480 nm on a slope, rows off by up to 5 nm rms, 0.5 nm of noise: in one call."""
    heights, ridge = synthetic.grating(n, duty=0.4, along_y=along_y)
    rng = np.random.default_rng(n)
    offsets = jitter * rng.standard_normal((n, 1)) * np.ones(n)
    rough = offsets + 0.5e-9 * rng.standard_normal(heights.shape)
    levelled, report = images.level(topography(synthetic.tilted(heights + rough, SIDE, 0.02, 0.03)), "plane+rows")
    step = np.median(levelled.heights[ridge]) - np.median(levelled.heights[~ridge])
    # what the offsets of the rows on it add to a level cannot be told from its height
    assert step == pytest.approx(480e-9 + offsets[ridge].mean() - offsets[~ridge].mean(), abs=0.1e-9 + 0.3 * jitter)
    left = np.median(levelled.heights - heights, axis=1).std()
    # a level of 15 rows (128 pixels, 0.4) leaves 1/4 of the jitter in its mean, and a tilt as uncertain
    assert left < 0.1e-9 + (0.5 if n == 128 else 0.3) * jitter
    assert [step.method for step in report.steps][:2] == ["plane", "rows"]
    if jitter == 0.0:
        assert report.steps[1].removed_range == 0.0


def test_a_plain_alignment_would_erase_it_and_says_so() -> None:
    """The verdict both ways: the same call on lines across the rows is harmless, along the rows it is not."""
    across, ridge = synthetic.grating(256, duty=0.4)
    clean, report = images.level(topography(across), "plane+medians")
    assert np.median(clean.heights[ridge]) - np.median(clean.heights[~ridge]) == pytest.approx(480e-9, rel=1e-6)
    assert report.warnings == ()
    along, ridge = synthetic.grating(256, duty=0.4, along_y=False)
    noisy = along + 0.5e-9 * np.random.default_rng(1).standard_normal(along.shape)
    with pytest.warns(UserWarning, match="medians erased what looks like 7 steps along the fast axis, up to 480"):
        erased, report = images.level(topography(noisy), "plane+medians")
    assert abs(np.median(erased.heights[ridge]) - np.median(erased.heights[~ridge])) < 1e-9
    assert report.steps[1].removed_range == pytest.approx(480e-9, rel=0.01)


def test_walls_that_slope_and_lines_that_are_not_quite_parallel() -> None:
    """As a tip shows them: walls five rows wide, lines turned by up to two degrees against the fast axis."""
    n = 256
    j, i = np.indices((n, n)).astype(float)
    rng = np.random.default_rng(4)
    for degrees in (0.05, 0.3, 2.0):
        position = j * np.cos(np.radians(degrees)) + i * np.sin(np.radians(degrees))
        ridge = (position - 20) % 77 < 35
        heights = cv2.blur(np.where(ridge, 480e-9, 0.0), (1, 5), borderType=cv2.BORDER_REPLICATE)
        rough = 1e-9 * rng.standard_normal((n, 1)) + 0.3e-9 * rng.standard_normal((n, n))
        levelled, _ = images.level(topography(heights + rough), "plane+rows")
        top = cv2.erode(ridge.astype(np.uint8), np.ones((9, 1))) > 0
        floor = cv2.erode((~ridge).astype(np.uint8), np.ones((9, 1))) > 0
        assert np.median(levelled.heights[top]) - np.median(levelled.heights[floor]) == pytest.approx(480e-9, rel=3e-3)


def test_a_fine_grating_along_the_rows_is_recognised_by_its_period() -> None:
    """Six rows a period: no level lasts long enough to be told from offsets otherwise."""
    n = 256
    fine = np.where(np.arange(n) % 6 < 3, 20e-9, 0.0)[:, None] + np.zeros((n, n))
    noisy = fine + 0.5e-9 * np.random.default_rng(2).standard_normal((n, n))
    with pytest.warns(UserWarning, match=r"rows repeat every (5\.9\d|6) rows .* taken for a grating"):
        levelled, report = images.level(topography(noisy), "rows")
    np.testing.assert_allclose(levelled.heights, noisy - noisy.mean(), rtol=0, atol=1e-21)
    assert report.steps[0].removed_range == 0.0
    wave = 20e-9 * np.sin(2 * np.pi * np.arange(n) / 64)[:, None] + noisy - fine
    with pytest.warns(UserWarning, match="rows repeat every 64 rows over 4"):
        kept, _ = images.level(topography(wave), "rows")
    assert np.ptp(np.median(kept.heights, axis=1)) == pytest.approx(40e-9, rel=0.03)


def test_a_row_far_off_is_put_back_with_a_warning() -> None:
    rng = np.random.default_rng(5)
    heights = film((128, 128), 3.0, 0.5e-9, 5) + 0.2e-9 * rng.standard_normal((128, 1))
    spoilt = heights.copy()
    spoilt[60:62] += 30e-9
    with pytest.warns(UserWarning, match=r"2 rows were off by up to 30\.?\d* nm .* first is row 60"):
        levelled, _ = images.level(topography(spoilt), "rows")
    assert levelled.height_range < 1.2 * np.ptp(heights)


@pytest.mark.parametrize("seed", range(3))
def test_a_surface_without_offsets_is_left_to_the_last_bit(seed: int) -> None:
    """Films of several grain sizes, and dots: what the halves do not agree on is no offset of rows."""
    for correlation in (1.0, 4.0, 12.0):
        before = topography(film((128, 160), correlation, 5e-9, seed))
        after, report = images.level(before, "rows")
        np.testing.assert_array_equal(after.heights, before.heights - before.heights.mean())
        assert "no offsets" in report.steps[0].note
    dots = surface.dots(500e-9, 256, seed=seed + 1)
    assert images.level(dots, "rows")[1].steps[0].removed_range == 0.0


def test_dots_draw_no_dark_bands_beside_them() -> None:
    """Offsets come from differences between rows, in which particles are outliers: the flat stays flat."""
    dots = surface.dots(500e-9, 256).heights
    jitter = 0.3e-9 * np.random.default_rng(8).standard_normal((256, 1))
    levelled, _ = images.level(topography(dots + jitter + 0.05e-9 * film((256, 256), 0.5, 1.0, 8)), "rows")
    flat = dots == 0
    row = np.array([np.median(z[f]) for z, f in zip(levelled.heights, flat, strict=True)])
    assert row.std() < 0.1e-9


def test_masked_rows_and_pixels_do_not_count() -> None:
    rng = np.random.default_rng(6)
    heights = 1e-9 * rng.standard_normal((96, 1)) + 0.2e-9 * rng.standard_normal((96, 200))
    want = images.level(topography(heights), "plane+rows")[0].heights
    spoilt, mask = heights.copy(), np.zeros(heights.shape, bool)
    mask[:, 150:], mask[40:43] = True, True
    spoilt[mask] = 1e-6 * rng.random(np.count_nonzero(mask))
    got = images.level(topography(spoilt), "plane+rows", mask=mask)[0].heights
    rest = (got - want)[~mask].reshape(93, 150)
    # the medians of 150 pixels in place of 200, and a gap of three rows
    assert (rest - rest.mean()).std() < 0.15e-9


def test_errors_of_many_medians_do_not_pass_for_a_structure() -> None:
    """2048 rows of 64 pixels: the sum of their median differences walks off by ten nanometres, their means do not."""
    rng = np.random.default_rng(9)
    heights = 1e-9 * rng.standard_normal((2048, 1)) + 1e-9 * rng.standard_normal((2048, 64))
    levelled, report = images.level(topography(heights), "plane+medians")
    assert report.warnings == ()
    assert levelled.heights.mean(axis=1).std() < 0.2e-9  # medians of 64 pixels of 1 nm
    rows = images.level(topography(heights), "plane+rows")[1].steps[1]
    assert float(rows.note.split(";")[1].split()[0]) < 2.0


def test_no_grating_is_lost_without_a_word() -> None:
    """Periods of 3 to 100 rows, three duties, sharp and sloping walls, up to ten times the offsets of the rows."""
    n, rng = 256, np.random.default_rng(10)
    for period, duty, height, walls in itertools.product(
        (3, 4, 5, 6, 7, 9, 12, 17, 25, 40, 64, 100), (0.3, 0.5, 0.7), (5e-9, 480e-9), (1, 3)
    ):
        profile = np.where(np.arange(n) % period < duty * period, height, 0.0)
        profile = np.convolve(np.pad(profile, 2, mode="wrap"), np.ones(walls) / walls, "same")[2:-2]
        if np.ptp(profile) < 0.5 * height:
            continue  # the walls fill the grooves
        off = 0.1 * min(height, 20e-9) * rng.standard_normal(n)
        image = (profile + off)[:, None] + 0.3e-9 * rng.standard_normal((n, n))
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            levelled, _ = images.level(topography(image), "rows")
        true = profile - profile.mean()
        kept = float(levelled.heights.mean(axis=1) @ true / (true @ true))
        assert kept > 0.9 or told, (period, duty, height, walls, kept)
