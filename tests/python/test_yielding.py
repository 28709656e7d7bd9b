# SPDX-License-Identifier: BSD-3-Clause
"""Plans of samples that yield to forces before contact, against the self-consistent half-space and layer."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from nanotouch import Plan, Scene, presets, reference
from nanotouch.errors import InvalidValue

sys.path.insert(0, str(Path(__file__).parents[1] / "heavy"))

import yielding


def gap_at(plan: Plan, force: float) -> float:
    low, high = -4e-6, 0.45e-6
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if plan.force(middle) > force else (low, middle)
    return high


def gel() -> Scene:
    """Under a double layer of 1 mM."""
    return Scene(
        tip={"shape": "sphere", "radius": 2.5e-6, "surface_potential": -0.06},
        sample={"youngs_modulus": 500.0, "poisson_ratio": 0.5, "surface_potential": -0.06},
        medium={"kind": "liquid", "ionic_strength": 1.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        range={"maximum_load": 2e-9},
    )


def test_a_softer_cell_gives_more() -> None:
    gaps = []
    for modulus in (100.0, 1e3, 1e5, 1e7):
        scene, _ = presets.cell_in_liquid()
        scene.sample.youngs_modulus = modulus
        gaps.append(gap_at(scene.plan(0.01), 1e-9))
    np.testing.assert_allclose(gaps, [-1320.7e-9, -261.5e-9, 38.1e-9, 44.1e-9], atol=0.3e-9)


def test_a_gel_gives_under_a_double_layer() -> None:
    soft, plan = gel(), gel().plan(1e-3)
    hard = gel()
    hard.sample.youngs_modulus = 1e12
    assert plan.explain()["yields"]
    assert gap_at(hard.plan(1e-3), 0.2e-9) - gap_at(plan, 0.2e-9) == pytest.approx(240e-9, abs=2e-9)
    gap = gap_at(plan, 0.2e-9)
    truth = float(reference.yielded_force(soft, [gap])[0])
    assert abs(float(plan.force(gap)) - truth) <= plan.bound * truth


@pytest.mark.parametrize("seed", [12, 34, 50])
def test_random_soft_scenes_keep_the_bound(seed: int) -> None:
    kind, error, bound = yielding.compare(seed, count=3)
    assert kind in ("yields", "rigid")
    assert error <= bound


def test_force_is_the_derivative_of_energy() -> None:
    plan = gel().plan(1e-3)
    for gap in np.linspace(0.4e-6, -0.8e-6, 60):
        step = 1e-12
        law = plan.run(gap + step * np.array([1.0, 0.0, -1.0]))
        assert (law.U[2] - law.U[0]) / (2.0 * step) == pytest.approx(law.F[1], rel=1e-4)
        assert (law.F[2] - law.F[0]) / (2.0 * step) == pytest.approx(law.k[1], rel=1e-3)


def test_a_plan_says_whether_its_sample_yields() -> None:
    assert "sample: yields to all forces together, elastic number" in str(gel().plan())
    stiff = gel()
    stiff.sample.youngs_modulus = 1e12
    assert "sample: does not yield before contact" in str(stiff.plan(0.3))


def test_what_neither_form_keeps_is_refused() -> None:
    with pytest.raises(InvalidValue, match="relative_accuracy"):
        gel().plan(1e-7)
    pointed = gel()
    pointed.tip.shape, pointed.tip.half_angle = "cone", 0.3
    with pytest.raises(InvalidValue):
        pointed.plan(1e-3)
