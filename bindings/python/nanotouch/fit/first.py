# SPDX-License-Identifier: BSD-3-Clause
"""The law to begin with, by what a curve shows: adhesion, the kind of tip, how soft the contact is."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from nanotouch.curves import CurveReport
from nanotouch.curves.adhesion import adhesion_of

from .models import title_of

AUTO = "auto"
_JKR, _DMT = 5.0, 0.05  # lambda from where, and up to where, they are Maugis-Dugdale (their `valid`)
_BETWEEN = 1.75  # pi w R: between the pull-off forces of DMT and JKR
_SURE = 0.9  # contact slope over spring constant from where a contact is stiff whatever the sensitivity


class FirstChoice(NamedTuple):
    """A law, the branch it is fitted to, and why."""

    model: str
    branch: Literal["approach", "retract"]
    words: str


def first_choice(
    report: CurveReport,
    spring_constant: float,
    radius: float,
    cohesive_range: float,
    *,
    sharp: bool = False,
    layer: bool = False,
    branch: Literal["approach", "retract"] | None = None,
) -> FirstChoice:
    """The law to begin with.

    Parameters
    ----------
    report : CurveReport
        Of the curve.
    spring_constant, radius, cohesive_range : float
        k_c [N/m], R [m] and h0 [m]: whether an adhesive contact is soft depends on them.
    sharp : bool
        The tip is a cone (its half angle was given).
    layer : bool
        The sample is a layer (its thickness was given).
    branch : {"approach", "retract"}, optional
        The only one that is wanted.
    """
    found = adhesion_of(report)
    pushed = branch or ("approach" if "approach" in report.branches else "retract")
    name = ("layer_cone" if sharp else "layer") if layer else "cone" if sharp else "hertz"
    if found.kind == "tear" and not sharp and not layer and branch != "approach":
        transition = _transition(report, spring_constant, radius, cohesive_range)
        soft, model = (  # Maugis-Dugdale holds for all: it is left to the fit where the slope does not tell
            ("soft", "jkr") if transition >= _JKR
            else ("stiff", "dmt") if 0.0 < transition <= _DMT
            else ("neither soft nor stiff", "maugis")
        )  # fmt: skip
        about = (
            f"{soft} (lambda about {transition:.2g})"
            if transition > 0.0
            else "of a stiffness that this slope does not tell"
        )
        return FirstChoice(model, "retract", f"{found.words} and is {about}: {title_of(model)} on the retraction")
    where = "approach" if pushed == "approach" else "retraction, where it repels"
    reason = {
        "tear": "a law with adhesion needs the retraction, a round tip and a half-space",
        "held": "no law of one contact describes that",
        "none": "a law without adhesion",
        "unknown": "a law without adhesion",
    }[found.kind]
    return FirstChoice(name, pushed, f"{found.words}, {reason}: {title_of(name)} on the {where}")


def _transition(report: CurveReport, spring_constant: float, radius: float, cohesive_range: float) -> float:
    """Maugis' lambda from the slope of the contact at the largest load; 0 where the lever is too soft to show it."""
    retract = report.branches["retract"]
    slope = retract.contact_slope[0]
    if not 0.0 < slope < _SURE * spring_constant:
        return 0.0
    stiffness = slope / (1.0 - slope / spring_constant)
    load = float(np.max(retract.force)) + report.pull_off_force
    modulus = (stiffness**3 / (6.0 * radius * load)) ** 0.5  # Hertz: k^3 = 6 E*^2 R F
    work = report.pull_off_force / (_BETWEEN * np.pi * radius)
    k = 4.0 / 3.0 * modulus
    return float(2.0 * work / cohesive_range * (radius / (np.pi * work * k**2)) ** (1.0 / 3.0))
