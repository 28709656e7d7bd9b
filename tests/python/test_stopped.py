# SPDX-License-Identifier: BSD-3-Clause
"""A run that failed does not look like one that measured nothing: a warning, and words in what it returns."""

import math
import warnings

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.touch.faults import KINDS
from nanotouch.touch.hal import Capabilities, Reading
from nanotouch.touch.operator import Input
from nanotouch.touch.supervisor import REASONS

NAMED = [(name, channel) for name, kind in KINDS.items() for channel in kind.channels]


class Quiet(nt.hal.Slave):
    """A stage over a spring, read by a sensor without noise."""

    def __init__(self, noise: float = 0.0) -> None:
        super().__init__()
        self.travel, self.ticks, self.noise = 0.0, 0, noise

    def describe(self) -> Capabilities:
        return Capabilities(axes=1, feels=True)

    def read(self) -> Reading:
        self.ticks += 1
        deflection = max(0.0, 0.5 * (self.travel - 100e-9)) + self.noise * (self.ticks % 7)
        return Reading(position=(math.nan, math.nan, self.travel), felt=(math.nan, math.nan, deflection))

    def write(self, action: nt.hal.Action) -> None:
        self.travel = action.target[2]


@pytest.mark.parametrize(("name", "channel"), NAMED)
def test_no_fault_by_name_ends_in_silence(name: str, channel: str) -> None:
    """A run that did not end in RUN warns, with the time and the reasons; one that did says nothing of a stop."""
    session = nt.Session(seed=1, clearance=20e-9, faults=nt.Faults().add(name, channel, at=0.05))
    x, y = session.path[0]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        recording = session.run(operator=[Input(2.0, x, y, 0.2), Input(3.0, x, y, 0.2)])
    said = [str(one.message) for one in caught if "stopped" in str(one.message) or "never ran" in str(one.message)]
    state = nt.touch.record.STATES[recording.state[-1]]
    assert session.state == state
    assert set(session.reasons) == {words for bit, words in enumerate(REASONS) if recording.reasons[-1] >> bit & 1}
    if state == "RUN":
        assert not said
        assert " at " not in repr(recording).split("columns")[0]
        return
    since = recording.time[np.flatnonzero(recording.state != recording.state[-1])[-1] + 1]
    words = f"{state} at {since:.4g} s: {', '.join(session.reasons)}"
    assert session.reasons
    assert len(said) == 1
    for told in (said[0], repr(session), repr(recording), session._repr_html_()):
        assert words in told


def test_a_sensor_without_noise() -> None:
    """What a session latches on, the conformance check finds, and what it says to declare is the cure."""
    rig = nt.Rig(stage={"axes": 1})
    with pytest.warns(UserWarning, match=r"stopped: LATCHED at 0\.\d+ s: sensor stuck"):
        recording = nt.Session(rig=rig, slave=Quiet(), path=[(0.0, 0.0)]).run(1.0)
    assert recording.slave_force.max() == 0.0
    assert "LATCHED at 0." in repr(recording)
    assert "sensor stuck" in repr(recording)
    with pytest.warns(UserWarning, match="the same number in every reading"):
        seen = nt.hal.rehearse(Quiet(), real_time=False)
    assert len(seen.advice) == 1
    assert "probe={'noise': 0.0}" in seen.advice[0]
    declared = nt.Rig(stage={"axes": 1}, probe={"noise": 0.0})
    recording = nt.Session(rig=declared, slave=Quiet(), path=[(0.0, 0.0)]).run(1.0)
    assert set(recording.state) == {0}
    assert recording.slave_force.max() > 10e-9
    assert nt.hal.rehearse(Quiet(noise=1e-12), real_time=False).advice == ()


def test_one_that_never_ran() -> None:
    session = nt.Session(seed=1)
    session.emergency_stop()
    with pytest.warns(UserWarning, match="never ran: LATCHED at 0 s: emergency stop"):
        session.run(0.01)
