# SPDX-License-Identifier: BSD-3-Clause
"""The felt line over the true profile."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._arrays import Floats
from .._io.drawing import BLUE, VERMILION, StrPath, new_figure, saved
from ..errors import InvalidValue
from ..touch.record import Recording
from ..units import engineering, in_words
from .events import phases, sideways
from .panels import dress, signal


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
    figure = new_figure(9.0, 6.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[3, 2])
    across, wide = engineering("m", distance)
    up, high = engineering("m", [np.ptp(height) for height in heights])
    strong, scale = engineering("N", part.slave_force)
    for label, (height, colour, style) in lines.items():
        signal(upper, (distance * wide, height * high), colour, style, label)
    signal(lower, (distance * wide, part.slave_force * scale), BLUE, "-", "slave $f_s$")
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
    dress(upper, "Felt line")
    dress(lower, "Force on the tip, + repulsive")
    lower.text(0.005, 0.03, _band(part), transform=lower.transAxes, fontsize=8, color="0.35", va="bottom")
    return saved(figure, save)


def _band(part: Recording) -> str:
    """What the pale band is, and the forces that single steps of the rig make, where the recording says what rig."""
    told = "line: mean; band: least to largest"
    rig = part.metadata.get("rig")
    if not (isinstance(rig, dict) and "alpha_p" in part.metadata):
        return told
    probe, lever = rig["probe"], float(rig["probe"]["spring_constant"])
    steps = {
        "the master's position": float(rig["master"]["resolution"]) * part.parameter("alpha_p"),
        "the stage's command": float(rig["stage"]["command_resolution"]),
        "the lever's signal": float(probe["resolution"]) * float(probe["sensitivity"]),
    }
    words = [f"{name} {in_words(step * lever, 'N', 3)}" for name, step in steps.items() if step > 0.0]
    return f"{told}; one step: {', '.join(words)}" if words else told


def _along(recording: Recording) -> tuple[slice, Floats]:
    """The rows between the first and the last sideways motion, and their distance along the path [m].

    Measured along 500 chords, so that the sensors' noise does not add up.
    """
    length = sideways(recording)
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
