# SPDX-License-Identifier: BSD-3-Clause
"""Fifty touches that are killed or interrupted at random moments, and full disks: are all rows there that were due?
``make heavy``

What was due, and how it is known: tests/python/interruptions.py. Every row must be that of a touch that was left alone.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

import interruptions
from interruptions import Ending
from nanotouch import record

SHARE = 0.998  # of the rows that were due
DURATION = "200s"  # 2 million rows
LATEST = 2.0  # signal [s], after the first block
DISKS = (1 << 20, 10 << 20)  # smallest and largest [bytes]


def report(what: str, endings: list[Ending], whole: record.Recording) -> bool:
    """One row of the table; whether it fails."""
    due, readable = (sum(getattr(ending, name) for ending in endings) for name in ("due", "readable"))
    begun = sum(ending.begun for ending in endings)
    least = min((min(1.0, e.readable / e.due) for e in endings if e.due), default=1.0)
    wrong = [e for e in endings if e.recording is not None and not interruptions.same_rows(e.recording, whole)]
    unmarked = [e for e in endings if e.recording is not None and e.recording.incomplete is None]
    loud = [e for e in endings if e.said.count("\n") > 1 or "Traceback" in e.said]
    statuses = sorted({ending.status for ending in endings})
    of_begun = 100 * readable / max(begun, 1)
    print(
        f"{what:20} {len(endings):4} {due:10} {readable:10} {100 * least:9.4f} % {of_begun:9.4f} %"
        f"   {statuses}, {len(wrong)} wrong, {len(unmarked)} not marked, {len(loud)} loud",
        flush=True,
    )
    return least < SHARE or len(statuses) > 1 or bool(wrong or unmarked or loud)


def on_small_disk(folder: Path, size: int) -> Ending | None:
    """On a file system in memory of this size [bytes]; None where none may be mounted."""
    folder.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "tmpfs", folder], capture_output=True).returncode:
        return None
    try:
        return interruptions.out_of_space(folder, DURATION)
    finally:
        subprocess.run(["umount", folder], check=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=50, help="signals")
    parser.add_argument("--disks", type=int, default=5, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    rng = np.random.default_rng(options.seed)
    with tempfile.TemporaryDirectory(prefix="nanotouch-kills-") as name:
        place = Path(name)
        whole = interruptions.out_of_space(place / "whole", DURATION).recording
        assert whole is not None
        assert whole.incomplete is None
        print(f"{'':20} runs        due   readable   least of due   of all begun")
        endings: dict[str, list[Ending]] = {}
        for run in range(options.runs):
            number = interruptions.SIGNALS[run % len(interruptions.SIGNALS)]
            ending = interruptions.signalled(place / f"run{run}", number, rng.uniform(0.0, LATEST), DURATION)
            endings.setdefault(number.name, []).append(ending)
        for run in range(options.disks):
            size = int(rng.integers(*DISKS))
            limited = interruptions.out_of_space(place / f"limit{run}", DURATION, size)
            endings.setdefault("limit on file size", []).append(limited)
            full = on_small_disk(place / f"disk{run}", size)
            if full is not None:
                endings.setdefault("full disk", []).append(full)
        failed = [report(what, found, whole) for what, found in endings.items()]
    if "full disk" not in endings and options.disks:
        print("full disk: left out, no file system may be mounted here")
    return int(any(failed))


if __name__ == "__main__":
    sys.exit(main())
