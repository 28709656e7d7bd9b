# SPDX-License-Identifier: BSD-3-Clause
"""Fig. 15 of ``nanotouch reproduce``: its image against the surface that was scanned."""

from __future__ import annotations

import math

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from nanotouch_app.studies.reproduce import figure15


def test_fig_15_images_the_array() -> None:
    """Beside the surface that was scanned, and the width of a cone at half its height, h tan(half angle), with the
    tip's radius at either side."""
    made, ground = figure15.image(), figure15.array()
    height, pitch, force = figure15.reproduce().statements
    heights = np.asarray(made.trace.height)
    assert height.number == pytest.approx(ground.height_range, rel=0.02)
    assert pitch.number == pytest.approx(figure15.PITCH.value, rel=0.03)
    assert 0.0 < force.number < 4e-7  # the scene's max load
    high = heights - heights.min() > 0.5 * ground.height_range
    width = 0.5 * figure15.HEIGHT.value * 2.0 * math.tan(0.5 * figure15.ANGLE.value)
    pixels = 9 * math.pi * np.array([0.5 * width, 0.5 * width + 20e-9]) ** 2 / np.prod(made.pixel_size)
    assert 0.8 * pixels[0] < high.sum() < 1.2 * pixels[1]
