# SPDX-License-Identifier: BSD-3-Clause
"""What is drawn of a contact: the law with its folds, and the section, against the plan and closed forms."""

from __future__ import annotations

import nanotouch as nt
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nanotouch import presets, view

SEVEN = list(presets.FELT)


@pytest.mark.parametrize("name", SEVEN)
def test_a_curve_is_the_law_on_the_way_in_and_out(name: str) -> None:
    scene, _ = getattr(presets, name)()
    plan = scene.plan()
    depth = float(plan.explain()["largest_indentation"])
    curve = view.curve(plan, -depth, 20e-9, 50)
    assert curve.apart[:, 1] == pytest.approx(plan.force(curve.apart[:, 0]), rel=1e-12, abs=1e-18)
    assert curve.attached[:, 1] == pytest.approx(plan.force(curve.attached[:, 0], "retract"), rel=1e-12, abs=1e-18)
    assert curve.attached[0, 0] == -depth


@pytest.mark.parametrize("name", SEVEN)
def test_bodies_never_go_through_each_other(name: str) -> None:
    scene, _ = getattr(presets, name)()
    plan = scene.plan()
    facts = plan.explain()
    r = np.linspace(0.0, 3.0 * np.sqrt(float(facts["radius"]) * float(facts["largest_indentation"])), 80)
    for gap in np.linspace(-float(facts["largest_indentation"]), 3e-9, 9):
        force = float(plan.force([gap], "retract")[0])
        section = view.section(plan, scene, gap, force, r)
        assert np.all(section.tip - section.sample >= -1e-6 * abs(facts["largest_indentation"]))


@settings(max_examples=30, deadline=None)
@given(st.floats(0.05, 0.95), st.floats(1e9, 200e9))
def test_the_softer_body_takes_the_deformation(share: float, modulus: float) -> None:
    ratio = {"poisson_ratio": 0.3}
    scene = nt.Scene(
        tip={**ratio, "youngs_modulus": modulus / share}, sample={**ratio, "youngs_modulus": modulus / (1.0 - share)},
        medium={"relative_humidity": 0.0}, adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
    )  # fmt: skip
    section = view.section(scene.plan(), scene, -1e-9, 1e-7, [0.0])
    assert section.sample[0] == pytest.approx(-(1.0 - share) * 1e-9, rel=1e-9)


def test_wrong_ranges_are_refused() -> None:
    plan = nt.Scene().plan()
    with pytest.raises(nt.Error, match="farthest"):
        view.curve(plan, 1e-9, 1e-9)
    with pytest.raises(nt.Error, match="points"):
        view.curve(plan, -1e-9, 1e-9, 1)
