# SPDX-License-Identifier: BSD-3-Clause
"""What happens on one branch: snap-in or pull-off, the tearing-off, the work of adhesion, the slope in contact."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from .. import _core
from ..errors import InvalidValue
from .baseline import Baseline, Floats, Kind, choice_of
from .curve import Segment


@dataclass(frozen=True, eq=False)
class Branch:
    """An approach or a retraction with its baseline taken off, from the deepest point outwards.

    Attributes
    ----------
    z, force : ndarray, shape (n,)
        Growing height of the base [m], force [N].
    baseline : Baseline
        What was taken off.
    noise : float
        Standard deviation from point to point [N].
    visible : float
        Smallest force that can be told from the baseline [N].
    lowest : int
        The point of the smallest force; not at the far end, where no baseline is left beyond to judge it by.
    dips : bool
        Whether it lies visibly below the baseline: alone, or together with its neighbours.
    tear : int or None
        The last point before the tip is torn off; None where the force comes back gradually, or not at all. It is found
        by the jump and not as the lowest point, which noise picks among several.
    repulsive : int
        How many points a law without attraction can describe.
    dip : (float, float, float)
        Depth below the baseline [N], its z [m] and the depth's uncertainty [N].
    adhesion_work : (float, float)
        Area below the baseline from where the force crosses it to its last visible dip, its uncertainty [J].
    contact_slope : (float, float)
        -dF/dz of the upper half of the load [N/m] and its uncertainty.
    """

    z: Floats
    force: Floats
    baseline: Baseline
    noise: float
    visible: float
    lowest: int
    dips: bool
    tear: int | None
    repulsive: int
    dip: tuple[float, float, float]
    adhesion_work: tuple[float, float]
    contact_slope: tuple[float, float]

    def sigma(self, z: float) -> float:
        """Standard uncertainty of one force at z [N]."""
        return math.hypot(self.noise, self.baseline.sigma(z))

    @classmethod
    def found(cls, read: Mapping[str, Any]) -> Branch:
        """From what the C library read."""
        return cls(**(dict(read) | {"baseline": Baseline.of(read["baseline"])}))

    @classmethod
    def of(cls, segment: Segment, kind: Kind, name: str) -> Branch:
        """Find the baseline of a segment and take it off."""
        z, force = arrays_of(segment, name)
        return cls.found(_core.read_branch(z, force, choice_of(kind)))


class Rupture(NamedTuple):
    """One tearing-off on the retraction.

    Attributes
    ----------
    z : float
        Of the base right before it [m].
    force : float
        Depth below the baseline right before it, positive [N].
    slope : float
        dF/dz of the straight piece before it [N/m]; about minus the spring constant where the tip was held fast.
    step : float
        By which the force rises within a few points [N].
    """

    z: float
    force: float
    slope: float
    step: float


def arrays_of(segment: Segment, name: str) -> tuple[Floats, Floats]:
    """Height [m] and force [N] of a segment of the curve `name`."""
    if segment.force is None:
        raise InvalidValue(f"{name}: no force without a spring constant; give it to curves.read, or --spring-constant")
    return segment.z, segment.force
