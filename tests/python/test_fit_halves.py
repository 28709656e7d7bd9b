# SPDX-License-Identifier: BSD-3-Clause
"""A slip or a bow of 3 nm in a contact is told and covered; a curve without one is left alone."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("nanotouch._fit")
sys.path.insert(0, str(Path(__file__).parents[1] / "bench"))

import bench_slip
from nanotouch import curves, fit

STIFF = bench_slip.SAMPLES[2]  # 100 kPa


@pytest.mark.parametrize("sample", bench_slip.SAMPLES)
def test_a_clean_contact_is_not_doubted(sample: tuple[float, float, float, float]) -> None:
    error, sigma, wrong, told = bench_slip.row(sample, "none", 30)
    assert told == 0.0
    assert wrong == 0.0
    assert error < sigma < 0.01


@pytest.mark.parametrize("defect", ["slip", "bow"])
def test_a_defect_is_told_and_sigma_covers_it(defect: str) -> None:
    error, sigma, wrong, told = bench_slip.row(STIFF, defect, 30)
    assert told == 1.0
    assert wrong <= 0.1
    assert 0.02 < error < 3.0 * sigma


def test_a_soft_layer_on_a_hard_one_says_both_moduli() -> None:
    """F = a d^1.5 up to 50 nm, stiffening beyond: the moduli of both halves lie on either side of the fitted one."""
    rng = np.random.default_rng(3)
    depth = np.linspace(0.0, 100e-9, 3000)
    force = 4.0 / 3.0 * 1e4 * np.sqrt(1e-6) * depth**1.5 * (1.0 + (depth / 80e-9) ** 2)
    base = depth + force / 0.1
    x = np.linspace(-1e-6, base[-1], 2000)
    measured = np.interp(x, base, force, left=0.0) + rng.normal(0.0, 2e-12, x.size)
    segment = curves.Segment("approach", np.full(x.size, np.nan), -x, "height (measured)", measured)
    result = fit.fit_curve(curves.ForceCurve((segment,), {"spring constant": 0.1}, "layer"), "hertz", radius=1e-6)
    (note,) = [note for note in result.notes if note.startswith("the shallow half")]
    assert "slip" in note
    fitted = result.values["effective_modulus"]
    assert result.sigma["effective_modulus"] > 0.2 * fitted
    shallow, deep = (float(word.split()[0]) for word in (note.split("E* = ")[1], note.split("half for ")[1]))
    assert shallow < fitted / 1e3 < deep


def test_where_the_halves_differ_by_more_than_half_the_modulus_is_not_determined() -> None:
    """Status "ok" never stands beside it; the bound covers the moduli of both halves."""
    rng = np.random.default_rng(5)
    depth = np.linspace(0.0, 100e-9, 3000)
    force = 4.0 / 3.0 * 1e4 * np.sqrt(1e-6) * depth**1.5 * (1.0 + (depth / 60e-9) ** 2)
    base = depth + force / 0.1
    x = np.linspace(-1e-6, base[-1], 2000)
    measured = np.interp(x, base, force, left=0.0) + rng.normal(0.0, 3e-11, x.size)
    segment = curves.Segment("approach", np.full(x.size, np.nan), -x, "height (measured)", measured)
    result = fit.fit_curve(curves.ForceCurve((segment,), {"spring constant": 0.1}, "layer"), "hertz", radius=1e-6)
    assert result.misfit < 3.0
    assert result.sigma["effective_modulus"] >= 0.5 * result.values["effective_modulus"]
    assert not result.identifiable["effective_modulus"]
    assert result.status == "undetermined"
    (note,) = [note for note in result.notes if note.startswith("the shallow half")]
    assert "E* is not determined" in note
    low, high = result.bounds["effective_modulus"]
    assert low <= result.interval["effective_modulus"][0]
    assert high >= result.interval["effective_modulus"][1]
    assert not np.isfinite(result.answer.modulus[0])
