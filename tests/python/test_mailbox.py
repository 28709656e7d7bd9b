# SPDX-License-Identifier: BSD-3-Clause
"""A half in another process by its mailbox: the templates are rehearsed, driven, killed and stopped."""

from __future__ import annotations

import math
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import nanotouch as nt
import pytest
from nanotouch.errors import DeviceError, Error, InvalidValue
from nanotouch.touch.hal import Capabilities, Channel, Mailbox, Reading
from nanotouch.touch.mailbox import Device

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "docs/examples/mailbox"
PATIENCE = 60.0  # with a machine that is busy [s]
MOTOR = Channel("motor force", "N", driven=True, minimum=-3.0, maximum=3.0, safe=0.0)


@pytest.fixture
def name() -> str:
    return f"test-{os.getpid()}-{time.monotonic_ns()}"


def hand() -> Capabilities:
    return Capabilities(pushes=True, period=1e-3, channels=[MOTOR])


@contextmanager
def program(command: list[str], name: str) -> Iterator[subprocess.Popen[bytes]]:
    """A device's program that serves this name; ended in any case."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    with subprocess.Popen([*command, name], env=environment) as served:
        try:
            yield served
        finally:
            served.kill()


def opened(name: str) -> nt.Session:
    """A session on this mailbox, once its program is there."""
    rig = nt.Rig(master={"gauge": "no", "max_force": 3.0, "rate": 1000.0})
    due = time.monotonic() + PATIENCE
    while True:
        try:
            return nt.Session(rig=rig, master=Mailbox(name), clearance=1e-6)
        except DeviceError:
            if time.monotonic() > due:
                raise
            time.sleep(0.05)


def awaited(session: nt.Session, state: str) -> None:
    due = time.monotonic() + PATIENCE
    while session.state != state:
        assert time.monotonic() < due, f"{session.state} instead of {state}"
        time.sleep(0.01)


def c_program(folder: Path) -> list[str]:
    """The template in C, compiled with the library's own sources, which a wheel does not ship."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    library = ROOT / "libnanotouch"
    sources = ["hal/mailbox.c", "hal/shared_memory.c", "hal/clock.c", "hal/capabilities.c", "core/status.c"]
    flags = ["-std=c11", "-O2", "-Wall", "-Wextra", "-Werror", "-I", str(library / "include"), "-I", str(library)]
    made = folder / "device"
    files = [str(EXAMPLES / "device.c"), *(str(library / source) for source in sources)]
    subprocess.run([compiler, *flags, "-o", str(made), *files, "-lm", "-lrt"], check=True)
    return [str(made)]


def rehearsed(name: str) -> nt.hal.Rehearsed:
    """On a clock that others share: the machine may miss periods, and then readings are too old."""
    due, busy = time.monotonic() + PATIENCE, 0
    while busy < 5:
        try:
            return nt.hal.rehearse(Mailbox(name), period=0.02, duration=0.1)
        except DeviceError:  # not there yet, or it did not run
            assert time.monotonic() < due
            time.sleep(0.05)
        except InvalidValue as error:
            if "age of a reading" not in str(error):
                raise
            busy += 1
    pytest.skip("the machine is too busy for a device of 1 kHz")


@pytest.mark.parametrize("language", ["python", "c"])
def test_templates_keep_the_contract(language: str, name: str, tmp_path: Path) -> None:
    command = [sys.executable, str(EXAMPLES / "device.py")] if language == "python" else c_program(tmp_path)
    with program(command, name) as served:
        assert rehearsed(name).readings > 0
        served.send_signal(signal.SIGTERM)
        served.wait(PATIENCE)
    with pytest.raises(DeviceError, match="programs that serve this mailbox"):
        nt.hal.rehearse(Mailbox(name))


def test_a_killed_program_latches(name: str) -> None:
    """How many ticks it takes is told by test_session_mailbox, without a clock."""
    with program([sys.executable, str(EXAMPLES / "device.py")], name) as served:
        session = opened(name)
        session.start("wall")
        served.kill()
        awaited(session, "LATCHED")
        session.halt()


