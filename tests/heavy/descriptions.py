# SPDX-License-Identifier: BSD-3-Clause
"""Damaged scenes, rigs, recordings and messages, as many as asked for: ``make damage``, or
``python tests/heavy/descriptions.py --count 1000000 --kinds scene,message --seed 2``.

Exits with a traceback at the first that is neither taken nor refused; build/damaged/ then holds it.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

import damaged_descriptions as descriptions


def main() -> None:
    """The table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=2000, help="of each kind (default: %(default)s)")
    parser.add_argument("--kinds", default=",".join(sorted(descriptions.KINDS)))
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    folder = Path(__file__).parents[2] / "build/damaged"
    folder.mkdir(parents=True, exist_ok=True)
    print("| kind | damaged | taken | refused | s |\n|---|---|---|---|---|")
    for kind in args.kinds.split(","):
        begun = time.monotonic()
        found = descriptions.run(kind, args.count, args.seed, folder)
        elapsed = time.monotonic() - begun
        print(f"| {kind} | {args.count} | {found['taken']} | {found['refused']} | {elapsed:.0f} |", flush=True)


if __name__ == "__main__":
    main()
