# SPDX-License-Identifier: BSD-3-Clause
"""What kind of adhesion a retraction shows: none, one clean tear of the contact, or something that does not detach."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from .._io.words import counted
from ..units import engineering
from .events import Branch
from .report import CurveReport

Kind = Literal["none", "tear", "held", "unknown"]

_REACH = (
    4.5  # times force over contact slope: JKR, DMT and Maugis-Dugdale let go within 4 (tests/python/test_answer.py)
)


class Adhesion(NamedTuple):
    """The kind of adhesion.

    Attributes
    ----------
    kind : {"none", "tear", "held", "unknown"}
        No dip; one tear of a contact, to which a contact law applies; tethers, several ruptures or a gradual end, of
        which force and work alone are known; no retraction.
    words : str
        The same as a part of a sentence.
    """

    kind: Kind
    words: str


def adhesion_of(report: CurveReport) -> Adhesion:
    """The kind of adhesion of a curve.

    A contact is torn off within a few times the force over the contact's slope of where the force crosses the baseline;
    what holds over longer ways is no contact any more.
    """
    retract = report.branches.get("retract")
    if retract is None:
        return Adhesion("unknown", "no retraction is recorded")
    if report.pull_off_force <= 0.0 or not retract.dips:
        most = report.pull_off_interval[1]
        unit, scale = engineering("N", most)
        return Adhesion("none", f"no adhesion above {most * scale:.3g} {unit} is seen")
    if len(report.ruptures) > 1:
        return Adhesion("held", f"the tip comes off in {counted(len(report.ruptures), 'rupture')}")
    end = _end(report, retract)
    if end is None:
        return Adhesion("held", "the tip comes off gradually")
    way, reach = end - _crossing(retract), report.pull_off_force / retract.contact_slope[0]
    if not reach > 0.0:
        return Adhesion("held", "the tip is torn off a contact whose slope the curve does not show")
    if way > _REACH * reach:
        unit, scale = engineering("m", way)
        return Adhesion("held", f"a tether holds the tip over {way * scale:.3g} {unit}")
    return Adhesion("tear", "the contact is torn off at once")


def _end(report: CurveReport, retract: Branch) -> float | None:
    """z of the only tearing-off [m]; None where there is none."""
    if report.ruptures:
        return report.ruptures[0].z
    return None if retract.tear is None else float(retract.z[retract.tear])


def _crossing(retract: Branch) -> float:
    """z at which the force goes below the baseline [m]."""
    below = np.flatnonzero(retract.force <= 0.0)
    return float(retract.z[below[0]]) if below.size else float(retract.z[-1])
