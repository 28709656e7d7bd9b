# SPDX-License-Identifier: BSD-3-Clause
"""What the panels share: title and legend, signals with their envelope, the lamp."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._io.drawing import ORANGE, PURPLE
from ..touch.record import STATES, Recording

STATE_COLOURS = {1: ORANGE, 2: PURPLE, 3: "#000000"}
LONG = 20_000  # points; of longer records only the extremes are drawn
STRETCHES = 2000  # more than a picture has pixels across


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


def dress(panel: Any, title: str) -> None:
    """Title at the left, legend at the right of the line above the panel, where it hides no data."""
    panel.set_title(title, loc="left", fontsize="medium")
    panel.grid(alpha=0.3)
    panel.legend(loc="lower right", bbox_to_anchor=(1.0, 0.99), ncols=6, frameon=False, fontsize="small")


def signal(panel: Any, data: tuple[Floats, Floats], colour: str, style: Any, label: str) -> None:
    """All samples, pale, and over them their mean over a five-hundredth of the record, in which dashes can be seen.
    Nothing, in the legend either, of what was not measured at all."""
    axis, values = data
    if not np.isfinite(values).any():
        return
    rows = envelope(values)
    if len(values) < 2000:
        panel.plot(axis, values, color=colour, ls=style, lw=1.5, label=label)
        return
    panel.plot(axis[rows], values[rows], color=colour, lw=0.5, alpha=0.35)
    mean = _running_mean(values, (len(values) // 500) | 1)
    few = np.linspace(0, len(values) - 1, 1000).astype(int)
    panel.plot(axis[few], mean[few], color=colour, ls=style, lw=1.6, label=label)


def _running_mean(values: Floats, width: int) -> Floats:
    """Mean over `width` (odd) rows around each, of those that are numbers; shorter at the ends. NaN where none is."""
    is_number = np.isfinite(values)
    total = np.concatenate([[0.0], np.cumsum(np.where(is_number, values, 0.0))])
    count = np.concatenate([[0], np.cumsum(is_number)])
    middle = np.arange(len(values))
    low, high = np.maximum(middle - width // 2, 0), np.minimum(middle + width // 2 + 1, len(values))
    known = count[high] - count[low]
    mean: Floats = np.where(known > 0, (total[high] - total[low]) / np.maximum(known, 1), np.nan)
    return mean


def state_band(panel: Any, recording: Recording, axis: Floats) -> None:
    """Lamp: the stretches in which the loop was not in RUN, behind the curves."""
    if "state" not in recording:
        return
    states = recording.state
    edges = np.flatnonzero(np.diff(states)) + 1
    named: set[int] = set()
    for first, last in zip([0, *edges], [*edges, len(states)], strict=True):
        state = int(states[first])
        if state in STATE_COLOURS:
            label = None if state in named else STATES[state]
            panel.axvspan(axis[first], axis[last - 1], color=STATE_COLOURS[state], alpha=0.25, lw=0.5, label=label)
            named.add(state)
