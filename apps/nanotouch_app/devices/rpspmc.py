# SPDX-License-Identifier: BSD-3-Clause
"""RPSPMC, Gxsm's controller on a Red Pitaya, as a slave that owns its z servo: JSON over a WebSocket, and a mailbox to
the session. As with Nanonis two set points are set, and the controller's own loop stays as it is:

    SPMC_Z_SERVO_UPPER      the session's travel: the servo moves the tip no farther down (its volts are + down)
    SPMC_Z_SERVO_SETPOINT   the guard: there the servo backs away by itself

A withdrawal sets the upper limit to the lower one, where the tip is up whatever the servo wants, and leaves it there:
set it back in Gxsm. A second process does the same when this one is killed or hangs.

Usage: python -m nanotouch_app.devices.rpspmc NAME --guard-nm NM --z-nm-per-V NM --signal-nm-per-V NM [--host HOST]
then, elsewhere: nanotouch.Session(rig=..., slave=nanotouch.hal.Mailbox(NAME))
"""

from __future__ import annotations

import argparse
import asyncio
import gzip
import json
import math
import signal
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from nanotouch.errors import DeviceError, Error, InvalidValue, require
from nanotouch.touch import mailbox
from nanotouch.touch.hal import Capabilities, Channel, Reading

from nanotouch_app.devices import nanonis_watcher
from nanotouch_app.devices.nanonis_watcher import Limits, Watcher

PROGRAM = "nanotouch_app.devices.rpspmc"
PORT = 9002
PERIOD = 0.05
"""between two messages of the controller, as it is asked for [s]"""
LARGEST = 1 << 20
"""of a message, packed or not [byte]"""
UPPER, LOWER, GUARD, MODE = (f"SPMC_Z_SERVO_{name}" for name in ("UPPER", "LOWER", "SETPOINT", "MODE"))
Z, SIGNAL = "SPMC_Z_MONITOR", "SPMC_SIGNAL_MONITOR"
NEEDED = (UPPER, LOWER, GUARD, MODE, Z, SIGNAL)
ON = 0x0001
"""the servo's bit of its mode"""
SAME = 1e-4
"""what a value may differ that was set and comes back: the controller keeps 32 bits [V]"""


@dataclass(frozen=True)
class Setup:
    """What the user says."""

    guard: float
    """deflection at which the servo backs away [m]"""
    z_scale: float
    """of z [m/V]"""
    signal_scale: float
    """deflection, + upwards, per volt of the servo's signal [m/V]"""
    host: str = "127.0.0.1"
    port: int = PORT
    patience: float = 0.3
    """with a value that was set to come back [s]"""


def understood(data: str | bytes) -> dict[str, float]:
    """The finite numbers of a message's parameters; empty for what is none."""
    try:
        text = gzip.decompress(data) if isinstance(data, bytes) else data
        given = json.loads(text)["parameters"]
        values = {name: one["value"] for name, one in given.items() if isinstance(one, dict) and "value" in one}
    except (OSError, EOFError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}
    return {name: float(v) for name, v in values.items()
            if isinstance(v, int | float) and not isinstance(v, bool) and abs(v) < 1e12}  # fmt: skip


class Link:
    """A connection: the last reply of the controller, and the commands to it."""

    def __init__(self, setup: Setup) -> None:
        self.setup, self.values, self.messages = setup, dict[str, float](), 0
        self._changed = asyncio.Event()

    async def __aenter__(self) -> Link:
        aiohttp = require("aiohttp", "browser")
        setup = self.setup
        self._client = aiohttp.ClientSession(timeout=aiohttp.ClientTimeout(total=None, sock_connect=setup.patience))
        try:
            self._socket = await self._client.ws_connect(f"ws://{setup.host}:{setup.port}", max_msg_size=LARGEST)
        except (OSError, aiohttp.ClientError, TimeoutError) as error:
            await self._client.close()
            raise DeviceError(
                f"no RPSPMC at ws://{setup.host}:{setup.port}: {error}; start its app on the Red Pitaya"
            ) from error
        self._reader = asyncio.create_task(self._read())
        return self

    async def __aexit__(self, *_: object) -> None:
        self._reader.cancel()
        with suppress(Exception):
            await self._socket.close()
        await self._client.close()

    async def _read(self) -> None:
        types = require("aiohttp", "browser").WSMsgType
        async for message in self._socket:
            found = understood(message.data) if message.type in (types.TEXT, types.BINARY) else {}
            if found:
                self.values |= found
                self.messages += 1
                self._changed.set()

    async def news(self, patience: float) -> None:
        """The next message; :class:`DeviceError` where none comes."""
        self._changed.clear()
        try:
            async with asyncio.timeout(patience):
                await self._changed.wait()
        except TimeoutError:
            raise DeviceError(f"RPSPMC is silent for {patience:g} s") from None

    async def set(self, **values: float) -> None:
        """Set parameters, and wait until they come back; :class:`DeviceError` where they do not."""
        told = {"parameters": {name: {"value": value} for name, value in values.items()}}
        due = time.monotonic() + self.setup.patience
        try:
            await self._socket.send_str(json.dumps(told))
            while not self.has(values):
                await self.news(max(1e-3, due - time.monotonic()))
        except (OSError, RuntimeError, DeviceError) as error:
            raise DeviceError(f"RPSPMC does not keep {', '.join(values)}: {error}") from error

    def has(self, values: dict[str, float]) -> bool:
        """Whether the controller has these."""
        return all(abs(self.values.get(name, math.inf) - value) < SAME for name, value in values.items())


