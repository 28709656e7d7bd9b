# SPDX-License-Identifier: BSD-3-Clause
"""Pull-off on curves whose truth is known: error, and how often the 95 % interval holds it. A table row per case.

python tests/bench/bench_tethers.py --curves 40
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
from nanotouch import curves
from synthetic_tethers import Made, Tether, make

FREE = 2.5e-6  # m beyond contact

#: part of the free travel after which it tears (0: nothing holds), and what else is in the curve
CASES: dict[str, dict[str, Any]] = {
    "nothing holds": {"part": 0.0},
    "nothing holds, bow": {"part": 0.0, "bow": True},
    "nothing holds, squeeze film": {"part": 0.0, "film": True},
    "contact adhesion of 1 nN": {"part": 0.0, "adhesion": 1e-9},
    "plateau to 5 %": {"part": 0.05},
    "to 20 %": {"part": 0.2},
    "to 50 %": {"part": 0.5},
    "to 80 %": {"part": 0.8},
    "to 95 %": {"part": 0.95},
    "to the end": {"part": 2.0},
    "to the end, 0.05 .. 0.3 nN": {"part": 2.0, "forces": (0.05e-9, 0.3e-9)},
    "chain to 20 %": {"part": 0.2, "chain": True},
    "chain to 50 %": {"part": 0.5, "chain": True},
    "chain to 80 %": {"part": 0.8, "chain": True},
    "three steps to 90 %": {"part": 0.9, "steps": 3},
    "plateau to 50 %, bow": {"part": 0.5, "bow": True},
    "to 80 %, bow": {"part": 0.8, "bow": True},
    "to 50 %, squeeze film": {"part": 0.5, "film": True},
}


def one(rng: np.random.Generator, seed: int, case: dict[str, Any]) -> tuple[float, bool, float, int]:
    """Error of the pull-off [N], whether the interval holds the truth, its width [N], number of ruptures."""
    force, steps = rng.uniform(*case.get("forces", (0.3e-9, 3e-9))), case.get("steps", 1)
    tethers = tuple(
        Tether(force / steps, case["part"] * FREE * (k + 1) / steps, case.get("chain", False)) for k in range(steps)
    )
    curve = make(
        Made(
            tethers=tethers if case["part"] else (),
            adhesion=case.get("adhesion", 0.0),
            drag=rng.uniform(5e-12, 25e-12),
            film=rng.uniform(20e-12, 80e-12) if case.get("film") else 0.0,
            bow=rng.uniform(-150e-12, 150e-12) if case.get("bow") else 0.0,
            flicker=2e-12,
            seed=seed,
        )
    )
    report = curves.analyse(curve)
    low, high = report.pull_off_interval
    truth = curve.meta["pull_off"]
    return report.pull_off_force - truth, low <= truth <= high, high - low, len(report.ruptures)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curves", type=int, default=40)
    count = parser.parse_args().curves
    print("| case | median error [pN] | 95 % of errors below [pN] | held [%] | width [pN] | ruptures |")
    print("|---|---|---|---|---|---|")
    for number, (name, case) in enumerate(CASES.items()):
        rng = np.random.default_rng(100 + number)
        rows = [one(rng, 1000 * number + i, case) for i in range(count)]
        error, held, width, ruptures = (np.array(column) for column in zip(*rows, strict=True))
        print(
            f"| {name} | {1e12 * np.median(error):.0f} | {1e12 * np.percentile(np.abs(error), 95):.0f} | "
            f"{100 * held.mean():.0f} | {1e12 * np.median(width):.0f} | {ruptures.mean():.1f} |"
        )


if __name__ == "__main__":
    main()
