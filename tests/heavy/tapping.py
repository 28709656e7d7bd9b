# SPDX-License-Identifier: BSD-3-Clause
"""Random levers, drives, samples and humidities that tap: is the slow flow ever farther from the time domain than is
told (docs/scan.md), amplitude 2 A0/Q, peak force 15 % of the larger of itself and the pull-off?

Resumable: ``--first SEED``. A violation prints the seed that makes the case again. Both begin with the motion that the
time domain has settled to.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter

import nanotouch as nt
import numpy as np
from nanotouch.errors import Error
from nanotouch.scan import FlowState

AMPLITUDE, FORCE = 2.0, 0.15


def compare(seed: int) -> tuple[str, float, float]:
    """What came of a seed; error of the amplitude over A0/Q, and of the peak force."""
    rng = np.random.default_rng(seed)

    def between(low: float, high: float) -> float:
        return float(low * (high / low) ** rng.random())

    scene = nt.Scene(tip={"radius": between(2e-9, 30e-9)}, sample={"youngs_modulus": between(1e8, 3e10)})
    scene.medium.relative_humidity = 0.0 if seed % 2 else float(rng.uniform(0.3, 0.7))
    quality, A0 = between(50.0, 800.0), between(5e-9, 60e-9)
    rig = nt.Rig(probe={"spring_constant": between(2.0, 60.0), "quality": quality, "resonance": 300e3})
    drive = nt.Drive(drive={"at": "base" if seed // 2 % 2 else "tip", "free_amplitude": A0})
    height = float(rng.uniform(0.5, 0.95)) * A0
    try:
        plan = scene.plan()
    except Error:
        return "refused by the plan", 0.0, 0.0
    tapping = nt.Tapping(plan, rig, drive, tolerance=1e-8)
    truth = tapping.settle(height)
    if not truth.settled:
        return "the time domain does not repeat", 0.0, 0.0
    begun = FlowState(
        truth.state.position - truth.value.mean, -truth.state.speed, truth.value.mean, truth.state.attached
    )
    _, value, settled = nt.SlowFlow(plan, rig, drive).settle(height, begun)
    if not settled:
        return "the slow flow does not settle", 0.0, 0.0
    if abs(value.phase - truth.value.phase) > 0.5:
        return "left for the other motion", 0.0, 0.0
    scale = max(abs(truth.value.peak_force), plan.pull_off_force)
    force = abs(value.peak_force - truth.value.peak_force) / scale if truth.value.contact_time > 0.0 else 0.0
    return "compared", abs(value.amplitude - truth.value.amplitude) * quality / A0, force


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=300)
    wanted = parser.parse_args()
    kinds: Counter[str] = Counter()
    worst, broken, start = np.zeros(2), 0, time.monotonic()
    for seed in range(wanted.first, wanted.first + wanted.count):
        kind, amplitude, force = compare(seed)
        kinds[kind] += 1
        worst = np.maximum(worst, (amplitude, force))
        if amplitude > AMPLITUDE or force > FORCE:
            broken += 1
            print(f"  VIOLATION: seed {seed}: amplitude {amplitude:.3g} A0/Q, peak force {force:.3g}", flush=True)
    print(f"{wanted.count} cases from seed {wanted.first} in {time.monotonic() - start:.0f} s: {dict(kinds)}")
    print(f"violations: {broken}; largest: amplitude {worst[0]:.3g} A0/Q, peak force {worst[1]:.3g}")
    return broken


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
