# SPDX-License-Identifier: BSD-3-Clause
"""Faults by name, channel and time; what Session does with them; docs/evidence/safety.md has every kind."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nanotouch import Faults, Input, Rig, Session, operator, record
from nanotouch.errors import InvalidValue
from nanotouch.touch.faults import CHANNELS, KINDS

RUN, HOLD, RETRACT, LATCHED = (record.STATES.index(name) for name in ("RUN", "HOLD", "RETRACT", "LATCHED"))
SAFETY = Path(__file__).parents[2] / "docs" / "evidence" / "safety.md"
CASES = Path(__file__).parents[1] / "c" / "fault_cases.h"


def states(faults: Faults, duration: float = 0.1) -> Any:
    return Session(faults=faults).advance(duration)["state"]


def test_a_fault_begins_and_ends_where_it_is_told_to() -> None:
    """One sample from 50 ms on: HOLD in tick 500 and nowhere else."""
    state = states(Faults().add("nan", "deflection", at=0.05, duration=1e-4))
    assert np.flatnonzero(state).tolist() == [500]
    assert state[500] == HOLD


@pytest.mark.parametrize("ticks", [499.51, 500.0, 500.3, 500.49])
@pytest.mark.parametrize("periods", [1e-6, 0.3, 0.7, 1.0])
def test_one_shorter_than_a_period_takes_the_nearest_sample(ticks: float, periods: float) -> None:
    state = states(Faults().add("nan", "deflection", at=1e-4 * ticks, duration=1e-4 * periods), 0.052)
    assert np.flatnonzero(state).tolist() == [500]


def test_two_samples_in_a_row_retract() -> None:
    state = states(Faults().add("nan", "deflection", at=0.05, duration=2e-4))
    assert state[500:502].tolist() == [HOLD, RETRACT]


def test_injected_while_it_runs() -> None:
    session = Session()
    session.advance(0.02)
    session.inject(Faults().add("emergency-stop", at=0.03))
    state = session.advance(0.02)["state"]
    assert np.flatnonzero(state == LATCHED)[0] == 100
    assert session.metadata()["faults"] == ["emergency-stop at 0.03 s"]


def test_late_ticks_are_lost() -> None:
    """The rig goes on meanwhile: 30 periods are lost, so that what happens at 20 ms is seen 30 records earlier."""
    faults = Faults().add("late", at=0.01, duration=1e-4, value=30).add("emergency-stop", at=0.02)
    columns = Session(faults=faults).advance(0.03)
    assert columns["lateness"].max() == pytest.approx(3e-3)
    assert np.flatnonzero(columns["state"] == LATCHED)[0] == 200 - 30


def test_a_restless_hand_is_refused_by_the_preflight() -> None:
    with pytest.raises(InvalidValue, match="gauge"):
        Session(rig=Rig(hand=operator.adversary()))


def test_the_hand_pushes_and_the_surface_jumps() -> None:
    """A push is measured by the gauge; a surface that rises is seen in the truth at once."""
    columns = Session(faults=Faults().add("push", at=0.01, value=1.0).add("jump", at=0.02, value=5e-9)).advance(0.05)
    assert columns["operator_force"][99] == pytest.approx(0.0, abs=0.03)
    assert columns["operator_force"][101] == pytest.approx(1.0, abs=0.03)
    height = columns["surface_height"]
    assert height[-1] - height[0] == pytest.approx(5e-9, rel=1e-9)


def test_a_stage_with_the_wrong_sign_is_found_before_it_starts() -> None:
    with pytest.raises(InvalidValue, match="stage"):
        Session(faults=Faults().add("gain", "stage", at=None, value=-1.0))


@pytest.mark.parametrize("name", KINDS)
def test_every_kind_on_every_channel_leaves_numbers(name: str) -> None:
    for channel in KINDS[name].channels:
        columns = Session(faults=Faults().add(name, channel, at=0.01)).advance(0.05)
        for truth in ("gap", "tip_force", "motor_force", "stage_command"):
            assert np.isfinite(columns[truth]).all(), (name, channel, truth)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"name": "gremlin"}, "'gremlin': valid are nan, infinite"),
        ({"name": "nan"}, "channel None: valid are deflection"),
        ({"name": "nan", "channel": "motor"}, "'motor': valid are deflection"),
        ({"name": "stale", "at": -1.0}, "at = -1.0 s"),
        ({"name": "stale", "at": math.nan}, "at = nan s"),
        ({"name": "stale", "duration": 0.0}, "duration = 0.0 s"),
        ({"name": "push", "value": math.inf}, "value = inf"),
        ({"name": "push", "value": math.nan}, "value = nan"),
        ({"name": "noise", "channel": "deflection", "value": -1.0}, "value = -1"),
        ({"name": "late", "value": 1001.0}, "valid is 0 .. 1000"),
        ({"name": "hysteresis", "value": 0.5}, "valid is 0 .. 0.4"),
        ({"name": "limit", "value": -1e-9}, "value = -1e-09 m"),
    ],
)
def test_refusals(arguments: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidValue, match=words.replace("(", r"\(")):
        Faults().add(**arguments)


def test_a_schedule_is_finite() -> None:
    faults = Faults()
    for _ in range(16):
        faults.add("late", duration=1e-4)
    with pytest.raises(InvalidValue, match="16 faults"):
        faults.add("late")
    assert len(faults) == 16


def test_the_page_has_every_fault_that_is_tested() -> None:
    """The table in the docs is what test_session_faults prints: each of its cases, each pair of those at 10 kHz but of
    the cases that were found later."""
    page = SAFETY.read_text(encoding="utf-8")
    paired, later = CASES.read_text(encoding="utf-8").split("later_cases[]")
    cases, more = (re.findall(r'^    \{"([^"]+)", CASE', part, re.MULTILINE) for part in (paired, later))
    assert len(cases) > 25
    assert len(more) > 10
    assert all(f"| {name} |" in page for name in cases + more)
    quick = len([name for name in cases if "1 kHz" not in name])
    assert f"All {quick * (quick - 1) // 2} pairs" in page


def test_the_page_names_every_row() -> None:
    """Every kind of fault is in the table, by its row."""
    rows = {line.split("|")[1].strip() for line in SAFETY.read_text().splitlines() if line.startswith("| ")}
    assert {str(kind.row) for kind in KINDS.values()} <= rows
    assert set(CHANNELS) == {channel for kind in KINDS.values() for channel in kind.channels}


# ---- the plant's options ----


def test_probe_models_agree_at_rest() -> None:
    """Pressed with 1 N: the mean of the felt force is the same, the thermal motion 0.18 nN RMS."""
    push = Input(1.0, 0.0, 0.0, 0.05)
    rest: dict[str, float] = {}
    for model in ("quasi-static", "dynamic"):
        fast = {"substep": 20.0} if model == "dynamic" else {}
        session = Session(clearance=2e-9, probe_model=model, **fast)  # type: ignore[arg-type]
        session.advance(0.25, push)
        rest[model] = float(np.mean(session.advance(0.05)["tip_force"]))
        assert session.probe_model == model
    assert rest["dynamic"] == pytest.approx(rest["quasi-static"], rel=0.05)  # still on its way: 0.25 s


@pytest.mark.parametrize(
    ("probe", "model"),
    [({}, "quasi-static"), ({"quality": 1e5}, "dynamic"), ({"resonance": 300.0}, "dynamic")],
)
def test_auto_takes_the_model_that_is_good_enough(probe: dict[str, float], model: str) -> None:
    """In vacuum the lever rings for longer than touch cannot feel; a slow lever lags."""
    assert Session(rig=Rig(probe=probe), preflight=False).probe_model == model


def test_unknown_models_are_refused() -> None:
    with pytest.raises(InvalidValue, match="'quick': valid are auto, quasi-static, dynamic"):
        Session(probe_model="quick")  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="substep"):
        Session(substep=0.0)


@pytest.mark.parametrize("hand", [operator.FINGER_PAD, operator.RIGID_FINGER, operator.adversary()])
def test_hands_touch_and_let_go(hand: dict[str, float]) -> None:
    session = Session(rig=Rig(hand=hand), preflight="random_force" not in hand)
    recording = session.run()
    assert recording.tip_force.max() < session.guarantee().force
    assert np.isfinite(recording.motor_force).all()
    still = Session(rig=Rig()).run()
    assert not np.array_equal(recording.operator_force[: len(still)], still.operator_force[: len(recording)])
