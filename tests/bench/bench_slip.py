# SPDX-License-Identifier: BSD-3-Clause
"""Does a fit tell a contact that slipped, or a scanner that bows? ``python tests/bench/bench_slip.py --curves 40``.

The curves come from Hertz' law tabulated over the base's position; nothing of the fit's own code.
"""

from __future__ import annotations

import argparse

import numpy as np
from nanotouch import curves, fit

RADIUS, TRAVEL, POINTS, SIZE = 1e-6, 3e-6, 2000, 3e-9
SAMPLES = ((1e3, 0.02, 500e-9, 5e-12), (1e4, 0.05, 300e-9, 1e-11), (1e5, 0.1, 100e-9, 2e-11), (1e6, 0.5, 40e-9, 3e-11))
DEFECTS = ("none", "slip", "bow")
KNOWN = fit.Uncertainties(sensitivity=1e-6)


def make(
    rng: np.random.Generator, modulus: float, stiffness: float, depth: float, noise: float, defect: str
) -> curves.ForceCurve:
    """Approach and retraction over a paraboloid; the approach with a defect of 3 nm while in contact."""
    indentation = np.linspace(0.0, depth, 4000)
    force = 4.0 / 3.0 * modulus * np.sqrt(RADIUS) * indentation**1.5
    base = indentation + force / stiffness
    x = np.linspace(-TRAVEL, base[-1], POINTS)
    shift = np.zeros(POINTS)
    if defect == "slip":
        shift = -SIZE * (x > rng.uniform(0.2, 0.8) * base[-1])
    elif defect == "bow":
        part = np.clip(x / base[-1], 0.0, 1.0)
        shift = SIZE * 4.0 * part * (1.0 - part) * rng.choice([-1.0, 1.0])
    parts = []
    for role, order, by in (("approach", slice(None), shift), ("retract", slice(None, None, -1), np.zeros(POINTS))):
        measured = np.interp(x + by, base, force, left=0.0)[order] + rng.normal(0.0, noise, POINTS)
        parts.append(curves.Segment(role, np.full(POINTS, np.nan), -x[order], "height (measured)", measured))  # type: ignore[arg-type]
    return curves.ForceCurve(tuple(parts), {"spring constant": stiffness}, "synthetic")


def row(sample: tuple[float, float, float, float], defect: str, count: int) -> tuple[float, float, float, float]:
    """Median error and sigma of E*, share that is off by more than 3 sigma, share that is told."""
    modulus, stiffness, depth, noise = sample
    rng, found = np.random.default_rng(1), []
    for _ in range(count):
        made = make(rng, modulus, stiffness, depth, noise, defect)
        result = fit.fit_curve(made, "hertz", radius=RADIUS, uncertainties=KNOWN)
        value, sigma = result.values["effective_modulus"], result.sigma["effective_modulus"]
        told = any("shallow half" in note for note in result.notes) or result.status != "ok"
        found.append((abs(np.log(value / modulus)), sigma / value, told))
    error, spread, told = np.array(found).T
    return float(np.median(error)), float(np.median(spread)), float(np.mean(error > 3 * spread)), float(np.mean(told))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curves", type=int, default=40)
    count = parser.parse_args().curves
    print("| E* | defect | median error [%] | median sigma [%] | wrong [%] | told [%] |\n|---|---|---|---|---|---|")
    for sample in SAMPLES:
        for defect in DEFECTS:
            error, sigma, wrong, told = (100.0 * value for value in row(sample, defect, count))
            print(f"| {sample[0] / 1e3:g} kPa | {defect} | {error:.1f} | {sigma:.1f} | {wrong:.0f} | {told:.0f} |")
