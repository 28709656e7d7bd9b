# SPDX-License-Identifier: BSD-3-Clause
"""Enters as people do and attacks every number that a session prints. ``make adversary``

Each seed draws scene, relief, rig, settings, a door (adversary_doors.py: a session in Python, the host of live, a
master or a slave in Python, a mailbox of another program), blows of the hand, requests, restores and a fault. Half of
the rigs have three axes, half of the scenes rub. All that was met is judged in one place (adversary_judge.py): force,
indentation, sideways force, motor force, energy to the hand. A run that breaks a number is printed with its seed, which
makes it again. With ``--rows FILE`` each run is written there, and one that is there is not run again.

``python tests/heavy/adversary.py --first 0 --count 100`` takes a minute; ``--only DOOR`` enters by one of them.
"""

from __future__ import annotations

import argparse
import json
import logging
import sys
import time
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

from adversary_doors import DOORS, Refused
from adversary_draws import Dice, plot_of
from adversary_ground import Ground
from adversary_judge import TOUCHED, Judge


def run(seed: int, door: str = "") -> dict[str, Any]:
    """One run; what is worth keeping of it."""
    plot = plot_of(seed, door)
    d = Dice(np.random.default_rng((seed, 1)))
    stands = plot.surface is None or plot.rig.stage.axes == 1.0
    ground = Ground(plot.surface) if plot.surface is not None and not stands else None
    judge = Judge(plot.fault, stands and plot.door == "session", ground)
    row: dict[str, Any] = {"seed": seed, "door": plot.door, "kind": plot.kind,
                           "fault": list(plot.fault[:2]) if plot.fault else None}  # fmt: skip
    try:
        DOORS[plot.door](plot, d, judge)
    except Refused as why:
        return row | {"refused": str(why)[:200]}
    worst = {name: [one.met, one.promised, one.time] for name, one in judge.worst.items()}
    return row | {"worst": worst, "broken": [one.what for one in judge.broken], "limit": judge.limit,
                  "warned": judge.warned, "steepest": judge.steepest}  # fmt: skip


def known(path: Path | None) -> dict[int, dict[str, Any]]:
    """Rows of before; a last line that was cut off is not among them."""
    if path is None or not path.exists():
        return {}
    lines = path.read_text().splitlines(keepends=True)
    rows = [json.loads(line) for line in lines if line.endswith("\n")]
    return {row["seed"]: row for row in rows}


def shares(rows: list[dict[str, Any]], kind: str, what: str) -> list[float]:
    """Bound over what was met, where it pressed, sideways where it is steep, and no WARNING said that the limit
    protects nothing."""
    found = []
    for row in rows:
        if row["kind"] == kind and "worst" in row and what in row["worst"] and not row["fault"] and not row["warned"]:
            met, promised, _ = row["worst"][what]
            presses = row["worst"]["force"][0] > TOUCHED * row["limit"] and (what != "sideways" or row["steepest"])
            if met > 0.0 and presses:
                found.append(promised / met)
    return found


def report(rows: list[dict[str, Any]]) -> int:
    """A line for each kind of rig and number; how many runs broke one."""
    opened = [row for row in rows if "worst" in row]
    print(f"{len(opened)} runs, {len(rows) - len(opened)} refused before arming; by door "
          f"{dict(Counter(row['door'] for row in opened))}")  # fmt: skip
    for kind in sorted({row["kind"] for row in opened}):
        for what in ("force", "sideways", "indentation"):
            found = shares(opened, kind, what)
            if found:
                print(f"{kind}: {what}: bound over worst met, median {np.median(found):.2f}, least {min(found):.3f}, "
                      f"{len(found)} runs")  # fmt: skip
    broken = Counter(what for row in opened for what in row["broken"])
    for what, count in broken.items():
        print(f"BROKEN {what}: {count} runs, such as seeds {[r['seed'] for r in opened if what in r['broken']][:8]}")
    return sum(bool(row["broken"]) for row in opened)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=20_000)
    parser.add_argument("--only", choices=sorted(DOORS), default="")
    parser.add_argument("--rows", type=Path)
    options = parser.parse_args()
    logging.disable(logging.WARNING)  # what halves tell
    done = known(options.rows)
    rows, begun = [], time.monotonic()
    for seed in range(options.first, options.first + options.count):
        row = done.get(seed) or run(seed, options.only)
        rows.append(row)
        if row.get("broken"):
            print({name: row[name] for name in ("seed", "door", "kind", "fault", "broken")}, row["worst"], flush=True)
        if options.rows is not None and seed not in done:
            with options.rows.open("a") as file:
                file.write(json.dumps(row) + "\n")
    failed = report(rows)
    print(f"{failed} broken; {time.monotonic() - begun:.0f} s")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
