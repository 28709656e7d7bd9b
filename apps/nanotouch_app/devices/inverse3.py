# SPDX-License-Identifier: BSD-3-Clause
"""Haply's Inverse3 as a master: JSON over a WebSocket to Haply's Inverse Service, and a mailbox to the session.

The service answers each command with a frame of all devices, so a force is sent for every frame, 0 N where nobody
drives. What it says is trusted as little as any other device: docs/devices.md tells what follows from what.

Usage: python -m nanotouch_app.devices.inverse3 NAME [--url URL] [--device ID] [--timeout S]
then, elsewhere: nanotouch.Session(rig=..., master=nanotouch.hal.Mailbox(NAME))
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import math
import signal
import sys
import threading
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

from nanotouch.errors import Error, require
from nanotouch.touch import mailbox
from nanotouch.touch.hal import Capabilities, Channel, Reading

if TYPE_CHECKING:
    from nanotouch_app.devices.bridge import Box

URL = "ws://localhost:10001"
"""of the Inverse Service"""
PERIOD = 1e-3
"""between two frames of the service [s]"""
TIMEOUT = 0.1
"""without a good frame for so long the connection is given up; of the mailbox, unless told otherwise [s]"""
PAUSE = 0.5
"""before the service is tried again [s]"""
LARGEST = 65536
"""of a frame; a larger one ends the connection [byte]"""
REACH = 0.2
"""the cursor stays within this distance of the origin of the workspace, along each axis [m]"""
CENTRE = (0.0, -0.15, 0.2)
"""of the workspace, in the service's frame: x to the right, y away from the base, z up [m]"""
LARGE = 1e3
"""what no length [m], scale or turn of a frame reaches; JSON has whole numbers that no float holds"""
STRONGEST = 10.0
"""force along an axis [N]"""
BUTTONS = ("a", "b", "c")
"""of the grip, bit by bit"""


def capabilities() -> Capabilities:
    """Three axes and motors, no force sensor."""
    reads = [Channel("position", "m", axis=axis, minimum=-2.0 * REACH, maximum=2.0 * REACH) for axis in range(3)]
    drives = [
        Channel("motor force", "N", driven=True, axis=axis, minimum=-STRONGEST, maximum=STRONGEST, safe=0.0)
        for axis in range(3)
    ]
    return Capabilities(axes=3, period=PERIOD, pushes=True, channels=[*reads, *drives])


class Frame(NamedTuple):
    """What a frame says of one device."""

    device: str
    position: tuple[float, float, float]
    """in our axes: x, y, and towards the sample [m]"""
    buttons: int
    is_turned: bool
    """the service reports in other axes than its own, by this frame's transform"""
    was_turned: bool | None
    """by basis or mount of a frame that tells the configuration, as the first one does; None: it tells none"""


def _vector(given: object) -> tuple[float, float, float] | None:
    """x, y, z of an object of three finite numbers; None for anything else."""
    if not isinstance(given, dict):
        return None
    numbers = [given.get(axis) for axis in "xyz"]
    if any(isinstance(n, bool) or not isinstance(n, int | float) or not abs(n) < LARGE for n in numbers):
        return None
    x, y, z = (float(n) for n in numbers)  # type: ignore[arg-type]
    return x, y, z


def _is_identity(given: object) -> bool:
    """Whether a mount or transform of the service's changes nothing."""
    if not isinstance(given, dict):
        return False
    rotation = given.get("rotation")
    turn = _vector(rotation) if isinstance(rotation, dict) else None
    shift, scale = _vector(given.get("position")), _vector(given.get("scale"))
    return turn == shift == (0.0, 0.0, 0.0) and scale == (1.0, 1.0, 1.0)


def _configured(found: dict[str, Any]) -> bool | None:
    """Whether basis or mount of a device turn its axes; None if the frame does not tell."""
    config = found.get("config")
    if not isinstance(config, dict):
        return None
    basis, mount = config.get("basis"), config.get("mount")
    return not (basis is None or basis == {"permutation": "XYZ"}) or not (mount is None or _is_identity(mount))


