# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of a touch, drawn with matplotlib's object interface: no global state, no display needed.

Every function returns the ``Figure`` and, with ``save=``, also writes it (whole or not at all). Of long records the
extremes of each stretch are drawn, so that a snap-in of one sample stays visible."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch.errors import InvalidValue, require
from nanotouch.record import STATES, Recording, replacing

Floats = NDArray[np.float64]
StrPath = str | os.PathLike[str]

# Okabe and Ito's palette: told apart with any colour vision, and by lightness in print.
BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY = "#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7", "#56B4E9"
STATE_COLOURS = {1: ORANGE, 2: PURPLE, 3: "#000000"}
LONG = 20_000  # points; of longer records only the extremes are drawn
STRETCHES = 2000  # more than a picture has pixels across
PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}


def engineering(unit: str, values: ArrayLike) -> tuple[str, float]:
    """The SI prefix that suits the largest magnitude: ``engineering("m", [2e-7])`` is ``("nm", 1e9)``."""
    magnitudes = np.abs(np.asarray(values, dtype=float))
    largest = float(np.max(magnitudes, where=np.isfinite(magnitudes), initial=0.0))
    power = 3 * math.floor(math.log10(largest) / 3 + 1e-12) if largest > 0 else 0
    power = min(max(power, min(PREFIXES)), max(PREFIXES))
    return PREFIXES[power] + unit, 10.0**-power


