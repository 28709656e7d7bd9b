# SPDX-License-Identifier: BSD-3-Clause
"""Frames of a running session, and requests to it, across processes."""

from __future__ import annotations

import math
import os
import signal
import subprocess
import sys
from collections.abc import Iterator

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import _core, commands, frames
from nanotouch.errors import DeviceError, Error, InvalidValue

NAME = f"pytest-{os.getpid()}"


def rows(first: int, end: int) -> np.ndarray:
    """Frames whose numbers are functions of the tick."""
    made = np.zeros(end - first, dtype=frames.FRAME)
    made["size"], made["version"] = frames.FRAME.itemsize, 1
    made["sequence"] = np.arange(first, end)
    made["time"] = 1e-4 * made["sequence"]
    made["tip_force"] = np.stack([made["time"] * axis for axis in (1.0, 2.0, -3.0)], axis=1)
    made["gap"] = np.nan
    return made


@pytest.fixture
def writer() -> Iterator[_core.Frames]:
    made = _core.Frames(NAME)
    yield made
    made.close()


def test_frame_is_as_documented() -> None:
    assert frames.FRAME.itemsize == 184
    assert frames.FRAME["tip_force"].shape == (3,)
    assert frames.FRAME.names == (
        "size", "version", "sequence", "time", "tip_position", "tip_force", "base_height", "deflection",
        "master_position", "motor_force", "gap", "contact_radius", "cohesive_radius", "neck_radius", "state",
        "reasons", "phase", "changes",
    )  # fmt: skip


def test_observer_reads_each_frame_once(writer: _core.Frames) -> None:
    with frames.attach(NAME) as observer:
        assert observer.newest() is None
        assert len(observer.read()) == 0
        writer.publish(rows(0, 10))
        newest = observer.newest()
        assert newest is not None
        assert newest["sequence"] == 9
        assert math.isnan(newest["gap"])
        assert observer.read(4).tobytes() == rows(0, 4).tobytes()  # NaN included
        assert observer.read().tobytes() == rows(4, 10).tobytes()  # NaN included
        assert len(observer.read()) == 0
        assert observer.missed == 0


def test_lagging_observer_counts_what_it_missed(writer: _core.Frames) -> None:
    with frames.attach(NAME) as observer:
        writer.publish(rows(0, 3 * frames.SLOTS))
        got = observer.read(10**9)
        assert len(got) + observer.missed == 3 * frames.SLOTS
        assert got.tobytes() == rows(3 * frames.SLOTS - len(got), 3 * frames.SLOTS).tobytes()  # NaN included


def test_description_and_its_changes(writer: _core.Frames) -> None:
    with frames.attach(NAME) as observer:
        assert (observer.description, observer.changes) == ("", 0)
        writer.describe('{"radius": "20 nm", "µ": 1}')
        assert (observer.description, observer.changes) == ('{"radius": "20 nm", "µ": 1}', 1)
        with pytest.raises(Error, match="full"):
            writer.describe("x" * 65536)
        assert observer.changes == 1


def test_closed_writer_is_dead(writer: _core.Frames) -> None:
    with frames.attach(NAME) as observer:
        assert observer.silence < math.inf
        writer.publish(rows(0, 3))
        writer.close()
        assert observer.silence == math.inf
        assert not observer.alive
        assert len(observer.read()) == 3
    with pytest.raises(DeviceError, match="no session"):
        frames.attach(NAME)


def test_errors_say_what_is_wrong(writer: _core.Frames) -> None:
    with pytest.raises(DeviceError, match="no session 'nobody' of this user"):
        frames.attach("nobody")
    with pytest.raises(InvalidValue, match="name = 'a/b': valid are"):
        commands.attach("a/b")
    with pytest.raises(Error, match="state"):
        _core.Frames(NAME)  # a second writer
    observer = frames.attach(NAME)
    with pytest.raises(InvalidValue, match="count = -1"):
        observer.read(-1)
    observer.close()
    observer.close()
    with pytest.raises(Error, match="closed"):
        observer.newest()
    assert repr(observer) == f"Observer('{NAME}')"


def test_requests_under_a_lease(writer: _core.Frames) -> None:
    with commands.attach(NAME) as one, commands.attach(NAME) as other:
        with pytest.raises(Error):
            one.post(7)
        one.lease()
        with pytest.raises(Error, match="another client holds the lease"):
            other.lease()
        request = one.post(7, 3, (1.0, 2.0, 3.0, 4.0))
        stop = other.stop()
        taken = writer.take()
        assert taken is not None
        assert taken[:2] == (stop, _core.request_stop)
        assert one.poll(request).pending
        assert writer.take() == (request, 7, 3, [1.0, 2.0, 3.0, 4.0])
        assert writer.take() is None
        writer.answer(request, 12, 3, False)
        assert one.poll(request) == commands.Answer(request, 12, 3, False, "a value is outside its valid range")
        one.release()
        other.lease()


READER = """
import sys
from nanotouch import frames
with frames.attach(sys.argv[1]) as observer:
    print("ready", flush=True)
    seen = 0
    while seen + observer.missed < int(sys.argv[2]):
        for frame in observer.read():
            assert frame["tip_force"].tolist() == [frame["time"] * axis for axis in (1.0, 2.0, -3.0)]
            seen += 1
    print(seen + observer.missed)
"""


def test_readers_in_other_processes(writer: _core.Frames) -> None:
    """One is killed, one stopped for a while; what the others read is right, and the writer knows of nothing."""
    readers = [
        subprocess.Popen([sys.executable, "-c", READER, NAME, "20000"], stdout=subprocess.PIPE, text=True)
        for _ in range(3)
    ]
    for reader in readers:
        assert reader.stdout is not None
        assert reader.stdout.readline() == "ready\n"
    readers[0].kill()
    readers[1].send_signal(signal.SIGSTOP)
    writer.publish(rows(0, 10000))
    readers[1].send_signal(signal.SIGCONT)
    writer.publish(rows(10000, 20000))
    out = [reader.communicate(timeout=60)[0] for reader in readers]
    assert out[1:] == ["20000\n", "20000\n"]
    assert readers[0].returncode == -signal.SIGKILL


def test_names_of_the_package() -> None:
    assert nt.frames is frames
    assert nt.commands is commands
