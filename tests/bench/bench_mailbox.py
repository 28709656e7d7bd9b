# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of a poll of a mailbox: what the session's end adds to a tick, its look at the clock included.

Run: python bench_mailbox.py build/dev/tests/bench/bench_mailbox [MOST]     (needs valgrind)

With MOST it fails if reading and writing together take more instructions than that: one of the tests.
"""

import shutil
import sys

from bench_cycle import count

SHORT, LONG = 1_000, 3_000


def main() -> int:
    """Print one line for each call and kind of poll."""
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is not here: instructions are not counted")
    most = float(sys.argv[2]) if len(sys.argv) > 2 else float("inf")
    largest = 0.0
    for kind in ("new", "old"):
        total = 0.0
        for call in ("nt_hal_read", "nt_hal_write"):
            short, long = (count(sys.argv[1], kind, polls, f"--toggle-collect={call}") for polls in (SHORT, LONG))
            total += (long - short) / (LONG - SHORT)
            print(f"instructions of {call:<13}{kind} reading {(long - short) / (LONG - SHORT):6.0f}")
        largest = total if total > largest else largest
    print(f"of a poll, at most {largest:24.0f}")
    return int(not largest <= most)


if __name__ == "__main__":
    sys.exit(main())
