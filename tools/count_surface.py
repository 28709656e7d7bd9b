#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Who calls what of the C surface: counts of headers and functions; with ``--list`` each function with its callers."""

from __future__ import annotations

import argparse
import re
import subprocess
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HEADERS = ROOT / "libnanotouch/include/nanotouch"
CALLERS = {"bindings": "bindings", "apps": "apps", "examples": "docs/examples", "install": "tests/install"}


def declared() -> dict[str, Path]:
    """Every public function with its header."""
    pattern = re.compile(r"^(?:NT_API|NT_INLINE|static inline)[^;{}]*?\b(nt_\w+)\s*\(", re.M | re.S)
    return {
        name: header for header in sorted(HEADERS.rglob("*.h"))
        for name in pattern.findall(header.read_text(encoding="utf-8"))
    }  # fmt: skip


def callers() -> dict[str, set[str]]:
    """Every word that begins like a function, with the groups of files that name it."""
    found: dict[str, set[str]] = defaultdict(set)
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in listed.splitlines():
        group = next((group for group, folder in CALLERS.items() if name.startswith(f"{folder}/")), None)
        if name.endswith(".md") and not name.startswith("docs/evidence") and name != "CHANGELOG.md":
            group = "docs"
        if group and name.endswith((".c", ".h", ".cpp", ".py", ".md", ".ino")):
            for word in re.findall(r"\bnt_\w+", (ROOT / name).read_text(encoding="utf-8")):
                found[word].add(group)
    return found


def main() -> None:
    """Print the counts."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--list", action="store_true", help="each function, its header and who names it")
    args = parser.parse_args()
    functions, users = declared(), callers()
    advanced = {name for name, header in functions.items() if header.parent.name == "advanced"}
    for label, folder, names in (
        ("public", HEADERS, functions.keys() - advanced), ("advanced", HEADERS / "advanced", advanced)
    ):  # fmt: skip
        unused = [name for name in names if not users.get(name)]
        print(
            f"{label}: {len(list(folder.glob('*.h')))} headers, {len(names)} functions, {len(unused)} without a caller"
        )
    if args.list:
        for name, header in functions.items():
            print(f"{header.relative_to(HEADERS)} {name}: {', '.join(sorted(users.get(name, ()))) or '-'}")


if __name__ == "__main__":
    main()
