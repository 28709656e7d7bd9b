# SPDX-License-Identifier: BSD-3-Clause
"""Blind reconstruction never makes the tip sharper than it is, and finds it where the surface is sharp enough."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic

ndimage = pytest.importorskip("scipy.ndimage")
pytest.importorskip("cv2")

from nanotouch import images  # noqa: E402
from nanotouch.errors import InvalidValue  # noqa: E402

PIXEL = (1e-9, 1.5e-9)


def lopsided(half: int = 6) -> synthetic.Array:
    """A tip of R = 8 nm that leans to one side, so that no flip or turn leaves it alone."""
    y, x = (np.arange(-half, half + 1) * d for d in PIXEL)
    tip = (y[:, None] ** 2 + x**2) / 16e-9
    return np.asarray(tip + 0.3 * np.maximum(x, 0) + 0.15 * np.maximum(-y[:, None], 0))


def film(seed: int, correlation: float = 2.0, height: float = 30e-9) -> images.Topography:
    noise = np.random.default_rng(seed).standard_normal((96, 110))
    return images.Topography(ndimage.gaussian_filter(noise, correlation) * height, PIXEL)


def spikes(seed: int) -> images.Topography:
    heights = np.zeros((96, 110))
    rng = np.random.default_rng(seed)
    heights[rng.integers(15, 80, 8), rng.integers(15, 95, 8)] = 60e-9
    return images.Topography(heights, PIXEL)


def test_spikes_show_the_tip_itself() -> None:
    estimate = images.estimate_tip(images.dilate(spikes(1), lopsided()), 13, 0.0)
    np.testing.assert_allclose(estimate.heights, lopsided(), rtol=0, atol=1e-18)  # a part in 1e10 of the heights
    assert estimate.converged


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("correlation", [0.7, 2.0, 4.0])
def test_the_estimate_is_nowhere_sharper_than_the_tip(seed: int, correlation: float) -> None:
    """On films whose features are smaller than the tip, as large, and larger: the sharper, the closer."""
    tip = lopsided()
    estimate = images.estimate_tip(images.dilate(film(seed, correlation), tip), 13, 0.0)
    assert (estimate.heights <= tip + 1e-20).all()
    assert estimate.heights[6, 6] == 0.0
    near = tip < 3e-9
    missing = float((tip - estimate.heights)[near].max())
    assert missing < (0.6e-9 if correlation < 1 else 3e-9)
    assert estimate.heights.max() > 0.0


@pytest.mark.parametrize("seed", range(3))
def test_noise_below_the_threshold_does_not_sharpen_it(seed: int) -> None:
    """Noise of 0.1 nm: with the default threshold never too sharp; without one it would be, so the test can fail."""
    tip, rng = lopsided(), np.random.default_rng(seed)
    image = images.dilate(film(seed, 1.0), tip)
    noisy = images.Topography(image.heights + 0.1e-9 * rng.standard_normal(image.shape), PIXEL)
    estimate = images.estimate_tip(noisy, 13)
    # the default is seven sigma of the noise, which is overestimated where the film is rough
    assert 0.6e-9 < estimate.threshold < 3e-9
    assert (estimate.heights <= tip + 1e-20).all()
    assert (images.estimate_tip(noisy, 13, 0.0).heights > tip + 0.05e-9).any()


def test_the_estimate_explains_the_whole_image() -> None:
    """The surface it leaves lies below that of the true tip, and imaged with it gives the image back."""
    surface = film(5, 1.0)
    image = images.dilate(surface, lopsided())
    estimate = images.estimate_tip(image, 13, 0.0)
    restored, _ = images.erode(image, estimate.heights)
    best = images.erode(image, lopsided())[0].heights
    assert (restored.heights <= best + 1e-20).all()
    inner = np.s_[12:-12, 12:-12]  # what lies outside may have been touched from near the border
    again = images.dilate(restored, estimate.heights).heights
    np.testing.assert_allclose(again[inner], image.heights[inner], rtol=0, atol=1e-18)
    assert (best - restored.heights).mean() < 0.1 * (image.heights - best).mean()


def test_filled_pixels_say_nothing() -> None:
    image = images.dilate(film(6, 1.0), lopsided())
    heights, mask = image.heights.copy(), np.zeros(image.shape, bool)
    heights[40, 50], mask[40, 50] = image.heights.max() + 50e-9, True  # a spike of one pixel would be a perfect tip
    estimate = images.estimate_tip(images.Topography(heights, PIXEL, mask=mask), 13, 0.0)
    assert (estimate.heights <= lopsided() + 1e-20).all()


def test_radius_and_wrong_arguments() -> None:
    y, x = (np.arange(-6, 7) * d for d in PIXEL)
    paraboloid = (y[:, None] ** 2 + x**2) / 20e-9
    image = images.dilate(spikes(2), paraboloid)
    estimate = images.estimate_tip(image, 13, 0.0)
    assert estimate.radius(2e-9) == pytest.approx(10e-9, rel=1e-6)
    with pytest.raises(InvalidValue, match="height"):
        estimate.radius(1e-12)
    for size in (4, 1, 55, 103):
        with pytest.raises(InvalidValue, match="size"):
            images.estimate_tip(image, size)
    with pytest.raises(InvalidValue, match="threshold"):
        images.estimate_tip(image, 13, -1e-9)
    flat = images.estimate_tip(images.Topography(np.zeros((32, 32)), PIXEL), 5)
    assert flat.converged
    assert not flat.heights.any()
