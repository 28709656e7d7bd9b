# SPDX-License-Identifier: BSD-3-Clause
"""Whether a branch has a free part at all: the baseline of a ramp that begins in contact lies in contact."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from nanotouch.curves import CurveReport

from .points import Branch
from .result import FitResult

_SCATTER = 4.0  # times the noise from point to point: below, nothing hides in the free part
_BETTER = 0.5  # of the scatter about the baseline: what a contact from further out must leave less than
_OUTER = 0.5  # of the free part, in which that contact must begin
_PLACES, _POINTS = 40, 600  # contact points that are tried, on so many points
_REASON = "no part of the branch is surely free"


def doubt_free_part(result: FitResult, report: CurveReport, branch: Branch) -> FitResult:
    """The result; or one of which nothing is determined, where contact from further out, over a level baseline,
    describes the whole branch much better than the baseline describes its own part.

    For laws without adhesion. Hertz' power of 3/2 tells contact from a straight line well enough for all of them.
    """
    baseline, data = report.baselines[branch], report.branches[branch]
    free = data.z >= baseline.nearest
    if not (baseline.scatter > _SCATTER * report.noise > 0.0 and free.sum() > _PLACES) or result.reason:
        return result
    apart = max(1, data.z.size // _POINTS)
    line = baseline.force + baseline.slope * (data.z - baseline.z_mean)  # is off the force
    depth, force = -data.z[::apart], (data.force + line)[::apart]
    outer, inner = float(depth.min()), float(-baseline.nearest)
    bend = (force - float(np.median(force[depth < outer + 0.02 * np.ptp(depth)]))) / result.spring_constant
    left = [
        (_left(np.clip(depth - start - bend, 0.0, None) ** 1.5, force), start)
        for start in np.linspace(outer, inner, _PLACES)
    ]
    least, start = min(left)
    if least > _BETTER * float(np.std(data.force[free])) or start > outer + _OUTER * (inner - outer):
        return result
    note = (
        f"{_REASON}: a contact that begins {(inner - start) * 1e9:.3g} nm further out describes all of it within "
        f"{least * 1e12:.3g} pN, and the baseline its own part within {baseline.scatter * 1e12:.3g} pN only; "
        "begin the ramp further away"
    )
    open_now = dict.fromkeys(result.identifiable, False)
    return replace(result, identifiable=open_now, bounds={}, reason=_REASON, notes=(*result.notes, note))


def _left(law: np.ndarray, force: np.ndarray) -> float:
    """RMS of what a level and a multiple of the law leave [N]."""
    columns = np.column_stack([np.ones_like(law), law])
    return float(np.sqrt(np.mean((force - columns @ np.linalg.lstsq(columns, force, rcond=None)[0]) ** 2)))
