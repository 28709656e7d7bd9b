# SPDX-License-Identifier: BSD-3-Clause
"""Whether a branch has a free part at all: the baseline of a ramp that begins in contact lies in contact."""

from __future__ import annotations

from dataclasses import replace

from nanotouch.curves import CurveReport

from .models import extension
from .points import Branch
from .result import FitResult

_REASON = "no part of the branch is surely free"


def doubt_free_part(result: FitResult, report: CurveReport, branch: Branch) -> FitResult:
    """The result; or one of which nothing is determined, where the branch begins in contact (nt_fit_begins_in_contact).

    For laws without adhesion.
    """
    line, data = report.baselines[branch], report.branches[branch]
    numbers = (line.force, line.slope, line.z_mean, line.nearest, line.scatter)
    begins, further, left = extension().begins_in_contact(
        data.z, data.force, numbers, report.noise, result.spring_constant
    )
    if not begins or result.reason:
        return result
    note = (
        f"{_REASON}: a contact that begins {further * 1e9:.3g} nm further out describes all of it within "
        f"{left * 1e12:.3g} pN, and the baseline its own part within {line.scatter * 1e12:.3g} pN only; "
        "begin the ramp further away"
    )
    open_now = dict.fromkeys(result.identifiable, False)
    return replace(result, identifiable=open_now, bounds={}, reason=_REASON, notes=(*result.notes, note))
