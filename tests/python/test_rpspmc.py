# SPDX-License-Identifier: BSD-3-Clause
"""The bridge to RPSPMC against a mock after Gxsm's sources: set points, refusals, a tip that is up whatever fails."""

from __future__ import annotations

import asyncio
import gzip
import json
import math
import os
import signal
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable

import nanotouch as nt
import pytest
from mock_rpspmc import SURFACE, Controller
from nanotouch.errors import DeviceError, InvalidValue

pytest.importorskip("aiohttp")

from nanotouch_app.devices import rpspmc
from nanotouch_app.devices.rpspmc import GUARD, LOWER, MODE, UPPER, Bridge, Link, Setup

PATIENCE = 30.0  # with a machine that is busy [s]
SCALE = 100e-9  # of z and signal [m/V]


class Box:
    """A mailbox in which a test asks."""

    def __init__(self) -> None:
        self.readings: list[nt.hal.Reading] = []
        self.armed, self.travel = False, 0.0

    def publish(self, reading: nt.hal.Reading) -> None:
        self.readings.append(reading)

    def now(self) -> int:
        return time.monotonic_ns()

    def ask(self) -> nt.mailbox.Request:
        return nt.mailbox.Request(self.armed, "RUN", 0, 0, (math.nan, math.nan, self.travel), 0.0, 0.0, 0.0)


Story = Callable[[Controller, Box, Bridge], Awaitable[None]]


def play(story: Story) -> Controller:
    """A controller, a bridge, and what happens to them."""

    async def played() -> Controller:
        controller = Controller()
        await controller.start()
        try:
            async with Link(Setup(20e-9, SCALE, SCALE, port=controller.port, patience=2.0)) as link:
                bridge, box = Bridge(link.setup, link), Box()
                await bridge.find()
                await story(controller, box, bridge)
        finally:
            await controller.stop()
        return controller

    return asyncio.run(played())


async def until(condition: Callable[[], bool]) -> None:
    due = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < due
        await asyncio.sleep(5e-3)


def test_travel_is_a_limit_and_the_guard_a_set_point() -> None:
    """The servo goes no farther than the session wants; in contact it stops at the guard; the end lifts."""

    async def story(controller: Controller, box: Box, bridge: Bridge) -> None:
        serving = asyncio.create_task(bridge.serve(box))  # type: ignore[arg-type]
        await until(lambda: len(box.readings) > 1)
        assert controller.values[MODE] == 0.0  # nothing moves before a session drives
        box.armed, box.travel = True, 100e-9
        await until(lambda: controller.values["SPMC_Z_MONITOR"] == pytest.approx(1.0))
        assert controller.values[GUARD] == pytest.approx(0.2)  # 20 nm
        await until(lambda: box.readings[-1].position[2] == pytest.approx(100e-9))
        box.travel = 400e-9  # far into the sample
        await until(lambda: box.readings[-1].felt[2] == pytest.approx(20e-9, rel=0.01))
        assert controller.values["SPMC_Z_MONITOR"] == pytest.approx(SURFACE + 0.05, rel=0.01)
        bridge.stopped = True
        await serving

    controller = play(story)
    assert controller.values[UPPER] == controller.values[LOWER] == -5.0
    assert controller.wrong == []


def test_a_value_that_is_not_kept_never_lets_the_servo_on() -> None:
    async def story(controller: Controller, box: Box, bridge: Bridge) -> None:
        controller.deaf.add(GUARD)
        object.__setattr__(bridge.setup, "patience", 0.3)
        box.armed = True
        with pytest.raises(DeviceError, match="does not keep"):
            await bridge.serve(box)  # type: ignore[arg-type]
        assert controller.values[MODE] == 0.0
        await bridge.release()

    assert play(story).values[UPPER] == -5.0


@pytest.mark.parametrize("what", ["silent", "changed"])
def test_silence_and_other_hands_end_it(what: str) -> None:
    async def story(controller: Controller, box: Box, bridge: Bridge) -> None:
        serving = asyncio.create_task(bridge.serve(box))  # type: ignore[arg-type]
        box.armed = True
        await until(lambda: controller.values[MODE] == 1.0)
        object.__setattr__(bridge.setup, "patience", 0.3)
        if what == "silent":
            controller.silent = True
        else:
            controller.values[GUARD] = 3.0
        with pytest.raises(DeviceError, match=r"silent|keep|somebody else"):
            await asyncio.wait_for(serving, PATIENCE)
        controller.silent = False
        assert bridge.is_ours
        object.__setattr__(bridge.setup, "patience", 2.0)
        await bridge.release()

    assert play(story).values[UPPER] == -5.0


@pytest.mark.parametrize("data", [
    b"", b"no gzip", gzip.compress(b"[]", mtime=0), gzip.compress(b'{"parameters": 3}', mtime=0),
    "[" * 10_000, "{}", '{"signals": {}}',
    '{"parameters": {"A": {"value": "1"}, "B": {"value": true}, "C": 3, "D": {"value": 1e99}}}',
])  # fmt: skip
def test_garbage_says_nothing(data: str | bytes) -> None:
    assert rpspmc.understood(data) == {}


def test_a_message_is_understood() -> None:
    packed = gzip.compress(json.dumps({"parameters": {"SPMC_BIAS": {"value": 0.5, "min": -10}}}).encode())
    assert rpspmc.understood(packed) == {"SPMC_BIAS": 0.5}


def test_limits_that_cannot_be_are_refused() -> None:
    async def story(controller: Controller, box: Box, bridge: Bridge) -> None:
        controller.values[UPPER] = -6.0
        await until(lambda: bridge.link.values[UPPER] == -6.0)
        with pytest.raises(InvalidValue, match=r"limits are -5 \.\. -6 V"):
            await bridge.find()

    play(story)


def test_a_killed_bridge_leaves_the_tip_up() -> None:
    """By its watcher, a second process."""

    async def played() -> None:
        controller = Controller()
        await controller.start()
        name = f"test-rpspmc-{os.getpid()}"
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        options = ["--guard-nm", "20", "--z-nm-per-V", "100", "--signal-nm-per-V", "100", "--timeout", "1.0"]
        command = [sys.executable, "-m", rpspmc.PROGRAM, name, *options, "--port", str(controller.port)]
        process = subprocess.Popen(command, env=environment)
        try:
            rig = nt.Rig(stage={"axes": 1})
            settings = nt.Settings.for_rig(rig)
            settings.gains.rate, settings.gains.force_gain, settings.gains.stage_integral = 10, 0.05, 1

            def opened() -> nt.Session:
                due = time.monotonic() + PATIENCE
                while True:
                    try:
                        return nt.Session(rig=rig, settings=settings, slave=nt.hal.Mailbox(name), preflight=False,
                                          minimum_margin=0.0)  # fmt: skip
                    except DeviceError:
                        assert time.monotonic() < due
                        time.sleep(0.1)

            session = await asyncio.to_thread(opened)
            session.start("hard")
            await until(lambda: controller.values[MODE] == 1.0)
            os.kill(process.pid, signal.SIGKILL)
            await until(lambda: controller.values[UPPER] == -5.0 and controller.values["SPMC_Z_MONITOR"] == -5.0)
            await until(lambda: session.state == "LATCHED")
            await asyncio.to_thread(session.halt)
        finally:
            process.kill()
            process.wait()
            await controller.stop()

    asyncio.run(played())
