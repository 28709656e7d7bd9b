# SPDX-License-Identifier: BSD-3-Clause
"""What happens on one branch: snap-in or pull-off, the tearing-off, the work of adhesion, the slope in contact."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..errors import InvalidValue
from .baseline import EVENT, WAVE, Baseline, Floats, Kind, fit_baseline, point_noise
from .curve import Segment

_END = 0.1  # part of the travel
_NEIGHBOURS = 5
_BEFORE, _AFTER = 0.5, 0.25  # of the depth: a tear leads from below the first past the second within two points


@dataclass(frozen=True, eq=False)
class Branch:
    """An approach or a retraction with its baseline taken off, from the deepest point outwards.

    Attributes
    ----------
    z, force : ndarray, shape (n,)
        Growing height of the base [m], force [N].
    noise : float
        Standard deviation from point to point [N].
    """

    z: Floats
    force: Floats
    baseline: Baseline
    noise: float

    @classmethod
    def of(cls, segment: Segment, kind: Kind, name: str) -> Branch:
        """Find the baseline of a segment and take it off."""
        if segment.force is None:
            raise InvalidValue(f"{name}: no force without a spring constant; give it to curves.read")
        baseline = fit_baseline(segment.z, segment.force, kind)
        order = np.argsort(segment.z, kind="stable")
        force = segment.force - baseline.at(segment.z)
        return cls(segment.z[order], force[order], baseline, point_noise(segment.force))

    @property
    def visible(self) -> float:
        """Smallest force that can be told from the baseline [N]."""
        return max(EVENT * self.noise, WAVE * self.baseline.scatter)

    def sigma(self, z: float) -> float:
        """Standard uncertainty of one force at z [N]."""
        return float(np.hypot(self.noise, self.baseline.sigma(z)))

    @cached_property
    def lowest(self) -> int:
        """The point of the smallest force; not at the far end, where no baseline is left beyond to judge it by."""
        inner = int(np.searchsorted(self.z, self.z[-1] - _END * (self.z[-1] - self.z[0])))
        return int(np.argmin(self.force[:inner]))

    @cached_property
    def dips(self) -> bool:
        """Whether it lies visibly below the baseline: alone, or together with its neighbours."""
        if -self.force[self.lowest] > self.visible:
            return True
        mean = np.convolve(
            self.force[: self.lowest + _NEIGHBOURS], np.full(_NEIGHBOURS, 1.0 / _NEIGHBOURS), mode="valid"
        )
        return bool(-mean.min() > max(EVENT / _NEIGHBOURS**0.5 * self.noise, WAVE * self.baseline.scatter))

    def dip(self) -> tuple[float, float, float]:
        """Depth below the baseline [N], its z [m] and the depth's uncertainty [N]."""
        depth, z = float(-self.force[self.lowest]), float(self.z[self.lowest])
        return (depth, z, self.sigma(z)) if self.dips else (0.0, np.nan, self.sigma(z))

    @cached_property
    def tear(self) -> int | None:
        """The last point before the tip is torn off; None where the force comes back gradually, or not at all.

        It is found by the jump and not as the lowest point, which noise picks among several.
        """
        if not self.dips:
            return None
        depth = -self.force[self.lowest]
        back = np.flatnonzero(self.force[self.lowest :] > -_BEFORE * depth)
        if back.size == 0:
            return None
        after = self.lowest + int(back[0])
        return after - 1 if float(self.force[after : after + 2].max()) > -_AFTER * depth else None

    def adhesion_work(self) -> tuple[float, float]:
        """Area below the baseline from where the force crosses it to its last visible dip, its uncertainty [J]."""
        if not self.dips:
            return 0.0, np.nan
        positive = np.flatnonzero(self.force[: self.lowest] >= 0.0)
        first = int(positive[-1]) + 1 if positive.size else 0
        limit = max(-self.visible, float(self.force[self.lowest]))
        back = self.lowest + np.flatnonzero(self.force[self.lowest :] <= limit)
        part = slice(first, int(back[-1]) + 2)
        z, force = self.z[part], self.force[part]
        steps = np.diff(z)
        level = self.baseline.sigma(float(self.z[self.lowest])) * float(np.ptp(z))
        area = float(np.sum(-0.5 * (force[1:] + force[:-1]) * steps))
        return area, float(np.hypot(level, self.noise * np.sqrt(float(steps @ steps))))

    def contact_slope(self) -> tuple[float, float]:
        """-dF/dz of the upper half of the load [N/m] and its uncertainty."""
        top = float(self.force.max())
        part = self.force > 0.5 * top
        if top <= self.visible or np.count_nonzero(part) < 4:
            return np.nan, np.nan
        x, y = self.z[part] - self.z[part].mean(), self.force[part]
        spread = float(x @ x)
        slope = float(x @ (y - y.mean())) / spread
        rest = y - y.mean() - slope * x
        return -slope, float(np.sqrt(rest @ rest / (x.size - 2) / spread))
