# SPDX-License-Identifier: BSD-3-Clause
"""Random operators, rigs, samples, drifts, calibrations and faults: does the force ever pass what was promised?

Each seed is one rig of tests/c/test_session_adversary: quasi-static with five operators, one after the other, dynamic
(peaks inside a tick counted) with one, or with one and a fault of random value. A run is one operator on one rig that
was not refused before arming. A rig whose promise is passed is printed with the seed that makes it again. With
``--rows FILE`` each block of seeds is written there when it is done, and one that is there is not run again: stop it
and go on at will. ``--shard I/N`` takes every N-th block. ``--search RUNS`` looks for what comes closest to each
promise on each of some rigs instead (tests/c/adversary_rigs.h)."""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "build" / "dev" / "tests" / "c" / "test_session_adversary"
BLOCKS = {"quasi-static": 50, "dynamic": 10, "fault": 100}
"""seeds of a block: some seconds each"""
OPERATORS = {"quasi-static": 5, "dynamic": 1, "fault": 1}
"""on each rig"""
AIMS = ("force", "peak", "indentation", "read-out", "sensor", "slip", "stage")
RIGS = ("default", "soft", "stiff", "open-loop")


def run(program: Path, *words: str) -> list[list[str]]:
    """Lines of the program, in words."""
    done = subprocess.run([program, *words], check=True, capture_output=True, text=True)
    return [line.split() for line in done.stdout.splitlines()]


def measure(program: Path, kind: str, first: int) -> dict[str, Any]:
    """One block of seeds, and what of it is worth keeping."""
    count = BLOCKS[kind]
    row: dict[str, Any] = {"kind": kind, "first": first, "count": count, "opened": 0, "touched": 0, "stops": 0}
    row |= {"broken": [], "force": 0.0, "indentation": 0.0}
    for seed, opened, force, indentation, stops, fault, value, *_ in run(program, kind, str(first), str(count)):
        row["opened"] += int(opened)
        row["touched"] += float(force) > 0.01
        row["stops"] += int(stops)
        row["force"] = float(np.maximum(row["force"], float(force)))
        row["indentation"] = float(np.maximum(row["indentation"], float(indentation)))
        if not (float(force) < 1.0 and float(indentation) < 1.0):
            row["broken"].append([seed, force, indentation, fault, value])
    return row


def rows_of(path: Path | None) -> list[dict[str, Any]]:
    """What has been run before; a last line that was cut off is not among it."""
    if path is None or not path.exists():
        return []
    return [json.loads(line) for line in path.read_text().splitlines(keepends=True) if line.endswith("\n")]


def runs_of(rows: list[dict[str, Any]], kind: str) -> int:
    return OPERATORS[kind] * sum(row["opened"] for row in rows if row["kind"] == kind)


def report(rows: list[dict[str, Any]]) -> int:
    """Print what came of each kind; how many broke their promise."""
    failed = 0
    print("| runs | rigs | refused before arming | came down | stops | broken | of the force | of the indentation |")
    print("|---|---|---|---|---|---|---|---|")
    for kind in BLOCKS:
        chosen = [row for row in rows if row["kind"] == kind]
        if not chosen:
            continue
        count, opened, touched, stops = (
            sum(row[key] for row in chosen) for key in ("count", "opened", "touched", "stops")
        )
        worst = {key: np.max([row[key] for row in chosen]) for key in ("force", "indentation")}
        broken = [run for row in chosen for run in row["broken"]]
        print(
            f"| {kind}: {runs_of(rows, kind)} | {opened} | {count - opened} | {touched} | {stops} | {len(broken)} | "
            f"{100 * worst['force']:.1f} % | {100 * worst['indentation']:.1f} % |"
        )
        for seed, force, indentation, fault, value in broken:
            print(f"BROKEN: {kind} {seed}: force {force}, indentation {indentation}; {fault} {value}")
        failed += len(broken)
    return failed


def blocks(kind: str, wanted: int, options: argparse.Namespace) -> Iterator[tuple[str, int]]:
    """Blocks of a kind that are not yet there, until so many runs are."""
    shard, shards = (int(word) for word in options.shard.split("/"))
    done = {row["first"] for row in options.found if row["kind"] == kind}
    number = shard
    while runs_of(options.found, kind) * shards < wanted and time.monotonic() < options.end:
        first = options.first + number * BLOCKS[kind]
        number += shards
        if first not in done:
            yield kind, first


def sample(options: argparse.Namespace) -> int:
    """Kinds take turns, so that each has its share whenever this is stopped."""
    options.found = rows_of(options.rows)
    options.end = time.monotonic() + options.seconds
    wanted = {"quasi-static": options.quasi_static, "dynamic": options.dynamic, "fault": options.faults}
    waiting = [blocks(kind, count, options) for kind, count in wanted.items()]
    while waiting:
        for jobs in list(waiting):
            job = next(jobs, None)
            if job is None:
                waiting.remove(jobs)
                continue
            row = measure(options.program, *job)
            options.found.append(row)
            if options.rows is not None:
                with options.rows.open("a") as stream:
                    print(json.dumps(row), file=stream)
    return report(options.found)


def search(options: argparse.Namespace) -> int:
    """The best share of each promise on each rig; how many promises no rig comes within a factor of two of."""
    missed = 0
    print("| promise | " + " | ".join(RIGS) + " |")
    print("|---|" + "---|" * len(RIGS))
    for target in AIMS:
        cells, best = [], 0.0
        for rig in RIGS:
            runs = options.search // 10 if target == "peak" else options.search
            found = run(options.program, "search", target, rig, str(options.first), str(runs))[-1]
            best = float(np.maximum(best, float(found[0])))
            cells.append(f"{100 * float(found[0]):.0f} % of {1e9 * float(found[2]):.4g} nN ({found[3]} {found[4]})")
        print(f"| {target} | " + " | ".join(cells) + " |", flush=True)
        missed += not best >= 0.5
    return missed


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quasi-static", type=int, default=100_000, help="runs")
    parser.add_argument("--dynamic", type=int, default=2000)
    parser.add_argument("--faults", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--shard", default="0/1", help="I/N: every N-th block of seeds, from the I-th")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="begin no block after this time")
    parser.add_argument("--rows", type=Path, help="file of what has been run")
    parser.add_argument("--program", type=Path, default=PROGRAM, help="of another build")
    parser.add_argument("--search", type=int, default=0, metavar="RUNS", help="search with so many runs instead")
    options = parser.parse_args()
    return (search(options) if options.search else sample(options)) > 0


if __name__ == "__main__":
    sys.exit(main())
