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


class Elsewhere(nt.hal.Slave):
    """A stage of three axes that stands away from where the session starts; below `floor` lies a sample."""

    def __init__(self, x: float, y: float, z: float, floor: float = 1.0) -> None:
        self.at, self.floor, self.ticks = (x, y, z), floor, 0
        self.told: list[tuple[float, ...]] = [self.at]

    def describe(self) -> Capabilities:
        return Capabilities(axes=3, feels=True)

    def read(self) -> Reading:
        self.ticks += 1
        deflection = max(0.0, 0.5 * (self.at[2] - self.floor)) + 1e-12 * (self.ticks % 7)
        return Reading(position=self.at, felt=(math.nan, math.nan, deflection))

    def write(self, action: Action) -> None:
        self.at = tuple(action.target)
        self.told.append(self.at)


@pytest.mark.parametrize("z", [-0.2e-6, 0.3e-6])
def test_stage_that_stands_elsewhere_does_not_jump(z: float) -> None:
    """Up, sideways, down: no step is larger than the limits allow, and none leads sideways below the start's height."""
    slave = Elsewhere(0.4e-6, -0.5e-6, z)
    session = nt.Session(slave=slave)
    settings = session.settings
    told = np.array(slave.told)
    assert abs(told[-1, 2]) < 1e-15
    way = told[: 1 + np.all(told == [*told[-1, :2], 0.0], axis=1).argmax()]  # what follows is the sign test
    assert len(way) > 200  # 0.5 um at 20 um/s
    steps = np.diff(way, axis=0) * settings.gains.rate
    most = 1.0 + 1e-9
    assert np.abs(steps[:, :2]).max() <= most * settings.limits.lateral_speed
    assert steps[:, 2].max() <= most * settings.gains.approach_speed
    assert -steps[:, 2].min() <= most * settings.limits.stage_speed
    assert way[1:][np.any(steps[:, :2] != 0.0, axis=1), 2].max() <= 0.0
    assert set(session.advance(0.1)["state"]) == {0}


def test_stage_that_meets_something_on_its_way_is_refused() -> None:
    """It has been approached while it was lifted: the start lies in the sample now."""
    slave = Elsewhere(0.0, 0.0, -0.2e-6, floor=-0.1e-6)
    with pytest.raises(InvalidValue, match=r"deflection on the way to where the session starts = 3\.3"):
        nt.Session(slave=slave)
    assert max(0.5 * (told[2] - slave.floor) for told in slave.told) < 33.2e-9  # a step beyond deflection_bias


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
