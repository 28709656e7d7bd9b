# SPDX-License-Identifier: BSD-3-Clause
"""Dilation by the tip against scipy, erosion against the surface it came from."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic

ndimage = pytest.importorskip("scipy.ndimage")

from nanotouch import images, surface  # noqa: E402
from nanotouch.errors import InvalidValue  # noqa: E402

PIXEL = (2e-9, 3e-9)  # not square: an exchange of the axes shows


def rough(shape: tuple[int, int] = (70, 90), seed: int = 1) -> images.Topography:
    noise = np.random.default_rng(seed).standard_normal(shape)
    return images.Topography(ndimage.gaussian_filter(noise, 1.5) * 30e-9, PIXEL)


def parabola(radius: float, half: tuple[int, int]) -> synthetic.Array:
    y, x = (np.arange(-k, k + 1) * d for k, d in zip(half, PIXEL, strict=True))
    return np.asarray((y[:, None] ** 2 + x**2) / (2 * radius))


def lopsided() -> synthetic.Array:
    """A tip that no flip leaves alone, with a part missing."""
    y, x = np.mgrid[-4:5, -3:4]
    tip = 1e-9 * (0.3 * y**2 + 0.7 * x**2 + 0.9 * np.maximum(x, 0) + 0.5 * np.maximum(-y, 0))
    tip[0, 0] = np.inf
    return np.asarray(tip)


def by_definition(z: synthetic.Array, tip: synthetic.Array) -> synthetic.Array:
    """i(x) = max_p s(p) - t(p - x), pixel by pixel."""
    ky, kx = (n // 2 for n in tip.shape)
    padded = np.pad(z, ((ky, ky), (kx, kx)), constant_values=-np.inf)
    out = np.empty(z.shape)
    for j, i in np.ndindex(z.shape):
        out[j, i] = (padded[j : j + 2 * ky + 1, i : i + 2 * kx + 1] - tip).max()
    return out


@pytest.mark.parametrize("radius", [1e-9, 10e-9, 200e-9])
def test_the_separable_paraboloid_is_scipys_dilation(radius: float) -> None:
    """Over a window that holds the whole reach; R = 1 nm and 200 nm reach 3 and 60 pixels."""
    topography = rough()
    half = tuple(min(int(np.sqrt(2 * radius * topography.height_range) / d) + 2, 69) for d in PIXEL)
    want = ndimage.grey_dilation(
        topography.heights,
        structure=-parabola(radius, half),
        mode="constant",
        cval=-np.inf,  # type: ignore[arg-type]
    )
    # three roundings of some 100 nm
    np.testing.assert_allclose(images.dilate(topography, images.Paraboloid(radius)).heights, want, rtol=0, atol=1e-22)


def test_any_tip_against_the_definition() -> None:
    topography = rough()
    dilated = images.dilate(topography, lopsided())
    np.testing.assert_allclose(dilated.heights, by_definition(topography.heights, lopsided()), rtol=0, atol=1e-22)


def test_rounded_cone_against_its_own_raster_by_scipy() -> None:
    """The tip's profile from its definition: sphere up to R cos(psi), cone beyond."""
    topography, radius, psi = rough(), 8e-9, 0.35
    y, x = (np.arange(-k, k + 1) * d for k, d in zip((20, 15), PIXEL, strict=True))
    r = np.hypot(y[:, None], x)
    with np.errstate(invalid="ignore"):
        sphere = radius - np.sqrt(radius**2 - r**2)
    cone = radius * (1 - np.sin(psi)) + (r - radius * np.cos(psi)) / np.tan(psi)
    tip = np.where(r <= radius * np.cos(psi), sphere, cone)
    assert tip[0].min() > topography.height_range  # the window holds the whole reach
    assert tip[:, 0].min() > topography.height_range
    want, certain_want = images.erode(images.dilate(topography, tip), tip)
    got, certain = images.erode(
        images.dilate(topography, images.RoundedCone(radius, psi)), images.RoundedCone(radius, psi)
    )
    np.testing.assert_allclose(got.heights, want.heights, rtol=0, atol=1e-21)
    np.testing.assert_array_equal(certain, certain_want)


TIPS = [images.Paraboloid(5e-9), images.RoundedCone(4e-9, 0.3), lopsided()]


@pytest.mark.parametrize("tip", TIPS, ids=["paraboloid", "cone", "any"])
@pytest.mark.parametrize("seed", [1, 2])
def test_erosion_is_above_the_surface_and_equal_where_certain(tip: object, seed: int) -> None:
    topography = rough(seed=seed)
    eroded, certain = images.erode(images.dilate(topography, tip), tip)  # type: ignore[arg-type]
    excess = eroded.heights - topography.heights
    assert excess.min() > -1e-21  # rounding of 1e-7 m
    assert np.abs(excess[certain]).max() < 1e-21
    same = np.abs(excess) < 1e-21
    assert 0.1 < certain.mean() <= same.mean()
    assert excess.max() > 1e-9  # something was lost: the test can fail


def test_certain_by_its_definition() -> None:
    """Apex by apex: one touch and no more, none possible beyond the border below the highest pixel."""
    tip = lopsided()
    image = images.dilate(rough((40, 45)), tip)
    eroded, certain = images.erode(image, tip)
    padded = np.pad(eroded.heights, ((4, 4), (3, 3)), constant_values=eroded.heights.max())
    want = np.zeros(padded.shape, bool)
    for j, i in np.ndindex(image.shape):
        touched = np.argwhere(padded[j : j + 9, i : i + 7] >= image.heights[j, i] + tip - 1e-20)
        if len(touched) == 1:
            want[j + touched[0, 0], i + touched[0, 1]] = True
    np.testing.assert_array_equal(certain, want[4:-4, 3:-3])


def test_certain_does_not_trust_the_border() -> None:
    """A pit beside the border: from inside the tip may rest on something beyond it."""
    heights = np.zeros((40, 40))
    heights[20, 20] = 50e-9
    topography = images.Topography(heights, PIXEL)
    _, certain = images.erode(images.dilate(topography, images.Paraboloid(20e-9)), images.Paraboloid(20e-9))
    assert certain[20, 20]
    assert not certain[0].any()


def test_masked_pixels_are_never_certain() -> None:
    mask = np.zeros((32, 32), bool)
    mask[10, 10] = True
    flat = images.Topography(np.zeros((32, 32)), PIXEL, mask=mask)
    _, certain = images.erode(flat, images.Paraboloid(5e-9))
    np.testing.assert_array_equal(certain, ~mask)


def test_dots_get_broader_by_the_tip_and_keep_their_height() -> None:
    dots = surface.dots(200e-9, 128)
    dilated = images.dilate(dots, images.RoundedCone(10e-9, 0.3))
    assert dilated.heights.max() == dots.heights.max()
    assert (dilated.heights > 1e-9).sum() > 1.3 * (dots.heights > 1e-9).sum()


@pytest.mark.parametrize("tip", [np.zeros((2, 3)), np.ones((3, 3)), -np.eye(3)[::-1] + np.diag([0, 1, 0]), np.zeros(3)])
def test_wrong_tips_are_refused(tip: synthetic.Array) -> None:
    with pytest.raises(InvalidValue, match="tip"):
        images.dilate(rough(), tip)
    with pytest.raises(InvalidValue, match="radius"):
        images.Paraboloid(0.0)
    with pytest.raises(InvalidValue, match="half_angle"):
        images.RoundedCone(1e-9, 2.0)
