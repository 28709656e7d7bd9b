# SPDX-License-Identifier: BSD-3-Clause
"""Record a session of an hour into a file, as fast as it goes: memory must not grow. ``make heavy``"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import time
from pathlib import Path

import nanotouch as nt
from nanotouch.touch.operator import Input

MOST = 4.0  # that the peak may grow by from a tenth of the recording to its end [MB]
SHARES = (0.1, 0.5, 1.0)


def peak() -> float:
    """The most memory that this process has had so far [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


def record(file: Path, seconds: float) -> list[float]:
    """Record a touch in contact; the peak at each of SHARES [MB]."""
    session = nt.Session(seed=1)
    session.aim(Input(0.5, *session.path[0], 1.0))
    session.start("free", duration=seconds)
    peaks: list[float] = []
    with nt.record.Writer(file, session.metadata()) as writer:
        while len(peaks) < len(SHARES):
            block = session.read()
            if block["time"].size:
                writer.append(block)
            else:
                time.sleep(1e-3)
            if writer.rows >= SHARES[len(peaks)] * seconds * session.rate:
                peaks.append(peak())
                print(f"{writer.rows:10} rows: at most {peaks[-1]:.1f} MB", flush=True)
    session.halt()
    return peaks


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=3600.0, help="of session time at 10 kHz")
    seconds = parser.parse_args().seconds
    with tempfile.TemporaryDirectory() as folder:
        file, start = Path(folder) / "recording.mcap", time.monotonic()
        peaks = record(file, seconds)
        rows = seconds * 1e4
        print(f"{time.monotonic() - start:.0f} s, {file.stat().st_size / rows:.1f} bytes of file and ", end="")
        print(f"{(peaks[-1] - peaks[0]) * 2**20 / (0.9 * rows):.3f} bytes of memory for each row")
    return int(peaks[-1] - peaks[0] > MOST)


if __name__ == "__main__":
    sys.exit(main())
