# SPDX-License-Identifier: BSD-3-Clause
"""Filters that leave out what was not measured, and the halvings for the view."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic
from hypothesis import given, settings
from hypothesis import strategies as st

pytest.importorskip("cv2")
ndimage = pytest.importorskip("scipy.ndimage")

from nanotouch import images  # noqa: E402
from nanotouch.errors import InvalidValue  # noqa: E402

PIXEL = (2e-9, 3e-9)


def rough(shape: tuple[int, int] = (40, 50), seed: int = 1, holes: float = 0.0) -> images.Topography:
    """With wild values where masked, which must not matter."""
    rng = np.random.default_rng(seed)
    mask = rng.random(shape) < holes
    heights = 1e-9 * rng.standard_normal(shape)
    return images.Topography(np.where(mask, 1e-6, heights), PIXEL, mask=mask)


def by_definition(image: images.Topography, sigma: float) -> synthetic.Array:
    """Weighted means over the measured pixels, one by one."""
    y, x = (np.arange(n) * d for n, d in zip(image.shape, PIXEL, strict=True))
    wy, wx = (np.exp(-0.5 * ((a[:, None] - a) / sigma) ** 2) for a in (y, x))
    for w, d, n in ((wy, PIXEL[0], image.shape[0]), (wx, PIXEL[1], image.shape[1])):
        w[np.abs(np.subtract.outer(np.arange(n), np.arange(n))) > np.ceil(4 * sigma / d)] = 0.0
    measured = (~image.mask).astype(float)
    return np.asarray((wy @ (image.heights * measured) @ wx) / (wy @ measured @ wx))


@pytest.mark.parametrize("holes", [0.0, 0.2])
def test_gaussian_by_its_definition(holes: float) -> None:
    image = rough(holes=holes)
    smooth = images.gaussian(image, 5e-9)
    np.testing.assert_allclose(smooth.heights, by_definition(image, 5e-9), rtol=0, atol=1e-18)
    np.testing.assert_array_equal(smooth.mask, image.mask)
    level = images.Topography(np.full((20, 30), 3e-9), PIXEL)
    np.testing.assert_allclose(images.gaussian(level, 20e-9).heights, 3e-9, rtol=1e-12)  # at the border too
    with pytest.raises(InvalidValue, match="sigma"):
        images.gaussian(image, 0.0)


@pytest.mark.parametrize("holes", [0.0, 0.2, 0.7])
@pytest.mark.parametrize("size", [3, 5])
def test_median_by_its_definition(holes: float, size: int) -> None:
    image = rough(holes=holes)
    got = images.median(image, size)
    values = np.pad(np.where(image.mask, np.nan, image.heights), size // 2, constant_values=np.nan)
    for j, i in np.ndindex(image.shape):
        window = values[j : j + size, i : i + size]
        want = image.heights[j, i] if np.isnan(window).all() else np.nanmedian(window)
        assert got.heights[j, i] == want
    for wrong in (2, 1, 33):
        with pytest.raises(InvalidValue, match="size"):
            images.median(image, wrong)


@settings(max_examples=30, deadline=None)
@given(st.integers(4, 70), st.integers(4, 70), st.sampled_from([0.0, 0.1, 0.6]), st.integers(0, 99))
def test_every_mip_level_by_its_definition(ny: int, nx: int, holes: float, seed: int) -> None:
    """Each pixel of each level from the pixels of the image that it stands for."""
    image = rough((ny, nx), seed, holes)
    levels = images.mip_levels(image, smallest=2)
    assert levels[0].mean is image.heights
    for level in levels:
        side = 2**level.level
        assert level.pixel_size == (PIXEL[0] * side, PIXEL[1] * side)
        assert level.mean.shape == (-(-ny // side), -(-nx // side))
        for j, i in np.ndindex(level.mean.shape):
            block = np.s_[j * side : (j + 1) * side, i * side : (i + 1) * side]
            measured = image.heights[block][~image.mask[block]]
            assert level.mask[j, i] == (measured.size == 0)
            if measured.size:
                assert level.mean[j, i] == pytest.approx(measured.mean(), abs=1e-20)
                assert level.highest[j, i] == measured.max()
    assert min(-(-n // (2 * 2 ** levels[-1].level)) for n in (ny, nx)) < 2


def test_mip_levels_of_the_usual_size() -> None:
    image = rough((256, 512))
    levels = images.mip_levels(image)
    assert [level.mean.shape for level in levels] == [(256 >> k, 512 >> k) for k in range(7)]
    np.testing.assert_allclose([level.mean.mean() for level in levels], image.heights.mean(), rtol=0, atol=1e-22)
    assert all(level.highest.max() == image.heights.max() for level in levels)
    with pytest.raises(InvalidValue, match="smallest"):
        images.mip_levels(image, 0)
    shapes = [level.mean.shape for level in images.mip_levels(rough((4, 9)), 1)]
    assert shapes == [(4, 9), (2, 5), (1, 3), (1, 2), (1, 1)]


@pytest.mark.parametrize("masked", [True, False])
def test_missing_heights_are_filled_and_everything_works_on_them(masked: bool) -> None:
    """A third of a slope is missing, in one hole and scattered: filled smoothly, then levelled by what was measured."""
    rng = np.random.default_rng(4)
    slope = np.add.outer(2e-9 * np.arange(60), 1e-9 * np.arange(80))
    hole = rng.random(slope.shape) < 0.2
    hole[20:40, 30:60] = True
    given = np.ma.array(slope, mask=hole) if masked else np.where(hole, np.nan, slope)
    heights, mask = images.fill(given)
    np.testing.assert_array_equal(mask, hole)
    np.testing.assert_array_equal(heights[~hole], slope[~hole])
    assert slope.min() <= heights.min()
    assert heights.max() <= slope.max()
    levelled, report = images.level(images.Topography(heights, PIXEL, mask=mask), "plane")
    assert report.tilt == pytest.approx((1.0, 1e-9 / PIXEL[1]), rel=1e-9)
    assert np.abs(levelled.heights[~hole]).max() < 1e-18
    whole = slope.copy()
    assert np.shares_memory(images.fill(whole)[0], whole)
    for wrong in (np.full((5, 5), np.nan), np.zeros(5)):
        with pytest.raises(InvalidValue, match="finite height"):
            images.fill(wrong)
