# SPDX-License-Identifier: BSD-3-Clause
"""What a recording shows: its phases, snap-in and pull-off."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .._arrays import Floats
from ..touch.record import Recording


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
    length = sideways(recording)
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


def sideways(recording: Recording) -> Floats:
    """Sideways distance from the start [m], shape (n,)."""
    if "x" not in recording or "y" not in recording or not len(recording):
        return np.zeros(len(recording))
    length: Floats = np.hypot(recording.x - recording.x[0], recording.y - recording.y[0])
    return length
