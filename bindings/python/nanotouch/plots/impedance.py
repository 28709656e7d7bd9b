# SPDX-License-Identifier: BSD-3-Clause
"""What the hand feels over frequency."""

from __future__ import annotations

from typing import Any

from .._io.drawing import BLUE, GREEN, PURPLE, SKY, VERMILION, StrPath, new_figure, saved
from ..touch import margins
from ..touch.record import Recording
from .panels import dress


def z_width(recording: Recording, save: StrPath | None = None) -> Any:
    """What the hand feels between air and the stiffest contact that was met, over frequency (docs/margins.md)."""
    width = margins.z_width(recording)
    panel = (figure := new_figure(7.5, 5.0)).subplots()
    panel.fill_between(width.frequency, width.free, width.contact, color="0.92")
    looks = {"free": (BLUE, "-"), "contact": (VERMILION, "-"), "passive": (GREEN, ":"), "stable": (PURPLE, "--")}
    for name, (colour, style) in looks.items():
        panel.loglog(width.frequency, getattr(width, name), color=colour, ls=style, label=name)
    panel.axhline(width.drag, color=SKY, lw=0.8, label="measured drag in air")
    panel.set_xlabel("frequency (Hz)")
    panel.set_ylabel("impedance at the hand $|f_m/x_m'|$ (N s/m)")
    dress(panel, "Z-width")
    return saved(figure, save)
