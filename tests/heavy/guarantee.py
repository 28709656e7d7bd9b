# SPDX-License-Identifier: BSD-3-Clause
"""Random operators, rigs, samples, drifts, calibrations and faults: does the force ever pass what was promised?

Each seed is one run of tests/c/test_session_adversary, quasi-static, dynamic (peaks inside a tick counted) or with one
fault of random value. A run that passes its promise is printed with the seed that makes it again. With ``--rows FILE``
each block of seeds is written there when it is done, and one that is there is not run again: stop it and go on at will.
``--shard I/N`` takes every N-th block. ``--search`` looks for what comes closest on the default rig instead."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build" / "dev" / "tests" / "c" / "test_session_adversary"
BLOCKS = {"quasi-static": 500, "dynamic": 20, "fault": 250}
"""seeds of a block: some seconds each"""


def run(*words: str) -> list[list[str]]:
    """Lines of the program, in words."""
    done = subprocess.run([PROGRAM, *words], check=True, capture_output=True, text=True)
    return [line.split() for line in done.stdout.splitlines()]


def measure(kind: str, first: int, count: int) -> dict[str, Any]:
    """One block of seeds, and what of it is worth keeping."""
    row: dict[str, Any] = {"kind": kind, "first": first, "count": count, "opened": 0, "stops": 0, "broken": []}
    row |= {"force": 0.0, "indentation": 0.0}
    for seed, opened, force, indentation, stops, fault, value in run(kind, str(first), str(count)):
        row["opened"] += int(opened)
        row["stops"] += int(stops)
        row["force"] = max(row["force"], float(force))
        row["indentation"] = max(row["indentation"], float(indentation))
        if not (float(force) < 1.0 and float(indentation) < 1.0):
            row["broken"].append([seed, force, indentation, fault, value])
    return row


def rows_of(path: Path | None) -> list[dict[str, Any]]:
    """What has been run before; a last line that was cut off is not among it."""
    if path is None or not path.exists():
        return []
    return [json.loads(line) for line in path.read_text().splitlines(keepends=True) if line.endswith("\n")]


def report(rows: list[dict[str, Any]]) -> int:
    """Print what came of each kind; how many broke their promise."""
    failed = 0
    for kind in BLOCKS:
        chosen = [row for row in rows if row["kind"] == kind]
        if not chosen:
            continue
        count, opened, stops = (sum(row[key] for row in chosen) for key in ("count", "opened", "stops"))
        worst = {key: max(row[key] for row in chosen) for key in ("force", "indentation")}
        broken = [run for row in chosen for run in row["broken"]]
        print(
            f"{kind}: {opened} runs ({count - opened} more refused before arming), {stops} stops: at worst "
            f"{worst['force']:.3f} of the promised force, {worst['indentation']:.3f} of the indentation; "
            f"{len(broken)} broken"
        )
        for seed, force, indentation, fault, value in broken:
            print(f"  BROKEN: seed {seed}: force {force}, indentation {indentation}; {fault} {value}")
        failed += len(broken)
    return failed


def sample(options: argparse.Namespace) -> int:
    wanted = {"quasi-static": options.quasi_static, "dynamic": options.dynamic, "fault": options.faults}
    rows = rows_of(options.rows)
    done = {(row["kind"], row["first"]) for row in rows}
    shard, shards = (int(word) for word in options.shard.split("/"))
    jobs = [
        (kind, options.first + i * BLOCKS[kind], BLOCKS[kind])
        for kind, count in wanted.items()
        for i in range(-(-count // BLOCKS[kind]))
        if i % shards == shard
    ]
    end = time.monotonic() + options.seconds

    def one(job: tuple[str, int, int]) -> dict[str, Any] | None:
        return measure(*job) if time.monotonic() < end else None

    with ThreadPoolExecutor(options.jobs) as pool:
        for row in pool.map(one, [job for job in jobs if job[:2] not in done]):
            if row is None:
                continue
            rows.append(row)
            if options.rows is not None:
                with options.rows.open("a") as stream:
                    print(json.dumps(row), file=stream)
    return report(rows)


def search(options: argparse.Namespace) -> int:
    """The default rig, ever closer; how many promises it did not come within a factor of two of."""
    missed = 0
    for kind in ("quasi-static", "fault"):
        best = 0.0
        for seed in range(options.first, options.first + 3):
            words = run("search", kind, str(seed), str(options.search))[-1]
            best = float(np.maximum(best, float(words[6].rstrip(";,"))))
            print(f"{kind}, search {seed}: {' '.join(words[1:])}")
        print(f"{kind}: {best:.3f} of what is promised")
        missed += best < 0.5
    return missed


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quasi-static", type=int, default=100_000, help="runs")
    parser.add_argument("--dynamic", type=int, default=2000)
    parser.add_argument("--faults", type=int, default=20_000)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--shard", default="0/1", help="I/N: every N-th block of seeds, from the I-th")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="begin no block after this time")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--rows", type=Path, help="file of what has been run")
    parser.add_argument("--search", type=int, default=0, metavar="RUNS", help="search with so many runs instead")
    options = parser.parse_args()
    return (search(options) if options.search else sample(options)) > 0


if __name__ == "__main__":
    sys.exit(main())
