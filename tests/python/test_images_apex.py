# SPDX-License-Identifier: BSD-3-Clause
"""The radius of tip and spike together, from images of the tip characteriser: within its interval, and within 10 %."""

from __future__ import annotations

from dataclasses import replace

import nanotouch as nt
import numpy as np
import pytest

pytest.importorskip("scipy.optimize")
pytest.importorskip("cv2")

from nanotouch import images
from nanotouch.errors import InvalidValue

SPIKE = 8e-9


def test_a_scanned_spike_tells_its_radius_and_the_tips() -> None:
    """20 scans in contact mode with noise of the loop's reading and 0.05 nm of the height, each with its own place of
    the spike between the pixels. Spheres add: R + R_s."""
    scene = nt.Scene(tip={"radius": 10e-9}, medium={"relative_humidity": 0.0})
    plan = scene.plan(0.3, surface=nt.Surface.touched_by(scene, nt.surface.spikes(160e-9, 160, radius=SPIKE)))
    rig, inside = nt.Rig(), 0
    for seed in range(20):
        random = np.random.default_rng(seed)
        x, y = 50e-9 + random.uniform(-1.0, 1.0, 2) * 1.5e-9
        area = {"x": x, "y": y, "width": 60e-9, "height": 60e-9, "pixels": 40, "lines": 40, "line_rate": 0.5}
        loop = {"mode": "contact", "set_force": 10e-9, "noise": 0.05e-9, "rate": 5e3}
        image = nt.Scanner(plan, nt.Scan(zloop=loop, raster=area), rig).run(seed).topography()  # type: ignore[arg-type]
        noisy = replace(image, heights=image.heights + 0.05e-9 * random.standard_normal(image.shape))
        found = images.apex_radius(noisy)
        assert found.radius == pytest.approx(10e-9 + SPIKE, rel=0.1)
        inside += found.low <= 10e-9 + SPIKE <= found.high
    assert inside >= 17  # of 20 at 95 %: fewer come by chance once in 60


@pytest.mark.parametrize(("tip", "pixel"), [(5e-9, 1e-9), (10e-9, 2e-9), (30e-9, 1e-9)])
def test_the_interval_holds_what_dilation_makes(tip: float, pixel: float) -> None:
    """Our own independent dilation; three spikes, of which the blunt one does not count."""
    n = round(300e-9 / pixel) - 1  # even or odd, the apex between pixels
    sharp, blunt = (nt.surface.spikes(n * pixel, n, radius=r, pitch=n * pixel).heights for r in (SPIKE, 3.0 * SPIKE))
    heights = np.concatenate([sharp, blunt, sharp], axis=1)
    surface = images.Topography(heights[n // 3 : 2 * n // 3], (pixel, pixel))
    image = images.dilate(surface, images.RoundedCone(tip, 0.3))
    for noise in (0.0, 0.1e-9):
        noisy = replace(image, heights=image.heights + noise * np.random.default_rng(1).standard_normal(image.shape))
        found = images.apex_radius(noisy)
        assert found.low <= tip + SPIKE <= found.high
        assert found.high - found.low < 0.1 * found.radius
        assert found.spikes == 2
        assert "of 2 spikes" in str(found)


def test_what_holds_no_spike_is_refused() -> None:
    rng = np.random.default_rng(3)
    with pytest.raises(InvalidValue, match="no spike over"):
        images.apex_radius(images.Topography(0.1e-9 * rng.standard_normal((64, 64)), (1e-9, 1e-9)))
    unresolved = nt.surface.spikes(400e-9, 64, radius=5e-9)
    with pytest.raises(InvalidValue, match="smaller pixels"):
        images.apex_radius(unresolved)
