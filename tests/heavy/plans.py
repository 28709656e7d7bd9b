# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes: is what a plan computes ever farther from the truth than the plan says? ``make heavy``

Every second scene is near a preset, every second one extreme (tests/python/random_scenes.py); the quantity is
drawn, too, and demands are spread evenly over the decades from 1e-6 to 0.3. The truth shares nothing with the library
(tests/python/oracle.py). Its samples are rigid, so that what a sample might deform, which is a part of most bounds, is
taken out of them first: the rest has to hold alone. A violation prints the seed that makes the scene again. With
``--rows FILE`` every row is written there when it is measured, and one that is there already is not measured again.
"""

from __future__ import annotations

import argparse
import json
import math
import re
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

import cycles
import random_scenes
from nanotouch.errors import Error
from nanotouch.scene.plan import Plan


class Row(NamedTuple):
    """One scene."""

    surface: str
    seed: int
    quantity: str
    refusal: str = ""
    error: float = 0.0
    bound: float = 0.0
    demand: float = 0.0
    folds_hold: bool = True
    cost: float = 0.0
    exact_cost: float = 0.0
    kept: bool = True  # the bound is inside the demand but for what the plan warns of
    deforms: float = 0.0  # what of the bound is the sample's, which is rigid here

    @property
    def rest(self) -> float:
        """The bound of a rigid sample; the sum of both has been rounded."""
        return (self.bound - self.deforms) * (1.0 + 1e-12) + 1e-15 * self.bound

    @property
    def violated(self) -> bool:
        return not self.refusal and not (self.error <= self.rest and self.kept and self.folds_hold)


def measure(job: tuple[str, int]) -> Row:
    """Plan, compare, and what came of it; over bumps for tips whose contact follows the radius of each place, and over
    bumps that are made of something else at each place."""
    surface, seed = job
    rng = np.random.default_rng(seed)
    scene = (random_scenes.near_preset if seed % 2 else random_scenes.extreme)(rng)
    quantity = str(rng.choice(random_scenes.QUANTITIES))
    demand = 10.0 ** rng.uniform(-6.0, math.log10(0.3))
    if surface == "flat":
        outcome = random_scenes.compare(scene, demand, quantity)
    else:
        scene.tip.shape = "paraboloid"
        body = cycles.bumpy(scene, seed)
        if surface == "made":
            try:
                body = cycles.made_of(scene, body, seed)
            except Error as error:
                return Row(surface, seed, quantity, _refused(error))
        outcome = random_scenes.compare_over(scene, body, demand, rng, quantity)
    if isinstance(outcome, Error):
        return Row(surface, seed, quantity, _refused(outcome))
    plan = outcome.plan
    if plan.explain()["deforms"]:
        return Row(surface, seed, quantity, "deforms, which has a sampler of its own")
    kept, full, deforms = random_scenes.keeps(plan, demand), float(plan.explain()["full_cost"]), deforms_by(plan)
    held = outcome.folds_hold
    return Row(surface, seed, quantity, "", outcome.error, plan.bound, demand, held, plan.cost, full, kept, deforms)


def deforms_by(plan: Plan) -> float:
    """What the bound has for forces before contact, to which the sample gives way; none beside a contact alone."""
    facts = plan.explain()
    beside = any(term["form"] != "off" for term in facts["terms"][1:])
    alone = not beside and facts["adhesion_source"] == "none" and plan.quantity in ("force", "stiffness")
    rigid = max(facts["rigid_error"], facts["around_error"])
    return 0.0 if alone or math.isinf(rigid) else rigid


def _refused(error: Error) -> str:
    """The field that a refusal names."""
    return re.split(r"[ =:]", str(error).removeprefix("plan: "), maxsplit=1)[0]


def report(rows: list[Row]) -> int:
    """Print the table; how many violate their plan."""
    planned = [row for row in rows if not row.refusal]
    violations = [row for row in planned if row.violated]
    print(f"{len(rows)} scenes, {len(planned)} planned, {len(rows) - len(planned)} refused")
    for field, count in Counter(row.refusal for row in rows if row.refusal).most_common():
        print(f"  refused, {field}: {count}")
    for row in violations:
        print(f"  VIOLATION: {row}")
    print(f"violations: {len(violations)}")
    for quantity in random_scenes.QUANTITIES:
        chosen = [row for row in planned if row.quantity == quantity and row.bound > 0.0]
        if not chosen:
            continue
        quantiles = np.quantile([row.error / row.rest for row in chosen], [0.1, 0.25, 0.5, 0.75, 0.9, 1.0])
        text = " ".join(f"{q:.3g}" for q in quantiles)
        print(f"{quantity}, {len(chosen)}: true error / bound, 10 25 50 75 90 100 %: {text}")
    coarse = max((row.cost for row in planned if row.demand >= 1e-4), default=0.0)
    largest = max((row.cost for row in planned), default=0.0)
    print(f"largest cost: {largest:.3g} Hertz evaluations, for 1e-4 and above {coarse:.3g}")
    print(f"dearer than everything exact: {sum(row.cost > row.exact_cost for row in planned)}")
    return len(violations)


def rows_of(path: Path | None) -> list[Row]:
    """What has been measured before; a last line that was cut off is not among it."""
    if path is None or not path.exists():
        return []
    rows = []
    for line in path.read_text().splitlines(keepends=True):
        if line.endswith("\n"):
            rows.append(Row(*json.loads(line)))
    return rows


def run(surface: str, seeds: range, jobs: int, path: Path | None) -> int:
    rows = [row for row in rows_of(path) if row.surface == surface and row.seed in seeds]
    done = {row.seed for row in rows}
    missing = [(surface, seed) for seed in seeds if seed not in done]
    with ProcessPoolExecutor(jobs) as pool:
        for row in pool.map(measure, missing, chunksize=20):
            rows.append(row)
            if path is not None:
                with path.open("a") as stream:
                    print(json.dumps(row), file=stream)
    return report(rows)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=20_000)
    parser.add_argument("--surfaces", type=int, default=2000, help="of them again over a surface")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--rows", type=Path, help="file of what has been measured")
    options = parser.parse_args()
    first = options.first
    failed = run("flat", range(first, first + options.scenes), options.jobs, options.rows)
    for surface in ("bumpy", "made"):
        print(f"over {surface} surfaces:")
        failed += run(surface, range(first, first + options.surfaces), options.jobs, options.rows)
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
