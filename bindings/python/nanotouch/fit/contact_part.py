# SPDX-License-Identifier: BSD-3-Clause
"""Two arrays of which a part is free: where contact ends, and the baseline that the free cantilever shows beyond.

No contact model has the points beyond a tear on its branch: fitted with the others they bend the law.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from nanotouch.curves.flicker import Noise, point_noise

from .models import Floats
from .points import Points

_CLEAR = 5.0  # standard deviations of the noise: one point in 2e6 lies as low without a dip
_OF_FEW = 15.0  # more of them where few points tell the noise: over the square root of their number
_FREE = 5  # points beyond the tear, at least
_RETURN = 0.75  # part of its depth that the force makes up within two points
_FLAT, _FLAT_PART = 3.0, 0.1  # scatter of the free part, over the noise and over the jump
_SURE = 2.0  # standard deviations of a slope
_SPREAD_OF_STEP = 12.0**-0.5  # standard deviation of what is equally likely anywhere in a step of 1
_PARTS, _OF_PART = 8, 5  # of the free part, and points of each, in which it is compared with its baseline
_SMOOTH, _SURELY = 0.5, 5.0  # of the noise, and standard deviations of a mean of it
_DIGITS = 1e-9  # of the largest force: a computed curve has no less noise than this


@dataclass(frozen=True, eq=False)
class Contact:
    """The points up to where contact ends, and the baseline taken off them.

    `level` [N] is that at ``points.baseline_z``, `tilt` in N/m; `torn`: the force jumps from below back to it;
    `is_level`: nothing but noise is left of the free part.
    """

    points: Points
    level: float
    tilt: float
    torn: bool
    is_level: bool


def contact_of(position: Floats, force: Floats, noise: float, *, offset: bool, tilt: bool) -> Contact | None:
    """The points in contact, the baseline of those beyond taken off; None where no end is straight.

    The tear's place is a datum where the arrays run as a retraction does, away from the sample: an approach jumps into
    contact elsewhere than where a retraction leaves it.
    """
    order = np.argsort(-position, kind="stable")
    z, ordered = -position[order], force[order]
    found = _end(ordered, noise)
    if found is None:
        return None
    last, scatter, torn = found
    baseline = _Level(z[last + 1 :], ordered[last + 1 :], scatter, offset, tilt)
    step = float(z[last + 1] - z[last])
    retracted = float(np.sum(np.sign(np.diff(position)))) < 0.0
    points = Points(
        z=z[: last + 1],
        force=ordered[: last + 1] - baseline.at(z[: last + 1]),
        noise=scatter,
        free=Noise(scatter**2, 0.0),
        tear=(float(z[last]) + 0.5 * step, _SPREAD_OF_STEP * step) if retracted and torn else None,
        baseline_z=baseline.middle,
        level_sigma=baseline.level_sigma,
        tilt_sigma=baseline.tilt_sigma,
    )
    return Contact(points, baseline.level, baseline.tilt, torn, baseline.is_all(scatter))


def _end(force: Floats, noise: float) -> tuple[int, float, bool] | None:
    """The last point before a straight free part, its noise [N], and whether the force jumps there.

    The noise is that of the free part: in contact the slope from point to point may exceed it.
    """
    level = float(np.median(force[-max(_FREE, force.size // 10) :]))
    lowest = int(np.argmin(force))
    half = force[lowest] + 0.5 * (level - force[lowest])
    last = lowest + int(np.argmax(force[lowest:] > half)) - 1
    beyond = force[last + 3 :]
    torn = _straight(beyond, noise, level - force[lowest])
    if torn is not None and level - force[lowest] > (_CLEAR + _OF_FEW / beyond.size**0.5) * torn:
        jumps = float(force[last + 1 : last + 3].max()) - force[lowest] > _RETURN * (level - force[lowest])
        return (last, torn, True) if jumps else None
    below = np.flatnonzero(force <= level)
    if below.size == 0 or below[0] == 0 or not _levels_off(force, int(below[0])):
        return None
    free = _straight(force[below[0] :], noise, float(np.ptp(force)))
    return None if free is None else (int(below[0]) - 1, free, False)


def _levels_off(force: Floats, first: int) -> bool:
    """Whether the end from a point on is surely flatter than as many points before it: else contact just goes on."""
    count = min(first, force.size - first)
    if count < 2:
        return False
    x = np.linspace(-1.0, 1.0, count)
    rises, errors = [], []
    for part in (force[first - count : first], force[first : first + count]):
        line = np.polynomial.Polynomial.fit(x, part, 1)
        rises.append(2.0 * float(line.convert().coef[-1]) if line.degree() else 0.0)
        errors.append(float(point_noise(part)) * (12.0 / count) ** 0.5)
    return bool(abs(rises[1]) + _SURE * errors[1] < 0.5 * abs(rises[0]))


def _straight(force: Floats, noise: float, depth: float) -> float | None:
    """The noise of a free part [N]; None where it is not straight, beside a jump of this depth [N]."""
    if force.size < _FREE:
        return None
    noise = max(noise or point_noise(force), _DIGITS * depth)
    x = np.linspace(-1.0, 1.0, force.size)
    scatter = float(np.std(force - np.polynomial.Polynomial.fit(x, force, 1)(x)))
    return noise if scatter < _FLAT * noise + _FLAT_PART * depth else None


class _Level:
    """Level and tilt of the free part, as far as they are asked for; `middle` is where they are independent [m]."""

    def __init__(self, z: Floats, force: Floats, noise: float, offset: bool, tilt: bool) -> None:
        z, force = z[1:], force[1:]  # the first may still be on its way
        self.middle = float(z.mean())
        spread = z - self.middle
        self.level = float(force.mean()) if offset else 0.0
        self.tilt = float(spread @ force / (spread @ spread)) if tilt else 0.0
        self.level_sigma = noise / z.size**0.5 if offset else 0.0
        self.tilt_sigma = noise / float(spread @ spread) ** 0.5 if tilt else 0.0

        self.left = force - self.at(z)

    def at(self, z: Floats) -> Floats:
        return self.level + self.tilt * (z - self.middle)

    def is_all(self, noise: float) -> bool:
        """Whether the free part holds no tilt, bow or wave beside it: its parts have the mean of noise."""
        parts = np.array_split(self.left, min(_PARTS, max(1, self.left.size // _OF_PART)))
        return all(abs(float(part.mean())) < noise * (_SMOOTH + _SURELY / part.size**0.5) for part in parts)
