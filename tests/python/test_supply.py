# SPDX-License-Identifier: BSD-3-Clause
"""What is installed and run for us is pinned: packages by hash, actions by commit; the list of parts is the lock's."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from nanotouch.extras import ADDS

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(not (ROOT / "tools").is_dir(), reason="only in a checkout")


def _name(requirement: str) -> str:
    found = re.match(r"[A-Za-z0-9._-]+", requirement)
    assert found is not None
    return re.sub(r"[-_.]+", "-", found[0]).lower()


def _packages(lock: str) -> list[dict[str, object]]:
    done = subprocess.run([sys.executable, str(ROOT / "tools/sbom.py"), str(ROOT / f"tools/lock/{lock}.txt")],
                          capture_output=True, text=True, check=True)  # fmt: skip
    found: list[dict[str, object]] = json.loads(done.stdout)["components"]
    return found


@pytest.mark.parametrize(("lock", "extras"), [("demo", "all"), ("test", "all,test")])
def test_the_locks_hold_what_is_asked_for_with_hashes(lock: str, extras: str) -> None:
    """Where this fails, pyproject.toml asks for a package that `make lock` has not seen."""
    line = [sys.executable, str(ROOT / "tools/requirements.py"), extras]
    asked = subprocess.run(line, capture_output=True, text=True, check=True).stdout.split("\n")
    text = (ROOT / f"tools/lock/{lock}.txt").read_text(encoding="utf-8")
    blocks = re.split(r"\n(?=\S)", text.strip())
    held = {_name(block) for block in blocks}
    assert {_name(one) for one in asked if one} <= held
    for block in blocks:
        assert re.match(r"\S+==\S+", block), block[:80]
        assert re.search(r"--hash=sha256:[0-9a-f]{64}", block), block[:80]
    assert "://" not in text


def test_actions_are_pinned_by_commit() -> None:
    for file in (ROOT / ".github/workflows").glob("*.yml"):
        for used in re.findall(r"uses:\s*(\S+)", file.read_text(encoding="utf-8")):
            assert re.fullmatch(r"[\w./-]+@[0-9a-f]{40}", used), f"{file.name}: {used}"


def test_the_list_of_parts_is_that_of_the_lock() -> None:
    text = (ROOT / "tools/lock/demo.txt").read_text(encoding="utf-8")
    found = _packages("demo")
    assert [f"{one['name']}=={one['version']}".lower() for one in found] == [
        re.sub(r"[-_.]+", "-", name).lower() + "==" + version.lower()
        for name, version in re.findall(r"^(\S+)==([^\s;]+)", text, re.MULTILINE)
    ]
    assert len({str(one["bom-ref"]) for one in found}) == len(found)
    assert all(one["purl"] == f"pkg:pypi/{one['name']}@{one['version']}" for one in found)


def test_the_page_on_installing_knows_every_extra() -> None:
    text = (ROOT / "docs/howto/install.md").read_text(encoding="utf-8")
    assert dict(re.findall(r"^\| `(\w+)` \| (.+?) \|$", text, re.MULTILINE)) == {
        name: re.sub(r"(nanotouch [\w -]+)$", r"`\1`", adds) for name, adds in ADDS.items()
    }


def test_no_page_installs_by_a_name_that_no_index_has() -> None:
    """Until the first release is published; then it may."""
    for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
        assert not re.search(r"pip install '?nanotouch\b(?!-)", page.read_text(encoding="utf-8")), page.name
