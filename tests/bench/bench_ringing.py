# SPDX-License-Identifier: BSD-3-Clause
"""How often the interval of the pull-off holds it where lever and stage ring after the turn. A table row per case.

nice python tests/bench/bench_ringing.py --curves 300
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
from nanotouch import curves
from synthetic_ringing import make

ADHESION = (("none", 0.0, 0.0), ("30 to 150", 30e-12, 150e-12), ("0.2 to 2 nN", 0.2e-9, 2e-9))  # N
RINGING = ((0.0, 0.0), (5e-12, 50e-12), (50e-12, 150e-12))  # N
SPEEDS = (5e-6, 20e-6, 50e-6, 100e-6)  # m/s


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curves", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    print(
        "| adhesion [pN] | ringing [pN] | held [%] | lower end above the truth [%] | median width [pN] | by speed [%] |"
    )
    print("|---|---|---|---|---|---|")
    for name, least, most in ADHESION:
        for low, high in RINGING:
            rng = np.random.default_rng([asked.seed, round(most * 1e12), round(high * 1e12)])
            rows = []
            for number in range(asked.curves):
                adhesion, amplitude = rng.uniform(least, most), rng.uniform(low, high)
                speed = SPEEDS[number % len(SPEEDS)]
                ends = curves.analyse(make(rng, amplitude, adhesion, speed)).pull_off_interval
                rows.append((ends[0] <= adhesion <= ends[1], ends[0] > adhesion, ends[1] - ends[0]))
            held, above, width = (np.array(column) for column in zip(*rows, strict=True))
            by_speed = ", ".join(f"{100 * held[k :: len(SPEEDS)].mean():.0f}" for k in range(len(SPEEDS)))
            print(
                f"| {name} | {low * 1e12:.0f} to {high * 1e12:.0f} | {100 * held.mean():.1f} | "
                f"{100 * above.mean():.1f} | {1e12 * np.median(width):.0f} | {by_speed} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
