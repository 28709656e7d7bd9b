# SPDX-License-Identifier: BSD-3-Clause
"""What :func:`nanotouch.curves.analyse` says about a curve."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from .baseline import Baseline
from .events import Branch, Rupture


@dataclass(frozen=True)
class CurveReport:
    """What a curve shows; plain SI floats, NaN where the curve does not show it.

    Attributes
    ----------
    contact_point : float
        z of the base [m] on the approach, coming out of contact: the median of `contact_points`. Its sigma contains
        their standard deviation.
    contact_points : mapping
        By each method that can say [m]: where the force crosses the baseline (``"crossing"``, after a snap-in) or can
        no longer be told from it (``"deviation"``); ``"hertz"``, the foot of F^(2/3) over the indentation;
        ``"two_lines"``, where baseline and a line through the lower half of the load meet; ``"gradient"`` (without a
        snap-in), where the slope leaves that of the baseline.
    snap_in_force, pull_off_force : float
        Depth below the baseline on the approach and on the retraction [N], positive. 0 where no dip is deeper than five
        times the noise and three times the scatter of the baseline.
    snap_in_z, pull_off_z : float
        z of the base there [m]; NaN where there is none.
    pull_off_interval : (float, float)
        95 % interval of `pull_off_force` [N]. A tether that holds to the end of the curve and an offset between the
        branches look the same: it spans both where they cannot be told apart (`notes` says why).
    ruptures : tuple of Rupture
        What tears off on the retraction, from the sample outwards.
    contact_slope : float
        -dF/dz in hard contact (upper half of the load) [N/m]: at most the spring constant, and equal to it on a sample
        that does not deform.
    contact_stiffness : float
        k = k_c s/(k_c - s) of the contact itself, with s the contact slope [N/m]; NaN where s is not below k_c.
    adhesion_work : float
        Area of the retraction below its baseline, over z of the base [J]; 0 without pull-off.
    baseline_tilt : float
        Slope of the approach's baseline (the retraction's where there is no approach) [N/m].
    noise : float
        Standard deviation of the force from point to point [N].
    branches : mapping
        The :class:`Branch` of each: points from the deepest outwards, baseline taken off.
    sigma : mapping
        Standard uncertainties of ``contact_point``, ``snap_in_force``, ``pull_off_force``, ``contact_slope``,
        ``contact_stiffness``, ``adhesion_work``:
        statistical, without those of the spring constant and the sensitivity.
    notes : tuple of str
        What the reader should know before using the numbers.
    """

    contact_point: float
    snap_in_force: float
    snap_in_z: float
    pull_off_force: float
    pull_off_z: float
    contact_slope: float
    contact_stiffness: float
    adhesion_work: float
    baseline_tilt: float
    noise: float
    branches: Mapping[str, Branch]
    sigma: Mapping[str, float]
    contact_points: Mapping[str, float]
    pull_off_interval: tuple[float, float] = (math.nan, math.nan)
    ruptures: tuple[Rupture, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def baselines(self) -> dict[str, Baseline]:
        """The :class:`Baseline` of ``"approach"`` and ``"retract"``, as far as there are such segments."""
        return {role: branch.baseline for role, branch in self.branches.items()}

    def __str__(self) -> str:
        return (
            f"pull-off {_in_nn(self.pull_off_force, self.sigma['pull_off_force'])}, "
            f"snap-in {_in_nn(self.snap_in_force, self.sigma['snap_in_force'])}, "
            f"contact slope {self.contact_slope:.3g} N/m, noise {self.noise * 1e12:.3g} pN"
            + "".join(f"; {note}" for note in self.notes)
        )


def _in_nn(value: float, sigma: float) -> str:
    return f"({value * 1e9:.4g} +- {sigma * 1e9:.2g}) nN"
