# SPDX-License-Identifier: BSD-3-Clause
"""The bound of any tap over a sample whose modulus and adhesion change from place to place."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import scan


@pytest.mark.parametrize("kind", ["stiff", "sticky", "both"])
def test_no_tap_over_a_map_is_harder(kind: str) -> None:
    """A level sample, half of it 60 times as stiff, or three times as adhesive: every tap is below the bound, which is
    at least that over the extreme places alone."""
    share = np.tile(np.arange(32) >= 16, (32, 1)).astype(float)
    scene = nt.Scene(tip={"radius": 10e-9}, sample={"youngs_modulus": 1e9}, medium={"relative_humidity": 0.0})
    scene.adhesion.hamaker_constant = 0.0
    scene.adhesion.work_of_adhesion = 0.02
    given: dict[str, Any] = {"youngs_modulus": 1e9 * 60.0**share, "work_of_adhesion": 0.02 * 3.0**share}
    given = {name: given[name] for name in given if kind == "both" or (name == "youngs_modulus") == (kind == "stiff")}
    surface = nt.Surface.touched_by(scene, np.zeros((32, 32)), pixel_size=10e-9, **given)
    rig = nt.Rig(probe={"spring_constant": 30.0, "quality": 150.0, "resonance": 250e3})
    raster: Any = {"x": 60e-9, "y": 60e-9, "width": 200e-9, "height": 20e-9, "pixels": 32, "lines": 1, "line_rate": 8.0}
    settings = nt.Scan(zloop={"rate": 25e3}, raster=raster)
    scanner = nt.Scanner(scene.plan(0.3, surface=surface), settings, rig)
    told = scan.peak_bounds(scanner, scene, surface)[0]
    image = scanner.run()
    reached = max(float(channels.peak_force.max()) for channels in image[:2])
    assert math.isfinite(told)
    assert 0.0 < reached < told
    alone = [scanner.peak_bound((x, 70e-9), 0.0, 0.0) for x in (80e-9, 240e-9)]
    assert told >= max(alone)
    if kind != "sticky":  # it would have been told of the first place alone
        assert alone[1] > 1.3 * alone[0]
