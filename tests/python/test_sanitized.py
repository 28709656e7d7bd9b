# SPDX-License-Identifier: BSD-3-Clause
"""Handles that Python keeps while what they came from is changed or closed: none reads freed memory.

Without a sanitizer a wrong number shows it, since what was freed is soon used again; `make sanitize` shows each read.
"""

from __future__ import annotations

import gc

import nanotouch as nt
import numpy as np
import pytest

pytestmark = pytest.mark.filterwarnings("ignore:the session was stopped")  # a change in contact may end in one
GAPS = np.linspace(-2e-9, 5e-9, 15)


def session() -> nt.Session:
    """Return one on a grating, whose plan borrows radii and tables of its contact surface."""
    surface = nt.Surface(nt.surface.grating(), tip_radius=20e-9)
    return nt.Session(nt.Scene(), surface=surface, mode="scan", recorded=False)


def test_a_plan_outlives_the_changes_of_its_session() -> None:
    """The session has closed the contact surface of each scene but the first and the present one by then."""
    touched = session()
    plans, forces = [], []
    for modulus in (50e9, 80e9, 90e9, 100e9):
        touched.change("scene", "sample.youngs_modulus", modulus)
        touched.run(0.01)
        plans.append(touched.plan)
        forces.append(np.asarray(plans[-1].force(GAPS)))
    for plan, before in zip(plans, forces, strict=True):
        np.testing.assert_array_equal(np.asarray(plan.force(GAPS)), before)


def test_a_plan_outlives_its_session() -> None:
    touched = session()
    touched.change("scene", "sample.youngs_modulus", 50e9)
    touched.run(0.01)
    plan = touched.plan
    before = np.asarray(plan.force(GAPS))
    interaction = nt.Interaction(plan)
    del touched
    gc.collect()
    session().run(0.01)  # takes what is free
    np.testing.assert_array_equal(np.asarray(plan.force(GAPS)), before)
    assert np.isfinite(interaction.eval((0.0, 0.0, 480e-9)).Fz)


def test_a_snapshot_of_another_scene_is_refused() -> None:
    touched = session()
    touched.run(0.01)
    snapshot = touched.snapshot()
    for modulus in (50e9, 80e9):
        touched.change("scene", "sample.youngs_modulus", modulus)
        touched.run(0.01)
    with pytest.raises(nt.Error, match="another setup"):
        touched.restore(snapshot)
