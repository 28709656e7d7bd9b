# SPDX-License-Identifier: BSD-3-Clause
"""From an image to the touchable surface without copies that are not needed."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
from nanotouch import Surface, Topography, _core


def rough(n: int) -> Topography:
    return Topography(1e-9 * np.random.default_rng(1).random((n, n)), (1e-9, 1e-9))


def test_coefficients_take_the_memory_of_the_heights_where_allowed() -> None:
    heights = 1e-9 * np.random.default_rng(2).random((40, 50))
    before = heights.copy()
    kept = _core.Surface(heights, 1e-9, 1e-9)
    np.testing.assert_array_equal(heights, before)
    taken = _core.Surface(heights, 1e-9, 1e-9, overwrite=True)
    assert not np.array_equal(heights, before)
    x, y = np.random.default_rng(3).uniform(0, 39e-9, (2, 100))
    np.testing.assert_array_equal(taken.heights(x, y), kept.heights(x, y))
    heights *= 2.0  # the very buffer that the surface reads
    np.testing.assert_allclose(taken.heights(x, y), 2.0 * kept.heights(x, y), rtol=1e-12)
    before.flags.writeable = False
    with pytest.raises(ValueError, match="not writeable"):
        _core.Surface(before, 1e-9, 1e-9, overwrite=True)


@pytest.mark.parametrize(("tip_radius", "peak"), [(None, 1), (10e-9, 2)])
def test_memory_of_a_surface(tip_radius: float | None, peak: int) -> None:
    """It keeps one array of the image's size; dilation needs a second one meanwhile. The image is not touched."""
    topography = rough(512)
    size = topography.heights.nbytes
    tracemalloc.start()
    surface = Surface(topography, tip_radius)
    kept, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    # 513 x 513 in place of 512 x 512, and small change
    assert kept == pytest.approx(size, rel=0.02)
    assert most == pytest.approx(peak * size, rel=0.02)
    assert np.shares_memory(surface.topography.heights, topography.heights)


def test_a_topography_shares_the_array_it_is_made_from() -> None:
    heights = np.zeros((64, 64))
    assert np.shares_memory(Topography(heights, (1e-9, 1e-9)).heights, heights)
