# SPDX-License-Identifier: BSD-3-Clause
"""A ramp that begins in contact has no baseline: its modulus is not told; hum and a bow are no contact."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("nanotouch._fit")

from nanotouch import curves, fit, maps

STIFFNESS, RADIUS, MODULUS = 0.1, 1e-6, 2e3


def ramp(start: float, more: float = 0.0, period: float = 1.0) -> curves.ForceCurve:
    """Hertz by the tip's own depth, from `start` [m] before the contact, with a wave of `more` [N] over it."""
    x = np.linspace(start, 0.8e-6, 1500)
    depth = np.linspace(0.0, 3e-6, 20000)
    law = 4.0 / 3.0 * MODULUS * np.sqrt(RADIUS) * depth**1.5
    force = np.interp(x, depth + law / STIFFNESS, law, left=0.0)
    force += more * np.sin(2 * np.pi * np.arange(x.size) / period)
    force += np.random.default_rng(30).normal(0.0, 5e-12, x.size)
    segment = curves.Segment("approach", np.full(x.size, np.nan), -x, "height (measured)", force)
    return curves.ForceCurve((segment,), {"spring constant": STIFFNESS}, "gel")


def approach(*of: float) -> fit.FitResult:
    """Its fit."""
    return fit.fit_curve(ramp(*of), "hertz", radius=RADIUS)


def test_a_ramp_that_begins_in_contact_tells_no_modulus() -> None:
    result = approach(-0.02e-6)
    assert abs(result.values["effective_modulus"] - MODULUS) > 5 * 0.03 * MODULUS  # wrong, and surely so
    assert result.status == "undetermined"
    assert result.reason == "no part of the branch is surely free"
    assert "begin the ramp further away" in result.notes[-1]
    assert not np.isfinite(result.answer.modulus[0])


@pytest.mark.parametrize(("more", "period"), [(0.0, 1.0), (60e-12, 37.0), (60e-12, 3000.0)])
def test_a_free_part_is_not_doubted(more: float, period: float) -> None:
    assert approach(-2e-6, more, period).reason != "no part of the branch is surely free"


def test_a_map_tells_no_modulus_of_such_a_curve_either() -> None:
    pytest.importorskip("xarray")
    data = maps.fit([ramp(-0.02e-6), ramp(-2e-6), ramp(-2e-6, 60e-12, 37.0)], "hertz", radius=RADIUS)
    assert maps.determined(data, "effective_modulus").ravel().tolist() == [False, True, True]
    assert maps.flag_counts(data)["begins_in_contact"] == 1
    assert np.isnan(data.effective_modulus_most.values.ravel()[0])
