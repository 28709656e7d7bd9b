# SPDX-License-Identifier: BSD-3-Clause
"""The z loop over a flat, before it scans: whether it comes to rest, and how hard it taps there."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nanotouch._arrays import Floats
from nanotouch.scan.scanner import Scanner
from nanotouch.scene import Scene

_TICKS = 2000  # there, and back
_STILL = 1e-3  # range of the reading at rest, over the free amplitude, or the noise of a reading
_DECAYS = 0.7  # from one quarter of the way back to the next
_SLOWER = 0.25  # of the K_I in use


class Rehearsal(NamedTuple):
    """What a z loop does over a flat, without noise."""

    peak_force: float
    """largest of a tap [N]"""
    unrest: float
    """range of the reading after 4000 ticks, which does not die away [m]; 0: the loop comes to rest"""


def rehearse(scanner: Scanner, scene: Scene, share: float = 1.0) -> Rehearsal:
    """With a share of the K_I in use; 4000 ticks after the tip has come down."""
    settings = scanner.scan.copy()
    settings["zloop.integral"], settings["zloop.noise"] = 0.0, 0.0
    settings["raster.lines"], settings["raster.pixels"] = 1, _TICKS
    settings["raster.line_rate"] = settings["zloop.rate"] / (2.0 * _TICKS)
    settings["raster.tilt_x"] = settings["raster.tilt_y"] = settings["raster.drift"] = 0.0
    A0 = float(scanner.drive["drive.free_amplitude"])
    flat = Scanner(scene.plan(), settings, scanner.rig, scanner.drive)
    if share * scanner.integral >= flat.integral * flat.margins.gain:  # of a map: it would ring over the scene's flat
        return Rehearsal(math.inf, A0)
    settings["zloop.integral"] = share * scanner.integral
    image = Scanner(flat.plan, settings, scanner.rig, scanner.drive).run(threads=1)
    error: Floats = image.retrace.error[0, ::-1]
    before, last = (float(np.ptp(part)) for part in np.split(error, 4)[2:])
    still = max(_STILL * A0, float(scanner.scan["zloop.noise"]))
    rests = last < still or last < _DECAYS * before
    peak = max(float(channels.peak_force.max()) for channels in image[:2])
    return Rehearsal(peak, 0.0 if rests else last)


def rests_slower(scanner: Scanner, scene: Scene) -> bool:
    """Whether the loop comes to rest with a quarter of the K_I in use."""
    return rehearse(scanner, scene, _SLOWER).unrest == 0.0
