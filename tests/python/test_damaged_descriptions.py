# SPDX-License-Identifier: BSD-3-Clause
"""Damaged scenes, rigs, recordings and messages: taken or refused, never a traceback. More of them: ``make damage``."""

from __future__ import annotations

from pathlib import Path

import damaged_descriptions
import pytest


@pytest.mark.parametrize("kind", sorted(damaged_descriptions.KINDS))
def test_some_damaged_descriptions(tmp_path: Path, kind: str) -> None:
    found = damaged_descriptions.run(kind, 60, 1, tmp_path)
    assert found["taken"] > 0  # most of it is sound
    assert found["refused"] > 0  # and the damage is felt
    assert set(found) == {"taken", "refused"}
