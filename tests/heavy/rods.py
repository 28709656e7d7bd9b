# SPDX-License-Identifier: BSD-3-Clause
"""Random rods, tips, levers and ways: does each step find a balance, is energy kept, is no push beyond q L?

Run: python tests/heavy/rods.py [SECONDS] [SEED]
"""

from __future__ import annotations

import math
import sys
import time

import numpy as np
from nanotouch.errors import Error, InvalidValue
from nanotouch.manipulation import Rod


def rod_of(rng: np.random.Generator) -> Rod | None:
    """None where the tip would go through it."""
    length = 10 ** rng.uniform(-6.6, -5.3)
    radius = length / rng.uniform(4, 80)
    tip = radius * 10 ** rng.uniform(-1, 1)
    lever = 0.0 if rng.random() < 0.4 else 10 ** rng.uniform(0, 3)
    try:
        return Rod(length, radius, 70e9, 10e9, 10 ** rng.uniform(-2.5, -0.7), 10 ** rng.uniform(5.5, 7.5), tip,
                   float(rng.choice([0.0, 0.1, 0.26, 0.6, 1.2])), 10 ** rng.uniform(0, 4), lever,
                   int(rng.choice([8, 24, 60])), min(radius, tip) / rng.uniform(5, 40))  # fmt: skip
    except InvalidValue:
        return None


def main(seconds: float, seed: int) -> int:
    """One line; 1 where something is wrong."""
    rng, end = np.random.default_rng(seed), time.monotonic() + seconds
    rods = ways = lost = through = 0
    off = most = 0.0
    while time.monotonic() < end:
        rod = rod_of(rng)
        if rod is None:
            continue
        rods += 1
        x, y = float(rng.choice([0.0, 3e-6, 5e-5, -2e-4])), float(rng.choice([0.0, 3e-6, 5e-5]))
        angle = float(rng.choice([0.0, 0.5 * math.pi, rng.uniform(0, 6)]))
        far = 2.0 * rod.length
        state = rod.place(x, y, angle, (x + float(rng.choice([0.0, far])), y + far, rng.uniform(0, 2.0 * rod.radius)))
        heat = turnover = 0.0
        for _ in range(4):
            aim = state.pose[:2] + 0.4 * rod.length * rng.standard_normal(2) * rng.choice([0.0, 1.0, 1.0], 2)
            to = np.array([*aim, max(0.0, rng.uniform(-rod.radius, 2.5 * rod.radius))])
            way = state.base + np.linspace(0.0, 1.0, 15)[1:, None] * (to - state.base)
            try:
                path = rod.run(*way.T, state=state)
            except Error as error:
                through += "range" in str(error)  # a tip that is led into it from above is refused
                lost += "range" not in str(error)
                break
            ways += 1
            turnover += float(np.abs(np.diff(path.work, prepend=state.work)).sum())
            between = float(np.abs(np.diff(way, axis=0, prepend=way[:1])).sum())
            turnover += 1e-5 * rod.friction * rod.length * between  # what comes and goes between two places [J]
            error = float(np.abs(path.stored + path.dissipated - path.work).max()) / turnover
            push = float(np.linalg.norm(path.force[:, :2], axis=1).max()) / (rod.friction * rod.length)
            off, most = float(np.maximum(off, error)), float(np.maximum(most, push))
            if (np.diff(path.dissipated, prepend=heat) < 0.0).any() or (path.stored < 0.0).any():
                print(f"heat falls, or what is stored is below 0: {rod}")
                return 1
            state, heat = path.state, float(path.dissipated[-1])
    print(f"{rods} rods, {ways} ways: {lost} without a balance, {through} refused from above")
    print(f"stored + dissipated beside work: {off:.1g} of the turnover; push over q L: 1 + {most - 1.0:.1g} at most")
    return int(lost > 0 or not (off < 1e-10 and most < 1.0 + 1e-6))


if __name__ == "__main__":
    given = [float(text) for text in sys.argv[1:]]
    sys.exit(main(given[0] if given else 80.0, int(given[1]) if len(given) > 1 else 1))
