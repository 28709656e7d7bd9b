# SPDX-License-Identifier: BSD-3-Clause
"""100 seeds of one task: a particle of 500 nm goes 5 um under a drift of 1 nm/s. ``make heavy``

At least 95 must end within 100 nm. Prints the share, the worst and the median error, pushes, lines and time. Beside it
naive pushing, which images the particle's surroundings after each push and knows nothing of drift, by rasters of 32
lines: the task must take a quarter of its lines at most.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

from nanotouch.manipulation import Bench, Particles, Pushed, push
from nanotouch.manipulation.pushing import Operator, World, world_of
from test_manipulation_push import latex

SEEDS = 100
RASTER = 32  # lines of an image


class Imaged(World):
    """Its look is a raster; the sphere is fitted to all of its heights."""

    def look(self, guess: np.ndarray, at: np.ndarray) -> np.ndarray:
        """Of the stage; the sample drifts while it is scanned."""
        reach = self.particle.radius + self.particle.tip_radius
        seen = []
        for y in np.linspace(-1.3, 1.3, RASTER) * reach:
            x, z = self.heights(guess + np.array([0.0, y]), 0, at)
            seen += [(px + guess[0], y + guess[1], pz) for px, pz in zip(x, z, strict=True) if pz > 0.5 * reach]
        points = np.array(seen)
        middle = points[:, :2].mean(axis=0)
        x, y, z = (points - [*middle, 0.0]).T
        unknowns = np.stack([2.0 * x, 2.0 * y, np.ones(len(x))], axis=1)
        return middle + np.linalg.lstsq(unknowns, x**2 + y**2 + z**2, rcond=None)[0][:2]


class Naive(Operator):
    """Believes that nothing drifts."""

    def drift_of(self, drift: np.ndarray) -> np.ndarray:
        """None."""
        return np.zeros(2)


def naive(seed: int) -> Pushed:
    """The same task."""
    particle = latex()
    world = world_of(Imaged, Particles(particle), Bench(), [(0.0, 0.0)], seed)
    return Naive(world, np.zeros(2), np.array((5e-6, 0.0)), 0.5 * particle.radius).work((0.0, 0.0), 30e-9, 200)


def told(name: str, done: list[Pushed]) -> tuple[int, float]:
    """How many are within 100 nm, and the mean number of lines."""
    errors = np.array([one.error for one in done])
    within = int(np.count_nonzero(errors < 100e-9))
    lines = float(np.mean([one.lines for one in done]))
    print(
        f"{name}: {within} of {len(done)} within 100 nm; worst {1e9 * errors.max():.1f} nm, "
        f"median {1e9 * np.median(errors):.1f} nm; "
        f"{np.mean([one.pushes for one in done]):.1f} pushes, {lines:.0f} lines, "
        f"{np.mean([one.duration for one in done]):.0f} s"
    )
    return within, lines


def main() -> int:
    within, lines = told("by lines", [push(latex(), (5e-6, 0.0), seed=seed) for seed in range(SEEDS)])
    _, imaged = told("by images", [naive(seed) for seed in range(SEEDS // 5)])
    print(f"{lines / imaged:.3f} of the lines")
    return int(within < 95 or lines > 0.25 * imaged)


if __name__ == "__main__":
    sys.exit(main())
