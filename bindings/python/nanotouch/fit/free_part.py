# SPDX-License-Identifier: BSD-3-Clause
"""Whether a branch has a free part at all: the baseline of a ramp that begins in contact lies in contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nanotouch.curves import CurveReport

from .models import extension
from .points import Branch
from .result import FitResult
from .show import newton

_REASON = "no part of the branch is surely free"


def doubt_free_part(result: FitResult, report: CurveReport, branch: Branch, power_sigma: float) -> FitResult:
    """The result; or one of which nothing is determined, where the branch begins in contact (nt_fit_begins_in_contact).

    For laws without adhesion.
    """
    line, data = report.baselines[branch], report.branches[branch]
    numbers = (line.force, line.slope, line.z_mean, line.nearest, line.scatter)
    begins, further, left = extension().begins_in_contact(
        data.z, data.force, numbers, report.noise, result.spring_constant
    )
    if not begins:
        return _doubt_branches(result, report, power_sigma)
    note = (
        f"{_REASON}: a contact that begins {further * 1e9:.3g} nm further out describes all of it within "
        f"{left * 1e12:.3g} pN, and the baseline its own part within {line.scatter * 1e12:.3g} pN only; "
        "begin the ramp further away"
    )
    open_now = dict.fromkeys(result.identifiable, False)
    return replace(result, identifiable=open_now, bounds={}, reason=_REASON, notes=(*result.notes, note))


def _doubt_branches(result: FitResult, report: CurveReport, power_sigma: float) -> FitResult:
    """What both branches say against a contact that is elastic and does not adhere (nt_fit_branch_doubts)."""
    approach, retract = report.branches.get("approach"), report.branches.get("retract")
    if approach is None or retract is None or np.isnan(power_sigma):
        return result
    fitted = (result.spring_constant, result.values["contact_point"], power_sigma)
    doubts, kept_back = extension().branch_doubts(approach, retract, len(report.ruptures), fitted)
    said = []
    if doubts & extension().flags["adhesive"]:
        said.append((
            "the contact adheres, this law does not",
            f"the tip snaps in with {newton(report.snap_in_force)} and is torn off with "
            f"{newton(report.pull_off_force)}: fit a law with adhesion (dmt, jkr, maugis)",
        ))  # fmt: skip
    if doubts & extension().flags["hysteresis"]:
        said.append((
            "approach and retraction differ in contact",
            f"the retraction keeps back {100 * kept_back:.0f} % of the work that the approach puts in: a sample that "
            "flows, friction or drift; E* of an elastic law depends on the speed",
        ))  # fmt: skip
    if not said:
        return result
    known = {name: is_known and name != "effective_modulus" for name, is_known in result.identifiable.items()}
    return replace(result, identifiable=known, bounds={}, reason=result.reason or said[0][0],
                   notes=(*result.notes, *(note for _, note in said)))  # fmt: skip
