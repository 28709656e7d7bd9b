# SPDX-License-Identifier: BSD-3-Clause
"""A touch that is killed, interrupted or runs out of disk, and what is left of its recording.

The command runs in a process of its own, which notes in a file the rows it begins to compute and those it hands to the
writer. From these notes, not from the recording, follows which rows were due:

- after SIGINT and SIGTERM all that were begun when the signal was sent;
- after SIGKILL, and on a full disk, all handed over but the last block, which was on its way: 500 rows, or 50 ms.
"""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np
from nanotouch import record
from nanotouch.touch.record import Recording

CHILD = """
import os, signal, sys, time

from nanotouch import record, session
from nanotouch_app.main import main

notes = os.open(sys.argv[1], os.O_WRONLY | os.O_CREAT | os.O_APPEND)
begun = handed = 0
advance, append = session.Session.advance, record.Writer.append

def noted_advance(self, duration, *rest):
    global begun
    begun += round(duration * self.rate)
    os.write(notes, f"begun {time.monotonic_ns()} {begun}\\n".encode())
    return advance(self, duration, *rest)

def noted_append(self, columns):
    global handed
    handed += len(columns["time"])
    os.write(notes, f"handed {time.monotonic_ns()} {handed}\\n".encode())
    append(self, columns)

session.Session.advance, record.Writer.append = noted_advance, noted_append
sys.exit(main(sys.argv[2:]))
"""
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGKILL)
STATUS = {signal.SIGINT: 130, signal.SIGTERM: 143, signal.SIGKILL: -signal.SIGKILL}


class Ending(NamedTuple):
    """What a run has left."""

    due: int
    begun: int
    status: int
    said: str
    recording: Recording | None

    @property
    def readable(self) -> int:
        """Rows of the recording."""
        return 0 if self.recording is None else len(self.recording)


def signalled(folder: Path, number: signal.Signals, delay: float, duration: str) -> Ending:
    """Send a signal some time [s] after the first block was begun; after SIGKILL `nanotouch recover` does the rest."""
    process, notes = _start(folder, duration)
    while not notes.exists() or not notes.stat().st_size:
        if process.poll() is not None:
            raise AssertionError(process.communicate()[1])
        time.sleep(0.001)
    time.sleep(delay)
    sent = time.monotonic_ns()
    process.send_signal(number)
    said = process.communicate()[1]
    begun, handed = _noted(notes, sent)
    if number != signal.SIGKILL:
        return Ending(begun, begun, process.returncode, said, _read(folder / "recording.mcap"))
    for part in folder.glob("recording.mcap.*.part"):
        subprocess.run([sys.executable, "-m", "nanotouch_app", "recover", part], check=False, capture_output=True)
    return Ending(_all_but_last(handed), begun, process.returncode, said, _read(folder / "recording.mcap"))


def out_of_space(folder: Path, duration: str, limit: int | None = None) -> Ending:
    """On a disk that is full, or with a limit on the size of files [bytes]."""
    before = None if limit is None else lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    process, notes = _start(folder, duration, before)
    said = process.communicate()[1]
    begun, handed = _noted(notes, time.monotonic_ns())
    return Ending(_all_but_last(handed), begun, process.returncode, said, _read(folder / "recording.mcap"))


def same_rows(one: Recording, other: Recording) -> bool:
    """Whether the shorter is the beginning of the longer, bit by bit."""
    rows = min(len(one), len(other))
    return all(values[:rows].tobytes() == other.columns[name][:rows].tobytes() for name, values in one.columns.items())


def _start(folder: Path, duration: str, before: Callable[[], None] | None = None) -> tuple[subprocess.Popen[str], Path]:
    notes = folder.with_suffix(".notes")
    arguments = ["touch", "--surface", "flat", "--duration", duration, "--no-window", "--out", str(folder)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    process = subprocess.Popen(
        [sys.executable, "-c", CHILD, str(notes), *arguments],
        env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, preexec_fn=before,
    )  # fmt: skip
    return process, notes


def _noted(notes: Path, until: int) -> tuple[int, list[int]]:
    """Rows begun until a time [ns], and the rows handed over, block by block."""
    lines = [line.split() for line in notes.read_text().splitlines()]
    begun = [int(rows) for what, at, rows in lines if what == "begun" and int(at) <= until]
    return max(begun, default=0), [int(rows) for what, _, rows in lines if what == "handed"]


def _all_but_last(handed: list[int]) -> int:
    return handed[-2] if len(handed) > 1 else 0


def _read(path: Path) -> Recording | None:
    if not path.exists():
        return None
    recording = record.read(path)
    np.testing.assert_allclose(np.diff(recording.time), 1e-4, rtol=1e-6)  # no gap
    return recording
