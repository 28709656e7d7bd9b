# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes: is the force of a table in single precision ever farther from its plan than it says? ``make heavy``

Scenes, quantities and demands are drawn as in plans.py. Each table is compared at some hundred gaps, most of them where
the force bends or jumps, on both histories. A violation prints the seed that makes the scene again.
"""

from __future__ import annotations

import sys
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

import random_scenes
import test_c_header as tables
from nanotouch import _core
from nanotouch.errors import Error


def main(first: int = 0, end: int = 1000) -> int:
    """Print what came of the scenes; how many tables were wrong."""
    refused: Counter[str] = Counter()
    pieces, folds, worst, wrong, deforming = [], [], 0.0, 0, 0
    for seed in range(first, end):
        rng = np.random.default_rng(seed)
        scene = (random_scenes.near_preset if seed % 2 else random_scenes.extreme)(rng)
        quantity = str(rng.choice(["force"] * 3 + ["stiffness", "radius", "folds"]))
        try:
            plan = scene.plan(10.0 ** rng.uniform(-6, -0.6), quantity=quantity)  # type: ignore[arg-type]
        except Error:
            refused["no such plan"] += 1
            continue
        try:
            table = _core.ForceTable(plan.core)
        except Error as refusal:
            refused[str(refusal)] += 1
            continue
        gaps = tables.gaps_of(plan, table, rng)
        found = max(tables.excess(plan, table, gaps, attached) for attached in (False, True))
        if not found <= 1.0:
            print(f"VIOLATION: seed {seed}, {found:.3g} of the bound {table.bound:.3g}")
            wrong += 1
        worst = float(np.maximum(worst, found))
        pieces.append(table.pieces)
        folds.append(table.fold_distance)
        deforming += plan.explain()["deforms"]
    print(
        f"{end - first} scenes, {len(pieces)} tables, {deforming} of samples that deform; outside their bound: {wrong}"
    )
    print(f"largest error over the bound: {worst:.3g}; pieces: median {np.median(pieces):.0f}, most {max(pieces)}")
    print("fold distance [m]: " + ", ".join(f"{q} %: {np.percentile(folds, q):.2g}" for q in (50, 90, 100)))
    for why, count in refused.most_common():
        print(f"  refused, {why}: {count}")
    return wrong


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
