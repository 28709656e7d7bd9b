# SPDX-License-Identifier: BSD-3-Clause
"""A hand on the session of another program: through the queue, with the lease, on simulated and real slaves."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import Error
from nanotouch_app.live.host import Host
from nanotouch_app.live.remote import TAKEN, Lease, Remote
from nanotouch_app.live.seen import Seen
from nanotouch_app.live.subject import of_preset

ROOT = Path(__file__).parents[2]
MOUSE = {"motor": "no", "gauge": "no"}  # no loop closes through such a hand
PATIENCE = 60.0  # of a loaded machine [s]


class Led:
    """A session that is advanced by hand, and a hand that leads it through the queue."""

    def __init__(self, session: nt.Session, name: str, sideways: bool = False) -> None:
        self.session = session
        session.publish(name)
        session.advance(0.01)
        self.observer = nt.frames.attach(name)
        self.remote = Remote(name, self.observer, leads=True, sideways=sideways)
        self.told: list[dict[str, Any]] = []
        self.turn()

    @property
    def frame(self) -> Any:
        """The newest."""
        return self.observer.newest()

    def turn(self) -> None:
        """What the hand does by itself, and what is told."""
        self.told += self.remote.turn(self.frame)

    def settle(self, duration: float = 0.1) -> None:
        """All that was asked is taken, then some time of the session goes by [s]."""
        end = time.monotonic() + PATIENCE
        while self.remote.asked and time.monotonic() < end:
            self.session.advance(0.001)
            self.turn()
        assert not self.remote.asked
        self.session.advance(duration)

    def ask(self, what: str, **more: Any) -> None:
        """As a window asks."""
        self.remote.ask({"do": what, **more}, self.frame)
        self.settle()
        self.turn()

    def close(self) -> None:
        """Let go."""
        self.remote.close()
        self.observer.close()


@pytest.fixture
def led() -> Iterator[Led]:
    made = Led(nt.Session(rig=nt.Rig(master=MOUSE), seed=1, recorded=False), f"led-{os.getpid()}-{time.monotonic_ns()}")
    yield made
    made.close()


def test_a_hand_presses_through_the_queue_and_goes_no_further_than_the_limit(led: Led) -> None:
    forces = []
    for _ in range(120):
        led.ask("wheel", steps=1.0)
        forces.append(float(led.frame["tip_force"][2]))
    limit = float(led.session.settings.limits.force)
    assert led.session.state == "RUN"
    assert 0.7 * limit < max(forces) < limit
    before = led.frame["tip_position"].copy()
    led.ask("move", way=(50e-9, 0.0, 0.0))
    led.settle()
    assert led.frame["tip_position"][0] - before[0] == pytest.approx(50e-9, abs=1e-9)
    led.ask("retract")
    led.settle(0.3)
    assert led.frame["gap"] > 10e-9
    assert not [one for one in led.told if one["tell"] == "refused"]


def test_beside_a_device_that_leads_z_the_mouse_leads_x_and_y() -> None:
    """Paper, section V: the device's place is left alone, however far the tip is led (its travel is no limit)."""
    surface = nt.Surface.touched_by(nt.Scene(), nt.surface.flat(size=4e-6, pixels=64))
    session = nt.Session(rig=nt.Rig(), surface=surface, path=[(2e-6, 2e-6)], seed=1, recorded=False)
    led = Led(session, f"sideways-{os.getpid()}", sideways=True)
    assert "its device leads z" in led.remote.world["source"]
    assert led.remote.world["leads"] == "xy"  # so that a wheel magnifies
    session.advance(0.2, nt.operator.Hold(session.core.master_start + 2e-3, 2e-6, 2e-6, 0.1))
    before = led.frame.copy()
    for _ in range(3):
        led.ask("move", way=(0.4e-6, -0.2e-6, 0.1e-6))
    for what in ("wheel", "press", "retract"):
        with pytest.raises(Error, match="the device leads the height"):
            led.remote.ask({"do": what, "steps": 1.0, "on": True}, led.frame)
    led.settle(0.2)
    way = led.frame["tip_position"] - before["tip_position"]
    assert way[:2] == pytest.approx([1.2e-6, -0.6e-6], abs=2e-9)
    assert led.frame["master_position"][2] == pytest.approx(before["master_position"][2], abs=1e-9)
    assert session.state == "RUN"
    assert not [one for one in led.told if one["tell"] == "refused"]
    led.close()


