# SPDX-License-Identifier: BSD-3-Clause
"""The scripted operator: approaches, stays below the limits, follows the path, and gets off the surface again."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from nanotouch import Faults, Session, Settings, Surface, presets, surface, testing
from nanotouch.errors import InvalidValue
from nanotouch.touch.operator import script_for

GRATING = Surface(surface.grating(pixels=128), 20e-9)
CORNERS = [(1e-6, 1e-6), (5e-6, 1e-6), (5e-6, 2e-6)]


def test_point() -> None:
    session = Session()
    script = script_for(session)
    forces = [step.operator_force for step in script]
    assert forces[0] > 0.0
    assert np.min(forces) < 0.0
    assert forces[-1] == 0.0
    assert {(step.x, step.y) for step in script} == {session.path[0]}
    assert all(step.duration > 0.0 for step in script)


@pytest.mark.parametrize("name", ["silicon_in_air", "silicon_on_gold", "mica_in_air", "polyester", "silicone_rubber"])
def test_within_the_limits_and_off_again(name: str) -> None:
    """Down to the softest sample, which is indented deepest."""
    scene, rig = getattr(presets, name)()
    session = Session(scene, rig)
    script = script_for(session)
    limit = session.settings.gains.alpha_f * session.settings.limits.force
    assert all(step.operator_force <= 0.6 * limit for step in script)
    assert all(abs(step.operator_force) < session.rig.master.gauge_range for step in script)
    recording = session.run()
    assert recording.contact_radius.max() > 0.0
    assert not recording.state.any()
    assert recording.contact_radius[-1] == 0.0
    assert recording.gap[-1] > 0.5 * session.clearance


@pytest.mark.parametrize("mode", ["scan", "topography"])
def test_path_is_followed_corner_by_corner(mode: str) -> None:
    session = Session(surface=GRATING, mode=mode, path=CORNERS)  # type: ignore[arg-type]
    script = script_for(session)
    places = list(dict.fromkeys((step.x, step.y) for step in script))
    assert places == CORNERS
    legs = [next(step for step in script if (step.x, step.y) == corner).duration for corner in CORNERS[1:]]
    assert legs[0] / legs[1] == pytest.approx(4.0, rel=1e-9)  # one speed
    assert np.max(np.hypot(*np.diff(CORNERS, axis=0).T) / legs) < session.settings.limits.lateral_speed


def test_scan_presses_topography_does_not() -> None:
    scan = script_for(Session(surface=GRATING, mode="scan", path=CORNERS))
    assert all(step.operator_force > 0.0 for step in scan if (step.x, step.y) == CORNERS[1])
    follow = script_for(Session(surface=GRATING, mode="topography", path=CORNERS))
    assert {step.operator_force for step in follow} == {0.0}


def test_a_steeper_path_takes_longer() -> None:
    def time(path: list[tuple[float, float]]) -> float:
        return sum(step.duration for step in script_for(Session(surface=GRATING, mode="topography", path=path)))

    along_the_lines = [(1.5e-6, 0.0), (1.5e-6, 6e-6)]
    across = [(0.0, 3e-6), (6e-6, 3e-6)]
    assert time(across) > time(along_the_lines)


def test_the_default_hand_comes_down_below_a_small_force_limit() -> None:
    """It approached with 0.2 N at the hand, whatever that is at the tip: 54 nN were the limit, and it was stopped."""
    scene, rig = presets.silicon_in_air()
    scene.range.maximum_load = 54e-9
    settings = Settings.for_rig(rig)
    settings.limits.force, settings.gains.alpha_f, settings.gains.set_point = 54e-9, 3e6, 20e-9
    session = Session(scene, rig, settings=settings, minimum_margin=0.0)
    limits, gains = session.settings.limits, session.settings.gains
    assert gains.alpha_f * limits.force < 0.2
    touch = session.run()
    assert not touch.state.any()
    assert touch.tip_force.max() > 0.3 * limits.force  # it presses all the same


@pytest.mark.parametrize(
    ("step", "words"),
    [
        ((1.0, 2.0, 3.0), "expected"),
        ((np.nan, 1.0), "force = nan N"),
        (("1N", 1.0), "force = '1N'"),
        ((1.0, 0.0), "duration = 0 s"),
    ],
)
def test_a_step_of_a_scripted_hand_that_is_none(step: Any, words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        testing.scripted_hand(Session(), step)


def test_a_time_of_a_fault_that_is_no_number() -> None:
    with pytest.raises(InvalidValue, match=r"fault 'nan': at = '0\.1': it must be a number"):
        Faults().add("nan", "deflection", at="0.1")  # type: ignore[arg-type]
