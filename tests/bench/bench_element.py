# SPDX-License-Identifier: BSD-3-Clause
"""Instructions of one element of an array of a law, and of a step, counted by valgrind: no clock of a shared machine
says them.

valgrind knows no AVX-512: these are the counts of AVX2.

Run: python bench_element.py build/dev/tests/bench/bench_element     (needs valgrind)
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

COUNT = 4096


def counts(program: str) -> dict[str, float]:
    """Instructions of an element of each array, by the names in bench_element.c."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "callgrind.out"
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={file}", program]
        subprocess.run(command, capture_output=True, text=True, check=True)
        shown = ["callgrind_annotate", "--inclusive=yes", "--threshold=100", str(file)]
        text = subprocess.run(shown, capture_output=True, text=True, check=True).stdout
    found = re.findall(r"^\s*([\d,]+) .*?:element_(\w+)", text, flags=re.MULTILINE)
    return {name: int(number.replace(",", "")) / COUNT for number, name in found}


def main() -> None:
    """Print one line for each."""
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is not here: instructions are not counted")
    for name, number in counts(sys.argv[1]).items():
        print(f"instructions of an element, {name:<14}{number:8.1f}")


if __name__ == "__main__":
    main()