async def withdraw(link: Link) -> None:
    """The upper limit to the lower one: the servo cannot hold the tip down."""
    if LOWER not in link.values:
        await link.news(link.setup.patience)
    await link.set(**{UPPER: link.values[LOWER]})


@dataclass
class Bridge:
    """Between the controller and a mailbox."""

    setup: Setup
    link: Link
    watcher: Watcher | None = None
    is_ours: bool = False
    """the tip may touch"""
    stopped: bool = False

    async def find(self) -> None:
        """What the user has set: limits, guard."""
        await self.link.set(PARAMETER_PERIOD=1e3 * PERIOD)
        due = time.monotonic() + 10.0 * self.setup.patience
        while missing := [name for name in NEEDED if name not in self.link.values]:
            if time.monotonic() > due:
                raise DeviceError(f"RPSPMC does not say {', '.join(missing)}")
            await self.link.news(self.setup.patience)
        values = self.link.values
        if not -10.0 <= values[LOWER] < values[UPPER] <= 10.0:
            low, high = values[LOWER], values[UPPER]
            raise InvalidValue(f"the z servo's limits are {low:g} .. {high:g} V: set them in Gxsm, the lower one first")
        self.limits = Limits(values[UPPER], values[LOWER])
        self.guard = self.setup.guard / abs(self.setup.signal_scale)

    def capabilities(self) -> Capabilities:
        """A slave of one axis with a servo of its own."""
        width = (self.limits.high - self.limits.low) * self.setup.z_scale
        z = [Channel("stage z", "m", minimum=-width, maximum=width),
             Channel("travel", "m", driven=True, minimum=-width, maximum=width),
             Channel("deflection", "m")]  # fmt: skip
        return Capabilities(axes=1, period=PERIOD, feels=True, servos=True, channels=z)

    async def serve(self, box: mailbox.Device) -> None:
        """A round for each message, until it is stopped; then the tip is withdrawn."""
        while not self.stopped:
            self._tell()
            await self.link.news(self.setup.patience)
            box.publish(self._reading(box))
            await self._steer(box.ask())
        await self.release()

    async def release(self) -> None:
        """Withdraw, if the tip may touch."""
        if self.is_ours:
            await withdraw(self.link)
            self.is_ours = False
            self._tell()

    def _tell(self) -> None:
        if self.watcher is not None:
            self.watcher.tell(self.limits if self.is_ours else None)

    async def _steer(self, request: mailbox.Request) -> None:
        if request.is_armed and not self.is_ours:
            await self._take()
        elif not request.is_armed:
            await self.release()
            return
        if self.is_ours and math.isfinite(request.target[2]):
            wanted = self.start + request.target[2] / self.setup.z_scale
            await self.link.set(**{UPPER: min(max(wanted, self.limits.low), self.limits.high)})
        if self.is_ours and not self.link.has({GUARD: self.guard, LOWER: self.limits.low}):
            raise DeviceError("somebody else has changed the guard or the limits of the z servo")

    async def _take(self) -> None:
        """The limit is where the tip stands before the servo goes on."""
        self.start = min(max(self.link.values[Z], self.limits.low), self.limits.high)
        self.is_ours = True  # from here on a failure withdraws
        self._tell()
        await self.link.set(**{UPPER: self.start, GUARD: self.guard})
        await self.link.set(**{MODE: float(int(self.link.values[MODE]) | ON)})

    def _reading(self, box: mailbox.Device) -> Reading:
        """As old as a message may be. A servo that somebody else has switched off is an emergency stop."""
        values = self.link.values
        is_off = self.is_ours and not int(values[MODE]) & ON
        start = self.start if self.is_ours else values[Z]
        travel = (values[Z] - start) * self.setup.z_scale
        felt = values[SIGNAL] * self.setup.signal_scale
        return Reading(position=(math.nan, math.nan, travel), felt=(math.nan, math.nan, felt),
                       time=box.now() - round(1e9 * PERIOD), flags=["emergency_stop"] * is_off)  # fmt: skip


