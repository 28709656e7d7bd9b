# SPDX-License-Identifier: BSD-3-Clause
"""Run one program that was built for several machines, and compare what it prints.

same_bits.py PROGRAM PATTERN FOLDER...   lines that match PATTERN must be there, and the same from each build folder
"""

import re
import subprocess
import sys
from pathlib import Path


def lines_of(folder: str, program: str, pattern: str) -> list[str]:
    """Return the lines that are to be compared; PROGRAM.command says how the program is run."""
    command = Path(folder, f"{program}.command").read_text().split(";")
    run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=240)
    if run.returncode:
        sys.exit(f"{' '.join(command)}: exit code {run.returncode}\n{run.stdout}")
    return [line for line in run.stdout.splitlines() if re.search(pattern, line)]


def main() -> int:
    """Print what is the same and what is not; return 1 if anything differs, or if nothing was compared."""
    program, pattern, first, *others = sys.argv[1:]
    expected = lines_of(first, program, pattern)
    print(f"{program} of {Path(first).name}:\n" + "\n".join(expected))
    differ = 0
    for folder in others:
        found = lines_of(folder, program, pattern)
        print(f"{Path(folder).name}: " + ("the same" if found == expected else "not the same:\n" + "\n".join(found)))
        differ += found != expected
    return int(differ > 0 or not expected or not others)


if __name__ == "__main__":
    sys.exit(main())
