# SPDX-License-Identifier: BSD-3-Clause
"""The radius of tip and spike together, from images of the tip characteriser: within its interval, and within 10 %."""

from __future__ import annotations

from dataclasses import replace

import draws
import nanotouch as nt
import numpy as np
import pytest

pytest.importorskip("scipy.optimize")
pytest.importorskip("cv2")

from nanotouch import images
from nanotouch.errors import InvalidValue

SPIKE = 8e-9


def test_a_scanned_spike_tells_its_radius_and_the_tips() -> None:
    """Scans in contact mode with noise of the loop's reading and 0.05 nm of the height, each with its own place of
    the spike between the pixels. Spheres add: R + R_s."""
    scene = nt.Scene(tip={"radius": 10e-9}, medium={"relative_humidity": 0.0})
    plan = scene.plan(0.3, surface=nt.Surface.touched_by(scene, nt.surface.spikes(160e-9, 160, radius=SPIKE)))
    rig, inside = nt.Rig(), 0
    scans = draws.count(8, 20)
    for seed in range(scans):
        random = np.random.default_rng(seed)
        x, y = 50e-9 + random.uniform(-1.0, 1.0, 2) * 1.5e-9
        area = {"x": x, "y": y, "width": 60e-9, "height": 60e-9, "pixels": 40, "lines": 40, "line_rate": 0.5}
        loop = {"mode": "contact", "set_force": 10e-9, "noise": 0.05e-9, "rate": 5e3}
        image = nt.Scanner(plan, nt.Scan(zloop=loop, raster=area), rig).run(seed).topography()  # type: ignore[arg-type]
        noisy = replace(image, heights=image.heights + 0.05e-9 * random.standard_normal(image.shape))
        found = images.apex_radius(noisy)
        assert found.radius == pytest.approx(10e-9 + SPIKE, rel=0.1)
        inside += found.low <= 10e-9 + SPIKE <= found.high
    assert inside >= 0.85 * scans  # at 95 % of each: of 20, fewer than 17 come by chance once in 60


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
        assert found.no_sphere == 0.0
        assert "of 2 spikes" in str(found)


@pytest.mark.parametrize(("tip", "pixel"), [(10e-9, 1.5e-9), (20e-9, 1.5e-9), (15e-9, 1e-9)])
def test_a_tip_that_is_no_sphere_widens_the_interval(tip: float, pixel: float) -> None:
    """A paraboloid is a sphere at its apex alone: a fit as deep as R finds up to 24 % more. Its own spike,
    dilated by scipy; the interval holds R + R_s, and the words say why it is wide."""
    ndimage = pytest.importorskip("scipy.ndimage")
    half = int(90e-9 / pixel)
    y, x = np.mgrid[-half : half + 1, -half : half + 1] * pixel + 0.3 * pixel
    r, slope = np.hypot(x, y), np.radians(25.0)
    sphere, end = SPIKE - np.sqrt(np.maximum(SPIKE**2 - r**2, 0.0)), SPIKE * np.cos(slope)
    below = np.where(r < end, sphere, SPIKE * (1.0 - np.sin(slope)) + (r - end) / np.tan(slope))
    reach = int(np.sqrt(2.0 * tip * 120e-9) / pixel)
    v, u = np.mgrid[-reach : reach + 1, -reach : reach + 1] * pixel
    parabola = -(u**2 + v**2) / (2.0 * tip)
    seen = ndimage.grey_dilation(np.maximum(120e-9 - below, 0.0), structure=parabola, mode="nearest")
    seen = seen + 0.05e-9 * np.random.default_rng(1).standard_normal(seen.shape)
    found = images.apex_radius(images.Topography(seen, (pixel, pixel)))
    assert found.low <= tip + SPIKE <= found.high
    assert found.no_sphere > 0.0
    assert "no sphere" in str(found)


def test_what_holds_no_spike_is_refused() -> None:
    rng = np.random.default_rng(3)
    with pytest.raises(InvalidValue, match="no spike over"):
        images.apex_radius(images.Topography(0.1e-9 * rng.standard_normal((64, 64)), (1e-9, 1e-9)))
    unresolved = nt.surface.spikes(400e-9, 64, radius=5e-9)
    with pytest.raises(InvalidValue, match="smaller pixels"):
        images.apex_radius(unresolved)
