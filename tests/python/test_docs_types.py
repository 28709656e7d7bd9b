# SPDX-License-Identifier: BSD-3-Clause
"""A strict type checker accepts the programs of the pages, of the gallery and of ``apps/python``."""

from __future__ import annotations

import json
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
IN_PARTS = "backend.md"
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


@pytest.fixture
def programs(tmp_path: Path) -> Path:
    """A folder with all of them."""
    pages = {f"{page.stem}.md": program(page.read_text(encoding="utf-8")) for page in PAGES if page.name != IN_PARTS}
    found = {name: text for name, text in pages.items() if text.strip().count("\n")}
    assert len(found) > 20
    for name, text in found.items():
        (tmp_path / f"page_{name.removesuffix('.md')}.py").write_text(text)
    for path in PROGRAMS:
        (tmp_path / f"{path.parent.name}_{path.name}").write_bytes(path.read_bytes())
    return tmp_path


def said(folder: Path, *command: str) -> str:
    """What a checker complains of."""
    environment = {**os.environ, "MYPY_CACHE_DIR": str(folder / "cache")}
    words = [sys.executable, "-m", *command, *sorted(path.name for path in folder.glob("*.py"))]
    done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    return done.stderr + done.stdout


def test_programs_of_the_docs_have_right_types(programs: Path) -> None:
    pytest.importorskip("mypy")
    (programs / "mypy.ini").write_text(SETTINGS)
    assert said(programs, "mypy") == ""


def test_an_editor_sees_nothing_wrong_in_them(programs: Path) -> None:
    """What Pylance shows, by pyright: `make lint` has it."""
    pytest.importorskip("pyright", reason="pyright is not installed: make lint installs it")
    lenient = {"reportMissingImports": False, "reportPossiblyUnboundVariable": False}  # of its parts; after a loop
    (programs / "pyrightconfig.json").write_text(json.dumps(lenient))
    found = said(programs, "pyright", "--pythonpath", sys.executable, "--project", "pyrightconfig.json")
    assert "0 errors" in found, found
