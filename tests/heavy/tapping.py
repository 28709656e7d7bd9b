# SPDX-License-Identifier: BSD-3-Clause
"""Random levers, drives, set points, samples and humidities that tap: is the cheapest tier that keeps a demand
(nanotouch.Steady) ever farther from the time domain than it is told to be, or does its motion not stay?

Resumable: ``--first SEED``. A violation prints the seed that makes the case again. The time domain begins with the
motion that is told, and runs until it repeats.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter

import nanotouch as nt
import numpy as np
from nanotouch.errors import Error


def compare(seed: int) -> tuple[str, float, float]:
    """What came of a seed; errors of amplitude and peak force over their bounds."""
    rng = np.random.default_rng(seed)

    def between(low: float, high: float) -> float:
        return float(low * (high / low) ** rng.random())

    scene = nt.Scene(tip={"radius": between(2e-9, 30e-9)}, sample={"youngs_modulus": between(1e8, 3e10)})
    scene.medium.relative_humidity = float(rng.uniform(0.3, 0.7)) if seed % 4 == 0 else 0.0
    quality, A0 = between(20.0, 800.0), between(5e-9, 60e-9)
    rig = nt.Rig(probe={"spring_constant": between(2.0, 60.0), "quality": quality, "resonance": 300e3})
    drive = nt.Drive(drive={"at": "base" if seed // 2 % 2 else "tip", "free_amplitude": A0})
    accuracy, share, lifted = between(1e-3, 0.2), float(rng.uniform(0.3, 0.95)), bool(rng.random() < 0.3)
    try:
        plan = scene.plan()
    except Error:
        return "refused by the plan", 0.0, 0.0
    found = nt.Steady(plan, rig, drive, accuracy=accuracy).at_amplitude(share * A0, lifted)
    if found is None:
        return "no motion of that set point", 0.0, 0.0
    if found.tier == "time domain":
        return found.tier, 0.0, 0.0
    truth = nt.Tapping(plan, rig, drive, tolerance=1e-8).settle(found.base_height, found.state)
    if not truth.settled:
        return "the time domain does not repeat", 0.0, 0.0
    if abs(found.phase - truth.value.phase) > 0.3:
        return "left for the other motion", 0.0, 0.0
    amplitude = abs(found.amplitude - truth.value.amplitude) / found.amplitude_bound
    return found.tier, amplitude, abs(found.peak_force - truth.value.peak_force) / found.force_bound


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
        if amplitude > 1.0 or force > 1.0 or kind.startswith("left"):
            broken += 1
            print(f"  VIOLATION: seed {seed}: {kind}, amplitude {amplitude:.3g}, peak force {force:.3g} of the bound",
                  flush=True)  # fmt: skip
        if (seed + 1) % 500 == 0:
            print(f"  to seed {seed}: {dict(kinds)}, largest {worst.round(3)}", flush=True)
    print(f"{wanted.count} cases from seed {wanted.first} in {time.monotonic() - start:.0f} s: {dict(kinds)}")
    print(f"violations: {broken}; largest: amplitude {worst[0]:.3g}, peak force {worst[1]:.3g} of the bound")
    return broken


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
