# SPDX-License-Identifier: BSD-3-Clause
"""A JPK map of two gigabytes through the guard: every curve is read, in a memory that does not grow with the file.

``python tests/heavy/large_map.py [GB]`` writes the map into a temporary folder, reads it in a guarded process, and
prints size, curves, time and the peak memory of that process.
"""

from __future__ import annotations

import os
import resource
import sys
import tempfile
import time
import zipfile
from pathlib import Path

import numpy as np
from nanotouch import curves
from nanotouch.curves.reading import GuardedStream

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
import synthetic
from test_curves_jpk import KNOWN, as_map

MORE = 16  # points for each of the known curve's


def _longer(values: np.ndarray) -> np.ndarray:
    return np.interp(np.linspace(0.0, values.size - 1.0, MORE * values.size), np.arange(values.size), values)


def _write(path: Path, size: float) -> int:
    """As many curves as fill so many bytes."""
    single = path.with_suffix(".jpk-force")
    segments = [("extend", _longer(KNOWN.approach_z), _longer(KNOWN.approach_force)),
                ("retract", _longer(KNOWN.retract_z), _longer(KNOWN.retract_force))]  # fmt: skip
    synthetic.write_jpk(single, segments, spring_constant=0.8, sensitivity=6e-8)
    count = 4 * int(size / (4 * single.stat().st_size))
    as_map(path, count, single)
    with zipfile.ZipFile(path) as archive:
        assert archive.testzip() is None
    return count


def _child_of(server: int) -> tuple[float, float]:
    """Processor time [s] and peak memory [MB] of the process that reads."""
    child = Path(f"/proc/{server}/task/{server}/children").read_text(encoding="ascii").split()[0]
    fields = Path(f"/proc/{child}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    lines = Path(f"/proc/{child}/status").read_text(encoding="ascii").splitlines()
    peak = next(line for line in lines if line.startswith("VmHWM"))
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), float(peak.split()[1]) / 1e3


def main() -> None:
    size = float(sys.argv[1]) if len(sys.argv) > 1 else 2.0
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.jpk-force-map"
        count = _write(path, size * 1e9)
        start = time.process_time()
        found = curves.stream(path, untrusted=True)
        assert isinstance(found, GuardedStream)
        assert len(found) == count, (len(found), count)
        points = 0
        for number in range(count):
            points += sum(len(segment) for segment in found[number].segments)
        used, peak = _child_of(found._there._process.pid)
        own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
        print(f"{path.stat().st_size / 1e9:.2f} GB, {count} curves, {points} points; processor time "
              f"{time.process_time() - start:.0f} s here and {used:.0f} s in the guarded process; "
              f"peak memory {own:.0f} MB here and {peak:.0f} MB there")  # fmt: skip


if __name__ == "__main__":
    main()
