# SPDX-License-Identifier: BSD-3-Clause
"""A z loop that does not come to rest over a flat is told before the scan, with what to change."""

from __future__ import annotations

from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import SolverError


def scanner(
    tip: float, modulus: float, humidity: float, probe: dict[str, float], **zloop: Any
) -> tuple[nt.Scanner, nt.Scene]:
    scene = nt.Scene(
        tip={"radius": tip}, sample={"youngs_modulus": modulus}, medium={"relative_humidity": humidity}
    )  # fmt: skip
    rig = nt.Rig(probe=probe, stage={"resonance": 4e3, "quality": 3.0})  # type: ignore[arg-type]
    drive = nt.Drive(drive={"free_amplitude": zloop.pop("free_amplitude")})
    return nt.Scanner(scene.plan(), nt.Scan(zloop=zloop), rig, drive), scene


def swing(of: nt.Scanner) -> float:
    """Range of the reading in the last part of a scan of 20 000 ticks over a flat, with no noise [m]."""
    settings = of.scan.copy()
    settings["zloop.noise"], settings["zloop.integral"] = 0.0, of.integral
    settings["raster.lines"], settings["raster.pixels"] = 1, 8000
    settings["raster.line_rate"] = settings["zloop.rate"] / 20000.0
    return float(np.ptp(nt.Scanner(of.plan, settings, of.rig, of.drive).run().retrace.signal[0, :800]))


WET = (22e-9, 69e9, 0.5, {"spring_constant": 9.85, "quality": 462.0, "resonance": 137e3})
DRY = (10e-9, 10e9, 0.0, {"spring_constant": 40.0, "quality": 200.0, "resonance": 300e3})


def test_a_loop_that_goes_to_and_fro_is_told() -> None:
    """Phase feedback on a wet sample, whose meniscus takes more than the lever has: no motion has the lag."""
    taps, scene = scanner(*WET, mode="phase", set_phase=0.462, free_amplitude=17.8e-9)
    told = nt.scan.forecast(taps, scene)
    assert swing(taps) > 1e-9
    assert told.unrest > 1e-9
    assert not told.rests_slower
    assert "at rest: no" in str(told)
    assert "larger free amplitude" in str(told)


@pytest.mark.parametrize("mode", ["tapping", "phase"])
def test_a_loop_that_rests_is_not(mode: str) -> None:
    taps, scene = scanner(*DRY, mode=mode, free_amplitude=20e-9)
    told = nt.scan.forecast(taps, scene)
    assert swing(taps) < 20e-12
    assert told.unrest == 0.0
    assert told.rests_slower
    assert "at rest" not in str(told)


def test_a_set_point_out_of_reach_says_what_to_change() -> None:
    sticky = (3.4e-9, 0.87e9, 0.0, {"spring_constant": 8.55, "quality": 880.0, "resonance": 145e3})
    taps, scene = scanner(*sticky, mode="phase", set_phase=0.472, free_amplitude=6e-9)
    with pytest.raises(SolverError, match=r"lag of a tip that is repelled.*hold the amplitude"):
        nt.scan.forecast(taps, scene)
