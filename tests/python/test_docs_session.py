# SPDX-License-Identifier: BSD-3-Clause
"""docs/session.md: its Python runs as printed."""

import re
from pathlib import Path

import pytest

PAGE = Path(__file__).parent.parent.parent / "docs/session.md"
BLOCKS = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.DOTALL)


@pytest.mark.parametrize("number", range(len(BLOCKS)))
def test_a_block_runs(number: int, capsys: pytest.CaptureFixture[str]) -> None:
    exec(compile(BLOCKS[number], f"{PAGE}, block {number}", "exec"), {"nt": __import__("nanotouch")})
    assert "Error" not in capsys.readouterr().out
