# SPDX-License-Identifier: BSD-3-Clause
"""Stated margins beside the simulated loop, for random rigs with a virtual coupling, slopes, friction and delays.

Each seed is a rig of ``build/dev/tests/c/test_session_limits``: turned to a stated margin of 1.1, landed, kicked, and
asked by bisection at which factor on the force that is felt the ripple grows. A factor below the stated margin over
1.01 breaks the promise. ``python tests/heavy/limits.py [RIGS]`` goes on where the last run was stopped
(``build/heavy/limits.csv``); ``--again`` begins anew.
"""

from __future__ import annotations

import argparse
import math
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM, KEPT = ROOT / "build/dev/tests/c/test_session_limits", ROOT / "build/heavy/limits.csv"
MOST_REFUSED = 3.0  # median of true over stated


def kept() -> dict[int, tuple[str, float]]:
    """What was run already: kind and ratio of each seed."""
    if not KEPT.exists():
        return {}
    rows = [line.split(",") for line in KEPT.read_text().splitlines() if line.count(",") == 2]
    return {int(seed): (kind, float(ratio)) for seed, kind, ratio in rows}


def main() -> None:
    """Run what is missing, and judge all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rigs", nargs="?", type=int, default=2000)
    parser.add_argument("--again", action="store_true")
    args = parser.parse_args()
    KEPT.parent.mkdir(parents=True, exist_ok=True)
    if args.again:
        KEPT.unlink(missing_ok=True)
    first = max(kept(), default=-1) + 1
    with KEPT.open("a") as out:
        if first < args.rigs:
            subprocess.run([PROGRAM, str(first), str(args.rigs - first)], stdout=out, check=True)
    found = kept()
    broken = [seed for seed, (_, ratio) in found.items() if ratio < 1.0 / 1.01 * (1.0 - 1e-3)]
    for kind in sorted({kind for kind, _ in found.values()}):
        ratios = [ratio for of, ratio in found.values() if of == kind and not math.isnan(ratio)]
        asked = sum(of == kind for of, _ in found.values())
        print(f"{kind:<20}{len(ratios):5d} of {asked} rigs have such a margin; true over stated: least "
              f"{min(ratios):.3f}, median {statistics.median(ratios):.2f}, largest {max(ratios):.3g}")  # fmt: skip
    median = statistics.median(ratio for _, ratio in found.values() if not math.isnan(ratio))
    print(f"{len(found)} rigs, {len(broken)} broken {broken or ''}; median {median:.2f}")
    sys.exit(bool(broken) or median > MOST_REFUSED)


if __name__ == "__main__":
    main()
