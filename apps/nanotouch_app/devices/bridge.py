# SPDX-License-Identifier: BSD-3-Clause
"""The bridge of a haptic device as a program: its module (nanotouch_app.devices.table) behind a mailbox.

It prints "ready" with the first reading. It ends at SIGTERM, with ``--child`` at the end of its input, too, and leaves
0 N. Where the device is missing it ends with status 2 and one line that says what to do.

Usage: python -m nanotouch_app.devices.bridge DEVICE NAME [--option TEXT] [--timeout S]
then, elsewhere: nanotouch live --hand NAME, or nanotouch.Session(rig=..., master=nanotouch.hal.Mailbox(NAME))
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import math
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from nanotouch.errors import DeviceError, Error, missing
from nanotouch.touch import mailbox
from nanotouch.touch.hal import Capabilities, Reading

from nanotouch_app.devices import calibration
from nanotouch_app.devices.table import DEVICES, Device, named

PATIENCE = 6.0
"""until the first reading [s]"""
TIMEOUT = 0.5
"""of the mailbox: who is silent for so long is lost; a busy machine may stop a program for a tenth of that [s]"""
DONE = b"done"
"""of a bridge that has let go by itself, to its guard"""
PRIORITY = 10
"""of SCHED_FIFO"""
FRESH, GONE = 0.03, 0.08
"""age of a request up to which its force is whole, and from which there is none: a session may hang [s]"""
NOTHING = (0.0, 0.0, 0.0)
"""no force [N]"""


def module_of(device: Device) -> Any:
    """Its module, once the package that it needs is there."""
    if (
        importlib.util.find_spec(device.module) is None
    ):  # imported it may fail for the maker's library, which is another matter
        raise missing(device.module, device.extra)
    return importlib.import_module(f"{__package__}.{device.name}")


class Box:
    """The mailbox as a device sees it. A force is finite and within the range of its channels, else there is none."""

    def __init__(
        self, device: mailbox.Device, capabilities: Capabilities, found: calibration.Calibration | None = None
    ) -> None:
        self._device = device
        self._found = calibration.Calibration() if found is None else found
        self._limits = {row.axis: row.maximum for row in capabilities.channels if row.driven}
        self.trouble = ""
        """why there is no reading, in words"""
        self.first = threading.Event()
        """a reading has come"""

    def publish(self, reading: Reading) -> None:
        """A new measurement."""
        self._device.publish(reading._replace(position=self._found.place(reading.position)))
        self.first.set()

    def beat(self) -> None:
        """A sign of life."""
        self._device.beat()

    def ask(self) -> mailbox.Request:
        """What the session wants."""
        request = self._device.ask()
        share = (GONE - 1e-9 * (self._device.now() - request.time)) / (GONE - FRESH)
        if not request.is_armed or share <= 0.0 or not all(map(math.isfinite, request.target)):
            return request._replace(target=NOTHING)
        force = self._bounded(self._found.force(request.target))
        x, y, z = (min(share, 1.0) * f for f in force)
        return request._replace(target=(x, y, z))

    def _bounded(self, force: Sequence[float]) -> tuple[float, float, float]:
        x, y, z = (
            max(-limit, min(limit, f)) for f, limit in ((f, self._limits.get(i, 0.0)) for i, f in enumerate(force))
        )
        return x, y, z


def serve(device: Device, args: argparse.Namespace, stopped: threading.Event) -> None:
    """Until it is stopped; :class:`~nanotouch.errors.Error` in words where no reading comes."""
    module = module_of(device)
    found = calibration.read(args.calibration) if args.calibration else None
    capabilities = module.capabilities()
    with mailbox.Device(args.name, capabilities, timeout=args.timeout) as opened:
        box = Box(opened, capabilities, found)
        late: list[str] = []
        guards: list[subprocess.Popen[bytes]] = []

        def announce() -> None:
            if box.first.wait(PATIENCE):
                guards.append(_guard(args))  # which says that we are ready
            elif not stopped.is_set():
                late.append(box.trouble or "no reading has come")
                stopped.set()

        threading.Thread(target=announce, daemon=True).start()
        try:
            module.serve(box, args.option, stopped)
        except DeviceError as error:
            late.append(str(error))
        for guard in guards:
            guard.communicate(DONE)
        if late:
            raise DeviceError(f"{device.title}: {late[0]}. {device.needs}")


def _guard(args: argparse.Namespace) -> subprocess.Popen[bytes]:
    """A second process, which lets go of the device if this one is killed: the pipe between them ends then."""
    option = ["--option", args.option] if args.option else []
    command = [sys.executable, "-P", "-m", __spec__.name, args.device, args.name, *option, "--guard"]
    return subprocess.Popen(command, stdin=subprocess.PIPE, start_new_session=True)


def watch(device: Device, option: str) -> None:
    """The guard: wait for the end of the bridge. It loads before anybody relies on the bridge, and behind other
    programs: before them it would keep the maker's service from answering, and readings would grow old."""
    module_of(device)  # now, not when it is needed
    _run_first()
    print("ready", flush=True)
    said = b""
    while more := os.read(0, 4096):
        said += more
    if said != DONE:
        release(device, option)


def release(device: Device, option: str) -> None:
    """Open the device, let go of it, and close it: what a bridge that was killed has left is no force any more."""
    done = threading.Event()

    class Empty:
        """A mailbox behind which nobody drives."""

        trouble = ""

        def publish(self, _: Reading) -> None:
            self.beat()

        def beat(self) -> None:
            threading.Timer(0.05, done.set).start()

        def ask(self) -> mailbox.Request:
            return mailbox.Request(False, "HOLD", 0, 0, NOTHING, 0.0, 0.0, 0.0)

    threading.Timer(2.0, done.set).start()
    module_of(device).serve(Empty(), option, done)


def _listen(stopped: threading.Event) -> None:
    """Whoever has started it goes: so does it."""

    def wait() -> None:
        while os.read(0, 4096):  # a buffered reader would hold a lock while Python ends
            pass
        stopped.set()

    threading.Thread(target=wait, daemon=True).start()


def _run_as_others() -> None:
    """As a program that nobody waits for."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def _run_first() -> None:
    """Before other programs, where the system grants it: a reading that is late holds the session."""
    with suppress(OSError, AttributeError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="bridge", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("device", metavar="DEVICE", help=", ".join(DEVICES))
    parser.add_argument("name", metavar="NAME", help="of the mailbox")
    parser.add_argument("--option", default="", help="for the device: the address of its service, its number, ...")
    parser.add_argument(
        "--timeout", type=float, default=TIMEOUT, metavar="S", help="of the mailbox (default: %(default)g)"
    )
    parser.add_argument("--calibration", type=Path, metavar="FILE", help="as nanotouch live --calibrate has kept it")
    parser.add_argument("--child", action="store_true", help="end with the input")
    parser.add_argument("--guard", action="store_true", help="let go of the device when the input ends early")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program."""
    args = _parser().parse_args(arguments)
    stopped = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopped.set())
    if args.guard:
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, signal.SIG_IGN)
    elif args.child:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the session, which ends first
        _listen(stopped)
    try:
        device = named(args.device)
        if args.guard:
            watch(device, args.option)
        else:
            serve(device, args, stopped)
    except Error as error:
        print(error, file=sys.stderr, flush=True)
        return 2
    return 0


if __name__ == "__main__":
    _run_as_others() if "--guard" in sys.argv else _run_first()
    sys.exit(main())