def to_ours(position: Sequence[float]) -> tuple[float, float, float]:
    """From the service's frame to ours: about the centre of the workspace, z + down, towards the sample."""
    x, y, z = (value - middle for value, middle in zip(position, CENTRE, strict=True))
    return x, y, -z


def to_theirs(force: Sequence[float]) -> dict[str, float]:
    """A force [N] as the service wants it: within its range, 0 for what is no number."""
    x, y, z = (max(-STRONGEST, min(STRONGEST, f)) if math.isfinite(f) else 0.0 for f in force)
    return {"x": x, "y": y, "z": -z}


def _first(given: object, device: str) -> dict[str, Any] | None:
    """The device with this id of a list of devices, the first one if the id is empty."""
    for one in given if isinstance(given, list) else []:
        if isinstance(one, dict) and isinstance(one.get("device_id"), str) and device in ("", one["device_id"]):
            return one
    return None


def understood(text: str | bytes, device: str = "") -> Frame | None:
    """What a frame says of the device with this id, "": the first one. None for what is no frame, or has no good
    position of it."""
    try:
        given = json.loads(text)
    except (ValueError, RecursionError):
        return None
    if not isinstance(given, dict) or (found := _first(given.get("inverse3"), device)) is None:
        return None
    state, status = found.get("state"), found.get("status")
    if not isinstance(state, dict) or (isinstance(status, dict) and status.get("ready") is False):
        return None
    position = _vector(state.get("cursor_position"))
    if position is None or any(abs(value) > REACH for value in to_ours(position)):
        return None
    grip = _first(given.get("wireless_verse_grip"), "") or {}
    pressed = grip.get("state", {}).get("buttons") if isinstance(grip.get("state"), dict) else None
    buttons = sum(
        1 << bit for bit, name in enumerate(BUTTONS) if isinstance(pressed, dict) and pressed.get(name) is True
    )
    is_turned = "transform" in state and not _is_identity(state["transform"])
    return Frame(found["device_id"], to_ours(position), buttons, is_turned, _configured(found))


def command(device: str, force: Sequence[float]) -> str:
    """The message that sets the force [N] of a device, and asks for the next frame."""
    values = {"values": to_theirs(force)}
    return json.dumps({"inverse3": [{"device_id": device, "commands": {"set_cursor_force": values}}]})


