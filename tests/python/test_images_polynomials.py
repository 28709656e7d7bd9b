# SPDX-License-Identifier: BSD-3-Clause
"""Bows, terraces and what holds for every method of levelling."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
import synthetic
from hypothesis import given, settings
from hypothesis import strategies as st

cv2 = pytest.importorskip("cv2")

from nanotouch import images  # noqa: E402

SIDE = 10e-6
METHODS = ("plane", "poly2", "poly3", "rows", "plane+rows", "poly2+rows", "terraces", "plane+medians")


def topography(heights: synthetic.Array, mask: np.ndarray | None = None) -> images.Topography:
    pixel = (SIDE / heights.shape[0], SIDE / heights.shape[1])
    return images.Topography(heights, pixel, mask=np.zeros(heights.shape, bool) if mask is None else mask)


def level(
    image: images.Topography, method: str, mask: np.ndarray | None = None
) -> tuple[synthetic.Array, images.LevelReport]:
    """Without the warnings, which the properties do not ask for."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        levelled, report = images.level(image, method, mask)
    return levelled.heights, report


def coordinates(shape: tuple[int, int]) -> tuple[synthetic.Array, synthetic.Array]:
    return np.linspace(-1, 1, shape[0])[:, None], np.linspace(-1, 1, shape[1])


@pytest.mark.parametrize("along_y", [True, False])
def test_a_bow_goes_from_under_a_grating_and_its_step_stays(along_y: bool) -> None:
    """60 nm of bow under 480 nm; a plain least-squares parabola would follow the ridges."""
    heights, ridge = synthetic.grating(256, duty=0.3, along_y=along_y)
    y, x = coordinates(heights.shape)
    bow = 60e-9 * (x**2 - 0.5 * y**2 + 0.3 * x * y) + 2e-7 * y
    levelled, report = level(topography(heights + bow), "poly2")
    np.testing.assert_allclose(levelled - levelled.mean(), heights - heights.mean(), rtol=0, atol=1e-12)
    assert "a bow of" in report.steps[0].note
    assert report.warnings == ()
    plain = np.polynomial.legendre.legfit(np.linspace(-1, 1, 256), (heights + bow).mean(axis=0 if along_y else 1), 2)
    assert abs(plain[2]) > 10e-9  # against 40 or 20 nm of the bow itself: the test can fail
    assert ridge.any()


def test_the_verdict_on_polynomials() -> None:
    """A bow turns once and goes quietly, whatever the order; a wave turns more often, and its loss is told."""
    rng = np.random.default_rng(3)
    noise = rng.standard_normal((128, 128)) * 1e-9
    y, x = coordinates(noise.shape)
    for method in ("poly2", "poly3", "poly4", "poly6"):
        assert level(topography(noise + 50e-9 * (x**2 + y**2)), method)[1].warnings == ()
    wave = topography(noise + 30e-9 * np.sin(1.5 * np.pi * x) + 0 * y)
    with pytest.warns(UserWarning, match="poly6 removed a background that turns [2-4] times along x .* may have gone"):
        images.level(wave, "poly6")


def test_terraces_are_listed_from_the_largest() -> None:
    """Atomic steps of 3 nm on a slope: the heights come out, and height 0 is the widest."""
    rng = np.random.default_rng(4)
    step = np.searchsorted([30, 90, 200], np.arange(256)) * 3e-9
    noise = 0.2e-9 * rng.standard_normal((256, 256))
    slope = synthetic.tilted(np.broadcast_to(step, (256, 256)) + noise, SIDE, 1e-3, -2e-3)
    levelled, report = level(topography(slope), "terraces")
    # widths 30, 60, 110, 56; a mean over 7 000 pixels of 0.2 nm, and the edge pixels that count as steep
    assert [t.height for t in report.terraces] == pytest.approx([0.0, -3e-9, 3e-9, -6e-9], abs=0.02e-9)
    assert [t.share for t in report.terraces] == pytest.approx([110 / 256, 60 / 256, 56 / 256, 30 / 256], abs=0.02)
    assert sum(t.share for t in report.terraces) == pytest.approx(1.0)
    assert np.median(levelled[:, 100:190]) == pytest.approx(0.0, abs=0.02e-9)
    grating, _ = synthetic.grating(256, duty=0.3)
    found = level(topography(grating), "terraces")[1].terraces
    assert [(round(t.height * 1e9, 6), t.pieces) for t in found] == [(0.0, 4), (480.0, 4)]


@st.composite
def surfaces(draw: st.DrawFn) -> synthetic.Array:
    """Films, particles, steps and offsets of rows on small images of any shape."""
    shape = draw(st.tuples(st.integers(24, 80), st.integers(24, 80)))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    z = cv2.GaussianBlur(rng.standard_normal(shape), (0, 0), draw(st.sampled_from([0.5, 2.0, 6.0]))) * 3e-9
    z += draw(st.sampled_from([0.0, 1e-9, 5e-9])) * rng.standard_normal((shape[0], 1))
    z += draw(st.sampled_from([0.0, 100e-9])) * (np.arange(shape[0]) > shape[0] // 2)[:, None]
    z += draw(st.sampled_from([0.0, 100e-9])) * (np.arange(shape[1]) > shape[1] // 3)
    return np.asarray(z)


@settings(max_examples=25, deadline=None)
@given(surfaces(), st.sampled_from(METHODS), st.floats(-0.05, 0.05), st.floats(-0.05, 0.05))
def test_an_added_plane_changes_nothing(z: synthetic.Array, method: str, a: float, b: float) -> None:
    if "plane" not in method and "poly" not in method and method != "terraces":
        a = b = 0.0
    once, _ = level(topography(z), method)
    again, _ = level(topography(synthetic.tilted(z, SIDE, a, b) + 1e-6), method)
    # the fit stops at a hundredth of the noise of a difference, of nanometres here, or after six rounds
    np.testing.assert_allclose(again, once, rtol=0, atol=0.5e-9)


@settings(max_examples=25, deadline=None)
@given(surfaces(), st.sampled_from(METHODS))
def test_levelling_twice_is_levelling_once(z: synthetic.Array, method: str) -> None:
    once, first = level(topography(z), method)
    twice, _ = level(topography(once), method)
    rows = max((step.removed_range for step in first.steps if step.method in ("rows", "medians")), default=0.0)
    # a smoothing is no projection: on images of a few dozen rows a part of the offsets shows only the second time, and
    # rows that were shifted have another plane. Of the row beside a step across all rows all of it may: before, its
    # offset looks like a part of the step
    *others, most = np.sort(np.abs(twice - once).max(axis=1))
    assert max(others) <= 0.5e-9 + 0.3 * rows
    assert most <= 0.5e-9 + rows


@settings(max_examples=25, deadline=None)
@given(surfaces(), st.sampled_from(METHODS), st.integers(0, 2**32 - 1))
def test_what_is_masked_does_not_matter(z: synthetic.Array, method: str, seed: int) -> None:
    """To the last bit, whether masked by the call or by the image."""
    rng = np.random.default_rng(seed)
    mask = np.zeros(z.shape, bool)
    mask[5 : 5 + z.shape[0] // 4, 3 : 3 + z.shape[1] // 4] = True
    spoilt = np.where(mask, 1e-6 * rng.standard_normal(z.shape), z)
    want, _ = level(topography(np.where(mask, 0.0, z)), method, mask)
    for image, masked in ((topography(spoilt), mask), (topography(spoilt, mask), None)):
        got, _ = level(image, method, masked)
        np.testing.assert_allclose(got[~mask], want[~mask], rtol=0, atol=1e-20)