def envelope(*signals: Floats, stretches: int = STRETCHES) -> NDArray[np.intp]:
    """Rows to draw: the first, the last and every signal's extremes in each stretch; all rows of a short record."""
    rows = len(signals[0])
    if rows <= LONG:
        return np.arange(rows)
    length = -(-rows // stretches)
    keep = [np.array([0, rows - 1])]
    for signal in signals:
        for fill, pick in ((np.inf, np.argmin), (-np.inf, np.argmax)):
            padded = np.full(-(-rows // length) * length, fill)
            padded[:rows] = np.where(np.isnan(signal), fill, signal)
            keep.append(pick(padded.reshape(-1, length), axis=1) + np.arange(0, padded.size, length))
    return np.unique(np.minimum(np.concatenate(keep), rows - 1))


@dataclass(frozen=True)
class Adhesion:
    """Snap-in and pull-off; NaN and row -1 where there is none, or none above the noise."""

    snap_in_force: float  # [N], positive
    snap_in_row: int
    pull_off_force: float  # [N], positive
    pull_off_row: int


def phases(recording: Recording) -> tuple[int, int]:
    """Row at which the approach ends, row at which the retraction starts.

    Between them the tip moves sideways; where it does not, both are the deepest point of the stage.
    """
    length = _length(recording)
    far = 1e-3 * float(np.max(length, initial=0.0))
    if not far > 0:
        turn = int(np.argmax(recording.stage_position))
        return turn, turn
    moved, moving = np.flatnonzero(length > far), np.flatnonzero(np.abs(length - length[-1]) > far)
    return int(moved[0]), int(moving[-1]) + 1 if moving.size else int(moved[0])


def adhesion(recording: Recording) -> Adhesion:
    """Find the sudden drop of the force on the way in, and the sudden rise on the way out.

    In the simulator's true tip force, where it was recorded: jumps of more than 5 % of the deepest attraction.
    Otherwise in the measured slave force: what differs by six standard deviations between the means over 0.5, 1.5 or
    5 ms before and after (noise alone is not expected to in 1e6 rows).
    """
    stop, start = phases(recording)
    force, halves = recording.slave_force, [1]
    if "tip_force" in recording:
        force = recording.tip_force
        least = 0.05 * float(np.max(-force, initial=0.0))
    else:
        step = float(np.median(np.diff(recording.time)))
        halves = sorted({max(1, round(duration / step / 2)) for duration in (5e-4, 1.5e-3, 5e-3)})
        least = 6 * 1.4826 * float(np.median(np.abs(np.diff(force)))) / math.sqrt(2 * halves[0])
    snap_in, row_in = _drop(force[:stop], least, halves)
    pull_off, row_out = _drop(force[start:][::-1], least, halves)  # backwards in time it is a snap-in
    return Adhesion(snap_in, row_in, pull_off, len(recording) - 1 - row_out if row_out >= 0 else -1)


def time(recording: Recording, save: StrPath | None = None) -> Any:
    """Master and scaled slave position (above) and force (below) against time, as the paper's Fig. 17."""
    figure = _figure(9.0, 6.5)
    upper, lower = figure.subplots(2, 1, sharex=True)
    seconds, factor = engineering("s", recording.time)
    axis = recording.time * factor
    positions = (recording.master_position, recording.scaled_stage_position, "$x_m$", r"$x_s/\alpha_p$")
    forces = (recording.operator_force, recording.scaled_slave_force, "$f_m$", r"$\alpha_f f_s$")
    for panel, quantity, unit, pair in ((upper, "position", "m", positions), (lower, "force", "N", forces)):
        master, slave, master_symbol, slave_symbol = pair
        label, scale = engineering(unit, np.concatenate([master, slave]))
        _signal(panel, (axis, master * scale), BLUE, "-", f"master {master_symbol}")
        _signal(panel, (axis, slave * scale), VERMILION, "--", f"scaled slave {slave_symbol}")
        _state_band(panel, recording, axis)
        panel.set_ylabel(f"{quantity} ({label})")
        panel.margins(x=0.01)
    _dress(upper, "Position, + towards the sample")
    _dress(lower, "Force, + pressing")
    lower.axhline(0, color="0.4", lw=0.8)
    lower.set_xlabel(f"time ({seconds})")
    return _saved(figure, save)


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
    figure = _figure(11.0 if magnified else 7.5, 5.0)
    panels = list(np.atleast_1d(figure.subplots(1, 2 if magnified else 1)))
    windows = [np.ones(len(recording), bool)]
    if magnified:
        windows.append(_adhesion_window(recording, seen, gap))
    for panel, window, title in zip(panels, windows, ("Force on the tip", "Magnified"), strict=False):
        _force_panel(panel, (gap, force), window, phases(recording))
        panel.set_xlabel(f"{quantity} ({engineering('m', gap[window])[0]})")
        _dress(panel, title)
    _mark_adhesion(panels[-1], (gap, force), windows[-1], seen)
    return _saved(figure, save)


def line(
    recording: Recording,
    topography: Any = None,
    profile: tuple[Floats, Floats] | None = None,
    save: StrPath | None = None,
) -> Any:
    """The felt line over the true profile (as the paper's Fig. 18, 19) and the force, against distance along the line.

    Parameters
    ----------
    topography : Topography, optional
        The surface; its heights under the line are drawn as ground.
    profile : (distance, height), shape (m,) each [m], optional
        The ground, if no topography is given.
    """
    rows, distance = _along(recording)
    part = recording[rows]
    ground = profile if topography is None else _profile(topography, part, distance)
    lines = _felt_lines(part)
    heights = [height for height, _, _ in lines.values()]
    figure = _figure(9.0, 6.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
    across, wide = engineering("m", distance)
    up, high = engineering("m", [np.ptp(height) for height in heights])
    strong, scale = engineering("N", part.slave_force)
    for label, (height, colour, style) in lines.items():
        _signal(upper, (distance * wide, height * high), colour, style, label)
    _signal(lower, (distance * wide, part.slave_force * scale), BLUE, "-", "slave $f_s$")
    lower.axhline(0, color="0.4", lw=0.8)
    if ground is not None:
        low, _ = upper.get_ylim()
        low = min(low, float(np.nanmin(ground[1])) * high)
        upper.fill_between(ground[0] * wide, ground[1] * high, low, color="0.85", label="true profile", lw=0, zorder=0)
        upper.set_ylim(bottom=low)
    upper.set_ylabel(f"height ({up})")
    lower.set_ylabel(f"force ({strong})")
    lower.set_xlabel(f"distance along the line ({across})")
    upper.margins(x=0.01)
    _dress(upper, "Felt line")
    _dress(lower, "Force on the tip, + repulsive")
    return _saved(figure, save)


def z_width(recording: Recording, save: StrPath | None = None) -> Any:
    """What the hand feels between air and the stiffest contact that was met, over frequency (docs/margins.md)."""
    from nanotouch import margins  # which needs the images, whose pictures need this module

    width = margins.z_width(recording)
    panel = (figure := _figure(7.5, 5.0)).subplots()
    panel.fill_between(width.frequency, width.free, width.contact, color="0.92")
    looks = {"free": (BLUE, "-"), "contact": (VERMILION, "-"), "passive": (GREEN, ":"), "stable": (PURPLE, "--")}
    for name, (colour, style) in looks.items():
        panel.loglog(width.frequency, getattr(width, name), color=colour, ls=style, label=name)
    panel.axhline(width.drag, color=SKY, lw=0.8, label="measured drag in air")
    panel.set_xlabel("frequency (Hz)")
    panel.set_ylabel("impedance at the hand $|f_m/x_m'|$ (N s/m)")
    _dress(panel, "Z-width")
    return _saved(figure, save)


def force_curves(curves: Mapping[str, tuple[Floats, Floats]], save: StrPath | None = None) -> Any:
    """Computed force-distance curves: label -> (gap [m], force [N])."""
    if not curves:
        raise InvalidValue("force_curves needs at least one curve")
    figure = _figure(7.5, 5.0)
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
    _dress(panel, "Force on the tip, + repulsive")
    return _saved(figure, save)


def _figure(width: float, height: float) -> Any:
    return require("matplotlib.figure", "app").Figure(figsize=(width, height), layout="constrained")


def _saved(figure: Any, save: StrPath | None) -> Any:
    if save is not None:
        with replacing(save) as part:
            figure.savefig(part, format=Path(save).suffix.lstrip(".") or "png", dpi=150)
    return figure


def _dress(panel: Any, title: str) -> None:
    """Title at the left, legend at the right of the line above the panel, where it hides no data."""
    panel.set_title(title, loc="left", fontsize="medium")
    panel.grid(alpha=0.3)
    panel.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=6, frameon=False, fontsize="small")


def _drop(force: Floats, least: float, halves: list[int]) -> tuple[float, int]:
    """The clearest sudden drop of a force: how attractive it is just after [N], and its row.

    Compares the means of 2 h rows before and after each row, for each h of `halves`; `least` is the smallest drop [N]
    that counts at the first h, and falls as 1/sqrt(h). As the force climbs again at once, the value is the straight
    line through the means of both halves after the drop, continued back to it.
    """
    best, value, row = least, math.nan, -1
    total = np.concatenate([[0.0], np.cumsum(force)])
    for half in halves:
        count = len(force) - 4 * half + 1  # of rows with 2 h before and after them
        if count < 1:
            continue
        start, edge, middle, stop = (total[k * half : k * half + count] for k in (0, 2, 3, 4))
        near, far = (middle - edge) / half, (stop - middle) / half
        attraction = (far - near) * (half - 1) / (2 * half) - near
        score = ((edge - start) - (stop - edge)) / (2 * half) * math.sqrt(half / halves[0])
        score[attraction <= 0] = 0.0  # a drop from pressing hard to pressing less
        clearest = int(np.argmax(score))
        if score[clearest] > best:
            best, value, row = float(score[clearest]), float(attraction[clearest]), clearest + 2 * half
    return value, row


def _running_mean(values: Floats, width: int) -> Floats:
    """Mean over `width` (odd) rows around each; shorter at the ends."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    middle = np.arange(len(values))
    low, high = np.maximum(middle - width // 2, 0), np.minimum(middle + width // 2 + 1, len(values))
    mean: Floats = (total[high] - total[low]) / (high - low)
    return mean


def _signal(panel: Any, data: tuple[Floats, Floats], colour: str, style: Any, label: str) -> None:
    """All samples, pale, and over them their mean over a five-hundredth of the record, in which dashes can be seen."""
    axis, values = data
    rows = envelope(values)
    if len(values) < 2000:
        panel.plot(axis, values, color=colour, ls=style, lw=1.5, label=label)
        return
    panel.plot(axis[rows], values[rows], color=colour, lw=0.5, alpha=0.35)
    mean = _running_mean(values, (len(values) // 500) | 1)
    few = np.linspace(0, len(values) - 1, 1000).astype(int)
    panel.plot(axis[few], mean[few], color=colour, ls=style, lw=1.6, label=label)


def _state_band(panel: Any, recording: Recording, axis: Floats) -> None:
    """Lamp: the stretches in which the loop was not in RUN, behind the curves."""
    if "state" not in recording:
        return
    states = recording.state
    edges = np.flatnonzero(np.diff(states)) + 1
    for first, last in zip([0, *edges], [*edges, len(states)], strict=True):
        if states[first] in STATE_COLOURS:
            panel.axvspan(axis[first], axis[last - 1], color=STATE_COLOURS[states[first]], alpha=0.25, lw=0.5)
    for state in np.unique(states):
        if state in STATE_COLOURS:
            panel.fill_between([], [], color=STATE_COLOURS[state], alpha=0.25, label=STATES[state])


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


def _length(recording: Recording) -> Floats:
    """Sideways distance from the start [m], shape (n,)."""
    if "x" not in recording or "y" not in recording or not len(recording):
        return np.zeros(len(recording))
    length: Floats = np.hypot(recording.x - recording.x[0], recording.y - recording.y[0])
    return length


def _along(recording: Recording) -> tuple[slice, Floats]:
    """The rows between the first and the last sideways motion, and their distance along the path [m].

    Measured along 500 chords, so that the sensors' noise does not add up.
    """
    length = _length(recording)
    if not np.max(length, initial=0.0) > 0:
        raise InvalidValue("the recording does not move sideways: there is no line to draw")
    start, stop = phases(recording)
    part = recording[start:stop]
    corners = np.unique(np.linspace(0, len(part) - 1, 501).astype(int))
    chords = np.hypot(np.diff(part.x[corners]), np.diff(part.y[corners]))
    distance: Floats = np.interp(np.arange(len(part)), corners, np.concatenate([[0.0], np.cumsum(chords)]))
    return slice(start, stop), distance


def _felt_lines(part: Recording) -> dict[str, tuple[Floats, str, Any]]:
    """Label -> (height [m], colour, dashes). The hand's constant offset, the bent cantilever, is taken out."""
    lines: dict[str, tuple[Floats, str, Any]] = {}
    if "surface_height" in part:
        lines["surface as the tip can follow it"] = (part.surface_height, "black", ":")
    lines["tip, measured"] = (part.tip_height, BLUE, "-")
    if "alpha_p" in part.metadata:
        hand = -part.parameter("alpha_p") * part.master_position
        lines["hand, scaled"] = (hand + float(np.nanmedian(part.tip_height - hand)), VERMILION, "--")
    return lines


def _profile(topography: Any, part: Recording, distance: Floats) -> tuple[Floats, Floats]:
    """Heights of the pixels under the line."""
    rows = np.linspace(0, len(part) - 1, min(len(part), 4000)).astype(int)
    dy, dx = topography.pixel_size
    high, wide = topography.heights.shape
    i = np.clip(np.rint(part.x[rows] / dx).astype(int), 0, wide - 1)
    j = np.clip(np.rint(part.y[rows] / dy).astype(int), 0, high - 1)
    return distance[rows], np.asarray(topography.heights, float)[j, i]
