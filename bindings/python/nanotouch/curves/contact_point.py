# SPDX-License-Identifier: BSD-3-Clause
"""Where a branch comes out of contact, by several published methods, none of which is right for every curve.

All take a branch from its largest force outwards, its baseline taken off.

* ``crossing`` (after a snap-in): the force crosses the baseline.
* ``deviation`` (without one): the last point above the noise.
* ``gradient`` (without one): where the smoothed slope leaves that of the baseline.
* ``two_lines``: baseline and a line through the load meet.
* ``hertz``: with F^(2/3) proportional to the indentation, z = z0 - alpha F^(2/3) - F/k_c, its z0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_CANDIDATES = 17  # of the place where two lines meet, in each of
_ROUNDS = 4  # rounds, each of which narrows it by 8
_STEEP = 5.0  # standard deviations of the baseline's own slope


@dataclass(frozen=True, eq=False)
class Outward:
    """From the largest force outwards.

    Attributes
    ----------
    z, force : ndarray, shape (n,)
        z [m] grows; the force is over the baseline [N].
    crossing : int
        The first point at or below the level where contact is taken to end.
    visible : float
        Smallest force that can be told from the baseline [N].
    stiffness : float or None
        k_c [N/m].
    adhesive : bool
        Whether the branch dips below the baseline.
    """

    z: Floats
    force: Floats
    crossing: int
    visible: float
    stiffness: float | None
    adhesive: bool


def others(branch: Outward) -> dict[str, float]:
    """z of the contact point [m] by each method besides the first; without those that cannot say."""
    found = {"hertz": _hertz(branch)}
    if branch.adhesive:
        found["two_lines"] = _line_down(branch)
    else:
        found["two_lines"] = _hinge(branch)
        found["gradient"] = _gradient(branch)
    low, high = float(branch.z[0]), float(branch.z[-1])
    return {name: z for name, z in found.items() if low < z <= high}


def _load(branch: Outward) -> slice:
    """The lower half of the load, where contact has begun and is still the same contact."""
    force = branch.force[: branch.crossing]
    above = np.flatnonzero(force > 0.5 * force[0])
    return slice(int(above[-1]) if above.size else 0, branch.crossing)


def _line_down(branch: Outward) -> float:
    part = _load(branch)
    z, force = branch.z[part], branch.force[part]
    if z.size < 4:
        return np.nan
    slope, level = np.polyfit(z - z[0], force, 1)
    return float(z[0] - level / slope) if slope < 0.0 else np.nan


def _hinge(branch: Outward) -> float:
    """F = max(0, s (z0 - z)) with the least sum of squares, through the lower half of the load and as far beyond."""
    start = _load(branch).start
    stop = min(branch.z.size, start + 2 * (branch.crossing - start) + 8)
    z, force = branch.z[start:stop], branch.force[start:stop]
    low, high = float(z[0]), float(z[-1])
    best = np.nan
    for _ in range(_ROUNDS):
        tried = np.linspace(low, high, _CANDIDATES)
        above = np.clip(tried[:, None] - z, 0.0, None)
        gain = np.clip(above @ force, 0.0, None) ** 2 / np.maximum(
            (above**2).sum(1), 1e-300
        )  # drop of the sum of squares
        best = float(tried[int(np.argmax(gain))])
        step = float(tried[1] - tried[0])
        low, high = best - step, best + step
    return best


def _gradient(branch: Outward) -> float:
    """From outside, the first block of points that is steeper than the baseline's blocks are."""
    size = max(8, branch.z.size // 100)
    blocks = branch.z.size // size
    if blocks < 8:
        return np.nan
    z = branch.z[: blocks * size].reshape(blocks, size)
    force = branch.force[: blocks * size].reshape(blocks, size)
    x = z - z.mean(1, keepdims=True)
    slope = -(x * force).sum(1) / (x**2).sum(1)
    outside = slope[z[:, 0] > branch.z[branch.crossing]]
    if outside.size < 4:
        return np.nan
    steep = np.flatnonzero(slope > _STEEP * float(outside.std()))
    return float(z[steep[-1]].mean()) if steep.size else np.nan


def _hertz(branch: Outward) -> float:
    force, z = branch.force[: branch.crossing], branch.z[: branch.crossing]
    part = force > branch.visible
    if branch.stiffness is None or np.count_nonzero(part) < 8:
        return np.nan
    force = force[part]
    slope, level = np.polyfit(force ** (2 / 3), z[part] + force / branch.stiffness, 1)
    return float(level) if np.isfinite(slope) else np.nan
