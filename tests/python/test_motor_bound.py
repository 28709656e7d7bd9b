# SPDX-License-Identifier: BSD-3-Clause
"""What is promised to the hand, entered as people do: a master written in Python, and the simulated one."""

import math
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import margins
from nanotouch.touch.hal import Capabilities, Channel, Reading
from nanotouch.touch.operator import Input
from numpy.typing import NDArray

AT = 3000
"""reading in which something happens"""


class Swung(nt.hal.Master):
    """A hand that swings the handle, fastest in the moment in which its device fails."""

    def __init__(self, speed: float, fails: str) -> None:
        super().__init__()
        self.speed, self.fails, self.readings = speed, fails, 0
        self.forces: list[float] = []
        self.began = 0
        self.last = Reading()

    def open(self, host: Any) -> None:
        self.host = host

    def describe(self) -> Capabilities:
        force = Channel("force", "N", driven=True, minimum=-3.3, maximum=3.3, safe=0.0)
        return Capabilities(
            axes=1, pushes=True, channels=[Channel("position", "m", minimum=-0.05, maximum=0.05), force]
        )

    def write(self, action: nt.hal.Action) -> None:
        self.forces.append(action.target[2])

    def read(self) -> Reading:
        self.readings += 1
        z = 0.009 * math.sin(self.speed / 0.009 * (self.readings - AT) * 1e-4)
        if self.readings >= AT:
            self.began = self.began or len(self.forces)
            if self.fails == "raises":
                raise RuntimeError("gone")
            if self.fails == "silent":
                return self.last
            if self.fails == "nan":
                z = math.nan
        self.last = Reading(position=(math.nan, math.nan, z), time=self.host.now())
        return self.last


def check(before: float, after: NDArray[np.float64], rig: nt.Rig, settings: nt.Settings) -> None:
    """Never above, never turned round, gone in time, no step beyond the motor's rate."""
    steps = np.abs(np.diff(after, prepend=before))
    assert np.abs(after).max() <= abs(before)
    assert (after * before >= 0.0).all()
    assert steps.max() <= settings.limits.motor_rate / settings.gains.rate * (1.0 + 1e-9)
    v, m, w = rig.master.max_speed, min(0.1, rig.master.mass), 1e-3
    time = min(0.05, 2.0 * w / (abs(before) * 0.5 * (v + math.sqrt(v * v + 2.0 * w / m)))) if before else 0.05
    time = np.maximum(time, abs(before) / settings.limits.motor_rate)
    assert not after[math.ceil(time * settings.gains.rate) :].any()


def test_a_motor_that_the_rig_does_not_have_is_told_nothing() -> None:
    """The device has one, the rig says that it has none: no force is promised, and none is written."""
    rig = nt.Rig(master={"gauge": "no", "motor": "no", "travel": 0.02})
    master = Swung(0.01, "nothing")
    session = nt.Session(rig=rig, master=master, seed=1, clearance=5e-9)
    columns = session.advance(0.4)
    assert session.guarantee().hand.force == 0.0
    assert np.abs(columns["motor_force"]).max() > 0.1  # what a hand would feel
    assert not np.any(master.forces)


@pytest.mark.parametrize("fails", ["raises", "nan", "silent"])
@pytest.mark.parametrize("speed", [0.01, 0.1])
def test_a_master_that_fails_while_the_hand_moves(speed: float, fails: str) -> None:
    rig = nt.Rig(master={"gauge": "no", "max_force": 3.3, "travel": 0.02})
    master = Swung(speed, fails)
    session = nt.Session(rig=rig, master=master, seed=1, clearance=0.5e-6)
    for duration in (0.3, 0.1):
        try:
            session.advance(duration)
        except RuntimeError:
            assert fails == "raises"
    # silence shows when it is older than two periods: until then they are coupled
    event = master.began + (2 if fails == "silent" else 0)
    assert session.state != "RUN"
    check(master.forces[event - 1], np.array(master.forces[event : event + 700]), rig, session.settings)


@pytest.mark.parametrize("force", [0.5, 2.0, -2.0])
@pytest.mark.parametrize(
    ("name", "channel"),
    [("nan", "master_position"), ("nan", "deflection"), ("dropout", "rig"), ("device-lost", "rig"),
     ("emergency-stop", "rig"), ("limit-switch", "rig")],
)  # fmt: skip
def test_a_stop_with_the_simulated_hand(force: float, name: str, channel: str) -> None:
    session = nt.Session(seed=1, clearance=1e-6, faults=nt.Faults().add(name, channel, at=0.12))
    x, y = session.path[0]
    columns = session.advance(0.3, Input(force, x, y, 0.05))
    at = int(np.flatnonzero(columns["state"])[0])
    check(float(columns["motor_force"][at - 1]), columns["motor_force"][at:], session.rig, session.settings)


def test_the_promise_is_printed_beside_that_of_the_sample() -> None:
    session = nt.Session(seed=1)
    hand = session.guarantee().hand
    assert hand == margins.motor_bound(session.rig, session.settings)
    assert hand.force == 5.0
    assert str(hand) in str(session.guarantee())
    assert str(hand) in session._repr_html_()
    # by hand: 5 N at 2000 N/s fall in 2.5 ms, and wait for a period before; J = 5 N (2.5/2 + 0.1) ms
    assert hand.fade_time == pytest.approx(2.5e-3)
    impulse = 5.0 * (0.5 * hand.fade_time + hand.delay)
    assert hand.energy == pytest.approx(impulse * 0.3 + impulse**2 / 0.2)
    without = nt.Rig(master={"motor": "no", "gauge": "no"})
    assert margins.motor_bound(without, nt.Settings.for_rig(without)).force == 0.0


def test_a_motor_that_is_fast_enough_gives_one_millijoule() -> None:
    rig = nt.Rig(master={"max_speed": 1.0})
    settings = nt.Settings.for_rig(rig)
    settings.limits.motor_rate = 1e6
    settings.gains.delay = 0.0
    hand = margins.motor_bound(rig, settings)
    assert hand.energy == pytest.approx(1e-3)
    assert hand.fade_time == pytest.approx(2e-3 / (5.0 * hand.speed))
    assert hand.speed == pytest.approx(0.5 * (1.0 + math.sqrt(1.02)))
