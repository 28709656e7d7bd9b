# SPDX-License-Identifier: BSD-3-Clause
"""The words of the field: those of the house do not come back (``tools/words.py`` lists where they still stand)."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

TOOL = Path(__file__).parents[2] / "tools/words.py"
pytestmark = pytest.mark.skipif(not TOOL.exists(), reason="needs the source tree")
LEFT = {"files": 40, "C": 57, "Python": 40, "messages": 75}
"""how many there are; lower it with each renaming"""


def test_words_of_the_house_become_fewer() -> None:
    spec = importlib.util.spec_from_file_location("words", TOOL)
    assert spec is not None
    assert spec.loader is not None
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    found = tool.counted()
    for kind, most in LEFT.items():
        words = {word: tool.WORDS[word] for word in found[kind]}
        assert sum(map(len, found[kind].values())) <= most, f"{kind}: {words} (tools/words.py --list)"
