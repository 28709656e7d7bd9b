# SPDX-License-Identifier: BSD-3-Clause
"""Scars go, structures along the fast axis stay."""

from __future__ import annotations

import numpy as np
import pytest
import synthetic

pytest.importorskip("cv2")

from nanotouch import images, surface

SIDE, NOISE = 10e-6, 0.3e-9


def topography(heights: synthetic.Array) -> images.Topography:
    return images.Topography(heights, (SIDE / heights.shape[0], SIDE / heights.shape[1]))


def noisy(heights: synthetic.Array, seed: int = 1) -> synthetic.Array:
    return np.asarray(heights + NOISE * np.random.default_rng(seed).standard_normal(heights.shape))


@pytest.mark.parametrize("along_y", [True, False], ids=["lines along y", "lines along the fast axis"])
def test_scars_on_a_tilted_grating_are_repaired_and_its_step_is_kept(along_y: bool) -> None:
    heights, ridge = synthetic.grating(along_y=along_y)
    clean = synthetic.tilted(heights, SIDE, 0.01, -0.02)
    measured = noisy(clean)
    scarred = measured.copy()
    scars = [(slice(30, 31), slice(30, 70), 20e-9), (slice(65, 67), slice(0, 50), -15e-9)]
    scars += [(slice(106, 109), slice(90, 128), 400e-9), (slice(75, 76), slice(5, 120), 5e-9)]
    marked = np.zeros(heights.shape, bool)
    for rows, columns, height in scars:
        assert (ridge[rows.start - 1 : rows.stop + 1, columns].std(axis=0) == 0).all()  # not on an edge of the grating
        scarred[rows, columns] += height
        marked[rows, columns] = True
    repaired, report = images.repair_scars(topography(scarred))
    assert report.scars == len(scars)
    assert report.largest == pytest.approx(400e-9, abs=6 * NOISE + 1.5e-9)
    assert report.lines == 0
    assert (repaired.mask & ~marked).sum() <= 4  # noise beside a scar's end may be bridged to it
    assert (marked & ~repaired.mask).sum() <= 4
    np.testing.assert_array_equal(repaired.heights[~repaired.mask], scarred[~repaired.mask])  # not even rounded
    # between two rows of noise: five standard deviations of the mean and of the pixel beneath
    assert np.abs(repaired.heights - clean)[repaired.mask].max() < 6 * NOISE
    flat = images.level(repaired, "plane")[0].heights
    assert np.median(flat[ridge]) - np.median(flat[~ridge]) == pytest.approx(480e-9, rel=1e-3)


@pytest.mark.parametrize("along_y", [True, False])
def test_structures_without_scars_are_left_to_the_last_bit(along_y: bool) -> None:
    samples = [synthetic.grating(along_y=along_y)[0], surface.dots(500e-9, 256).heights]
    for heights in samples:
        for seed in range(3):
            before = topography(noisy(heights, seed))
            after, report = images.repair_scars(before)
            assert report.pixels == 0
            np.testing.assert_array_equal(after.heights, before.heights)
    assert images.repair_scars(topography(np.zeros((16, 64))))[1].pixels == 0


def test_a_wire_along_the_fast_axis_is_a_structure() -> None:
    heights = np.zeros((128, 128))
    heights[50:53] = 30e-9
    before = topography(noisy(heights))
    with pytest.warns(UserWarning, match="1 line along the fast axis"):
        after, report = images.repair_scars(before)
    np.testing.assert_array_equal(after.heights, before.heights)
    assert (report.lines, report.scars) == (1, 0)


def test_a_texture_of_streaks_is_refused() -> None:
    heights = np.zeros((128, 128))
    heights[2:-2:6, 20:100] = 30e-9
    before = topography(noisy(heights))
    with pytest.warns(UserWarning, match="taken for its texture"):
        after, report = images.repair_scars(before)
    assert report.refused
    np.testing.assert_array_equal(after.heights, before.heights)


def test_short_streaks_are_particles() -> None:
    heights = np.zeros((64, 64))
    heights[30:32, 20:30] = 20e-9
    assert images.repair_scars(topography(noisy(heights)))[1].pixels == 0
