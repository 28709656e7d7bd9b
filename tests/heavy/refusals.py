# SPDX-License-Identifier: BSD-3-Clause
"""How many of the scenes that a laboratory has are refused, which, and why. ``make heavy``

Forty by hand with their sources (tests/python/ordinary_scenes.py), each at four demands, and random ones at 1 %.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

from nanotouch import Scene
from nanotouch.errors import Error
from ordinary_scenes import ORDINARY, random_ordinary

DEMANDS = (1e-1, 1e-2, 1e-3, 1e-4)


def refusal(tables: dict[str, object], demand: float) -> tuple[str, float]:
    """What is said, nothing of a scene that is planned; processor time [s]."""
    start = time.thread_time()
    try:
        Scene(**tables).plan(demand)
    except Error as error:
        return str(error), time.thread_time() - start
    return "", time.thread_time() - start


def spent(times: list[float]) -> str:
    """Processor time of answers [s]."""
    return f"processor time {np.median(times) * 1e3:.1f} ms, at most {np.max(times):.2f} s"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--random", type=int, default=1000, help="random scenes")
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    refused, times = np.zeros(len(DEMANDS), dtype=int), []
    for scene in ORDINARY:
        for i, demand in enumerate(DEMANDS):
            words, seconds = refusal(scene.tables, demand)
            refused[i] += bool(words)
            times.append(seconds)
            if words and demand == 1e-2:
                print(f"  {scene.name}: {words[:160]}")
    print(f"refused of {len(ORDINARY)} at {DEMANDS}: {refused.tolist()}; {spent(times)}")
    if args.random == 0:
        return 0
    rng = np.random.default_rng(args.seed)
    answers = [refusal(random_ordinary(rng), 1e-2) for _ in range(args.random)]
    count = sum(bool(words) for words, _ in answers)
    print(f"refused of {args.random} random ones at 1 %: {count}; {spent([seconds for _, seconds in answers])}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
