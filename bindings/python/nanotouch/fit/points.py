# SPDX-License-Identifier: BSD-3-Clause
"""Which points of a branch are fitted, and what is known of them beforehand."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from nanotouch.curves import CurveReport
from nanotouch.curves.flicker import Noise
from nanotouch.errors import InvalidValue

from .models import Floats, Model

Branch = Literal["approach", "retract"]
Window = tuple[float, float]

_FEWEST = 16
_SPREAD_OF_STEP = 12.0**-0.5  # standard deviation of what is equally likely anywhere in a step of 1


@dataclass(frozen=True, eq=False)
class Points:
    """What is fitted.

    Attributes
    ----------
    z, force : ndarray, shape (n,)
        Height of the base [m], from the deepest point outwards; force with its baseline taken off [N].
    noise : float
        Standard deviation from point to point [N].
    free : Noise
        White and flicker noise of the free cantilever [N^2].
    tear : (float, float) or None
        z at which the tip was torn off, and its standard uncertainty [m].
    baseline_z : float
        Where level and tilt of the baseline are not correlated [m].
    level_sigma, tilt_sigma : float
        Their standard uncertainties [N], [N/m].
    """

    z: Floats
    force: Floats
    noise: float
    free: Noise
    tear: tuple[float, float] | None
    baseline_z: float
    level_sigma: float
    tilt_sigma: float

    def kept(self, mask: NDArray[np.bool_], name: str) -> Points:
        """Some of them."""
        if np.count_nonzero(mask) < _FEWEST:
            raise InvalidValue(
                f"{name}: {np.count_nonzero(mask)} points are left to fit; at least {_FEWEST} are needed"
            )
        return replace(self, z=self.z[mask], force=self.force[mask])

    def without_tear(self) -> Points:
        """The same, where the tear is no part of what is asked."""
        return replace(self, tear=None)


def points_of(report: CurveReport, branch: Branch, model: Model, *, window: Window | None, name: str) -> Points:
    """The points of a branch that a model can describe; window: limits of the force [N]."""
    measured = report.branches.get(branch)
    if measured is None:
        raise InvalidValue(f"{name}: no {branch} with force to fit")
    z, force = measured.z, measured.force
    torn = measured.tear if branch == "retract" and model.adhesive else None
    if torn is not None:
        last = torn
    elif measured.dips and model.adhesive:
        last = measured.lowest
    else:
        last = measured.repulsive - 1
    tear = None
    if torn is not None:
        step = float(z[torn + 1] - z[torn])
        tear = (float(z[torn]) + 0.5 * step, _SPREAD_OF_STEP * step)
    baseline = measured.baseline
    level, tilt = np.sqrt(baseline.variance)
    found = Points(z, force, measured.noise, baseline.noise, tear, baseline.z_mean, float(level), float(tilt))
    mask = np.arange(z.size) <= last
    if window is not None:
        mask &= (force >= window[0]) & (force <= window[1])
        found = replace(found, tear=None)
    return found.kept(mask, name)
