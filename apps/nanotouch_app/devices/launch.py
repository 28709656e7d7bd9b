# SPDX-License-Identifier: BSD-3-Clause
"""Starts the bridge of a haptic device and ends it. The bridge's guard lets go of the device where it was killed."""

from __future__ import annotations

import itertools
import os
import queue
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Self

from nanotouch.errors import DeviceError
from nanotouch.touch.scratch import Scratch

from nanotouch_app.devices import calibration
from nanotouch_app.devices.bridge import PRIORITY, TIMEOUT
from nanotouch_app.devices.table import Device, named

START = 30.0  # of a bridge on a busy machine; without a device it ends by itself, before that [s]
ENDS, RELEASES = 3.0, 8.0  # a bridge that is asked to, within this [s]
_numbers = itertools.count(1)


class Launched:
    """A bridge that is ready; use it in a ``with`` statement."""

    def __init__(self, device: Device, option: str = "", timeout: float = TIMEOUT, found: Path | None = None) -> None:
        self.device, self.option = device, option
        self.name = f"{device.name}-{os.getpid()}-{next(_numbers)}"
        """of its mailbox"""
        self._folder = Scratch()
        self._said = self._folder.path / "said.txt"
        more = [] if found is None else ["--calibration", str(found)]
        command = self._command("--child", "--timeout", str(timeout), *more)
        with open(self._said, "wb") as errors:
            self.process = subprocess.Popen(
                command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, env=_environment(), text=True,
            )  # fmt: skip
        try:
            self._wait_ready()
        except BaseException:
            self.close()
            raise

    def _command(self, *more: str) -> list[str]:
        option = ["--option", self.option] if self.option else []
        return [sys.executable, "-P", "-m", "nanotouch_app.devices.bridge", self.device.name, self.name, *option, *more]

    def _wait_ready(self) -> None:
        lines: queue.SimpleQueue[str] = queue.SimpleQueue()

        def read() -> None:
            assert self.process.stdout is not None
            for line in self.process.stdout:  # a library of the maker may print before it
                lines.put(line.strip())
            lines.put("")

        self._reader = threading.Thread(target=read, daemon=True)
        self._reader.start()
        with suppress(queue.Empty):
            while line := lines.get(timeout=START):
                if line == "ready":
                    return
        raise DeviceError(self._last_words() or f"the {self.device.title} gives no reading. {self.device.needs}")

    def _last_words(self) -> str:
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(ENDS)
        lines = self._said.read_text(errors="replace").strip().splitlines()
        return lines[-1] if lines else ""

    @property
    def ended(self) -> str:
        """How it has ended, "" while it runs."""
        status = self.process.poll()
        if status is None:
            return ""
        how = f"died of {signal.Signals(-status).name}" if status < 0 else f"ended with status {status}"
        return f"the bridge of the {self.device.title} {how}" + "".join(
            f" ({line})" for line in [self._last_words()] if line
        )

    def close(self) -> None:
        """End it in order, or by force where it hangs; then wait until the device is let go of."""
        assert self.process.stdin is not None
        with suppress(OSError):
            self.process.stdin.close()
        try:
            self.process.wait(ENDS)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._reader.join(RELEASES)  # its guard has the same output
        if self.process.stdout is not None:
            self.process.stdout.close()
        self._folder.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


@contextmanager
def first() -> Iterator[None]:
    """A session that starts in here runs before other programs, as its bridge does, where the system grants it: what
    keeps it waiting keeps the hand's force waiting."""
    if not hasattr(os, "sched_setscheduler"):
        yield
        return
    before = os.sched_getscheduler(0), os.sched_getparam(0)
    with suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    try:
        yield
    finally:
        os.sched_setscheduler(0, *before)


def of_hand(hand: str) -> Launched:
    """The bridge of ``DEVICE`` or ``DEVICE:OPTION``, with its calibration where there is one."""
    name, _, option = hand.partition(":")
    device = named(name)
    path = calibration.path_of(device.name)
    return Launched(device, option, found=path if path.is_file() else None)


def _environment() -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
