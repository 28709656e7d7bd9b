# SPDX-License-Identifier: BSD-3-Clause
"""A million forces from Python, per element, beside what bench_contact.c measures for arrays in C on the same machine.

Processor time of this process, the least of several runs.

Run: python bench_contact.py FOLDER     (where bench_contact_dispatched.json is: build/release/tests/bench)
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
from nanotouch.contact import reduced
from timing import least

COUNT = 1_000_000
RUNS = {"table": 30, "polished": 10, "exact": 3}


def main() -> None:
    """Print one line per tier."""
    measured = json.loads((Path(sys.argv[1]) / "bench_contact_dispatched.json").read_text())["benchmarks"]
    in_c = {row["name"]: row["ns"] for row in measured if row["lambda"] == 1.0}
    d = np.random.default_rng(1).uniform(-1.0, 9.0, COUNT)
    out = np.empty_like(d)
    for tier in reduced.TIERS:
        seconds = least(lambda tier=tier: reduced.force(1.0, d, tier=tier, out=out), RUNS[tier])  # type: ignore[misc]
        ns, c = seconds / COUNT * 1e9, in_c[f"maugis {tier} array"]
        print(f"{tier:<10}{ns:>10.4g} ns{c:>10.4g} ns in C{ns / c:>8.3g}")


if __name__ == "__main__":
    main()
