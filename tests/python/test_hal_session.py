# SPDX-License-Identifier: BSD-3-Clause
"""Halves written in Python in a session: a slave of one axis."""

from __future__ import annotations

import math

import nanotouch as nt
import numpy as np
from nanotouch.hal import Action, Capabilities, Reading


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
    columns = touch.advance(1.5, nt.Input(0.3, math.nan, math.nan, 0.3))
    assert set(columns["state"]) == {0}
    assert columns["deflection"].max() > 10e-9
    assert np.ptp(columns["x"]) == np.ptp(columns["y"]) == 0.0
    assert (columns["x"][0], columns["y"][0]) == (1e-6, 2e-6)
    assert str(touch.guarantee()).endswith("the tip stays at its place, for the stage has one axis")
    assert "one axis" not in str(nt.Session().guarantee())
