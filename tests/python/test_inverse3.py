# SPDX-License-Identifier: BSD-3-Clause
"""The bridge to Haply's Inverse3 against a mock that speaks its protocol: frames, forces, garbage, silence, losses."""

from __future__ import annotations

import asyncio
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable
from pathlib import Path

import nanotouch as nt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mock_inverse3 import ID, Service, frame
from nanotouch.errors import DeviceError

pytest.importorskip("aiohttp")

from nanotouch_app.devices import inverse3

PATIENCE = 60.0  # with a machine that is busy [s]
JSON = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(
        ["inverse3", "state", "device_id", "cursor_position", "x", "y", "z", "wireless_verse_grip", "buttons"]), inner),
    max_leaves=20,
)  # fmt: skip


# --- frames ---


def test_a_frame_is_understood() -> None:
    found = inverse3.understood(frame(z=0.25, pressed="ac"))
    assert found is not None
    assert found.device == ID
    assert found.position == pytest.approx((0.01, 0.0, -0.05))  # up is away from the sample
    assert found.buttons == 0b101
    assert inverse3.understood(frame().encode()) is not None
    assert inverse3.understood(frame(), "another") is None


WRONG = [
    "", "{", "null", "[]", "{}", "[" * 100_000, '{"inverse3": {}}', '{"inverse3": [3]}',
    '{"inverse3": [{"state": {}}]}',
    frame().replace("0.01", "NaN"), frame().replace("0.01", "1e999"), frame().replace("0.01", "true"),
    frame().replace("0.01", '"0.01"'), frame().replace("0.01", "null"), frame().replace('"x": 0.01, ', ""),
    frame().replace('"cursor_position"', '"position"'), frame(z=5.0),
    frame().replace("0.01", "1" + "0" * 400), frame().replace('"state"', '"status": {"ready": false}, "state"', 1),
    frame().replace(f'"{ID}"', "7"), frame()[:-1],
]  # fmt: skip


@pytest.mark.parametrize("text", [*WRONG, b"\xff\xfe\x00", b"\x00" * 100])
def test_garbage_is_no_frame(text: str | bytes) -> None:
    assert inverse3.understood(text) is None


STILL = {
    "position": dict.fromkeys("xyz", 0),
    "rotation": {"w": 1.0, "x": 0, "y": 0, "z": 0},
    "scale": dict.fromkeys("xyz", 1),
}
UPSIDE_DOWN = STILL | {"rotation": {"w": 0.0, "x": 1, "y": 0, "z": 0}}


def told(config: object = None, transform: object = None) -> str:
    """A frame with these beside its position."""
    made = json.loads(frame())
    (one,) = made["inverse3"]
    one |= {"config": config} if config else {}
    one["state"] |= {"transform": transform} if transform else {}
    return json.dumps(made)


def test_axes_that_somebody_has_turned_are_none() -> None:
    """The first frame of a connection tells basis and mount, each frame the transform."""
    bridge = inverse3.Bridge(None)  # type: ignore[arg-type]
    plain = {"basis": {"permutation": "XYZ"}, "mount": STILL}

    def is_taken(text: str) -> bool:
        return bridge._untouched(inverse3.understood(text)) is not None

    assert is_taken(told(plain, STILL))
    assert is_taken(told())
    assert not is_taken(told(transform=UPSIDE_DOWN))
    assert not is_taken(told(transform=STILL | {"scale": {"x": 1, "y": 1, "z": -1}}))
    assert not is_taken(told(transform={"rotation": 3}))
    assert is_taken(told())
    for odd in ({"basis": {"permutation": "XZY"}}, {"mount": UPSIDE_DOWN}):
        assert not is_taken(told(plain | odd))
        assert not is_taken(told())  # remembered
    assert is_taken(told(plain))


@settings(max_examples=50, deadline=None)
@given(JSON)
def test_no_json_is_too_odd(found: object) -> None:
    made = inverse3.understood(json.dumps(found))
    assert made is None or all(math.isfinite(value) for value in made.position)


@given(st.tuples(*[st.floats()] * 3))
def test_a_force_is_finite_and_within_its_range(force: tuple[float, float, float]) -> None:
    said = json.loads(inverse3.command(ID, force))
    (one,) = said["inverse3"]
    values = one["commands"]["set_cursor_force"]["values"]
    assert all(abs(value) <= inverse3.STRONGEST for value in values.values())
    if all(math.isfinite(f) and abs(f) < inverse3.STRONGEST for f in force):
        assert (values["x"], values["y"], -values["z"]) == force


# --- the bridge ---


async def until(condition: Callable[[], bool]) -> None:
    due = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < due
        await asyncio.sleep(5e-3)


class Box(nt.mailbox.Device):
    """A mailbox that notes what is published."""

    def __init__(self) -> None:
        super().__init__(f"test-inverse3-{os.getpid()}-{time.monotonic_ns()}", inverse3.capabilities())
        self.readings: list[nt.hal.Reading] = []
        self.force = (0.0, 0.0, 0.0)

    def publish(self, reading: nt.hal.Reading) -> None:
        super().publish(reading)
        self.readings.append(reading)

    def ask(self) -> nt.mailbox.Request:
        return super().ask()._replace(target=self.force)


def play(story: Callable[[Service, Box, inverse3.Bridge], Awaitable[None]]) -> tuple[Service, Box, inverse3.Bridge]:
    """A service, a bridge that runs, and what happens to them."""

    async def played() -> tuple[Service, Box, inverse3.Bridge]:
        service = Service()
        await service.start()
        with Box() as box:
            bridge = inverse3.Bridge(box, f"ws://127.0.0.1:{service.port}")
            running = asyncio.create_task(bridge.run())
            try:
                await until(lambda: len(box.readings) > 2)
                await story(service, box, bridge)
            finally:
                running.cancel()
                await asyncio.gather(running, return_exceptions=True)
                await until(lambda: service.open == 0)  # it has heard all that was said
                await service.stop()
        return service, box, bridge

    return asyncio.run(played())


