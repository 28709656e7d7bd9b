# SPDX-License-Identifier: BSD-3-Clause
"""Halves of a rig from outside: Python classes, shared objects, another process; each goes through the rehearsal."""

from __future__ import annotations

import gc
import math
import os
import runpy
import shutil
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import DeviceError, InvalidValue
from nanotouch.touch.hal import Capabilities, Channel, Reading

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "docs/examples/hal"
PERIOD = 1 / 125
#: sessions take halves of one's own
takes_halves = pytest.mark.skipif(
    "master" not in nt.session.Options.__annotations__, reason="Session has no option master"
)


class Mouse(nt.hal.Master):
    """A position device that goes where `path` says, and notes what is asked of it."""

    def __init__(self, every: int = 8) -> None:
        self.every, self.calls, self.actions = every, [], []

    def path(self, seconds: float) -> float:
        return -8e-3 + min(6.8e-3, 6e-3 * seconds)

    def open(self, host: Any) -> None:
        self.calls.append("open")
        self.host, self.reads = host, 0

    def describe(self) -> Capabilities:
        channel = Channel("position", "m", minimum=-0.01, maximum=0.01)
        return Capabilities(period=PERIOD, event_driven=True, channels=[channel])

    def configure(self, configuration: nt.hal.Configuration) -> None:
        self.calls.append("configure")
        self.configuration = configuration

    def arm(self) -> None:
        self.calls.append("arm")

    def read(self) -> Reading | None:
        self.reads += 1
        if self.reads % self.every != 1:
            return None
        return Reading(position=(math.nan, math.nan, self.path(1e-9 * self.host.now())))

    def write(self, action: nt.hal.Action) -> None:
        self.actions.append(action)

    def disarm(self) -> None:
        self.calls.append("disarm")

    def close(self) -> None:
        self.calls.append("close")


class Bench(nt.hal.Slave):
    """A stage that stands where it was told to, in front of a spring."""

    option = "spring"

    def open(self, host: Any) -> None:
        self.at = np.zeros(3)

    def read(self) -> Reading:
        return Reading(position=self.at, felt=[math.nan, math.nan, max(0.0, float(self.at[2]) - 1e-7)])

    def write(self, action: nt.hal.Action) -> None:
        self.at = np.array(action.target)


# --- the contract ---


def test_python_classes_keep_the_contract() -> None:
    mouse = Mouse()
    seen = nt.hal.rehearse(mouse, real_time=False)
    assert seen.readings == 50
    assert seen.oldest == pytest.approx(7e-3)
    life = ["open", "configure", "arm", "disarm", "close"]
    assert (mouse.calls, mouse.configuration) == (["open", "close", *life, *life], (1e-3, 1e-6, ""))
    assert len(mouse.actions) == 400
    assert all(action.target == (0.0, 0.0, 0.0) and action.state == "RUN" for action in mouse.actions)
    with pytest.raises(ValueError, match="closed"):
        mouse.host.now()
    with pytest.warns(UserWarning, match="the deflection is the same number in every reading"):
        assert nt.hal.rehearse(Bench(), real_time=False).readings == 400


@pytest.mark.parametrize(
    ("reading", "rule"),
    [
        (Reading(position=(math.nan, math.nan, math.inf)), "valid bits of what is no number"),
        (Reading(position=(0.0, math.nan, 0.0)), "valid bits of what it cannot measure"),
        (Reading(position=(math.nan, math.nan, 0.0), felt=(math.nan, math.nan, 0.0)), "cannot measure"),
        (Reading(position=(math.nan, math.nan, 0.0), time=10**18), "age of a reading"),
        (Reading(), "valid first readings"),
        (None, "valid first readings"),
    ],
)
def test_broken_rules_are_named(reading: Reading | None, rule: str) -> None:
    class Broken(Mouse):
        def read(self) -> Reading | None:
            return reading

    broken = Broken()
    with pytest.raises(InvalidValue, match=f"rehearsal of Broken: .*{rule}"):
        nt.hal.rehearse(broken, real_time=False)
    assert broken.calls.count("open") == broken.calls.count("close")


@pytest.mark.parametrize("method", ["open", "describe", "configure", "arm", "read", "write", "disarm", "close"])
def test_what_a_method_raises_reaches_the_caller(method: str) -> None:
    def fail(*_: object) -> None:
        raise KeyError("from within")

    mouse = Mouse()
    setattr(mouse, method, fail)
    with pytest.raises(KeyError, match="from within"):
        nt.hal.rehearse(mouse, real_time=False)


