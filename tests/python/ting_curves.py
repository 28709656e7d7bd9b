# SPDX-License-Identifier: BSD-3-Clause
"""Force curves of power-law samples in closed form (Lee and Radok; Ting; Efremov et al. 2017), as a file would hold
them: free parts, a lever that bends, noise. Nothing of the library's own forces is in them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from nanotouch.curves import ForceCurve, Segment
from numpy.typing import NDArray
from scipy.special import beta as beta_function
from scipy.special import betainc

Floats = NDArray[np.float64]
RADIUS, STIFFNESS, POISSON = 2.5e-6, 0.06, 0.5


@dataclass(frozen=True)
class Sample:
    """A ramp of constant speed of the indentation, down to `depth` and back; SI."""

    modulus: float
    exponent: float
    speed: float = 1e-6
    depth: float = 1e-6
    power: float = 1.5
    scale: float = 4.0 / 3.0 * RADIUS**0.5
    """elastic law over E*: scale delta^power"""

    def loop(self, points: int) -> tuple[Floats, Floats, Floats]:
        """Time, indentation and force of both branches, from the first point in contact on."""
        n, v, top = self.power, self.speed, self.depth / self.speed
        whole = self.scale / (1 - POISSON**2) * self.modulus * n * v**n * beta_function(n, 1 - self.exponent)
        time = np.arange(1, 2 * points + 1) * top / points
        last = time - 2.0 ** (1 / (1 - self.exponent)) * np.clip(time - top, 0.0, None)
        part = betainc(n, 1 - self.exponent, np.clip(last / time, 0.0, 1.0))
        return time, self.depth - np.abs(time - top) * v, whole * time ** (n - self.exponent) * part

    def with_peak(self, force: float) -> Sample:
        """The same with the modulus that makes this the greatest force [N]."""
        return Sample(
            self.modulus * force / float(self.loop(2)[2].max()), self.exponent, self.speed, self.depth, self.power,
            self.scale,
        )  # fmt: skip


def curve_of(
    sample: Sample, points: int = 2000, *, noise: float = 0.0, drag: float = 0.0, seed: int = 0, times: bool = True
) -> ForceCurve:
    """`points` for each branch, half of them free; `drag` [N s/m] over the base's speed."""
    inside = points // 2
    time, depth, force = sample.loop(inside)
    step = time[1] - time[0]
    free = sample.speed * step * np.arange(1, points - inside + 1)
    depth = np.concatenate([depth[0] - free[::-1], depth, depth[-1] - free])
    force = np.concatenate([0.0 * free, force, 0.0 * free])
    base = depth + force / STIFFNESS
    time = step * np.arange(base.size)
    turn = points - inside + inside
    force = force + drag * np.gradient(base, time, edge_order=1) * np.where(np.arange(base.size) == turn, 0.0, 1.0)
    force = force + noise * np.random.default_rng(seed).normal(size=force.size)
    z = base.max() - base
    parts = [
        Segment(role, (time if times else np.full_like(time, np.nan))[part], z[part], "height (measured)", force[part],
                force[part] / STIFFNESS)
        for role, part in (("approach", slice(0, turn)), ("retract", slice(turn, None)))
    ]  # fmt: skip
    return ForceCurve(tuple(parts), {"spring constant": STIFFNESS, "sensitivity": 5e-8}, "synthetic")
