# SPDX-License-Identifier: BSD-3-Clause
"""Halves written in Python in a session: a slave of one axis, what halves say, a position device's margin."""

from __future__ import annotations

import logging
import math
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import InvalidValue
from nanotouch.touch.hal import Action, Capabilities, Reading


class OneAxis(nt.hal.Slave):
    """A stage that goes up and down over a spring of 8 N/m behind 100 nm."""

    def __init__(self) -> None:
        self.travel = 0.0
        self.ticks = 0

    def describe(self) -> Capabilities:
        return Capabilities(axes=1, feels=True)

    def read(self) -> Reading:
        self.ticks += 1
        noise = 1e-12 * (self.ticks % 7)  # a live sensor is never still
        deflection = max(0.0, 0.5 * (self.travel - 100e-9)) + noise
        return Reading(position=(math.nan, math.nan, self.travel), felt=(math.nan, math.nan, deflection))

    def write(self, action: Action) -> None:
        self.travel = action.target[2]


def test_slave_of_one_axis_touches() -> None:
    rig = nt.Rig(stage={"axes": 1})
    touch = nt.Session(rig=rig, slave=OneAxis(), path=[(1e-6, 2e-6)])
    columns = touch.advance(1.5, nt.Input(1.7, math.nan, math.nan, 0.3))  # 95 nN at alpha_f = 1.8e7
    assert set(columns["state"]) == {0}
    assert columns["deflection"].max() > 8e-9
    assert np.ptp(columns["x"]) == np.ptp(columns["y"]) == 0.0
    assert (columns["x"][0], columns["y"][0]) == (1e-6, 2e-6)
    assert str(touch.guarantee()).endswith("the tip stays at its place, for the stage has one axis")
    assert "one axis" not in str(nt.Session().guarantee())


def test_slave_of_ones_own_is_recorded_and_replayed(tmp_path: Path) -> None:
    """Its start height is not known, which a file has to bear."""
    pytest.importorskip("mcap")
    touch = nt.Session(rig=nt.Rig(stage={"axes": 1}), slave=OneAxis())
    file = tmp_path / "own.mcap"
    with nt.record.Writer(file, touch.metadata()) as writer:
        writer.append(touch.advance(1.0, nt.Input(0.3, math.nan, math.nan, 0.3)))
        writer.update(touch.metadata())
    recording = nt.record.read(file)
    assert recording.metadata["start_height"] is None
    with pytest.raises(InvalidValue, match="lacks 'start_height'"):
        recording.parameter("start_height")
    again = recording.replay()
    np.testing.assert_array_equal(again.stage_command, recording.stage_command)
    np.testing.assert_array_equal(again.state, recording.state)


def test_what_a_half_says_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    class Talking(OneAxis):
        def open(self, host: Any) -> None:
            self.host = host
            host.say("found at port 100 %")

        def disarm(self) -> None:
            self.host.say("lifted")

    touch = nt.Session(rig=nt.Rig(stage={"axes": 1}), slave=Talking())
    del touch
    said = [(record.name, record.levelno, record.getMessage()) for record in caplog.records]
    assert said == [
        ("nanotouch.hal", logging.WARNING, "found at port 100 %"),
        ("nanotouch.hal", logging.WARNING, "lifted"),
    ]


def test_margin_of_a_position_device_is_said_in_words() -> None:
    rig = nt.Rig(master={"motor": "no", "gauge": "no", "rate": 125})
    found = nt.Session(rig=rig).margins()
    assert found.rule == "stage integral"
    assert found.verdict == f"{found.least:.3g} (stage integral; 1 is the limit)"
    settings = nt.Settings.for_rig(rig)
    settings.gains.stage_integral = 0.0
    free = nt.margins.compute(rig, settings, 100.0)
    assert math.isinf(free.least)
    assert free.refusal is None
    assert free.verdict == "none is needed: no loop is closed, the stage goes where it is told"