@pytest.mark.parametrize(
    ("answer", "message"),
    [
        (3, "must return a nanotouch.hal.Reading or None, not 3"),
        (Reading(position=(1.0, 2.0)), "position must be three numbers"),
        (Reading(position=5.0), "position must be three numbers"),  # type: ignore[arg-type]
        (Reading(position="abc"), "position = 'a': valid are numbers"),  # type: ignore[arg-type]
        (Reading(position=(0.0, 0.0, 0.0), time=1.5), "time = 1.5: valid are whole"),  # type: ignore[arg-type]
        (Reading(flags=["tired"]), "no flag 'tired': valid are emergency_stop"),
    ],
)
def test_answers_that_are_no_reading(answer: object, message: str) -> None:
    mouse = Mouse()
    mouse.read = lambda: answer  # type: ignore[assignment,method-assign,return-value]
    with pytest.raises((TypeError, ValueError), match=message):
        nt.hal.rehearse(mouse, real_time=False)


def test_only_halves_are_rehearsed() -> None:
    with pytest.raises(TypeError, match=r"neither a nanotouch\.hal\.Master, "):
        nt.hal.rehearse(object())  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="period = 0"):
        nt.hal.rehearse(Mouse(), period=0.0)
    with pytest.raises(InvalidValue, match="duration"):
        nt.hal.rehearse(Mouse(), duration=math.nan)


# --- a device in another process ---


@pytest.fixture(scope="module")
def pointer() -> SimpleNamespace:
    return SimpleNamespace(**runpy.run_path(str(EXAMPLES / "pointer.py")))


@pytest.fixture(scope="module")
def device() -> SimpleNamespace:
    return SimpleNamespace(**runpy.run_path(str(EXAMPLES / "device.py")))