def test_the_hand_begins_where_the_program_has_left_it(led: Led) -> None:
    """It does not jump back to where it was: neither at its first move nor after the program has moved on."""
    for start in (2e-3, 4e-3):
        led.session.advance(0.4, nt.operator.Hold(led.session.core.master_start + start, 0.5e-6, 0.0, 0.1))
        held = float(led.frame["master_position"][2])
        led.ask("wheel", steps=0.1)
        assert abs(float(led.frame["master_position"][2]) - held) < 0.5e-3


def test_the_hand_lets_go_where_another_program_drives(led: Led, monkeypatch: pytest.MonkeyPatch) -> None:
    led.ask("wheel", steps=1.0)
    held = float(led.frame["master_position"][2])
    led.remote.lease.client.release()
    other = Lease(led.remote.name)
    other.take()
    with pytest.raises(Error, match="another program drives"):
        led.remote.ask({"do": "wheel", "steps": 5.0}, led.frame)
    led.settle()
    assert float(led.frame["master_position"][2]) == held
    other.close()
    led.ask("wheel", steps=1.0)
    assert float(led.frame["master_position"][2]) > held


def test_a_host_that_presses_lets_go_where_another_program_drives(monkeypatch: pytest.MonkeyPatch) -> None:
    host = Host(of_preset("silicon_in_air"), lambda message: None, stepped=True)
    host.advance(0.05)
    host.answer({"do": "press", "on": True})
    place = host.core.state["place"]

    def taken(_: Lease) -> None:
        raise Error(TAKEN)

    monkeypatch.setattr(Lease, "take", taken)
    host.tick()
    assert not host.core.state["presses"]
    assert host.core.state["place"] == place
    host.close()


def _slave(folder: Path) -> str:
    """A stage over a spring, as a shared object that calls itself real."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler")
    made = folder / "stage.so"
    include, source = ROOT / "libnanotouch" / "include", ROOT / "tests" / "c" / "real_backend.c"
    flags = ["-std=c11", "-O1", "-fPIC", "-shared", "-D_POSIX_C_SOURCE=200809L"]
    subprocess.run([compiler, *flags, "-I", str(include), "-o", str(made), str(source)], check=True)
    return str(made)


def _until(holds: Callable[[], bool]) -> None:
    end = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < end, "it never came"
        time.sleep(0.01)


def test_a_real_slave_at_hard_pace_is_led_and_watched(tmp_path: Path) -> None:
    """The hand arrives at the master whatever the scheduler does: HOLD for late ticks keeps the stage, not the hand."""
    name = f"hard-{os.getpid()}"
    rig, slave = nt.Rig(master=MOUSE, stage={"axes": 1}), nt.hal.SharedObject(_slave(tmp_path))
    session = nt.Session(rig=rig, slave=slave, preflight=False, recorded=False)
    session.publish(name)
    session.start("hard")
    observer, seen = nt.frames.attach(name), Seen()
    remote = Remote(name, observer, leads=True)
    try:
        _until(lambda: observer.newest() is not None)
        for message in remote.turn(None):
            seen.hear(message)

        def arrived() -> bool:
            seen.look(observer)
            return seen.frame is not None

        _until(arrived)
        start = float(seen.frame["master_position"][2])
        remote.ask({"do": "wheel", "steps": 3.0}, seen.frame)

        def moved() -> bool:
            seen.look(observer)
            return float(seen.frame["master_position"][2]) > start + 1e-5

        _until(moved)
        assert seen.is_blind
        assert np.isfinite(seen.force)
        remote.ask({"do": "stop"})
        _until(lambda: session.state == "LATCHED")
    finally:
        session.halt()
        remote.close()
        observer.close()
