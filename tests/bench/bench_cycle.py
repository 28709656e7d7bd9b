# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of one control period of a simulated session in contact: read, touch step, record, write, and the plant.

Two runs of different length are counted, so that opening and closing the session cancel. A count says what no clock can
on a shared machine: it is the same to a few parts in a thousand from run to run.

Run: python bench_cycle.py build/dev/tests/bench/bench_cycle     (needs valgrind)
"""

import re
import shutil
import subprocess
import sys

SHORT, LONG = 10_000, 30_000


def count(program: str, scene: str, periods: int, *options: str) -> int:
    """Count the instructions of one run."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", *options, program, scene, str(periods)]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    found = re.search(r"Collected : (\d+)", said)
    if found is None:
        raise RuntimeError(said)
    return int(found[1])


def main() -> None:
    """Print one line for each scene, and one for the touch step."""
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is not here: instructions are not counted")
    for scene in ("hertz", "default"):
        difference = count(sys.argv[1], scene, LONG) - count(sys.argv[1], scene, SHORT)
        print(f"instructions of a period, scene {scene:<8}{difference / (LONG - SHORT):8.0f}")
    inside = [count(sys.argv[1], "hertz", periods, "--toggle-collect=nt_touch_step") for periods in (SHORT, LONG)]
    print(f"of them the touch step                {(inside[1] - inside[0]) / (LONG - SHORT):8.0f}")


if __name__ == "__main__":
    main()
