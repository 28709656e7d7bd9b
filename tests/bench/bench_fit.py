# SPDX-License-Identifier: BSD-3-Clause
"""Time of one fit of 2 000 points, per model: ``python tests/bench/bench_fit.py``."""

from __future__ import annotations

import time

import numpy as np
from nanotouch import _fit
from nanotouch.contact import MODELS

POINTS, RUNS, NOISE = 2000, 20, 10e-12  # -, -, N
TRUTH = {"effective_modulus": 2e9, "work_of_adhesion": 0.05, "cohesive_range": 0.2e-9, "compliance": 1.0}


def milliseconds(model: str, jitter: float) -> float:
    """Median over the runs; jitter: noise of the positions [m], as of a height sensor."""
    options = _fit.Options(MODELS.index(model))
    options.radius, options.spring_constant, options.force_noise = 20e-9, 1.0, NOISE
    options.hold("cohesive_range", TRUTH["cohesive_range"])
    rng = np.random.default_rng(1)
    position = np.linspace(-30e-9, 20e-9, POINTS) + jitter * rng.standard_normal(POINTS)
    values = [TRUTH.get(name, 0.0) for name, _ in _fit.parameters]
    force = _fit.evaluate(options, values, position)[0] + NOISE * rng.standard_normal(POINTS)
    taken = []
    for _ in range(RUNS):
        start = time.perf_counter()
        _fit.run(options, position, force)
        taken.append(time.perf_counter() - start)
    return 1e3 * float(np.median(taken))


if __name__ == "__main__":
    print(f"{'model':8} even steps [ms]  0.2 nm of jitter [ms]")
    for name in MODELS:
        print(f"{name:8} {milliseconds(name, 0.0):15.2f} {milliseconds(name, 0.2e-9):22.2f}")
