# SPDX-License-Identifier: BSD-3-Clause
"""Make an image touchable without inventing or erasing structure: take out tilt, bow, drift and offsets of rows.

Every method but one is aware of steps. Tilt and bow are what the flat pieces of the surface agree on (terraces.py).
Offsets of rows are what does not last and what both halves of the image agree on (rows.py). Drift is what lasts and
the surface does not show the other way (drift.py). Each says what it removed, and warns where it had to leave, or has
taken, what may be a structure. The everyday method, "auto", chooses among them (level_choice.py).
"""

from __future__ import annotations

import re
import warnings
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValue
from . import terraces
from ._robust import used_pixels
from .despeckling import DespeckleReport, despeckle
from .level_choice import choose
from .level_job import Job
from .level_report import Candidate, LevelReport
from .topography import READY, Topography

_METHOD = re.compile(r"plane|poly[2-6]|lines|rows|medians|terraces")


def prepare(
    topography: Topography, method: str = "auto"
) -> tuple[Topography, tuple[LevelReport | DespeckleReport, ...]]:
    """Level and despeckle: what ``nanotouch touch`` does to an image before it is touched.

    Parameters
    ----------
    topography : Topography
        The image.
    method : str
        As for :func:`level`, or ``"none"``, which only despeckles. ``"auto"`` does nothing to the channel
        :data:`READY`, which ``nanotouch scan`` writes.
    """
    if method == "auto" and topography.channel == READY:
        return topography, ()
    if method == "none":
        clean, despeckle_report = despeckle(topography)
        return clean, (despeckle_report,)
    levelled, level_report = level(topography, method)
    clean, despeckle_report = despeckle(levelled)
    return clean, (level_report, despeckle_report)


def level(
    topography: Topography, method: str = "auto", mask: NDArray[np.bool_] | None = None
) -> tuple[Topography, LevelReport]:
    """Take out tilt, bow, drift and offsets of rows and the mean height, keeping every step.

    Parameters
    ----------
    topography : Topography
        The image.
    method : str
        ``auto``: a plane, or ``poly2`` where a bow shows in tiles that were held out; then ``lines``, or ``rows`` where
        a step that is added on trial would not survive that. The report says what the runner-up would have given. Or
        one of these, or several joined by ``+`` and done in that order, as ``"plane+rows"`` (after lines or rows the
        background before them is fitted once more):

        ==============  ==============================================================================================
        ``plane``       the tilt that the flat pieces of the surface agree on
        ``poly2``       a polynomial of total order 2 (up to ``poly6``) in the same way: the bow of a scanner
        ``lines``       offsets and drift of rows, as far as they are no structure
        ``rows``        offsets from row to row alone; what lasts stays
        ``medians``     every row to the same median, whatever that erases; warns where it is a structure
        ``terraces``    as ``plane``; height 0 is the largest level, and the levels are listed in the report
        ==============  ==============================================================================================
    mask : ndarray, shape (ny, nx), bool, optional
        True where a pixel shall not take part; pixels that were filled in never do.

    Returns
    -------
    topography : Topography
        Mean height of the pixels that took part 0 (with ``terraces``: the largest level).
    report : LevelReport
        What was removed; its warnings are given as :class:`UserWarning` too.
    """
    methods = method.split("+") if isinstance(method, str) else [""]
    if method != "auto" and not all(_METHOD.fullmatch(m) for m in methods):
        raise InvalidValue(
            f"method: {method!r}, expected auto, or plane, poly2 .. poly6, lines, rows, medians or terraces, or "
            "several of them joined by +"
        )
    used = used_pixels(topography, mask, terraces.SMALLEST_PIECE)
    candidates: tuple[Candidate, ...] = ()
    if method == "auto":
        job, candidates = choose(topography, used)
    else:
        job = Job(topography, used)
        for name in methods:
            job.take_out(name)
    levelled, report = job.result(method)
    for text in report.warnings:
        warnings.warn(text, stacklevel=2)
    return levelled, replace(report, candidates=candidates)
