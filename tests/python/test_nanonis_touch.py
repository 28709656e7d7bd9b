# SPDX-License-Identifier: BSD-3-Clause
"""A touch on a controller that owns its z servo. Controller, bridge and session are processes; each is lost once."""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import nanotouch as nt
import pytest
from mock_nanonis import SURFACE
from nanotouch.errors import DeviceError

PATIENCE = 20.0  # with a machine that is busy [s]


def until(condition: Any) -> None:
    due = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < due
        time.sleep(2e-3)


@contextmanager
def program(*arguments: object) -> Iterator[subprocess.Popen[str]]:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, *map(str, arguments)]
    with subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as made:
        try:
            yield made
        finally:
            made.kill()


class Rig:
    """A touch over the bridge: the session is in RUN, the lever bent."""

    def __init__(self, mock: subprocess.Popen[str], port: int, name: str) -> None:
        self.mock, self.port = mock, port
        rig = nt.Rig(stage={"axes": 1})
        chosen = nt.Settings.for_rig(rig)
        chosen.gains.rate, chosen.gains.force_gain, chosen.gains.stage_integral = 50.0, 0.1, 5.0
        due = time.monotonic() + PATIENCE
        while True:
            try:
                self.session = nt.Session(rig=rig, settings=chosen, slave=nt.hal.Mailbox(name), preflight=False)
                break
            except DeviceError:  # not there yet
                assert time.monotonic() < due
                time.sleep(0.05)
        self.session.aim(nt.Input(1.5, math.nan, math.nan, 0.3))
        self.session.start("wall")

    def tell(self, line: str = "") -> dict[str, Any]:
        assert self.mock.stdin is not None
        assert self.mock.stdout is not None
        print(line, file=self.mock.stdin, flush=True)
        return json.loads(self.mock.stdout.readline())

    def awaited(self, *states: str) -> None:
        due = time.monotonic() + PATIENCE
        while self.session.state not in states:
            assert time.monotonic() < due, f"{self.session.state} instead of {states}"
            time.sleep(0.01)

    def touch(self) -> None:
        due = time.monotonic() + PATIENCE
        while self.tell()["z"] > SURFACE - 10e-9:
            if self.session.state != "RUN":
                pytest.skip(f"the machine is too busy: {self.session.state} before the touch")
            assert time.monotonic() < due
            time.sleep(0.02)


@contextmanager
def touching() -> Iterator[tuple[Rig, subprocess.Popen[str]]]:
    name = f"test-nanonis-{os.getpid()}-{time.monotonic_ns()}"
    with program(Path(__file__).with_name("mock_nanonis.py")) as mock:
        assert mock.stdout is not None
        port = int(mock.stdout.readline())
        options = ["--guard-nm", 100, "--port", port, port, "--timeout", 0.5]
        with program("-m", "nanotouch_app.devices.nanonis", name, *options) as bridge:
            rig = Rig(mock, port, name)
            try:
                rig.touch()
                yield rig, bridge
            finally:
                rig.session.halt()


def test_a_connection_lost_in_a_touch_latches_and_withdraws() -> None:
    with touching() as (rig, bridge):
        rig.tell("cut")
        rig.awaited("LATCHED")
        until(lambda: rig.tell()["asked"]["ZCtrl.Withdraw"] > 0)
        until(lambda: rig.tell()["z"] > 0.5e-6)  # lifted
        assert bridge.wait(PATIENCE) == 2


def test_a_dead_controller_latches_and_is_withdrawn_once_it_answers() -> None:
    with touching() as (rig, bridge):
        rig.tell("mangle silent")
        rig.awaited("LATCHED")
        rig.tell("mangle no")
        until(lambda: rig.tell()["z"] > 0.5e-6)
        assert bridge.wait(PATIENCE) == 2


def test_a_slow_controller_holds_or_lifts() -> None:
    """40 ms a command, seven in a round: readings of more than five periods."""
    with touching() as (rig, bridge):
        rig.tell("delay 0.04")
        rig.awaited("RETRACT", "LATCHED")
        rig.tell("delay 0")
        until(lambda: rig.tell()["z"] > SURFACE)
        assert bridge.poll() is None


def test_a_killed_bridge_latches_and_is_withdrawn() -> None:
    """By the process beside it, which gives the user's limits back, too."""
    with touching() as (rig, bridge):
        bridge.kill()
        until(lambda: rig.tell()["asked"]["ZCtrl.Withdraw"] == 1)
        rig.awaited("LATCHED")
        until(lambda: rig.tell()["z"] > 0.5e-6)
        assert rig.tell()["status"] == 1


@pytest.mark.skipif(not hasattr(signal, "SIGSTOP"), reason="no process can be stopped here")
def test_a_bridge_that_hangs_is_withdrawn_and_may_come_back() -> None:
    with touching() as (rig, bridge):
        os.kill(bridge.pid, signal.SIGSTOP)
        rig.awaited("LATCHED")
        until(lambda: rig.tell()["z"] > 0.5e-6)
        os.kill(bridge.pid, signal.SIGCONT)
        time.sleep(0.5)
        assert rig.tell()["z"] > 0.5e-6
        assert bridge.poll() is None


def watchers_of(process: int) -> list[int]:
    return [int(each) for each in Path(f"/proc/{process}/task/{process}/children").read_text().split()]


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="the children of a process are not told here")
@pytest.mark.parametrize("way", ["SIGKILL", "SIGSTOP"])
def test_a_touch_without_a_watcher_is_none(way: str) -> None:
    with touching() as (rig, bridge):
        (watcher,) = watchers_of(bridge.pid)
        os.kill(watcher, getattr(signal, way))
        try:
            rig.awaited("LATCHED")
            until(lambda: rig.tell()["z"] > 0.5e-6)
            assert bridge.wait(PATIENCE) == 2
        finally:
            with suppress(ProcessLookupError):
                os.kill(watcher, signal.SIGKILL)


def test_a_bridge_that_ends_by_itself_leaves_no_watcher() -> None:
    with touching() as (rig, bridge):
        watchers = watchers_of(bridge.pid) if Path("/proc/self/task").is_dir() else []
        rig.session.halt()
        until(lambda: rig.tell()["asked"]["ZCtrl.Withdraw"] == 1)
        bridge.terminate()
        assert bridge.wait(PATIENCE) == 0
        assert not any(Path(f"/proc/{each}").exists() for each in watchers)
        assert rig.tell()["asked"]["ZCtrl.Withdraw"] == 1
