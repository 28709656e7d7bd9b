# SPDX-License-Identifier: BSD-3-Clause
"""The pull-off where lever and stage ring after a fast turn: ``tests/bench/bench_ringing.py``, with fewer curves."""

from __future__ import annotations

import numpy as np
import pytest
from nanotouch import curves
from synthetic_ringing import make

SPEEDS = (5e-6, 20e-6, 50e-6, 100e-6)  # m/s
CURVES = 60


def _found(seed: int, adhesion: tuple[float, float], ringing: tuple[float, float]) -> tuple[np.ndarray, list[str]]:
    """Truth and both ends of the interval [N], a row a curve; the notes of all."""
    rng = np.random.default_rng(seed)
    rows, notes = [], []
    for number in range(CURVES):
        truth, amplitude = rng.uniform(*adhesion), rng.uniform(*ringing)
        report = curves.analyse(make(rng, amplitude, truth, SPEEDS[number % len(SPEEDS)]))
        rows.append((truth, *report.pull_off_interval))
        notes += [note for note in report.notes if "free level after the turn" in note]
    return np.array(rows), notes


@pytest.mark.parametrize("adhesion", [(0.0, 0.0), (0.2e-9, 2e-9)])
def test_the_interval_holds_the_pull_off_where_the_lever_rings(adhesion: tuple[float, float]) -> None:
    """At least 93 % are asked for; 60 curves of 97 % hold 53 (88 %) or more, but for one draw in a thousand."""
    found, notes = _found(40, adhesion, (50e-12, 150e-12))
    held = (found[:, 1] <= found[:, 0]) & (found[:, 0] <= found[:, 2])
    assert held.mean() >= 0.88  # of those at which nothing adheres, 59 % before
    assert len(notes) >= CURVES // 4


def test_ringing_is_not_seen_where_there_is_none() -> None:
    """Noise shows it in less than one curve of a hundred; and a clean pull-off stays as well known as it was."""
    found, notes = _found(41, (0.2e-9, 2e-9), (0.0, 0.0))
    assert len(notes) <= 2
    assert np.median(found[:, 2] - found[:, 1]) < 200e-12


@pytest.mark.parametrize("ringing", [(0.0, 0.0), (5e-12, 150e-12)])
def test_a_hold_of_few_samples_is_in_its_interval(ringing: tuple[float, float]) -> None:
    """Of 30 to 150 pN, near the noise or torn between two samples. Of 96 %, 60 curves hold 52 (87 %) or more, but for
    one draw in a thousand; 82 % of them were held."""
    found, _ = _found(42, (30e-12, 150e-12), ringing)
    held = (found[:, 1] <= found[:, 0]) & (found[:, 0] <= found[:, 2])
    assert held.mean() >= 0.87
    assert np.median(found[:, 2] - found[:, 1]) < 200e-12
