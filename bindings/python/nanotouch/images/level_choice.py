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


def choose(topography: Topography, used: NDArray[np.bool_] | None) -> tuple[Job, tuple[Candidate, ...]]:
    """The image with the chosen method applied; what was chosen, the runner-up, and the others."""
    plane = Job(topography, used)
    plane.take_out("plane")
    along = plane.look()
    strays = bool(np.median(np.abs(np.diff(along.rows.offsets))) > 0.0)  # rows differ by more than their noise
    bent = Job(topography, used, rows_stray=along.structure and strays)
    bows = drift.bends(plane.strips) and not along.fine
    if bows:
        bent.take_out("poly2")
    first, other = (("poly2", bent), ("plane", plane)) if bows else (("plane", plane), ("poly2", bent))
    listed = [_judged(*first, then) for then in ("lines", "rows", "medians")]
    if not bows:
        bent.take_out("poly2")
    listed.append(_judged(*other, "lines"))
    if listed[0][1].step_kept < _SURVIVES or listed[0][1].rms > _NO_DRIFT * listed[1][1].rms:
        listed[:2] = listed[1::-1]
    return listed[0][0], tuple(candidate for _, candidate in listed)


def _judged(background: str, begun: Job, then: str) -> tuple[Job, Candidate]:
    """A background that was taken out, and the rows after it."""
    begun.look()
    job = begun.copy()
    flat, remove = job.strips, _ROWS[then]
    job.take_out(then)
    offsets = job.offsets
    half = flat[:, 1::2] - remove(flat[:, ::2])[:, None]
    held_out = np.diff(rows.summed(np.diff(half, axis=0)))
    return job, Candidate(
        f"{background}+{then}",
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
