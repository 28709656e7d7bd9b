# SPDX-License-Identifier: BSD-3-Clause
"""A sample of the matrix of extremes: nothing is wrong. ``make heavy`` makes the whole (tests/heavy/extremes.py)."""

from __future__ import annotations

import itertools

import extremes
import extremes_scenes
import numpy as np
import pytest
from extremes import KINDS
from extremes_laws import LAWS


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_laws(law: extremes.Law) -> None:
    for kind in KINDS:
        found = extremes.of_law(law, kind, np.random.default_rng(1), 5)
        assert not found.wrong, kind
        assert found.tried == found.right + sum(found.refused.values())


def test_a_wrong_law_is_found() -> None:
    """Derjaguin's form in place of the sphere, and a force that is not held."""
    wrong = LAWS[0]._replace(call=LAWS[1].call)
    assert len(extremes.of_law(wrong, "30 decades", np.random.default_rng(1), 40).wrong) > 5
    assert extremes.of_law(LAWS[0]._replace(hold=""), "zeros", np.random.default_rng(1), 1).wrong


@pytest.mark.parametrize("kind", KINDS)
def test_plans_loop_and_fits(kind: str) -> None:
    """A tenth of the fields."""
    rng = np.random.default_rng(2)
    trials = [
        *extremes_scenes.plans(kind, "humid", rng, 1), *extremes_scenes.plans(kind, "in water", rng, 1),
        *extremes_scenes.loop(kind, rng, 1), *extremes_scenes.fits(kind, rng, 3),
    ]  # fmt: skip
    found = extremes.cell(itertools.islice(trials, int(rng.integers(10)), None, 10))
    assert found.tried > 5
    assert not found.wrong
