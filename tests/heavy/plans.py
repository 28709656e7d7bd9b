# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes: is the planned force ever farther from the reference than the plan says? ``make heavy``

Every second scene is near a preset, every second one extreme (tests/python/random_scenes.py); demands are spread evenly
over the decades from 1e-6 to 0.3. A violation prints the seed that makes the scene again.
"""

from __future__ import annotations

import argparse
import math
import re
import sys
from collections import Counter
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

import cycles
import random_scenes
from nanotouch.errors import Error


class Row(NamedTuple):
    """One scene."""

    seed: int
    refusal: str = ""
    error: float = 0.0
    bound: float = 0.0
    demand: float = 0.0
    folds_hold: bool = True
    cost: float = 0.0
    exact_cost: float = 0.0

    @property
    def violated(self) -> bool:
        return not self.refusal and not (self.error <= self.bound <= self.demand and self.folds_hold)


def on_a_flat(seed: int) -> Row:
    """Plan, compare, and what came of it."""
    rng = np.random.default_rng(seed)
    scene = (random_scenes.near_preset if seed % 2 else random_scenes.extreme)(rng)
    demand = 10.0 ** rng.uniform(-6.0, math.log10(0.3))
    return row_of(seed, demand, random_scenes.compare(scene, demand))


def on_bumps(seed: int) -> Row:
    """The same over a random surface, for tips whose contact follows the radius of each place."""
    rng = np.random.default_rng(seed)
    scene = (random_scenes.near_preset if seed % 2 else random_scenes.extreme)(rng)
    scene.tip.shape = "paraboloid"
    demand = 10.0 ** rng.uniform(-6.0, math.log10(0.3))
    return row_of(seed, demand, random_scenes.compare_over(scene, cycles.bumpy(scene, seed), demand, rng))


def row_of(seed: int, demand: float, outcome: random_scenes.Outcome | Error) -> Row:
    if isinstance(outcome, Error):
        return Row(seed, refusal=re.split(r"[ =:]", str(outcome).removeprefix("plan: "), maxsplit=1)[0])
    plan = outcome.plan
    full = float(plan.explain()["full_cost"])
    return Row(seed, "", outcome.error, plan.bound, demand, outcome.folds_hold, plan.cost, full)


def report(rows: list[Row]) -> int:
    """Print the table; how many violate their plan."""
    planned = [row for row in rows if not row.refusal]
    violations = [row for row in planned if row.violated]
    print(f"{len(rows)} scenes, {len(planned)} planned, {len(rows) - len(planned)} refused")
    for field, count in Counter(row.refusal for row in rows if row.refusal).most_common():
        print(f"  refused, {field}: {count}")
    for row in violations:
        print(f"  VIOLATION: seed {row.seed}: {row}")
    print(f"violations: {len(violations)}")
    ratios = np.array([row.error / row.bound for row in planned if row.bound > 0.0])
    quantiles = np.quantile(ratios, [0.1, 0.25, 0.5, 0.75, 0.9, 1.0])
    print("true error / bound, 10 25 50 75 90 100 %: " + " ".join(f"{q:.3g}" for q in quantiles))
    coarse = max(row.cost for row in planned if row.demand >= 1e-4)
    print(f"largest cost: {max(row.cost for row in planned):.3g} Hertz evaluations, for 1e-4 and above {coarse:.3g}")
    print(f"dearer than everything exact: {sum(row.cost > row.exact_cost for row in planned)}")
    return len(violations)


def run(measure: Callable[[int], Row], seeds: range, jobs: int) -> int:
    if jobs == 1:
        return report([measure(seed) for seed in seeds])
    with ProcessPoolExecutor(jobs) as pool:
        return report(list(pool.map(measure, seeds, chunksize=20)))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--surfaces", type=int, default=1000, help="of them again over a surface")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--jobs", type=int, default=1)
    options = parser.parse_args()
    first = options.first
    failed = run(on_a_flat, range(first, first + options.scenes), options.jobs)
    print("over bumpy surfaces:")
    failed += run(on_bumps, range(first, first + options.surfaces), options.jobs)
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
