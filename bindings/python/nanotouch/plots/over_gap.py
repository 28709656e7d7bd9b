# SPDX-License-Identifier: BSD-3-Clause
"""Force against gap: as recorded, and as computed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._io.drawing import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, StrPath, new_figure, saved
from ..errors import InvalidValue
from ..scene import Scene
from ..scene.plan import History
from ..touch.record import Recording
from ..units import engineering
from .events import Adhesion, adhesion, phases
from .panels import dress, envelope

BINS = 300  # steps of the stage over each way
MAGNIFIED = 3  # adhesion has a panel of its own where the largest force is above so many times it


def force_gap(recording: Recording, save: StrPath | None = None, seen: Adhesion | None = None) -> Any:
    """Slave force against the gap, approach and retraction apart, as the paper's Fig. 5; adhesion magnified beside it.

    Lines are medians over equal steps of the stage, dots are readings, and below them lies the planned law of a flat,
    where scene and true gap were recorded. The gap is the simulator's truth where it was recorded, otherwise the tip's
    height from measured quantities.
    `seen` is what to mark; by default what :func:`adhesion` finds.
    """
    seen = seen or adhesion(recording)
    gap, quantity = (recording.gap, "gap $h$") if "gap" in recording else (recording.tip_height, "tip height $z_t$")
    force = recording.slave_force
    deepest = float(np.nanmax([seen.snap_in_force, seen.pull_off_force, 0.0]))
    magnified = 0 < MAGNIFIED * deepest < float(np.nanmax(np.abs(force)))
    figure = new_figure(11.0 if magnified else 7.5, 5.0)
    panels = list(np.atleast_1d(figure.subplots(1, 2 if magnified else 1)))
    windows = [np.ones(len(recording), bool)]
    if magnified:
        windows.append(_adhesion_window(recording, seen, gap))
    for panel, window, title in zip(panels, windows, ("Force on the tip", "Magnified"), strict=False):
        if "gap" in recording:
            _law(panel, recording, (gap[window], force[window]))
        _force_panel(panel, (gap, force, recording.stage_position), window, phases(recording))
        panel.set_xlabel(f"{quantity} ({engineering('m', gap[window])[0]})")
        dress(panel, title)
    if magnified:  # one legend for both: two would lie over their titles
        for panel in panels:
            panel.get_legend().remove()
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4, frameon=False)
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


def _force_panel(
    panel: Any, data: tuple[Floats, Floats, Floats], window: NDArray[np.bool_], split: tuple[int, int]
) -> None:
    gap, force, stage = data
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
            kept = envelope(x, y)
            panel.plot(x[kept], y[kept], ".", color=colour, ms=1.0, alpha=0.3)
            across, up = _binned(stage[rows], window[rows], (x, y))
            panel.plot(across, up, color=colour, lw=1.4, label=label)
    panel.axhline(0, color="0.4", lw=0.8)
    panel.set_ylabel(f"slave force $f_s$, + repulsive ({strong})")


def _binned(stage: Floats, window: NDArray[np.bool_], seen: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
    """Medians over equal steps of the stage, which moves on through a steep contact as through free air: no zigzag of
    its steps, and a jump stays between two of them. NaN where all of a step lies outside of the window."""
    if len(seen[0]) < 2 * BINS:
        return seen
    edges = np.linspace(float(stage.min()), float(stage.max()), BINS + 1)
    number = np.clip(np.searchsorted(edges, stage, side="right") - 1, 0, BINS - 1)
    steps, inside = np.unique(number), number[window]
    medians = np.full((2, len(steps)), np.nan)
    for place, step in enumerate(steps):
        rows = inside == step
        if rows.any():
            medians[:, place] = np.median(seen[0][rows]), np.median(seen[1][rows])
    return medians[0], medians[1]


def _law(panel: Any, recording: Recording, shown: tuple[Floats, Floats]) -> None:
    """The way in and the way out that were planned, within what is shown."""
    scene = recording.metadata.get("scene")
    gap, force = shown
    if scene is None or not len(gap) or scene.get("terms"):
        return
    plan = Scene(**scene).plan()
    wide, scale = engineering("m", gap)[1], engineering("N", force)[1]
    low, high = float(force.min()), float(force.max())
    gaps = np.linspace(float(np.nanmin(gap)), float(np.nanmax(gap)), 4000)
    ways: tuple[tuple[History, str], ...] = (("approach", "-"), ("retract", "--"))
    for history, style in ways:
        law = plan.force(gaps, history)
        seen = (law >= low - 0.1 * abs(low)) & (law <= 1.1 * high)
        panel.plot(gaps * wide, np.where(seen, law * scale, np.nan), color="0.25", ls=style, lw=0.9,
                   label="planned law" if history == "approach" else None, zorder=1)  # fmt: skip


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
