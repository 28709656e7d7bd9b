# SPDX-License-Identifier: BSD-3-Clause
"""Check that every public header compiles alone, as C99, C11 and C++17, without a warning.

Usage: check_headers.py CC
"""

import subprocess
import sys
from pathlib import Path

INCLUDE = Path(__file__).resolve().parent.parent / "libnanotouch/include"
FLAGS = ["-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror"]
LANGUAGES = (("c", "c99"), ("c", "c11"), ("c++", "c++17"))


def main() -> int:
    """Compile each header as each language; return the number of failures."""
    headers = sorted(INCLUDE.glob("nanotouch/*.h"))
    failures = 0
    for header in headers:
        for language, standard in LANGUAGES:
            source = f'#include "nanotouch/{header.name}"\n'
            command = [sys.argv[1], f"-std={standard}", *FLAGS, "-I", str(INCLUDE), "-x", language, "-"]
            failures += subprocess.run(command, input=source, text=True, check=False).returncode != 0
    print(f"{len(headers)} headers in {len(LANGUAGES)} languages: {failures} failures")
    return min(failures, 99) if headers else 1


if __name__ == "__main__":
    sys.exit(main())
