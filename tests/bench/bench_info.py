# SPDX-License-Identifier: BSD-3-Clause
"""Processor time of `nanotouch info FILE`, its guarded process included, beside that of Python with numpy, in one run.
An editable install looks for what has to be built first: measure an installed wheel.

Usage: python tests/bench/bench_info.py FILE [FILE ...]"""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys

TURNS = 5


def used(command: list[str]) -> float:
    """Of the command and the processes that it waited for [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def main(files: list[str]) -> None:
    """The median of each, measured in turns."""
    commands = {"import numpy": [sys.executable, "-c", "import numpy"]}
    commands |= {file: [sys.executable, "-m", "nanotouch_app", "info", file] for file in files}
    taken: dict[str, list[float]] = {name: [] for name in commands}
    for _ in range(TURNS):
        for name, command in commands.items():
            taken[name].append(used(command))
    for name, times in taken.items():
        print(f"{statistics.median(times):.3f} s  {name}")


if __name__ == "__main__":
    main(sys.argv[1:])
