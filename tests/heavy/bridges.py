# SPDX-License-Identifier: BSD-3-Clause
"""Each haptic device's bridge against its mock, under a load of four busy processes: how long from the command to the
first force on the hand, how much of the time the session is in RUN, how long a force outlives its bridge.

Usage: bridges.py [--load N] [--seconds S]    status 1 where a figure misses its goal
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import ExitStack
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / "python"))

import numpy as np
import pytest
from desks import KINDS, Kind, OnDesk, placed
from nanotouch_app.devices import launch, table
from nanotouch_app.live import device as live
from nanotouch_app.live.subject import of_preset

FIRST, RUNS, LEFT = 60.0, 0.99, 1.0  # goals: first force [s], share of RUN, force after a kill [s]
SINE, DEPTH = 0.5, 1.5e-3  # of the hand, once it has felt something [Hz], [m]


class Person(threading.Thread):
    """Goes down by 1 cm/s until something is felt, then up and down about there."""

    def __init__(self, device: OnDesk) -> None:
        super().__init__(daemon=True)
        self.device, self.felt, self.ends = device, threading.Event(), threading.Event()

    def run(self) -> None:
        begun, place = time.monotonic(), 0.0
        while not self.ends.wait(0.004):
            now = time.monotonic()
            if not self.felt.is_set():
                place = 0.01 * (now - begun)
                if self.device.pressed() < -0.3:
                    self.felt.set()
                    begun = now
                self.device.hold("down", place)
            else:
                self.device.hold("down", place + DEPTH * np.sin(2.0 * np.pi * SINE * (now - begun)))


def tried(kind: Kind, seconds: float) -> tuple[float, float, float]:
    """First force [s], share of RUN, time that a force outlives its bridge [s]."""
    begun, patch = time.monotonic(), pytest.MonkeyPatch()
    with ExitStack() as stack:
        stack.callback(patch.undo)
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        device = stack.enter_context(placed(kind, folder, patch))
        row = table.named(kind.name)
        bridge = stack.enter_context(launch.Launched(row, device.option))
        session = live.opened(of_preset("silicon_in_air"), row, bridge.name, recorded=True)
        stack.callback(session.halt)
        with launch.first():
            session.start("wall")
        person = Person(device)
        stack.callback(person.ends.set)
        person.start()
        states: list[np.ndarray] = []
        while not person.felt.is_set() and time.monotonic() < begun + FIRST:
            states.append(session.read(5000)["state"])
            time.sleep(0.005)
        first, end = time.monotonic() - begun, time.monotonic() + seconds
        while time.monotonic() < end:
            states.append(session.read(5000)["state"])
            time.sleep(0.005)
        os.kill(bridge.process.pid, signal.SIGKILL)
        killed = time.monotonic()
        while device.size > 0.0 and time.monotonic() < killed + 10.0:
            time.sleep(1e-3)
        left = time.monotonic() - killed
    return first, float(np.mean(np.concatenate(states) == 0)), left


def main() -> int:
    """Each device in turn."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--load", type=int, default=4)
    parser.add_argument("--seconds", type=float, default=10.0)
    args = parser.parse_args()
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(args.load)]
    missed = False
    try:
        for kind in KINDS:
            first, share, left = tried(kind, args.seconds)
            is_met = first < FIRST and share >= RUNS and left < LEFT
            missed = missed or not is_met
            print(f"{kind.name:15} first force {first:5.1f} s  RUN {100.0 * share:6.2f} %  "
                  f"force after a kill {left:5.2f} s  {'ok' if is_met else 'MISSED'}", flush=True)  # fmt: skip
    finally:
        for process in busy:
            process.kill()
            process.wait()
    return int(missed)


if __name__ == "__main__":
    sys.exit(main())
