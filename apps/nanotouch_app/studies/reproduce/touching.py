# SPDX-License-Identifier: BSD-3-Clause
"""What the figures of the closed loop (16 to 19) share: sessions of the simulated rig, errors of tracking, panels."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch.touch.operator import Input

from nanotouch_app.studies.reproduce import drawing
from nanotouch_app.studies.reproduce.statement import Floats, Parameter

ROWS = 2001
RATE = Parameter("rate of the repaired loop", 10e3, "Hz", "ours; the paper's 3 ms leave no margin")
PAPER_RATE = Parameter("rate of the literal loop", 1.0 / 3e-3, "Hz", "Sec. V, 3 ms")


def settings(rig: nt.Rig, rate: float, **gains: float) -> nt.Settings:
    """The defaults for a rig with other gains."""
    made = nt.Settings.for_rig(rig)
    made["gains.rate"] = rate
    for name, value in gains.items():
        made[f"gains.{name}"] = value
    return made


def sinusoid(mean: float, amplitude: float, period: float, cycles: float) -> list[Input]:
    """The hand's force mean - amplitude cos(2 pi t/period) [N] in straight pieces, 48 a period."""
    times = np.arange(1, round(48 * cycles) + 1) / 48.0
    return [Input(float(mean - amplitude * math.cos(2 * math.pi * t)), 0.0, 0.0, period / 48.0) for t in times]


def position_error(recording: nt.Recording) -> Floats:
    """alpha_p (x_m - its start) - x_s [m]."""
    alpha_p, start = recording.parameter("alpha_p"), recording.parameter("master_start")
    return np.asarray(alpha_p * (recording.master_position - start) - recording.stage_position)


def force_error(recording: nt.Recording) -> Floats:
    """f_m - alpha_f f_s [N]."""
    return np.asarray(recording.operator_force - recording.scaled_slave_force)


def rms(values: Floats) -> float:
    """Root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else math.nan


def columns(recordings: Mapping[str, nt.Recording], end: float) -> dict[str, Floats]:
    """The four signals of each recording at common times; NaN after its end."""
    time = np.linspace(0.0, end - 5e-3, ROWS)  # the last sample is a period before the end
    found: dict[str, Floats] = {"time [s]": time}
    for name, recording in recordings.items():
        signals = {
            "master position [m]": recording.master_position,
            "scaled slave position [m]": recording.scaled_stage_position,
            "master force [N]": recording.operator_force,
            "scaled slave force [N]": recording.scaled_slave_force,
        }
        for what, values in signals.items():
            found[f"{name} {what}"] = np.interp(time, recording.time, values, right=math.nan)
    return found


def panels(figure: Any, found: Mapping[str, Floats], titles: Mapping[str, str]) -> None:
    """Positions above, forces below, a column for each name."""
    grid = figure.subplots(2, len(titles), sharex=True, squeeze=False)
    time = found["time [s]"]
    for (name, title), (upper, lower) in zip(titles.items(), grid.T, strict=True):
        for panel, what, scale in ((upper, "position [m]", 1e3), (lower, "force [N]", 1.0)):
            for side, (colour, style) in zip(("master", "scaled slave"), drawing.LOOKS, strict=False):
                panel.plot(time, found[f"{name} {side} {what}"] * scale, color=colour, ls=style, lw=1.0, label=side)
        drawing.dress(upper, title, "", "position (mm)")
        drawing.dress(lower, "", "time (s)", "force (N)", None)
        drawing.zero(lower)
