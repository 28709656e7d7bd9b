# SPDX-License-Identifier: BSD-3-Clause
"""Each line of the threat model names a test, and that test exists."""

from __future__ import annotations

import re
from pathlib import Path

PAGE = Path(__file__).parents[2] / "docs" / "security.md"


def test_each_line_has_a_test_that_exists() -> None:
    text = PAGE.read_text(encoding="utf-8")
    named = re.findall(r"`(test_\w+\.py)::(test_\w+)`", text)
    assert len(named) > 20
    for file, test in named:
        assert f"def {test}(" in (Path(__file__).parent / file).read_text(encoding="utf-8"), f"{file}::{test}"
    for section in ("Code", "Files", "Pages, programs"):
        part = text.partition(f"## {section}\n")[2].partition("\n## ")[0]
        rows = [row for row in part.splitlines() if row.startswith("| ") and not row.endswith("| test |")]
        assert rows
        assert all("::test_" in row for row in rows), section
