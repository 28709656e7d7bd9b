# SPDX-License-Identifier: BSD-3-Clause
"""Coverage has floors (``make coverage``), and no commit has lowered one."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import pytest

ROOT = Path(__file__).parents[2]
TOOL = ROOT / "tools/coverage.py"
pytestmark = pytest.mark.skipif(not TOOL.exists(), reason="needs the source tree")
FILE = "tests/coverage/floors.toml"


@pytest.fixture(scope="module")
def tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("nanotouch_coverage", TOOL)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # its dataclasses look for it there
    spec.loader.exec_module(module)
    return module


def test_a_figure_below_its_floor_is_named(tool: ModuleType) -> None:
    floors = {"hal": {"lines": 90.0, "mcdc": 70.0}, "scan": {"lines": 80.0}}
    assert tool.judge({"hal": {"lines": 90.0, "mcdc": 70.4}, "scan": {"lines": 81.0}}, floors) == []
    wrong = tool.judge({"hal": {"lines": 89.9, "mcdc": 70.4}}, floors)
    assert wrong == ["hal: lines 89.90 %, below 90.0 %", "scan: nothing was measured"]


def test_floors_are_raised_and_never_lowered(tool: ModuleType) -> None:
    old = {"hal": {"lines": 90.0, "branches": 80.0, "mcdc": 70.0}}
    figures = {"hal": {"lines": 91.7, "branches": 79.0, "mcdc": 100.0}}
    now = tomllib.loads(tool.raised(figures, old))
    assert now == {"hal": {"lines": 91.0, "branches": 80.0, "mcdc": 100.0}}
    assert tool.lowered(old, now) == []
    assert tool.lowered(now, old) == ["hal: lines 91.0 % -> 90.0 %", "hal: mcdc 100.0 % -> 70.0 %"]


def test_no_commit_has_lowered_a_floor(tool: ModuleType) -> None:
    """Against each version of the file that this checkout knows."""

    def git(*arguments: str) -> str:
        done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
        return done.stdout if done.returncode == 0 else ""

    newest = tomllib.loads((ROOT / FILE).read_text())
    assert newest["all"]["lines"] > 80.0
    for commit in git("log", "--format=%H", "-n", "20", "--", FILE).split():
        older = tomllib.loads(git("show", f"{commit}:{FILE}"))
        assert tool.lowered(older, newest) == [], commit
