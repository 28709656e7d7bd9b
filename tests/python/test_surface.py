# SPDX-License-Identifier: BSD-3-Clause
"""The touchable surface: passes through its pixels, C2, dilated by the tip, the right way up; built-in samples."""

from __future__ import annotations

import math
import pickle
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import Surface, Topography, surface
from nanotouch.errors import InvalidValue
from nanotouch.images.checks import unusual


def bumpy(shape: tuple[int, int] = (12, 17), pixel: tuple[float, float] = (2e-9, 3e-9)) -> Topography:
    heights = 1e-9 * np.random.default_rng(3).standard_normal(shape)
    return Topography(heights=heights, pixel_size=pixel)


def test_passes_through_the_pixels_the_right_way_up() -> None:
    """heights[j, i] lies at x = i dx, y = j dy; asymmetric in everything."""
    topography = bumpy()
    made = Surface(topography)
    j, i = np.indices(topography.shape)
    # the spline is solved to rounding
    np.testing.assert_allclose(made.height(i * 3e-9, j * 2e-9), topography.heights, rtol=0, atol=1e-21)


def test_size_is_the_scan_size_and_all_of_it_can_be_touched() -> None:
    made = Surface(bumpy())
    assert made.size == (17 * 3e-9, 12 * 2e-9)
    nt.Session(surface=made, path=[made.size], clearance=20e-9)
    nt.Session(surface=made, path=[(0.0, 0.0)], clearance=20e-9)


def test_an_array_is_a_surface_too() -> None:
    topography = bumpy()
    for made in (Surface(topography.heights, pixel_size=(2e-9, 3e-9)),
                 Surface(topography.heights.tolist(), pixel_size=np.array([2e-9, 3e-9])),  # type: ignore[arg-type]
                 pickle.loads(pickle.dumps(Surface(topography.heights, pixel_size=(2e-9, 3e-9))))):  # fmt: skip
        assert made.height(7e-9, 5e-9) == Surface(topography).height(7e-9, 5e-9)
    square = Surface(topography.heights, 20e-9, pixel_size=1e-9)
    assert square.size == pytest.approx((17e-9, 12e-9))
    assert repr(square).startswith("Surface(17 x 12 pixels, 17 nm x 12 nm, heights over ")
    assert repr(square).endswith("dilated by a tip of 20 nm)")
    of_scene = Surface.touched_by(nt.Scene(), topography.heights, pixel_size=1e-9)
    assert of_scene.height(3e-9, 4e-9) == Surface(topography.heights, 20e-9, pixel_size=1e-9).height(3e-9, 4e-9)
    nt.Session(surface=of_scene, clearance=20e-9)


def test_an_array_needs_its_pixel_size() -> None:
    heights = bumpy().heights
    for wrong, words in (
        (lambda: Surface(heights), "an array of heights .* needs the size of its pixels"),
        (lambda: Surface(bumpy(), pixel_size=1e-9), "a Topography has its own"),
        (lambda: Surface(heights, pixel_size=(1e-9, 1e-9, 1e-9)), "one length .* or two"),  # type: ignore[arg-type]
        (lambda: Surface(heights, pixel_size=-1e-9), "expected two positive lengths"),
        (lambda: Surface(heights[0], pixel_size=1e-9), "expected two dimensions"),
    ):  # fmt: skip
        with pytest.raises(InvalidValue, match=words):
            wrong()


def test_broadcasts() -> None:
    made = Surface(bumpy())
    x, y = np.linspace(0, 4e-8, 5), np.linspace(0, 2e-8, 4)
    grid = made.height(x, y[:, None])
    assert grid.shape == (4, 5)
    assert grid[3, 2] == made.height(x[2], y[3])
    assert type(made.height(1e-9, 1e-9)) is float
    assert made.height(np.empty(0), 1e-9).shape == (0,)
    with pytest.raises(ValueError, match="broadcast"):
        made.height(np.zeros(2), np.zeros(3))


def test_is_smooth() -> None:
    """C2: second differences on a fine line have no steps, only the cubic's own slope."""
    made = Surface(bumpy())
    x = np.linspace(5e-9, 40e-9, 20001)
    second = np.diff(made.height(x, 1.1e-8), 2) / (x[1] - x[0]) ** 2
    assert np.abs(np.diff(second)).max() < 2e-3 * np.ptp(second)


def test_dilation_against_brute_force() -> None:
    """max over pixels of height minus tip, a sphere that runs into a cone; where the body is smooth the peak of a
    parabola through it, here at most a quarter of the noise's second differences (4 x 4 nm) higher."""
    radius, angle = 4e-9, 0.4
    topography = bumpy()
    dilated = Surface(topography, radius, angle)
    j, i = np.indices(topography.shape)
    padded = np.pad(topography.heights, ((0, 1), (0, 1)), mode="edge")
    pj, pi = np.indices(padded.shape)
    expected = np.empty(topography.shape)
    for row, column in np.ndindex(*topography.shape):
        r = np.hypot((pi - column) * 3e-9, (pj - row) * 2e-9)
        edge = radius * math.cos(angle)
        sphere = radius - np.sqrt(np.maximum(radius**2 - r**2, 0.0))
        cone = radius * (1 - math.sin(angle)) + (r - edge) / math.tan(angle)
        expected[row, column] = (padded - np.where(r <= edge, sphere, cone)).max()
    above = dilated.height(i * 3e-9, j * 2e-9) - expected
    assert (above > -1e-20).all()
    assert above.max() < 4e-9
    assert np.mean(above < 1e-20) > 0.2
    assert (expected >= topography.heights).all()


