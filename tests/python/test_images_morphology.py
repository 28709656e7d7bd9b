# SPDX-License-Identifier: BSD-3-Clause
"""What dilation and erosion do whatever the tip and the surface: the algebra of grey-scale morphology."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic
from hypothesis import given, settings
from hypothesis import strategies as st

ndimage = pytest.importorskip("scipy.ndimage")

from nanotouch import images  # noqa: E402

PIXEL = (2e-9, 3e-9)
ROUNDING = 1e-20  # of heights of 1e-7 m


@st.composite
def rasters(draw: st.DrawFn) -> synthetic.Array:
    """Any heights, with parts missing."""
    rng = np.random.default_rng(draw(st.integers(0, 999)))
    shape = 2 * draw(st.integers(0, 5)) + 1, 2 * draw(st.integers(0, 5)) + 1
    raster = 10e-9 * rng.random(shape)
    raster[rng.random(shape) < 0.1] = np.inf
    raster[shape[0] // 2, shape[1] // 2] = 0.0
    return np.asarray(raster)


radii = st.floats(1e-9, 100e-9)
paraboloids = radii.map(images.Paraboloid)
cones = st.builds(images.RoundedCone, radii, st.floats(0.1, 1.2))
tips = st.one_of(paraboloids, cones, rasters())


@st.composite
def surfaces(draw: st.DrawFn) -> images.Topography:
    shape = draw(st.integers(12, 40)), draw(st.integers(12, 40))
    rng = np.random.default_rng(draw(st.integers(0, 999)))
    smooth = ndimage.gaussian_filter(rng.standard_normal(shape), draw(st.sampled_from([0.0, 1.0, 4.0])))
    return images.Topography(30e-9 * np.asarray(smooth), PIXEL)


Tip = images.Paraboloid | images.RoundedCone | synthetic.Array


@settings(max_examples=60, deadline=None)
@given(surfaces(), tips)
def test_extensive_and_opening_twice_is_opening_once(surface: images.Topography, tip: Tip) -> None:
    dilated = images.dilate(surface, tip)
    assert (dilated.heights >= surface.heights).all()
    eroded = images.erode(surface, tip)[0]
    assert (eroded.heights <= surface.heights).all()
    closed = images.erode(dilated, tip)[0]  # what can be restored of the surface
    assert (closed.heights >= surface.heights - ROUNDING).all()
    again = images.erode(images.dilate(closed, tip), tip)[0]
    np.testing.assert_allclose(again.heights, closed.heights, rtol=0, atol=ROUNDING)
    opened = images.dilate(eroded, tip)  # what of an image this tip can have taken
    assert (opened.heights <= surface.heights + ROUNDING).all()
    twice = images.dilate(images.erode(opened, tip)[0], tip)
    np.testing.assert_allclose(twice.heights, opened.heights, rtol=0, atol=ROUNDING)


@settings(max_examples=40, deadline=None)
@given(surfaces(), tips, st.integers(0, 999), st.floats(-1e-6, 1e-6))
def test_monotone_and_equivariant(surface: images.Topography, tip: Tip, seed: int, lift: float) -> None:
    """A higher surface has a higher image; lifted, it has the same image lifted; turned round with the tip, too."""
    higher = surface.heights + 5e-9 * np.random.default_rng(seed).random(surface.shape)
    image = images.dilate(surface, tip)
    assert (images.dilate(images.Topography(higher, PIXEL), tip).heights >= image.heights).all()
    lifted = images.dilate(images.Topography(surface.heights + lift, PIXEL), tip)
    np.testing.assert_allclose(lifted.heights, image.heights + lift, rtol=0, atol=1e-20)
    turned = tip[::-1, ::-1] if isinstance(tip, np.ndarray) else tip
    round_ = images.dilate(images.Topography(surface.heights[::-1, ::-1], PIXEL), turned)
    np.testing.assert_allclose(round_.heights[::-1, ::-1], image.heights, rtol=0, atol=ROUNDING)


@settings(max_examples=40, deadline=None)
@given(surfaces(), radii, radii, rasters())
def test_a_blunter_tip_gives_a_higher_image(
    surface: images.Topography, one: float, other: float, raster: synthetic.Array
) -> None:
    blunt, sharp = (images.dilate(surface, images.Paraboloid(r)) for r in (max(one, other), min(one, other)))
    assert (blunt.heights >= sharp.heights - ROUNDING).all()
    assert (images.dilate(surface, 0.5 * raster).heights >= images.dilate(surface, raster).heights).all()


@settings(max_examples=40, deadline=None)
@given(surfaces(), rasters())
def test_raster_tips_against_scipy(surface: images.Topography, tip: synthetic.Array) -> None:
    """To the last bit: maxima of the same differences."""
    structure = -tip[::-1, ::-1]
    want = ndimage.grey_dilation(surface.heights, structure=structure, mode="constant", cval=-np.inf)
    np.testing.assert_array_equal(images.dilate(surface, tip).heights, want)
    want = ndimage.grey_erosion(surface.heights, structure=structure, mode="constant", cval=np.inf)
    np.testing.assert_array_equal(images.erode(surface, tip)[0].heights, want)
