# SPDX-License-Identifier: BSD-3-Clause
"""What is drawn of a contact, from C, so that every front end draws the same: the force curve with its folds, and the
section through tip and sample as they are deformed."""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, as_floats
from nanotouch.errors import InvalidValue
from nanotouch.scene import Scene
from nanotouch.scene.plan import Plan

POINTS = 200


class Curve(NamedTuple):
    """Force against gap of a plan; rows of gap [m] and force [N], none where there is no such part."""

    apart: Floats
    """the way in, downwards, to where adhesion takes hold, or to first touch"""
    attached: Floats
    """the way out, upwards, to the fold where it lets go"""
    unstable: Floats
    """between the folds: equilibria that nothing can hold"""


class Section(NamedTuple):
    """A section through the contact, heights over the undeformed sample [m]."""

    r: Floats
    """distance from the axis [m]"""
    tip: Floats
    """lower side of the tip as it is deformed; infinite where there is none"""
    sample: Floats
    """sample as it is deformed"""
    rigid_tip: Floats
    """the tip as it would be undeformed"""
    contact_radius: float
    """a [m]; 0 where the bodies do not touch"""
    cohesive_radius: float
    """c, where the adhesive zone ends [m]"""
    attached: bool
    """adhesion has taken hold, or the bodies touch"""


def curve(plan: Plan, nearest: float, farthest: float, points: int = POINTS) -> Curve:
    """The law of a plan between two gaps [m] over a flat, with its folds."""
    if not farthest > nearest:
        raise InvalidValue(f"farthest = {farthest:g} m: it must be above nearest, {nearest:g} m")
    if points < 2:
        raise InvalidValue(f"points = {points}: valid is 2 or more")
    return Curve(*(_core.view_curve(plan.core, part, nearest, farthest, points) for part in range(3)))


def section(plan: Plan, scene: Scene, gap: float, force: float, r: ArrayLike) -> Section:
    """Tip and sample as they are deformed, at distances r >= 0 from the axis [m].

    Of the branches that the law has at a gap [m] the one is drawn whose force is nearest to ``force`` [N].
    """
    distance = as_floats(r, "r")
    pose = (gap, force, _core.view_tip_share(scene.core))
    rows, contact_radius, cohesive_radius, attached = _core.view_section(plan.core, pose, distance)
    tip, sample, rigid = rows.T
    return Section(distance, tip, sample, rigid, contact_radius, cohesive_radius, attached)
