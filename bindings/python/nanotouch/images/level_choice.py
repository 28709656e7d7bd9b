# SPDX-License-Identifier: BSD-3-Clause
"""Which way of levelling an image gets if none is named, and what the others would give.

Not the smallest roughness decides, which erasing a grating gives: a bow has to show in tiles that were held out, and a
step that is added to the image on trial has to survive. What is drift and what a structure is told in drift.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from . import drift, rows
from ._robust import MAD
from .level_job import Job
from .level_report import Candidate
from .topography import Topography

_SURVIVES = 0.9  # share of the step on trial
_NO_DRIFT = 2.1  # rms with what lasts along y taken out over that with the offsets alone; an oblique step has up to 2
_TRIAL = 12.0  # its height, over the standard deviation from row to row; at least half the rms, and what is taken out
_ROWS = {
    "lines": lambda strips: drift.analyse(strips).offsets,
    "rows": lambda strips: rows.analyse(strips).offsets,
    "medians": rows.medians,
}


def choose(topography: Topography, used: NDArray[np.bool_] | None) -> tuple[Candidate, ...]:
    """What is chosen, the runner-up, and the others."""
    flat = _without("plane", topography, used)
    bent = drift.bends(flat) and not drift.analyse(flat).fine
    background, other = ("poly2", "plane") if bent else ("plane", "poly2")
    listed = [
        _judged(f"{first}+{then}", topography, used)
        for first, then in ((background, "lines"), (background, "rows"), (background, "medians"), (other, "lines"))
    ]
    if listed[0].step_kept < _SURVIVES or listed[0].rms > _NO_DRIFT * listed[1].rms:
        listed[:2] = listed[1::-1]
    return tuple(listed)


def _without(background: str, topography: Topography, used: NDArray[np.bool_] | None) -> Floats:
    job = Job(topography, used)
    job.take_out(background)
    return job.strips


def _judged(method: str, topography: Topography, used: NDArray[np.bool_] | None) -> Candidate:
    job = Job(topography, used)
    background, then = method.split("+")
    job.take_out(background)
    flat, remove = job.strips, _ROWS[then]
    job.take_out(then)
    offsets = remove(flat)
    half = flat[:, 1::2] - remove(flat[:, ::2])[:, None]
    held_out = np.diff(rows.summed(np.diff(half, axis=0)))
    return Candidate(
        method,
        float(np.nanstd(job.strips)),
        float(np.sqrt(np.mean(held_out**2))),
        drift.anisotropy(job.strips),
        _step_kept(flat, offsets, remove),
    )


def _step_kept(flat: Floats, offsets: Floats, remove: object) -> float:
    """Of a step across the rows, two fifths up the image."""
    steps = np.diff(rows.summed(np.diff(flat, axis=0)))
    noise = MAD * float(np.median(np.abs(steps)))
    height = max(_TRIAL * noise, 0.5 * float(np.nanstd(flat)), float(np.ptp(offsets)))
    if height == 0.0:
        return 1.0
    at = 2 * len(flat) // 5
    trial = flat.copy()
    trial[at:] += height
    change = remove(trial) - offsets  # type: ignore[operator]
    reach = min(max(2, len(flat) // 10), at)  # of four rows one lies below
    return 1.0 - float(np.median(change[at : at + reach]) - np.median(change[at - reach : at])) / height
