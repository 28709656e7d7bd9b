# SPDX-License-Identifier: BSD-3-Clause
"""A process beside the bridge (nanotouch_app.devices.nanonis). It withdraws the tip when the bridge is killed or hangs.

The bridge tells it where it stands, one line at a time: "held HIGH LOW" while the tip may touch, else "free".
The bridge is lost when the pipe ends, or when no line comes for SILENCE deadlines of a reply while the tip is held.

Usage, by the bridge: python -m nanotouch_app.devices.nanonis_watcher HOST PATIENCE PORT [PORT ...]
"""

from __future__ import annotations

import os
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Self

from nanotouch_app.devices.nanonis_link import Address, Link, LinkError

PAUSE = 0.5
"""before a withdrawal is tried again [s]"""
SILENCE = 12
"""of a bridge that is lost [deadlines of a reply]; a round asks at most ten times"""
LONGEST = 60.0
"""that a watcher tries to withdraw; after that, somebody else may have the controller [s]"""


@dataclass(frozen=True)
class Limits:
    """Of z, as the user has set them."""

    high: float
    """[m]"""
    low: float
    """[m]"""


def withdraw(link: Link) -> None:
    """Servo off, tip up to the upper limit. LinkError if that is not acknowledged."""
    link.call("ZCtrl.Withdraw", "Ii", 0, -1)


def give_back(link: Link, limits: Limits) -> None:
    """The user's limits, after a withdrawal. Where somebody has switched them off, the controller takes none."""
    link.call("ZCtrl.LimitsSet", "ff", limits.high, limits.low)


class Watcher:
    """The process, from the side of the bridge. It outlives the bridge by what it has to do."""

    def __init__(self, host: str, ports: Sequence[int], patience: float, module: str = __name__) -> None:
        command = [sys.executable, "-P", "-m", module, host, str(patience), *map(str, ports)]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._pipe = self._process.stdin
        if not any(line.strip() == b"ready" for line in self._process.stdout):  # others may print before it
            self.close()
            raise LinkError("the watcher did not start")
        with suppress(OSError, AttributeError):  # a pipe of Windows, before Python 3.12
            os.set_blocking(self._pipe.fileno(), False)

    @property
    def pid(self) -> int:
        return self._process.pid

    def tell(self, held: Limits | None) -> None:
        """Limits to give back while the tip may touch, else None. LinkError if nobody listens."""
        line = f"held {held.high!r} {held.low!r}\n" if held else "free\n"
        try:
            os.write(self._pipe.fileno(), line.encode())
        except OSError as error:
            raise LinkError(f"the watcher is gone or hangs: {error}") from error

    def close(self) -> None:
        """Let it end; it does not if the last that it was told is that the tip may touch."""
        with suppress(OSError):
            self._pipe.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(PAUSE)


# --- the process itself ---


def _said(text: str) -> None:
    with suppress(OSError):  # the terminal may have gone with the bridge
        print(f"watcher: {text}", file=sys.stderr, flush=True)


def rescue(host: str, ports: Sequence[int], patience: float, limits: Limits) -> bool:
    """Withdraw by new connections, on each port in turn, for LONGEST at the most. Whether it was acknowledged."""
    due = time.monotonic() + LONGEST
    while time.monotonic() < due:
        for port in ports:
            with suppress(LinkError), Link(Address(host, port), patience) as link:
                withdraw(link)
                with suppress(LinkError):
                    give_back(link, limits)
                return True
        time.sleep(PAUSE)
    return False


def _limits(line: str) -> Limits | None:
    match line.split():
        case ["held", high, low]:
            return Limits(float(high), float(low))
    return None


def _lines() -> queue.SimpleQueue[str | None]:
    """Of standard input; None at its end."""
    found: queue.SimpleQueue[str | None] = queue.SimpleQueue()

    def read() -> None:
        for line in sys.stdin:
            found.put(line)
        found.put(None)

    threading.Thread(target=read, daemon=True).start()
    return found


def watch(
    host: str,
    ports: Sequence[int],
    patience: float,
    rescues: Callable[[str, Sequence[int], float, Limits], bool] = rescue,
) -> None:
    """Until the bridge ends."""
    lines = _lines()
    line: str | None = ""
    while line is not None:
        held = _limits(line)
        try:
            line = lines.get(timeout=SILENCE * patience if held else None)
        except queue.Empty:
            line = ""  # it hangs; if it comes back, it says where it stands
        if held and not line:
            _said(f"the bridge {'is gone' if line is None else 'hangs'}: withdrawing")
            is_done = rescues(host, ports, patience, held)
            _said("withdrawn" if is_done else "no controller has acknowledged a withdrawal: the tip may still touch")


def main(arguments: Sequence[str], rescues: Callable[[str, Sequence[int], float, Limits], bool] = rescue) -> int:
    """Run the process. Ctrl-C and a request to end are for the bridge, whose end it waits for."""
    host, patience, *ports = arguments
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    print("ready", flush=True)
    watch(host, [int(port) for port in ports], float(patience), rescues)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
