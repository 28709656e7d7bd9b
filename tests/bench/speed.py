# SPDX-License-Identifier: BSD-3-Clause
"""docs/speed.md from what `make bench` measured: this version, the one before, and what was aimed at.

Run: python speed.py FOLDER     (where bench_contact_dispatched.json and bench_contact_x86-64-v3.json are)
     python speed.py            (the page again from the measurements that are kept in speed.json)
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs/speed.md"
LAMBDA = 5.8

HEAD = """# Speed

What one element of an array costs: in nanoseconds, and in multiples of Hertz' force written inline (AVX2,
{hertz:.2g} ns). *Counted* are instructions with AVX2. Unlike times they are the same on every run: a test fails where
one grows by 3 % (`tests/bench/instructions.json`, `test_cycle.py`). So are those of a step of a session in C, and,
of a scalar call and `session.step` from Python, the bytecode instructions and the calls into C
(`test_cycle_python.py`). The times are of one machine: {machine}; λ = 5.8.

`make bench` measures, `python tests/bench/speed.py build/release/tests/bench` writes this page.

| call | ns | Hertz | with AVX2: ns | Hertz | last version: ns | numba: ns | limit | counted |
|---|---|---|---|---|---|---|---|---|
"""

TAIL = """
F alone comes {ratio:.2g} times as fast from the table as U, F, k and a. The first *ns* are of what the processor
offers, here AVX-512. Both give the same bits. *numba* is a plain loop over Hertz and one of Newton's method
over JKR, with neither branches nor a check (`tests/bench/peer_loops.py`, where numba is installed).

## What made the difference

- Newton's method runs in all lanes of a block until the last has converged; a lane that has, stays. So an array has
  the bits of the scalar law.
- Selections instead of jumps. gcc makes jumps of them again (`-ftree-pre`), so this pass is off for the exact kernel:
  64 became 42 ns.
- A sum over a block stands in a loop of its own: inside the loop of Newton's method it keeps gcc from vectorising.
- The cells of a table are transposed, four at a time, before their cubics are taken. The arrays between begin on a
  cache line: else the time is 4.9 or 6.2 ns, as chance has it.
- The folds of one λ are explicit: the branch parameter y of each is a smooth function of λ, in eighths of which a
  polynomial has all of its digits (`tools/maugis_folds.py`); the four points of the branch are then one vector. Numbers
  that have just been stored one by one are not read as a vector, which would wait for them: 130 became 97 ns.
- So every element of an array may have a contact of its own, in the same block.

## What did not help

- Gathering the cells inside the loop that evaluates them: gcc 12 finds the loads not suitable, and the loop stays
  scalar.
- `restrict` on the block that is written: gcc 12 left the variants for other instruction sets scalar. Results that
  stand in the block that is read are vectorised.

## Not yet

- With AVX2 the exact array costs up to {worst:.3g} Hertz, for 100.
"""


def measured(folder: Path) -> None:
    """Take the measurements of a folder into speed.json."""
    kept = json.loads((HERE / "speed.json").read_text())
    files = {"now": "bench_contact_dispatched.json", "avx2": "bench_contact_x86-64-v3.json"}
    for column, name in files.items():
        found = json.loads((folder / name).read_text())["benchmarks"]
        times = {row["name"]: row["ns"] for row in found if row["lambda"] == LAMBDA}
        for row in kept["rows"]:
            row[column] = times[row["bench"]]
        if column == "avx2":
            kept["hertz"] = times["hertz array"]
            kept["avx2_worst"] = max(row["hertz"] for row in found if row["name"] == "maugis exact array")
    peers = folder / "peers.json"
    if peers.exists():
        times = json.loads(peers.read_text())
        kept["rows"] = [row | ({"peer": times[row["bench"]]} if row["bench"] in times else {}) for row in kept["rows"]]
    lines = ",\n    ".join(json.dumps(row) for row in kept.pop("rows"))
    text = json.dumps(kept, indent=2)[:-2] + f',\n  "rows": [\n    {lines}\n  ]\n}}\n'
    (HERE / "speed.json").write_text(text)


def page() -> str:
    """The page from what is kept."""
    kept: dict[str, Any] = json.loads((HERE / "speed.json").read_text())
    counts: dict[str, float] = json.loads((HERE / "instructions.json").read_text())["element"]
    hertz, times = kept["hertz"], {row["bench"]: row["now"] for row in kept["rows"]}
    text = HEAD.format(hertz=hertz, machine=kept["machine"])
    for row in kept["rows"]:
        now, avx2 = row["now"], row["avx2"]
        count = f"{counts[row['count']]:.4g}" if row["count"] else ""
        peer = f"{row['peer']:.3g}" if row.get("peer") else ""
        text += (
            f"| {row['call']} | {now:.3g} | {now / hertz:.3g} | {avx2:.3g} | {avx2 / hertz:.3g} | {row['last']:.4g} "
            f"| {peer} | {row['limit']} | {count} |\n"
        )
    ratio = times["maugis table array U F k a"] / times["maugis table array"]
    return text + TAIL.format(ratio=ratio, worst=kept["avx2_worst"])


def main() -> None:
    """Write the page."""
    if len(sys.argv) > 1:
        measured(Path(sys.argv[1]))
    PAGE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
