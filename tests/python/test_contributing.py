# SPDX-License-Identifier: BSD-3-Clause
"""CONTRIBUTING.md leads to what there is: every path exists, every function of a walk is in the file that it names."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = re.sub(r"```.*?```", "", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"), flags=re.DOTALL)
FOLDERS = ("apps", "bindings", "docs", "libnanotouch", "tests", "tools")
PATH = re.compile(rf"(?:{'|'.join(FOLDERS)})/[\w./]+\w")
PATHS = sorted({path for quoted in re.findall(r"`([^`]+)`", PAGE) for path in PATH.findall(quoted)})
STEPS = re.findall(r"^\| `([^`]+)` \| (.*) \|$", PAGE, re.MULTILINE)


@pytest.mark.parametrize("path", [*PATHS, *re.findall(r"\]\(([^)#:]+)\)", PAGE)])
def test_paths_exist(path: str) -> None:
    assert (ROOT / path).exists()


def test_there_are_four_walks() -> None:
    assert len(PATHS) > 30
    assert len(STEPS) > 25
    assert PAGE.count("| where | what |") == 4


@pytest.mark.parametrize(("path", "words"), STEPS)
def test_functions_of_a_step_are_in_its_files(path: str, words: str) -> None:
    """Each name that a step quotes is in the step's file, or in another one that the step names."""
    quoted = re.findall(r"`([^`]+)`", words)
    files = [path, *(name for name in quoted if "/" in name)]
    text = "\n".join((ROOT / file).read_text(encoding="utf-8") for file in files)
    names = [name.rpartition(".")[2] for name in quoted if "/" not in name]
    assert [name for name in names if not re.search(rf"\b{re.escape(name)}\b", text)] == []