def test_positions_come_and_forces_go() -> None:
    async def story(service: Service, box: Box, _: inverse3.Bridge) -> None:
        box.force, service.pressed = (0.5, 0.0, 2.0), "b"
        await until(lambda: service.forces[-1] == {"x": 0.5, "y": 0.0, "z": -2.0})
        await until(lambda: box.readings[-1].buttons == 0b010)

    service, box, bridge = play(story)
    assert service.wrong == []
    assert bridge.device == ID
    assert box.readings[-1].position == pytest.approx((0.01, 0.0, 0.0))
    assert service.forces[-1]["z"] == 0.0  # let go at the end


def test_garbage_publishes_nothing_and_takes_the_force_away() -> None:
    async def story(service: Service, box: Box, bridge: inverse3.Bridge) -> None:
        box.force = (0.0, 0.0, 1.0)
        await until(lambda: service.forces[-1]["z"] == -1.0)
        before = len(service.forces)
        service.instead.extend(WRONG)
        await until(lambda: not service.instead)
        await until(lambda: bridge.counts["refused"] >= len(WRONG) or bridge.counts["connections"] > 1)
        assert any(force["z"] == 0.0 for force in service.forces[before:])
        await until(lambda: service.forces[-1]["z"] == -1.0)  # and it goes on

    _, box, _ = play(story)
    assert all(reading.position == box.readings[0].position for reading in box.readings)


def test_silence_ends_the_connection_and_a_new_one_goes_on() -> None:
    async def story(service: Service, box: Box, bridge: inverse3.Bridge) -> None:
        service.silent = True
        await until(lambda: bridge.counts["late"] > 0)
        published = len(box.readings)
        await asyncio.sleep(0.02)
        assert len(box.readings) == published  # nothing is made up meanwhile
        service.silent = False
        await until(lambda: len(box.readings) > published)
        assert service.connections > 1

    play(story)


@pytest.mark.parametrize("what", [None, "x" * (inverse3.LARGEST + 1)])
def test_a_lost_connection_is_made_again(what: str | None) -> None:
    """The service closes, or sends more than any frame has."""

    async def story(service: Service, box: Box, bridge: inverse3.Bridge) -> None:
        service.instead.append(what)
        await until(lambda: bridge.counts["connections"] > 1)
        published = len(box.readings)
        await until(lambda: len(box.readings) > published)

    play(story)


def test_a_service_that_ends_and_comes_back() -> None:
    async def story(service: Service, box: Box, bridge: inverse3.Bridge) -> None:
        await service.stop()
        await until(lambda: service.connections == bridge.counts["connections"])
        published = len(box.readings)
        await service.start()  # at the same port
        await until(lambda: len(box.readings) > published)

    play(story)


def test_another_device_does_not_take_its_place() -> None:
    async def story(service: Service, box: Box, bridge: inverse3.Bridge) -> None:
        refused = bridge.counts["refused"]
        service.instead.append(frame(z=0.3, device="another"))
        await until(lambda: bridge.counts["refused"] > refused)

    _, box, _ = play(story)
    assert all(reading.position[2] == pytest.approx(0.0) for reading in box.readings)


# --- service, bridge and session, each a process of its own ---


class Process:
    """A Python program; `said` is its first line. Killed at the end."""

    def __init__(self, *arguments: object, talks: bool = False) -> None:
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        command = [sys.executable, *map(str, arguments)]
        self.process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
        assert self.process.stdout is not None
        self.said = self.process.stdout.readline() if talks else ""

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *_: object) -> None:
        self.process.kill()
        self.process.communicate()


def opened(name: str) -> nt.Session:
    rig = nt.Rig(master={"gauge": "no", "max_force": 3.0, "rate": 1000.0})
    due = time.monotonic() + PATIENCE
    while True:
        try:
            return nt.Session(rig=rig, master=nt.hal.Mailbox(name), clearance=1e-6, preflight=False)
        except DeviceError:  # not there yet
            assert time.monotonic() < due
            time.sleep(0.05)


def awaited(session: nt.Session, state: str) -> None:
    due = time.monotonic() + PATIENCE
    while session.state != state:
        if state != "LATCHED" and session.state == "LATCHED":
            pytest.skip("the machine is too busy: the bridge did not run for a second")
        assert time.monotonic() < due, f"{session.state} instead of {state}"
        time.sleep(0.01)


def test_the_session_holds_without_the_service_and_latches_without_the_bridge() -> None:
    name, mock = f"test-inverse3-{os.getpid()}-{time.monotonic_ns()}", Path(__file__).with_name("mock_inverse3.py")
    with Process(mock, talks=True) as service:
        url = f"ws://127.0.0.1:{int(service.said)}"
        bridge = Process("-m", "nanotouch_app.devices.inverse3", name, "--url", url, "--timeout", 1.0)
        with bridge:
            session = opened(name)
            session.start("wall")
            awaited(session, "RUN")
            service.process.kill()
            awaited(session, "HOLD")
            service.process.wait()
            with Process(mock, int(service.said), talks=True):
                awaited(session, "RUN")
                bridge.process.kill()
                awaited(session, "LATCHED")
            session.halt()


def test_it_says_why_it_cannot_begin(capsys: pytest.CaptureFixture[str]) -> None:
    assert inverse3.main(["a/b"]) == 2
    assert "bytes of the name" in capsys.readouterr().err
