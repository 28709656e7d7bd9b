# SPDX-License-Identifier: BSD-3-Clause
"""Calibrations of simulated rigs whose numbers are drawn: how far each fit is off, in its own sigmas.

Usage: calibrations.py [RIGS]    a line for each number: how many of them lie within one and two sigma
"""

from __future__ import annotations

import sys

import nanotouch as nt
import numpy as np
from nanotouch.touch import calibrate
from nanotouch.touch.calibrate import Value

PERIOD = 1e-4


def off(found: Value, truth: float) -> float:
    return (found.value - truth) / found.sigma


def stage(seed: int, plan: nt.scene.plan.Plan, seconds: float = 2.0) -> dict[str, float]:
    """Resonance, Q, delay; then gain and hysteresis. The fit is told the rig by default, not the one that is driven."""
    draw = np.random.default_rng(seed)
    f_n, Q, late, h = draw.uniform(300, 600), draw.uniform(5, 25), draw.uniform(0, 4e-4), draw.uniform(0.02, 0.15)
    described = {"axes": 1, "resonance": f_n, "quality": Q, "noise": 0.3e-9}
    rig = nt.Rig(stage=described, converters={"dac_latency": late})
    half = calibrate.simulated(rig, plan, period=PERIOD, clearance=50e-6, seed=seed)
    path = calibrate.sweep(rig.stage.max_speed, lowest=50.0, highest=1500.0, seconds=seconds, period=PERIOD)
    found = calibrate.stage_response(calibrate.drive(half, path, period=PERIOD), nt.Rig())
    bent = nt.Rig(stage=described | {"hysteresis": h})
    half = calibrate.simulated(bent, plan, period=PERIOD, clearance=50e-6, seed=seed)
    path = calibrate.staircase(20e-6, steps=10, period=PERIOD)
    found |= calibrate.stage_gain(calibrate.drive(half, path, period=PERIOD), bent, stroke=20e-6, steps=10)
    truth = {"stage.resonance": f_n, "stage.quality": Q, "delay": late, "stage.hysteresis": h}
    return {name: off(found[name], value) for name, value in truth.items()}


def master(seed: int, plan: nt.scene.plan.Plan, seconds: float = 4.0) -> dict[str, float]:
    """Mass and damping of a master whose position comes in steps of 40 um."""
    draw = np.random.default_rng(seed)
    m, b = draw.uniform(0.07, 0.15), draw.uniform(70, 130)
    half = calibrate.simulated(nt.Rig(master={"mass": m, "damping": b}), plan, period=PERIOD, seed=seed)
    path = calibrate.pushes(nt.Rig(), seconds=seconds, period=PERIOD)
    found = calibrate.master_motion(calibrate.drive(half, path, period=PERIOD, is_master=True), nt.Rig())
    return {"master.mass": off(found["master.mass"], m), "master.damping": off(found["master.damping"], b)}


def sensitivity(seed: int, plan: nt.scene.plan.Plan) -> dict[str, float]:
    """The slope on a hard sample. Its contact deforms by k_c/k_s, k_s = 2 E* a, a^3 = F R/E*."""
    rig = nt.Rig(stage={"axes": 1}, probe={"spring_constant": 0.3})
    half = calibrate.simulated(rig, plan, period=PERIOD, seed=seed)
    run = calibrate.drive(half, np.linspace(0.0, 2e-6, 10000), period=PERIOD, turn=200e-9, returns=True)
    found = calibrate.sensitivity(calibrate.contact_slope(run), rig, sample_stiffness=STIFFNESS)
    return {"probe.sensitivity": off(found, rig.probe.sensitivity)}


STIFFNESS = 2.0 * (0.5 * 135e9 / (1 - 0.35**2)) ** (2 / 3) * (35e-9 * 20e-9) ** (1 / 3)
"""of the default tip on the default sample at 35 nN, by Hertz [N/m]"""


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    plan = nt.Scene().plan()
    rows: dict[str, list[float]] = {}
    for seed in range(count):
        for name, z in (stage(seed, plan) | master(seed, plan) | sensitivity(seed, plan)).items():
            rows.setdefault(name, []).append(z)
    for name, found in rows.items():
        size = np.abs(found)
        one, two = np.mean(size < 1), np.mean(size < 2)
        print(f"{name}: {one:.0%} within 1 sigma, {two:.0%} within 2; largest {size.max():.2g}")


if __name__ == "__main__":
    main()
