# SPDX-License-Identifier: BSD-3-Clause
"""Curves per second of a map, and how time and memory grow with it: ``python tests/bench/bench_maps.py [FILE ...]``.

With ``--stored N [N ...]`` instead: so many curves from a file that is mapped into memory, in single precision.

A synthetic map of 128 x 128 curves of 2 000 points (1 000 in, 1 000 out), all steps included: hash of the input,
baselines, fits, Dataset. Rows of the table are maps of a part of it. For each FILE: reading against fitting.
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import threading
import time
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import curves, fit, maps

SIDES = (4, 8, 16, 32, 64, 128)
RADIUS, STIFFNESS, NOISE = 20e-9, 1.0, 30e-12  # m, N/m, N


def synthetic(side: int) -> maps.ArrayVolume:
    """Two moduli in a chequerboard."""
    y, x = np.mgrid[:side, :side] // 8
    modulus = np.where((x + y) % 2 == 0, 2e8, 1e9)
    return maps.synthesize(
        modulus, 0.015, radius=RADIUS, spring_constant=STIFFNESS, noise=NOISE, points=1000, depth=20e-9, tilt=1e-4
    )


def part_of(volume: maps.ArrayVolume, side: int) -> maps.ArrayVolume:
    """Its first rows and columns."""
    return maps.ArrayVolume(volume.values[:side, :side], volume.z, volume.spring_constant)


def seconds(call: Any, times: int = 1) -> tuple[float, float]:
    """On the clock and of all processors together, the least of some times."""
    taken = []
    for _ in range(times):
        start, work = time.perf_counter(), time.process_time()
        call()
        taken.append((time.perf_counter() - start, time.process_time() - work))
    return min(taken)


def growth(volume: maps.ArrayVolume, model: str, threads: int) -> None:
    """One row for each size."""
    print(f"\n{model}, {threads or 'all'} threads")
    print("  curves  seconds  curves/s  CPU ms/curve  growth of the peak RSS [MiB]")
    maps.fit(part_of(volume, SIDES[0]), model, radius=RADIUS)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for side in (s for s in SIDES if s <= volume.shape[0]):
        part = part_of(volume, side)
        call = partial(maps.fit, part, model, radius=RADIUS, threads=threads)
        taken, work = seconds(call, 3 if side < 32 else 1)
        count, grown = side * side, (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
        print(f"{count:8d} {taken:8.2f} {count / taken:9.0f} {1e3 * work / count:13.3f} {grown:29.1f}", flush=True)


class Watch(threading.Thread):
    """The most memory of this process's own, without what is mapped from files [MiB], while it runs."""

    def __init__(self) -> None:
        super().__init__(daemon=True)
        self.most, self._done = 0.0, threading.Event()

    def run(self) -> None:
        while not self._done.wait(0.02):
            status = Path("/proc/self/status").read_text(encoding="ascii")
            own = next(line for line in status.splitlines() if line.startswith("RssAnon"))
            self.most = max(self.most, int(own.split()[1]) / 1024)

    def end(self) -> float:
        """When all is done."""
        self._done.set()
        self.join()
        return self.most


def stored(volume: maps.ArrayVolume, model: str, count: int, threads: int) -> None:
    """The curves of a map again and again, in rows of 256; the hash of the file is reading, the rest is not."""
    curves_of = volume.values.reshape(-1, volume.z.size).astype(np.float32)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "forces.npy"
        shape = (count // 256, 256, volume.z.size)
        written = np.lib.format.open_memmap(path, "w+", np.float32, shape)
        for row in range(shape[0]):
            written[row] = curves_of[np.arange(256 * row, 256 * row + 256) % len(curves_of)]
        del written
        mapped = maps.ArrayVolume(np.load(path, mmap_mode="r"), volume.z, volume.spring_constant)
        _, reading = seconds(mapped.digest)
        watch = Watch()
        watch.start()
        taken, work = seconds(lambda: maps.fit(mapped, model, radius=RADIUS, threads=threads))
        print(
            f"{model}, {256 * shape[0]} curves from a file: {taken:.1f} s on the clock, CPU {work:.1f} s, of which its "
            f"hash {reading:.1f} s: {1e3 * (work - reading) / (256 * shape[0]):.3f} ms a curve; "
            f"memory of its own {watch.end():.0f} MiB", flush=True
        )  # fmt: skip


def alone(volume: maps.ArrayVolume, model: str) -> None:
    """The same curve by fit_curve, which is Python around the same C."""
    half = volume.z.size // 2
    parts: list[tuple[Any, slice]] = [("approach", slice(0, half)), ("retract", slice(half, None))]
    segments = tuple(
        curves.Segment(role, np.full(half, np.nan), volume.z[part], "height (measured)", volume.values[0, 0, part])
        for role, part in parts
    )
    curve = curves.ForceCurve(segments, {"spring constant": STIFFNESS})
    taken, work = seconds(lambda: fit.fit_curve(curve, model, radius=RADIUS, baseline="line"), 20)
    print(f"one curve by fit_curve: {1e3 * taken:.2f} ms, CPU {1e3 * work:.2f} ms")


def measured(path: str) -> None:
    """Reading and fitting of a file."""
    curves.read(path)
    _, read = seconds(lambda: curves.read(path), 3)
    volume = maps.CurveVolume.of(curves.read(path), path)
    _, fitted = seconds(lambda: maps.fit(volume, "dmt", radius=RADIUS), 3)
    count = len(volume.places)
    print(f"{path}: {count} curves, CPU ms/curve: reading {1e3 * read / count:.2f}, fitting {1e3 * fitted / count:.2f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", metavar="FILE")
    parser.add_argument("--side", type=int, default=128, help="of the largest map (default: %(default)s)")
    parser.add_argument("--threads", type=int, default=0, help="default: one per processor")
    parser.add_argument("--stored", nargs="+", type=int, default=[], metavar="N", help="curves from a mapped file")
    parser.add_argument("--models", nargs="+", default=["hertz", "jkr", "maugis"], help="default: %(default)s")
    args = parser.parse_args()
    made = synthetic(args.side)
    for name in args.models if args.stored else ():
        for size in args.stored:
            stored(made, name, size, args.threads)
    for name in () if args.stored else args.models:
        growth(made, name, args.threads)
        alone(made, name)
    for file in args.files:
        measured(file)
