# SPDX-License-Identifier: BSD-3-Clause
"""A strict type checker accepts the programs of the pages, of the gallery and of ``apps/python``."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [
    ROOT / "README.md",
    *(path for folder in ("", "howto", "tutorials") for path in (ROOT / "docs" / folder).glob("*.md")),
]
PROGRAMS = [*(ROOT / "docs/examples").glob("*/*.py"), *(ROOT / "apps/python").glob("*.py")]
BLOCK = re.compile(r"^ *```(?:python|\{testsetup\}|\{testcode\})\n(.*?)^ *```", re.MULTILINE | re.DOTALL)
IN_PARTS = "hal.md"
"""shows parts of docs/examples/hal, which is checked as a whole"""

SETTINGS = """[mypy]
strict = true
allow_untyped_defs = true
allow_untyped_calls = true
allow_redefinition = true
ignore_missing_imports = true
error_summary = false
"""
"""a reader's own functions need no annotations"""


def program(page: str) -> str:
    """The blocks of a page, each where it stands, so that an error names its line; the heading gives way to what every
    page takes for granted."""
    lines = [""] * (page.count("\n") + 1)
    for block in BLOCK.finditer(page):
        first = page.count("\n", 0, block.start(1))
        for at, line in enumerate(dedent(block[1]).splitlines(), first):
            lines[at] = line
    lines[0] = "import nanotouch as nt; import numpy as np; import pytest"
    return "\n".join(lines) + "\n"


def test_programs_of_the_docs_have_right_types(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    (tmp_path / "mypy.ini").write_text(SETTINGS)
    pages = {f"{page.stem}.md": program(page.read_text(encoding="utf-8")) for page in PAGES if page.name != IN_PARTS}
    found = {name: text for name, text in pages.items() if text.strip().count("\n")}
    assert len(found) > 20
    for name, text in found.items():
        (tmp_path / f"page_{name.removesuffix('.md')}.py").write_text(text)
    for path in PROGRAMS:
        (tmp_path / f"{path.parent.name}_{path.name}").write_bytes(path.read_bytes())
    command = [sys.executable, "-m", "mypy", *sorted(path.name for path in tmp_path.glob("*.py"))]
    environment = {**os.environ, "MYPY_CACHE_DIR": str(tmp_path / "cache")}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.stderr + done.stdout == ""
    assert done.returncode == 0
