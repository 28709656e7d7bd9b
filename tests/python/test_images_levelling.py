# SPDX-License-Identifier: BSD-3-Clause
"""Levelling keeps steps, despeckling keeps edges."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic

cv2 = pytest.importorskip("cv2")

from nanotouch import images  # noqa: E402
from nanotouch.errors import InvalidValue  # noqa: E402

SIDE = 10e-6
SLOPE = np.tan(np.radians(5.0))


def topography(heights: synthetic.Array) -> images.Topography:
    return images.Topography(heights, (SIDE / heights.shape[0], SIDE / heights.shape[1]))


def plane(image: images.Topography, **options: object) -> tuple[images.Topography, images.LevelReport]:
    return images.level(image, "plane", **options)  # type: ignore[arg-type]


def terrace_slopes(heights: synthetic.Array, ridge: np.ndarray) -> list[float]:
    """Least-squares slopes along y and x within ridges and within grooves, as height over the whole side [m]."""
    j, i = np.indices(heights.shape)
    slopes: list[float] = []
    for part in (ridge, ~ridge):
        terms = np.column_stack([np.ones(part.sum()), j[part], i[part]])
        slopes += list(np.linalg.lstsq(terms, heights[part], rcond=None)[0][1:] * heights.shape[0])
    return slopes


@pytest.mark.parametrize("along_y", [True, False], ids=["lines along y", "lines along the fast axis"])
@pytest.mark.parametrize("duty", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("noise", [0.0, 1e-9])
def test_a_tilted_grating_keeps_its_step_and_gets_level_terraces(along_y: bool, duty: float, noise: float) -> None:
    """480 nm on 5 degrees, in both directions (row alignment would leave 0 nm of it in one of them)."""
    heights, ridge = synthetic.grating(duty=duty, along_y=along_y)
    rough = noise * np.random.default_rng(2).standard_normal(heights.shape)
    levelled, report = plane(topography(synthetic.tilted(heights + rough, SIDE, 0.8 * SLOPE, 0.6 * SLOPE)))
    step = np.median(levelled.heights[ridge]) - np.median(levelled.heights[~ridge])
    assert step == pytest.approx(480e-9, rel=1e-3)
    # over the whole side: 1 nm of noise on 16 384 pixels fixes a slope to 0.03 nm; terraces are a part of the side
    assert np.abs(terrace_slopes(levelled.heights, ridge)).max() < 0.5e-9
    assert report.tilt == pytest.approx((0.8 * SLOPE, 0.6 * SLOPE), abs=1e-4)
    assert abs(levelled.heights.mean()) < 1e-15
    assert report.removed_range == pytest.approx(1.4 * SLOPE * SIDE * 127 / 128, rel=1e-3)


def test_an_ordinary_plane_fit_would_not_do() -> None:
    """The same grating, unequal ridges: plain least squares leaves a false tilt, which shows that the test can fail."""
    heights, ridge = synthetic.grating(duty=0.3)
    j, i = np.indices(heights.shape)
    terms = np.column_stack([np.ones(heights.size), j.ravel(), i.ravel()])
    plain = heights - (terms @ np.linalg.lstsq(terms, heights.ravel(), rcond=None)[0]).reshape(heights.shape)
    assert np.abs(terrace_slopes(plain, ridge)).max() > 20e-9
    levelled, _ = plane(topography(heights))
    assert np.abs(terrace_slopes(levelled.heights, ridge)).max() < 1e-15


def test_a_grating_with_sloping_walls() -> None:
    """As a tip shows it: walls five pixels wide."""
    heights, ridge = synthetic.grating(256, duty=0.4)
    soft = cv2.blur(heights, (5, 1), borderType=cv2.BORDER_REPLICATE)
    noise = 0.5e-9 * np.random.default_rng(3).standard_normal(soft.shape)
    levelled, _ = plane(topography(synthetic.tilted(soft + noise, SIDE, -SLOPE, SLOPE)))
    inner = cv2.erode(ridge.astype(np.uint8), np.ones((1, 7))) > 0
    outer = cv2.erode((~ridge).astype(np.uint8), np.ones((1, 7))) > 0
    step = np.median(levelled.heights[inner]) - np.median(levelled.heights[outer])
    assert step == pytest.approx(480e-9, rel=2e-3)


def test_dots_on_a_flat_and_a_coarsely_digitised_slope() -> None:
    rng = np.random.default_rng(4)
    y, x = np.meshgrid(np.arange(128), np.arange(128), indexing="ij")
    flat = np.zeros((128, 128))
    for cy, cx in rng.integers(0, 64, (20, 2)):  # all in one quarter: a plain plane would tilt
        flat = np.maximum(flat, 20e-9 - 2e-9 * np.hypot(y - cy, x - cx))
    slope = synthetic.tilted(flat, SIDE, 2e-3, -1e-3)
    levelled, _ = plane(topography(slope))
    bare = flat == 0
    assert np.ptp(levelled.heights[bare]) < 1.0e-9
    for steeper in (1.0, 10.0):  # to three steps of the digitiser from pixel to pixel
        slope = synthetic.tilted(flat, SIDE, 2e-3 * steeper, -1e-3 * steeper)
        coarse, _ = plane(topography(np.round(slope / 0.5e-9) * 0.5e-9))
        assert np.ptp(coarse.heights[bare]) < 2.0e-9  # the digitiser's step of 0.5 nm shows, no more


def test_a_smooth_surface_gets_the_ordinary_plane() -> None:
    rng = np.random.default_rng(5)
    film = cv2.GaussianBlur(rng.standard_normal((128, 128)), (0, 0), 4.0) * 10e-9
    levelled, report = plane(topography(synthetic.tilted(film, SIDE, 0.01, -0.02)))
    # the film's own least-squares plane is the uncertainty of what "level" means
    j, i = np.indices(film.shape)
    terms = np.column_stack([np.ones(film.size), j.ravel(), i.ravel()])
    own = np.linalg.lstsq(terms, film.ravel(), rcond=None)[0]
    pixel = SIDE / 128
    assert report.tilt == pytest.approx((0.01 + own[1] / pixel, -0.02 + own[2] / pixel), abs=2e-4)
    assert levelled.height_range < 1.2 * np.ptp(film)


def test_levelling_is_idempotent_and_masks() -> None:
    heights, _ = synthetic.grating(duty=0.4)
    once, _ = plane(topography(synthetic.tilted(heights, SIDE, 0.01, 0.02)))
    twice, report = plane(once)
    np.testing.assert_allclose(twice.heights, once.heights, rtol=0, atol=1e-18)
    assert report.removed_range < 1e-17
    # half of the image is another slope: masked away, it does not matter
    half = np.zeros(heights.shape, bool)
    half[64:] = True
    folded = np.where(half, 1e-6, synthetic.tilted(heights, SIDE, 0.01, 0.02))
    assert plane(topography(folded), mask=half)[1].tilt == pytest.approx((0.01, 0.02), rel=1e-9)
    for wrong in ("planes", "poly9", "plane+", ""):
        with pytest.raises(InvalidValue, match="method"):
            images.level(once, method=wrong)
    with pytest.raises(InvalidValue, match="mask: leaves 0 pixels"):
        plane(once, mask=np.ones(heights.shape, bool))


def test_speckles_go_and_everything_else_stays() -> None:
    heights, _ = synthetic.grating()
    heights[40:60, 100:118] = 200e-9  # a plateau: corners
    heights[90, 10:40] = 60e-9  # a line one pixel wide
    noise = 0.2e-9 * np.random.default_rng(6).standard_normal(heights.shape)
    spoilt = heights + noise
    speckles = {(5, 5): 900e-9, (64, 64): -700e-9, (100, 90): 35e-9, (100, 91): 30e-9, (0, 127): 50e-9}
    for place, off in speckles.items():
        spoilt[place] += off
    clean, report = images.despeckle(topography(spoilt))
    assert report.pixels == len(speckles)
    assert report.largest == pytest.approx(900e-9, rel=0.01)
    assert {(int(j), int(i)) for j, i in np.argwhere(clean.mask)} == set(speckles)
    np.testing.assert_allclose(clean.heights, heights, rtol=0, atol=1.5e-9)
    untouched = ~clean.mask
    np.testing.assert_array_equal(clean.heights[untouched], spoilt[untouched])  # not even rounded


def test_a_clean_grating_and_a_flat_are_not_touched() -> None:
    for along_y in (True, False):
        heights, _ = synthetic.grating(along_y=along_y)
        clean, report = images.despeckle(topography(heights))
        assert report.pixels == 0
        np.testing.assert_array_equal(clean.heights, heights)
    assert images.despeckle(topography(np.zeros((16, 16))))[1].pixels == 0


def test_prepare_does_both_and_says_so() -> None:
    heights, ridge = synthetic.grating(duty=0.3)
    heights[70, 70] += 300e-9
    clean, (level_report, despeckle_report) = images.prepare(topography(synthetic.tilted(heights, SIDE, SLOPE, 0.0)))
    assert despeckle_report.pixels == 1
    assert clean.masked_pixels == 1
    assert np.ptp(clean.heights) == pytest.approx(480e-9, rel=1e-6)
    assert "5 degrees" in str(level_report)
    assert "1 speckled" in str(despeckle_report)
    assert ridge.any()


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_what_lasts_along_y_stays_where_taking_it_out_makes_the_image_rougher() -> None:
    """A third of the rows has hardly a pixel, and those are wrong: `lines` would add a drift of 128 nm rms to 35."""
    rng = np.random.default_rng(0)
    heights = rng.normal(0.0, 1e-9, (150, 120))
    missing = np.zeros(heights.shape, bool)
    missing[100:] = True
    lone = (rng.uniform(size=heights.shape) < 0.03) & missing
    heights[lone] += rng.uniform(0.0, 5e-7, int(lone.sum()))
    image = images.Topography(heights, (1e-8, 1e-8), mask=missing & ~lone)
    levelled, report = images.level(image)
    assert report.candidates[0].method == "plane+rows"
    assert report.candidates[1].rms > 3.0 * report.candidates[0].rms
    assert np.std(levelled.heights[:100]) < 5e-9


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize("shape", [(4, 4), (4, 16), (4, 300), (5, 5), (16, 4)])
def test_the_smallest_images_are_levelled(shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(3)
    for noise in (0.0, 1e-9, 1e-9, 1e-9):
        heights = noise * rng.standard_normal(shape) + 2e-9 * np.arange(shape[1])
        levelled, _ = images.prepare(images.Topography(heights, (1e-9, 1e-9)))
        assert np.ptp(levelled.heights) <= np.ptp(heights)
