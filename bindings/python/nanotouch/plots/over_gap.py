# SPDX-License-Identifier: BSD-3-Clause
"""Force against gap: as recorded, and as computed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._drawing import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, StrPath, new_figure, saved
from ..errors import InvalidValue
from ..record import Recording
from ..units import engineering
from .events import Adhesion, adhesion, phases
from .panels import dress, envelope


def force_gap(recording: Recording, save: StrPath | None = None, seen: Adhesion | None = None) -> Any:
    """Slave force against the gap, approach and retraction apart, as the paper's Fig. 5; adhesion magnified beside it.

    The gap is the simulator's truth where it was recorded, otherwise the tip's height from measured quantities.
    `seen` is what to mark; by default what :func:`adhesion` finds.
    """
    seen = seen or adhesion(recording)
    gap, quantity = (recording.gap, "gap $h$") if "gap" in recording else (recording.tip_height, "tip height $z_t$")
    force = recording.slave_force
    deepest = float(np.nanmax([seen.snap_in_force, seen.pull_off_force, 0.0]))
    magnified = 0 < 10 * deepest < float(np.nanmax(np.abs(force)))
    figure = new_figure(11.0 if magnified else 7.5, 5.0)
    panels = list(np.atleast_1d(figure.subplots(1, 2 if magnified else 1)))
    windows = [np.ones(len(recording), bool)]
    if magnified:
        windows.append(_adhesion_window(recording, seen, gap))
    for panel, window, title in zip(panels, windows, ("Force on the tip", "Magnified"), strict=False):
        _force_panel(panel, (gap, force), window, phases(recording))
        panel.set_xlabel(f"{quantity} ({engineering('m', gap[window])[0]})")
        dress(panel, title)
    _mark_adhesion(panels[-1], (gap, force), windows[-1], seen)
    return saved(figure, save)


def force_curves(curves: Mapping[str, tuple[Floats, Floats]], save: StrPath | None = None) -> Any:
    """Computed force-distance curves: label -> (gap [m], force [N])."""
    if not curves:
        raise InvalidValue("force_curves needs at least one curve")
    figure = new_figure(7.5, 5.0)
    panel = figure.subplots()
    across, wide = engineering("m", np.concatenate([gap for gap, _ in curves.values()]))
    up, strong = engineering("N", np.concatenate([force for _, force in curves.values()]))
    looks = [(BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (PURPLE, ":"), (ORANGE, (0, (5, 1, 1, 1))), (SKY, "-")]
    for number, (label, (gap, force)) in enumerate(curves.items()):
        colour, style = looks[number % len(looks)]
        panel.plot(gap * wide, force * strong, color=colour, ls=style, label=label)
    panel.axhline(0, color="0.4", lw=0.8)
    panel.axvline(0, color="0.4", lw=0.8)
    panel.set_xlabel(f"gap $h$ ({across})")
    panel.set_ylabel(f"force ({up})")
    dress(panel, "Force on the tip, + repulsive")
    return saved(figure, save)


def _adhesion_window(recording: Recording, seen: Adhesion, gap: Floats) -> NDArray[np.bool_]:
    """Rows of the magnified panel: forces up to the adhesion, gaps a few times what the released spring jumps."""
    deepest = float(np.nanmax([seen.snap_in_force, seen.pull_off_force]))
    events = [row for row in (seen.snap_in_row, seen.pull_off_row) if row >= 0]
    jump = deepest / recording.parameter("spring_constant")
    near = gap < float(np.max(gap[events])) + 5 * jump
    window: NDArray[np.bool_] = near & (recording.slave_force < 1.5 * deepest)
    return window


def _force_panel(panel: Any, data: tuple[Floats, Floats], window: NDArray[np.bool_], split: tuple[int, int]) -> None:
    gap, force = data
    wide = engineering("m", gap[window])[1]
    strong, scale = engineering("N", force[window])
    stop, start = split
    parts = [
        (slice(stop, start), "0.6", "along the line"),
        (slice(0, stop), BLUE, "approach"),
        (slice(start, None), VERMILION, "retraction"),
    ]
    for rows, colour, label in parts:
        inside = np.flatnonzero(window[rows])
        if inside.size:
            x, y = gap[rows][inside] * wide, force[rows][inside] * scale
            y[:-1][np.diff(inside) > 1] = np.nan  # no line where the curve leaves the window
            kept = envelope(x, y)
            panel.plot(x[kept], y[kept], color=colour, lw=0.7, alpha=0.8, label=label)
    panel.axhline(0, color="0.4", lw=0.8)
    panel.set_ylabel(f"slave force $f_s$, + repulsive ({strong})")


def _mark_adhesion(panel: Any, data: tuple[Floats, Floats], window: NDArray[np.bool_], seen: Adhesion) -> None:
    gap, force = data
    wide, scale = engineering("m", gap[window])[1], engineering("N", force[window])[1]
    marks = [
        ("snap-in", seen.snap_in_force, seen.snap_in_row, BLUE),
        ("pull-off", seen.pull_off_force, seen.pull_off_row, VERMILION),
    ]
    for number, (name, value, row, colour) in enumerate(marks):
        text = f"no {name} found"
        if row >= 0:
            unit, factor = engineering("N", value)
            text = f"{name} −{value * factor:.3g} {unit}"
            panel.plot(gap[row] * wide, -value * scale, "o", ms=8, mfc="none", mec=colour, mew=1.6, zorder=5)
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85}
        place = (0.97, 0.93 - 0.08 * number)  # far out and repulsive: no data there
        panel.text(*place, text, color=colour, ha="right", va="center", transform=panel.transAxes, bbox=box)