async def run(name: str, setup: Setup, timeout: float) -> None:
    """Serve the mailbox. If the controller fails the mailbox closes, which latches the session; then the tip lifts."""
    async with Link(setup) as link:
        bridge = Bridge(setup, link)
        await bridge.find()
        for number in (signal.SIGINT, signal.SIGTERM):
            asyncio.get_running_loop().add_signal_handler(number, setattr, bridge, "stopped", True)
        with Watcher(setup.host, [setup.port], setup.patience, PROGRAM) as bridge.watcher:
            try:
                with mailbox.Device(name, bridge.capabilities(), half="slave", timeout=timeout) as box:
                    await bridge.serve(box)
            finally:
                with suppress(DeviceError):
                    await bridge.release()
                if bridge.is_ours:
                    print("rpspmc: no withdrawal was acknowledged: the watcher goes on", file=sys.stderr, flush=True)


def rescue(host: str, ports: Sequence[int], patience: float, limits: Limits) -> bool:
    """The watcher's withdrawal over a new connection, for at most LONGEST. Returns whether it was acknowledged."""
    due = time.monotonic() + nanonis_watcher.LONGEST

    async def once() -> None:
        async with Link(Setup(1.0, 1.0, 1.0, host, ports[0], patience)) as link:
            await link.set(**{UPPER: limits.low})

    while time.monotonic() < due:
        with suppress(DeviceError):
            asyncio.run(once())
            return True
        time.sleep(nanonis_watcher.PAUSE)
    return False


def _setup(arguments: Sequence[str] | None) -> tuple[argparse.Namespace, Setup]:
    parser = argparse.ArgumentParser(prog="rpspmc", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("name", metavar="NAME", help="of the mailbox")
    parser.add_argument(
        "--guard-nm", type=float, required=True, metavar="NM", help="deflection at which the servo backs away"
    )
    parser.add_argument("--z-nm-per-V", dest="z", type=float, required=True, metavar="NM", help="of the z scanner")
    parser.add_argument("--signal-nm-per-V", dest="signal", type=float, required=True, metavar="NM",
                        help="deflection, + upwards, per volt of the servo's signal")  # fmt: skip
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=PORT)
    parser.add_argument("--timeout", type=float, default=0.5, metavar="S", help="of the mailbox (default: %(default)g)")
    args = parser.parse_args(arguments)
    ranges = {"guard-nm": (args.guard_nm, 1e-3, 1e5), "z-nm-per-V": (args.z, 1e-3, 1e6),
              "signal-nm-per-V": (abs(args.signal), 1e-3, 1e6), "timeout": (args.timeout, 0.2, 1.0)}  # fmt: skip
    for key, (value, least, most) in ranges.items():
        if not least <= value <= most:
            raise InvalidValue(f"{key} = {value:g}: valid is {least:g} .. {most:g}")
    return args, Setup(1e-9 * args.guard_nm, 1e-9 * args.z, 1e-9 * args.signal, args.host, args.port)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program; 2 with one line if it cannot begin, or the controller failed."""
    try:
        args, setup = _setup(arguments)
        asyncio.run(run(args.name, setup, args.timeout))
    except Error as error:
        print(f"rpspmc: error: {error}", file=sys.stderr)
        return 2
    return 0


def _is_watcher(arguments: Sequence[str]) -> bool:
    """HOST PATIENCE PORT, as a watcher is started."""
    return len(arguments) == 3 and not any(word.startswith("-") for word in arguments)


if __name__ == "__main__":
    given: Any = sys.argv[1:]
    sys.exit(nanonis_watcher.main(given, rescue) if _is_watcher(given) else main(given))