@pytest.fixture
def port() -> Iterator[int]:
    command = [sys.executable, str(EXAMPLES / "device.py")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        yield int(process.stdout.readline())
        process.kill()


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Compiled as the page says: one include folder, nothing linked."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler")
    made = tmp_path_factory.mktemp("pointer") / "pointer.so"
    include = ROOT / "libnanotouch/include"
    flags = ["-std=c11", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-fPIC", "-shared"]
    subprocess.run([compiler, *flags, "-I", str(include), "-o", str(made), str(EXAMPLES / "pointer.c")], check=True)
    return made


def test_device_in_another_process(port: int, pointer: SimpleNamespace, shared: Path) -> None:
    """On a clock that others share: the machine may miss periods, and readings be too old."""
    for half in (pointer.Pointer(port), nt.hal.SharedObject(shared, str(port))):
        for _ in range(5):
            try:
                seen = nt.hal.rehearse(half, period=2e-3)
                break
            except InvalidValue as error:  # a busy machine: the device's process did not run
                if "age of a reading" not in str(error):
                    raise
        else:
            pytest.skip("the machine is too busy for a device of 125 Hz")
        assert seen.readings >= 4


def test_object_links_nothing_of_ours(shared: Path) -> None:
    nm = shutil.which("nm")
    if nm is None:
        pytest.skip("no nm")
    command = [sys.executable, str(ROOT / "tools/check_symbols.py"), "backend", nm, str(shared)]
    assert subprocess.run(command, check=False, capture_output=True).returncode == 0


def test_object_is_open_once(port: int, shared: Path) -> None:
    first = nt.hal.SharedObject(shared, str(port))
    with pytest.raises(InvalidValue, match=r"option: the device's port = 0: valid is 1 \.\. 65535"):
        nt.hal.rehearse(nt.hal.SharedObject(shared))
    with pytest.raises(DeviceError, match="is a master, a slave is wanted"):
        nt.hal.rehearse(first, slave=True)
    with pytest.raises(DeviceError, match="No such file"):
        nt.hal.rehearse(nt.hal.SharedObject("nowhere.so"))


@pytest.fixture
def pair(pointer: SimpleNamespace) -> Iterator[tuple[Any, socket.socket]]:
    """An open backend, and the end that it listens to."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.bind(("127.0.0.1", 0))
        link.settimeout(5.0)
        half = pointer.Pointer(link.getsockname()[1])
        half.open(SimpleNamespace(now=time.monotonic_ns))
        half.greet()
        message, sender = link.recvfrom(64)
        assert message == b"hello"
        link.connect(sender)
        yield half, link
        half.close()


def test_garbage_is_refused(pair: tuple[Any, socket.socket], device: SimpleNamespace) -> None:
    half, link = pair
    good = device.report(7, 2, time.monotonic_ns(), (0.0, 0.0, 2e-3))
    damaged = bytearray(good)
    damaged[40] ^= 1
    rng = np.random.default_rng(1)
    bad = [
        b"", b"x", good[:-1], good + b"\0", bytes(damaged), rng.bytes(56), rng.bytes(200),
        device.report(7, 3, 0, (0.0, 0.0, math.nan)), device.report(7, 3, 0, (0.0, 0.0, 1.0)),
    ]  # fmt: skip
    for datagram in bad:
        link.send(datagram)
        assert half.read() is None
    assert half.refused == len(bad)
    link.send(good)
    assert half.read().position[2] == 2e-3
    link.send(device.report(7, 1, 0, (0.0, 0.0, 3e-3)))  # overtaken on its way
    assert half.read() is None
    link.send(device.report(8, 1, 5, (0.0, 0.0, 4e-3)))  # started anew
    assert half.read().position[2] == 4e-3


def test_newest_counts_and_stamps_are_the_hosts(pair: tuple[Any, socket.socket], device: SimpleNamespace) -> None:
    half, link = pair
    last = 0
    for sequence in range(1, 20):
        before = time.monotonic_ns()
        for z in (1e-3, 2e-3, 3e-3):
            link.send(device.report(1, 3 * sequence + round(z * 1e3), 10**6 * sequence, (0.0, 0.0, z)))
        reading = half.read()
        assert reading.position[2] == 3e-3
        assert last <= reading.time <= time.monotonic_ns()
        assert sequence > 1 or reading.time >= before
        last = reading.time
        assert half.read() is None  # and it has not waited


def test_nobody_is_there(pointer: SimpleNamespace) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.bind(("127.0.0.1", 0))
        free = link.getsockname()[1]
    with pytest.raises(DeviceError, match=f"no device answers at 127.0.0.1:{free}"):
        nt.hal.rehearse(pointer.Pointer(free))


# --- in a session ---


def mouse_rig(rate: float = 125.0) -> nt.Rig:
    return nt.Rig(master={"motor": "no", "gauge": "no", "rate": rate})


def session(**options: Any) -> nt.Session:
    return nt.Session(rig=mouse_rig(), **options)


@takes_halves
def test_mouse_touches() -> None:
    """125 Hz, no motor, no gauge: what it holds between two reports counts in the margin; it never leaves RUN."""
    mouse = Mouse(every=80)
    touch = session(master=mouse)
    assert 1.5 < touch.margins().least < math.inf  # R1 is of a motor
    columns = touch.advance(3.0)
    assert set(columns["state"]) == {0}
    assert 7e-3 < columns["master_age"].max() < PERIOD
    assert columns["slave_force"].max() > 100e-9
    assert abs(np.diff(columns["slave_force"][-2000:])).max() < 50e-9  # it rests
    assert mouse.actions[-1].tick == 29999
    del touch
    gc.collect()
    assert mouse.calls == ["open", "configure", "arm", "disarm", "close"]


@takes_halves
def test_silent_master_is_held() -> None:
    class Silent(Mouse):
        def read(self) -> Reading | None:
            return super().read() if self.host.now() < 1.5e9 else None

    columns = session(master=Silent(every=80)).advance(2.0)
    held = columns["time"][columns["state"] == 1]
    assert set(columns["state"]) == {0, 1}
    assert 1.2 < held[0] < 1.52  # the host's clock has run since before preflight
    assert held[-1] == columns["time"][-1]
    assert np.ptp(columns["stage_command"][-2000:]) == 0.0


@takes_halves
def test_failing_method_latches_and_is_raised_afterwards() -> None:
    class Breaking(Mouse):
        def read(self) -> Reading | None:
            if self.reads == 5000:
                raise ZeroDivisionError("the cable")
            return super().read()

    touch = session(master=Breaking(every=80))
    with pytest.raises(ZeroDivisionError, match="the cable"):
        touch.advance(0.5)
    columns = touch.read(10_000)
    assert columns["state"][0] == 0
    assert columns["state"][-1] == 3


@takes_halves
def test_runs_in_the_sessions_thread() -> None:
    mouse = Mouse(every=80)
    touch = session(master=mouse)
    touch.start("free", duration=1.0)
    while touch.progress.runs:
        time.sleep(0.01)
    touch.halt()
    assert len(mouse.actions) >= 10_000
    touch.start("wall")
    del touch  # while it runs: its thread needs the GIL to end
    gc.collect()
    assert mouse.calls[-2:] == ["disarm", "close"]


@takes_halves
def test_refusals_of_a_session() -> None:
    with pytest.raises((InvalidValue, DeviceError)):
        session(master=Mouse()).start("hard")
    with pytest.raises(TypeError, match="neither"):
        session(master=Bench())
    with pytest.raises(InvalidValue, match="rate"):
        nt.Session(rig=mouse_rig(1000.0), master=Mouse())


@takes_halves
def test_slave_in_python() -> None:
    """A spring behind 100 nm; what only a simulation knows is NaN."""
    touch = nt.Session(slave=Bench(), preflight=False)
    columns = touch.advance(0.5, nt.Input(1.0, math.nan, math.nan, 0.3))
    assert np.isnan(columns["gap"]).all()
    assert np.isfinite(columns["slave_force"]).all()
    assert touch.core.master_start < 0.0


@takes_halves
def test_page_is_followed(tmp_path: Path) -> None:
    """The example runs as a user runs it; a peer that dies holds the stage."""
    pytest.importorskip("mcap")
    file = tmp_path / "pointer.mcap"
    command = [sys.executable, "-W", "error", str(EXAMPLES / "touch.py"), "2", str(file)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "20000 ticks" in done.stdout
    assert len(nt.record.read(file)) == 20_000
