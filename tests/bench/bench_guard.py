# SPDX-License-Identifier: BSD-3-Clause
"""What the guard costs: the same batch of files read in this process and in confined ones, turn by turn.

python tests/bench/bench_guard.py [files] [turns]: wall and processor time of a fresh Python that has imported readers
and its children; the median of the differences.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from nanotouch import images

KINDS = {"image .gsf": "gsf", "recording": "mcap"}
CODE = """
import json, os, sys, time
from nanotouch import images, record
from nanotouch._io import series, worker
kind, guarded, files = sys.argv[1], sys.argv[2] == "guarded", sys.argv[3:]
read = images.read if kind == "gsf" else record.read
import mcap.stream_reader, zstandard
start, used = time.perf_counter(), sum(os.times()[:4])
with series.of(files):
    for file in files:
        read(file, untrusted=guarded)
worker._stop_at_exit()
print(json.dumps([time.perf_counter() - start, sum(os.times()[:4]) - used]))
"""


def _files(folder: Path, kind: str, count: int) -> list[str]:
    from nanotouch import record

    files = []
    for number in range(count):
        file = folder / f"{number}.{kind}"
        if kind == "gsf":
            heights = np.random.default_rng(number).normal(0.0, 1e-9, (256, 256))
            images.write(file, images.Topography(heights, (1e-8, 1e-8)))
        else:
            rows = {"time": np.arange(3000.0), "gap": np.random.default_rng(number).normal(0.0, 1e-9, 3000)}
            record.write(file, record.Recording(rows, {"alpha_f": 2.0}))
        files.append(str(file))
    return files


def main() -> None:
    count, turns = (int(text) for text in (*sys.argv[1:], "20", "7")[:2])
    for kind, ending in KINDS.items():
        with tempfile.TemporaryDirectory() as folder:
            files = _files(Path(folder), ending, count)
            found: dict[str, list[list[float]]] = {"plain": [], "guarded": []}
            for _ in range(turns):
                for how, times in found.items():
                    line = [sys.executable, "-c", CODE, ending, how, *files]
                    times.append(json.loads(subprocess.run(line, capture_output=True, text=True, check=True).stdout))
        for number, what in enumerate(("wall", "processor")):
            plain, guarded = (statistics.median(one[number] for one in found[how]) for how in ("plain", "guarded"))
            each = 1e3 * (guarded - plain)
            print(f"{kind}: {count} files, {what} {1e3 * plain:.0f} ms, with the guard {1e3 * guarded:.0f} ms: "
                  f"{each:.0f} ms more, {each / count:.1f} ms a file")  # fmt: skip


if __name__ == "__main__":
    main()
