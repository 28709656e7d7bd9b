# SPDX-License-Identifier: BSD-3-Clause
"""Print what pyproject.toml asks for, one requirement per line: to build, to run, and for the extras named.

Usage: requirements.py all,test
"""

import re
import sys
import tomllib
from pathlib import Path
from typing import Any


def requirements_of(extras: dict[str, list[str]], name: str) -> set[str]:
    """Return the requirements of one extra, with `nanotouch[a,b]` resolved to those of a and b."""
    found: set[str] = set()
    for requirement in extras[name]:
        own = re.fullmatch(r"nanotouch\[(.*)\]", requirement)
        found |= {r for n in own[1].split(",") for r in requirements_of(extras, n)} if own else {requirement}
    return found


def main() -> None:
    """Print the sorted list."""
    data: dict[str, Any] = tomllib.loads((Path(__file__).parent.parent / "pyproject.toml").read_text())
    wanted = {*data["build-system"]["requires"], *data["project"]["dependencies"]}
    for name in sys.argv[1].split(","):
        wanted |= requirements_of(data["project"]["optional-dependencies"], name)
    print("\n".join(sorted(wanted)))


if __name__ == "__main__":
    main()
