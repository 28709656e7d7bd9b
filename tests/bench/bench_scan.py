# SPDX-License-Identifier: BSD-3-Clause
"""What tapping costs, in processor time of one run: an oscillation in the time domain beside that of a published
simulator, a steady motion by each tier, an image of 256 x 256 pixels in time and steady."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable

import nanotouch as nt

PEER = (
    92e-6  # pyDAMPF, 512 Runge-Kutta steps in an oscillation, measured on this kind of machine (docs/comparison.md) [s]
)


def seconds(work: Callable[[], object], repeats: int = 1) -> float:
    """Processor time of all threads, for one of them."""
    begin = time.process_time()
    for _ in range(repeats):
        work()
    return (time.process_time() - begin) / repeats


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--pixels", type=int, default=256)
    parser.add_argument("--lines", type=int, default=256)
    wanted = parser.parse_args()
    scene = nt.Scene(tip={"radius": 10e-9}, sample={"youngs_modulus": 10e9}, medium={"relative_humidity": 0.0})
    rig = nt.Rig(probe={"spring_constant": 40.0, "quality": 200.0, "resonance": 300e3})
    plan = scene.plan()
    tapping = nt.Tapping(plan, rig, tolerance=1e-6)
    state = tapping.settle(14e-9).state
    one = seconds(lambda: tapping.run(state, 14e-9, 2000)) / 2000
    print(
        f"time domain (tolerance 1e-6): {one * 1e6:.3g} us an oscillation; "
        f"peer: {PEER * 1e6:.3g} us, {PEER / one:.3g} times"
    )
    exact = nt.Tapping(plan, rig)
    one = seconds(lambda: exact.run(state, 14e-9, 1000)) / 1000
    print(f"time domain (tolerance 1e-9): {one * 1e6:.3g} us an oscillation; {PEER / one:.3g} times")
    for accuracy in (0.5, 0.1, 0.02, 0.005, 1e-5):
        steady = nt.Steady(plan, rig, accuracy=accuracy)
        motion = steady.at_amplitude(14e-9)
        assert motion is not None
        took = seconds(lambda: steady.at_amplitude(14e-9), 3)  # noqa: B023
        print(f"steady to {accuracy:g}: {motion.tier}, {motion.harmonics} harmonics, {motion.evaluations} forces, "
              f"{took * 1e3:.3g} ms with the curve")  # fmt: skip
    surface = nt.Surface.touched_by(scene, nt.surface.dots())
    over, (width, height) = scene.plan(0.3, surface=surface), surface.size
    raster = {"width": width, "height": height, "pixels": wanted.pixels, "lines": wanted.lines, "line_rate": 1.0}
    scanner = nt.Scanner(over, nt.Scan(raster=raster), rig)
    for accuracy in (0.5, 0.1):
        took = seconds(lambda: scanner.steady(accuracy))  # noqa: B023
        print(f"{wanted.pixels} x {wanted.lines} pixels steady to {accuracy:g}: {took:.3g} s of processor time")
    took = seconds(scanner.run)
    print(
        f"{wanted.pixels} x {wanted.lines} pixels in time, one line per second, 50 kHz: {took:.3g} s of processor time"
    )


if __name__ == "__main__":
    main()
