# SPDX-License-Identifier: BSD-3-Clause
"""Roughness of surfaces whose roughness is known."""

from __future__ import annotations

import numpy as np
import pytest
from nanotouch import images
from nanotouch.errors import InvalidValue


def test_a_sine_has_the_roughness_of_a_sine() -> None:
    """Amplitude A: Sa = 2 A / pi, Sq = A / sqrt 2, b = 2 A; 1000 points a period give the mean |sin| to 4e-6."""
    wave = 5e-9 * np.sin(2 * np.pi * np.arange(1000) / 1000) * np.ones((8, 1)) + 3e-9
    found = images.roughness(images.Topography(wave, (1e-9, 1e-9)))
    assert found.arithmetic == pytest.approx(10e-9 / np.pi, rel=1e-5)
    assert found.rms == pytest.approx(5e-9 / np.sqrt(2), rel=1e-12)
    assert found.peak_to_peak == pytest.approx(10e-9, rel=1e-12)


def test_masked_pixels_do_not_count() -> None:
    heights = np.zeros((8, 8))
    heights[:4], heights[4:] = -1e-9, 1e-9
    spoilt, filled, left_out = heights.copy(), np.zeros((8, 8), bool), np.zeros((8, 8), bool)
    spoilt[0, 0], spoilt[7, 7] = 1e-6, -1e-6
    filled[0, 0] = left_out[7, 7] = True
    topography = images.Topography(spoilt, (1e-9, 1e-9), mask=filled)
    found = images.roughness(topography, left_out)
    assert (found.arithmetic, found.rms, found.peak_to_peak) == pytest.approx((1e-9, 1e-9, 2e-9), rel=1e-12)
    assert images.roughness(topography).peak_to_peak > 1e-6
    with pytest.raises(InvalidValue, match="leaves 0 pixels"):
        images.roughness(topography, np.ones((8, 8), bool))
    with pytest.raises(InvalidValue, match="shape"):
        images.roughness(topography, np.ones((2, 2), bool))
