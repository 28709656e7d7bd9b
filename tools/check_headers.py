# SPDX-License-Identifier: BSD-3-Clause
"""Check that every public header compiles alone, as C99, C11 and C++17, without a warning; that each public function
has a comment of its own right above it, and each floating-point field its unit in brackets (or its choices: "no|yes").

Usage: check_headers.py CC
"""

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

INCLUDE = Path(__file__).resolve().parent.parent / "libnanotouch/include"
FLAGS = ["-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Werror"]
LANGUAGES = (("c", "c99"), ("c", "c11"), ("c++", "c++17"))

PROTOTYPE = re.compile(r"^NT_API[^;{}]*?\b(nt_\w+)\s*\(", re.MULTILINE)
STRUCT = re.compile(r"^(?:typedef )?struct \w+ \{\n(.*?)^\}", re.MULTILINE | re.DOTALL)
FIELD = re.compile(r"^ +(?:const )?(?:double|float)\s+([^;*]+);", re.MULTILINE)
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
UNIT = re.compile(r"\[[^\]]+\]|\"[^\"]*\|")


def silent_functions(text: str) -> Iterator[tuple[int, str]]:
    """Yield line and name of the public functions without a comment that ends on the line above."""
    ends = {
        comment.end() for comment in COMMENT.finditer(text) if text[: comment.start()].rpartition("\n")[2].strip() == ""
    }
    for function in PROTOTYPE.finditer(text):
        if function.start() - 1 not in ends:
            yield text.count("\n", 0, function.start()) + 1, function[1]


def fields_without_unit(text: str) -> Iterator[tuple[int, str]]:
    """Yield line and name of the fields whose comment, beside or right above them, has no unit."""
    for struct in STRUCT.finditer(text):
        for field in FIELD.finditer(struct[1]):
            beside = re.match(r"[ \t]*(/\*.*?\*/)?", struct[1][field.end() :], re.DOTALL)
            above = (
                struct[1][: field.start()].rstrip().rpartition("/*")[2]
                if struct[1][: field.start()].endswith("*/\n")
                else ""
            )
            if not UNIT.search((beside[0] if beside else "") + above):
                yield text.count("\n", 0, struct.start(1) + field.start()) + 1, field[1]


def undocumented(header: Path) -> int:
    """Print what a header leaves unsaid; return how often."""
    text = header.read_text(encoding="utf-8")
    said = [f"{header}:{line}: {name} has no comment of its own right above" for line, name in silent_functions(text)]
    said += [f"{header}:{line}: {name} has no unit in brackets" for line, name in fields_without_unit(text)]
    print(*said, sep="\n", end="\n" if said else "")
    return len(said)


def main() -> int:
    """Check each header, and compile it as each language; return the number of failures."""
    headers = sorted(INCLUDE.glob("nanotouch/**/*.h"))
    failures = sum(undocumented(header) for header in headers)
    for header in headers:
        for language, standard in LANGUAGES:
            source = f'#include "{header.relative_to(INCLUDE).as_posix()}"\n'
            command = [sys.argv[1], f"-std={standard}", *FLAGS, "-I", str(INCLUDE), "-x", language, "-"]
            failures += subprocess.run(command, input=source, text=True, check=False).returncode != 0
    print(f"{len(headers)} headers in {len(LANGUAGES)} languages: {failures} failures")
    return min(failures, 99) if headers else 1


if __name__ == "__main__":
    sys.exit(main())
