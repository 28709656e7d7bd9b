#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What each backend keeps of the rules in docs/hal.md, as a table: ``make conformance``.

Usage: tools/conformance.py FOLDER [PROGRAM ...]    FOLDER has the tests in C; each PROGRAM is run, too
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

TESTS = (
    "test_hal_conformance", "test_hal_mailbox", "test_hal_spi", "test_hal_spi_fuse", "test_session_tapping_converters"
)  # fmt: skip
RULES = ("rehearsal", "at rest before arm", "close", "disarm", "no number", "silence", "loss")


def main(folder: str, *more: str) -> int:
    """Print the table; 1 if a test failed or printed no row."""
    print("| backend | " + " | ".join(RULES) + " |\n|" + "---|" * (len(RULES) + 1))
    failed = 0
    for program in [*(Path(folder) / name for name in TESTS), *map(Path, more)]:
        ran = subprocess.run([program], capture_output=True, text=True)
        rows = [line for line in ran.stdout.splitlines() if line.startswith("| ")]
        print(*rows, sep="\n", end="\n" if rows else "")
        if ran.returncode or not rows:
            words = "left out: this machine cannot run it" if not ran.returncode else ran.stderr.strip()[-400:]
            print(f"{program.name}: {words}", file=sys.stderr)
            failed += ran.returncode != 0
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
