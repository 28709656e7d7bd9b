# SPDX-License-Identifier: BSD-3-Clause
"""Positions and forces against time."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._io.drawing import BLUE, VERMILION, StrPath, new_figure, saved
from ..touch.record import Recording
from ..units import engineering
from .panels import dress, signal, state_band


def time(recording: Recording, save: StrPath | None = None) -> Any:
    """Master and scaled slave position (above) and force (below) against time, as the paper's Fig. 17."""
    figure = new_figure(9.0, 6.5)
    upper, lower = figure.subplots(2, 1, sharex=True)
    seconds, factor = engineering("s", recording.time)
    axis = recording.time * factor
    positions = (recording.master_position, recording.scaled_stage_position, "$x_m$", r"$x_s/\alpha_p$")
    forces = (recording.operator_force, recording.scaled_slave_force, "$f_m$", r"$\alpha_f f_s$")
    for panel, quantity, unit, pair in ((upper, "position", "m", positions), (lower, "force", "N", forces)):
        master, slave, master_symbol, slave_symbol = pair
        label, scale = engineering(unit, np.concatenate([master, slave]))
        signal(panel, (axis, master * scale), BLUE, "-", f"master {master_symbol}")
        signal(panel, (axis, slave * scale), VERMILION, "--", f"scaled slave {slave_symbol}")
        state_band(panel, recording, axis)
        panel.set_ylabel(f"{quantity} ({label})")
        panel.margins(x=0.01)
    dress(upper, "Position, + towards the sample")
    dress(lower, "Force, + pressing")
    lower.axhline(0, color="0.4", lw=0.8)
    lower.set_xlabel(f"time ({seconds})")
    return saved(figure, save)
