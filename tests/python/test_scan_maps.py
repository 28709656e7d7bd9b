# SPDX-License-Identifier: BSD-3-Clause
"""The bound of any tap: over maps of modulus and adhesion, and up a slope that the loop cannot follow."""

from __future__ import annotations

import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import scan
from nanotouch.scan.overshoot import _largest


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


@pytest.mark.parametrize("rate", [0.3, 1.0])
def test_a_slope_that_the_loop_cannot_follow(rate: float) -> None:
    """A ramp of 2. At 0.3 Hz the loop lags by less than the set point: no tap is above a finite bound. At 1 Hz it
    lags by more: the lever stops, and is pressed on for as long as the ramp lasts. No amplitude helps."""
    scene, rig = nt.Scene(), nt.Rig()
    scene.range.maximum_load = 400e-9
    ramp = np.tile(2.0 * np.clip(np.arange(128) * 4e-9 - 100e-9, 0.0, 120e-9), (16, 1))
    surface = nt.Surface.touched_by(scene, ramp, pixel_size=4e-9)
    raster: Any = {"width": 500e-9, "height": 8e-9, "y": 24e-9, "pixels": 64, "lines": 1, "line_rate": rate}
    scanner = nt.Scanner(scene.plan(0.1, surface=surface), nt.Scan(raster=raster), rig)
    told = scan.forecast(scanner, scene, surface)
    reached = max(float(channels.peak_force.max()) for channels in scanner.run(1)[:2])
    assert reached < told.peak_bound
    if rate > 0.5:
        assert reached > 800e-9  # docs/scan.md
        assert math.isinf(told.peak_bound)
        assert math.isnan(told.safe_free_amplitude)
        assert "is pressed on: scan slower" in str(told)
    else:
        assert told.force_limit < told.peak_bound < 600e-9
        assert 0.8 * 20e-9 < told.safe_free_amplitude < 20e-9


@pytest.mark.parametrize("largest", [0.93, 0.4, 0.051])
def test_the_largest_amplitude_is_found_though_smaller_ones_fail(largest: float) -> None:
    """Attraction may hold a tip of small amplitude: what keeps the limit need not reach down."""
    found = _largest(lambda share: 0.6 * largest < share <= largest)
    assert 0.95 * largest < found <= largest
    assert math.isnan(_largest(lambda share: False))