def test_both_ends(name: str) -> None:
    with Device(name, hand()) as device:
        request = device.ask()
        assert not request.is_armed
        assert request.target == (0.0, 0.0, 0.0)
        device.publish(Reading(position=(math.nan, math.nan, 1e-3)))
        device.beat()
        assert abs(device.now() - time.monotonic_ns()) < 60e9
    with pytest.raises(ValueError, match="closed"):
        device.ask()
    device.close()


def test_one_program_has_a_name(name: str) -> None:
    with Device(name, hand()), pytest.raises(Error, match="another program serves it"):
        Device(name, hand())
    Device(name, hand()).close()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"name": "a/b"}, "bytes of the name"),
        ({"name": ""}, "bytes of the name"),
        ({"half": "both"}, "half = 'both': valid are master and slave"),
        ({"timeout": 0.0}, "timeout = 0"),
        ({"timeout": math.nan}, "timeout = nan"),
        ({"timeout": 2.0}, "timeout = 2"),
        ({"capabilities": Capabilities(axes=4)}, "axes = 4"),
        ({"capabilities": Capabilities(channels=[MOTOR] * 10)}, "rows = 10"),
        ({"capabilities": Capabilities(channels=[MOTOR._replace(name="x" * 32)])}, "bytes of a channel's name = 32"),
        ({"capabilities": Capabilities(period=0.6), "timeout": 1.0}, "timeout = 1"),
    ],
)
def test_what_cannot_be_is_refused(name: str, options: dict[str, object], words: str) -> None:
    with pytest.raises(InvalidValue, match=words):
        Device(**{"name": name, "capabilities": hand()} | options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "reading",
    [
        Reading(position=(1e-3, math.nan, 0.0)),  # it has one axis
        Reading(position=(math.nan, math.nan, math.inf)),
        Reading(position=(math.nan, math.nan, 0.0), felt=(math.nan, math.nan, 1.0)),  # it has no gauge
        Reading(position=(math.nan, math.nan, 0.0), flags=["device_lost"]),
        Reading(position=(math.nan, math.nan, 0.0), time=2**62),
    ],
)
def test_a_reading_that_cannot_be_is_refused(name: str, reading: Reading) -> None:
    with Device(name, hand()) as device, pytest.raises(InvalidValue, match="cannot be a reading of this device"):
        device.publish(reading)


def test_wrong_names_of_a_session() -> None:
    with pytest.raises(InvalidValue):
        nt.hal.rehearse(Mailbox(""))
    with pytest.raises(InvalidValue):
        nt.hal.rehearse(Mailbox("x" * 65))
    with pytest.raises(DeviceError, match="programs that serve this mailbox = 0"):
        nt.hal.rehearse(Mailbox("nobody-has-this-name"))


def test_a_session_may_be_opened_beside_the_device_in_one_program(name: str) -> None:
    """Arming waits for a reading; other threads go on meanwhile."""
    with Device(name, hand()) as device:
        stopped = threading.Event()

        def serve() -> None:
            while not stopped.wait(5e-4):
                device.ask()
                device.publish(Reading(position=(math.nan, math.nan, 0.0)))

        thread = threading.Thread(target=serve)
        thread.start()
        try:
            rig = nt.Rig(master={"gauge": "no", "max_force": 3.0, "rate": 1000.0})
            session = nt.Session(rig=rig, master=Mailbox(name), clearance=1e-6, preflight=False)
            assert session.state == "RUN"
            del session
        finally:
            stopped.set()
            thread.join()


@pytest.mark.skipif(not Path("/dev/shm").is_dir(), reason="shared memory has no files here")
def test_a_mailbox_of_another_version_is_named(name: str) -> None:
    with Device(name, hand()):
        os.truncate(f"/dev/shm/nanotouch.mailbox.{name}", 512)
        with pytest.raises(DeviceError, match="another version of nanotouch made it"):
            nt.Session(rig=nt.Rig(master={"gauge": "no"}), master=Mailbox(name))
        os.truncate(f"/dev/shm/nanotouch.mailbox.{name}", 4096)