@dataclass
class Bridge:
    """Between the service and a mailbox, until it is stopped."""

    mailbox: mailbox.Device | Box
    url: str = URL
    device: str = ""
    """id of the device; "": the first one that is there, and no other from then on"""
    counts: dict[str, int] = field(
        default_factory=lambda: dict.fromkeys(("frames", "refused", "turned", "late", "connections"), 0)
    )
    is_turned: bool = False
    """the service reports in other axes than its own: up may be down"""

    @property
    def trouble(self) -> str:
        """Why there is no reading, in words."""
        if not self.counts["connections"]:
            return f"nothing answers at {self.url}"
        if self.counts["turned"]:
            return "the service turns, moves or scales its axes: set basis, mount and transform back"
        return f"the service at {self.url} reports no Inverse3 that is ready"

    async def run(self) -> None:
        """Connect, and again after each loss. Meanwhile the program lives, and its last reading grows old."""
        beats = asyncio.create_task(self._beat())
        try:
            while True:
                with contextlib.suppress(*_losses()):
                    await self._converse()
                await asyncio.sleep(PAUSE)
        finally:
            beats.cancel()

    async def _beat(self) -> None:
        while True:
            self.mailbox.beat()
            await asyncio.sleep(TIMEOUT / 10)

    async def _converse(self) -> None:
        """One connection, to its end: lost, closed, or no good frame for the timeout."""
        aiohttp = require("aiohttp", "browser")
        wait = aiohttp.ClientTimeout(total=None, sock_connect=5.0)
        async with (
            aiohttp.ClientSession(timeout=wait) as client,
            client.ws_connect(self.url, max_msg_size=LARGEST, autoping=True) as link,
        ):
            self.counts["connections"] += 1
            loop = asyncio.get_running_loop()
            due = loop.time() + TIMEOUT
            try:
                while (left := due - loop.time()) > 0.0:
                    async with asyncio.timeout(left):
                        message = await link.receive()
                    if message.type not in (aiohttp.WSMsgType.TEXT, aiohttp.WSMsgType.BINARY):
                        return  # closed
                    if await self._answer(link, message.data):
                        due = loop.time() + TIMEOUT
                self.counts["late"] += 1
            except TimeoutError:
                self.counts["late"] += 1
            finally:  # a hand that is let go feels nothing
                if self.device:
                    with contextlib.suppress(*_losses()):
                        async with asyncio.timeout(TIMEOUT):
                            await link.send_str(command(self.device, (0.0, 0.0, 0.0)))

    async def _answer(self, link: Any, data: str | bytes) -> bool:
        """Publish a good frame; send the force in any case, so that the next frame comes. Was it good?"""
        frame = self._untouched(understood(data, self.device))
        self.counts["frames" if frame else "refused"] += 1
        if frame:
            self.device = frame.device
            self.mailbox.publish(Reading(position=frame.position, buttons=frame.buttons))
        if self.device:
            force = self.mailbox.ask().target if frame else (0.0, 0.0, 0.0)
            async with asyncio.timeout(TIMEOUT):
                await link.send_str(command(self.device, force))
        return frame is not None

    def _untouched(self, frame: Frame | None) -> Frame | None:
        """None for a frame in axes that somebody has turned."""
        if frame is None:
            return None
        self.is_turned = self.is_turned if frame.was_turned is None else frame.was_turned
        if not self.is_turned and not frame.is_turned:
            return frame
        if not self.counts["turned"]:
            print("inverse3: the service turns, moves or scales the axes: set basis, mount and transform back",
                  file=sys.stderr, flush=True)  # fmt: skip
        self.counts["turned"] += 1
        return None


def serve(box: Box, option: str, stopped: threading.Event) -> None:
    """For nanotouch_app.devices.bridge; the option is the address of the service."""

    async def served() -> None:
        bridge = Bridge(box, option or URL)
        task = asyncio.create_task(bridge.run())
        while not stopped.is_set() and not task.done():
            box.trouble = bridge.trouble
            await asyncio.sleep(0.02)
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task

    asyncio.run(served())


def _losses() -> tuple[type[BaseException], ...]:
    """How a connection is lost."""
    return (require("aiohttp", "browser").ClientError, OSError, TimeoutError)


async def _serve_until_stopped(args: argparse.Namespace) -> None:
    with mailbox.Device(args.name, capabilities(), timeout=args.timeout) as box:
        task = asyncio.create_task(Bridge(box, args.url, args.device).run())
        for number in (signal.SIGINT, signal.SIGTERM):
            asyncio.get_running_loop().add_signal_handler(number, task.cancel)
        with contextlib.suppress(asyncio.CancelledError):
            await task


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program; 2 with one line if it cannot begin."""
    parser = argparse.ArgumentParser(prog="inverse3", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("name", metavar="NAME", help="of the mailbox")
    parser.add_argument("--url", default=URL, help=f"of the Inverse Service (default: {URL})")
    parser.add_argument("--device", default="", metavar="ID", help="of the Inverse3 (default: the first one)")
    parser.add_argument(
        "--timeout", type=float, default=TIMEOUT, metavar="S", help=f"of the mailbox (default: {TIMEOUT:g})"
    )
    try:
        asyncio.run(_serve_until_stopped(parser.parse_args(arguments)))
    except Error as error:
        print(f"inverse3: error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