def cap(radius: float, pixels: int = 80, pixel: float = 1e-9) -> Topography:
    """A ball's upper side around the middle; a bowl for radius < 0."""
    x = (np.arange(pixels) - pixels // 2) * pixel
    r2 = np.minimum(x**2 + x[:, None] ** 2, (0.7 * radius) ** 2)
    return Topography(heights=math.copysign(1.0, radius) * np.sqrt(radius**2 - r2), pixel_size=(pixel, pixel))


@pytest.mark.parametrize("body", [60e-9, -80e-9])
def test_radius_map(body: float) -> None:
    """Sphere on sphere, sphere in a bowl: 1/R_eff = 1/R + 1/R_body, to the 1 % that pixels leave."""
    made = Surface(cap(body), tip_radius=20e-9)
    x = np.linspace(30e-9, 50e-9, 41)
    found = made.radius_map.radius(x, x[:, None])
    np.testing.assert_allclose(found.radius, 1 / (1 / 20e-9 + 1 / body), rtol=0.01)
    low, high = made.radius_map.bounds
    assert 2e-9 * (1 - 1e-15) <= low <= found.radius.min() <= found.radius.max() <= high <= 200e-9 * (1 + 1e-15)
    step = 1e-13
    slope = (made.radius_map.radius(x + step, 41e-9).radius - made.radius_map.radius(x - step, 41e-9).radius) / 2 / step
    np.testing.assert_allclose(made.radius_map.radius(x, 41e-9).dx, slope, atol=1e-5)
    assert made.radius_map is made.radius_map
    assert surface.RadiusMap(made, 0.99, 1.01).limited > made.radius_map.limited


def test_radius_map_of_a_flat_is_the_tip() -> None:
    made = Surface(surface.flat(), tip_radius=20e-9).radius_map
    assert made.radius(1e-6, 2e-6) == pytest.approx((20e-9, 0.0, 0.0), rel=1e-14, abs=1e-16)
    assert made.limited == 0


def test_grating() -> None:
    made = surface.grating()
    assert made.shape == (512, 512)
    assert made.size == pytest.approx((6e-6, 6e-6), rel=1e-15)
    assert made.name == "grating"
    assert set(np.unique(made.heights)) == {0.0, 480e-9}
    assert (made.heights == made.heights[0]).all()  # lines along y
    x = np.arange(512) * 6e-6 / 512
    np.testing.assert_array_equal(made.heights[0] > 0, (x - 0.75e-6) % 3e-6 < 1.5e-6)


def test_dots() -> None:
    made = surface.dots()
    assert made.heights.min() == 0.0
    assert 10e-9 / 3 * 0.9 < made.heights.max() <= 10e-9  # caps a third as high as they are wide
    np.testing.assert_array_equal(made.heights, surface.dots().heights)
    assert (made.heights != surface.dots(seed=2).heights).any()


def test_spikes_are_an_array_that_our_own_reader_accepts() -> None:
    found = nt.surface.spikes()
    assert found.size == pytest.approx((6e-6, 6e-6))
    assert found.height_range == pytest.approx(300e-9, rel=0.02)
    low = found.heights < 0.5 * found.height_range
    edges = np.abs(np.diff(low[low.shape[0] // 2].astype(int))).sum()
    assert edges == 6  # three in a row
    assert unusual(found) == ()


def test_flat() -> None:
    assert not surface.flat().heights.any()
    assert Surface(surface.flat(), 20e-9).height(1e-6, 2e-6) == 0.0


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: surface.grating(size=0.0), "size = 0 m"),
        (lambda: surface.grating(size=math.nan), "size = nan m"),
        (lambda: surface.grating(pixels=2), "pixels = 2: valid is 4"),
        (lambda: surface.dots(pixels=10**6), "pixels = 1000000"),
        (lambda: surface.grating(period=-1.0), "period = -1 m"),
        (lambda: surface.grating(duty=2.0), "duty = 2"),
        (lambda: surface.grating(height=math.inf), "height = inf m"),
        (lambda: surface.flat(pixels=0), "pixels = 0"),
        (lambda: surface.dots(count=0), "quantum dots"),
        (lambda: Surface(bumpy()).radius_map, "tip_radius"),
        (lambda: surface.RadiusMap(Surface(bumpy(), 5e-9), minimum=0.0), "radius map"),
        (lambda: Surface(bumpy(), tip_radius=0.0), "radius|tip dilation"),
        (lambda: Surface(bumpy(), tip_radius=1e-9, tip_half_angle=2.0), "half_angle|tip dilation"),
    ],
)
def test_bad_values_are_refused(call: Any, words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        call()


def test_dots_that_do_not_fit() -> None:
    with pytest.raises(nt.Error, match="quantum dots"):
        surface.dots(size=60e-9, count=60)
