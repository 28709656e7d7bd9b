# SPDX-License-Identifier: BSD-3-Clause
"""Fits of 2 000 force curves of power-law samples in closed form: bias, coverage, time, and what an elastic law says.

Usage: .venv/bin/python tests/heavy/fit_ting.py [--count 2000] [--seed 1]

8 to 20 pN of noise, 3 to 10 nN at the peak, beta 0 (a sixth of them) to 0.5, 1 and 20 um/s, 2 x 2 000 points, drag.
Exits with 1 where a mean of E_1 is off by 0.5 %, one of beta by 0.002, coverage lies outside of 93 to 97 %, or a fit
takes more than 4 ms of processor time (the C library's part, without reading the curve), or where Hertz' law says of
fewer than 95 % of those with beta >= 0.1 that they relax, of more than 2 % of the elastic ones, or blames a
calibration.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

import numpy as np
from nanotouch import fit
from nanotouch.curves import analyse
from nanotouch.fit import ting
from nanotouch.fit.models import extension

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "python"))

from ting_curves import POISSON, RADIUS, STIFFNESS, Sample, curve_of

EXACT = fit.Uncertainties(sensitivity=0.0)
FEWEST = 100  # curves of a row whose coverage is judged


def one(rng: np.random.Generator, seed: int) -> tuple[float, ...]:
    """Speed, beta; errors of E_1 (relative) and beta; whether each lies in its interval; seconds of a fit; whether an
    elastic law says that the sample relaxes, and whether it blames the calibration."""
    speed = (1e-6, 2e-5)[seed % 2]
    exponent = 0.0 if rng.uniform() < 1 / 6 else rng.uniform(0.0, 0.5)
    sample = Sample(1e3, exponent, speed).with_peak(rng.uniform(3e-9, 10e-9))
    curve = curve_of(sample, noise=rng.uniform(8e-12, 20e-12), drag=rng.uniform(0.0, 4e-6), seed=seed)
    report = analyse(curve)
    found = fit.fit_curve(curve, "ting_power", radius=RADIUS, poisson_ratio=POISSON, uncertainties=EXACT, report=report)
    law = ting.Law(fit.OVER_TIME["ting_power"], RADIUS, 0.3, 0.0, STIFFNESS, ting.noise_of(report))
    track = ting.track_of(curve, report, approach_only=False, window=None)
    path, options = track.path(extension()), law.options(extension())
    begun = time.process_time()
    extension().run_path(options, path)
    taken = time.process_time() - begun
    true = {"youngs_modulus": sample.modulus, "exponent": exponent}
    inside = [found.interval[key][0] <= value <= found.interval[key][1] for key, value in true.items()]
    errors = found.values["youngs_modulus"] / sample.modulus - 1.0, found.values["exponent"] - exponent
    elastic = fit.fit_curve(curve, "hertz", radius=RADIUS, report=report)
    return speed, exponent, *errors, *inside, taken, "relaxes" in elastic.reason, "calibration" in elastic.reason


def main() -> int:
    """All curves, a line for each group."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    rng = np.random.default_rng(args.seed)
    rows = np.array([one(rng, args.seed * 1_000_000 + i) for i in range(args.count)])
    bad = 0
    print("speed [um/s]  beta          curves  E_1 off [%]  beta off  E_1 in 95 %  beta in 95 %")
    groups = [(speed, low, high) for speed in (1e-6, 2e-5) for low, high in ((0, 0), (0, 0.1), (0.1, 0.3), (0.3, 0.5))]
    for speed, low, high in [*groups, (None, 0, 0), (None, -1, 0.5)]:
        chosen = (rows[:, 0] == speed) | (speed is None)
        chosen &= (rows[:, 1] == 0) if high == 0 else (rows[:, 1] > low) & (rows[:, 1] <= high)
        part = rows[chosen]
        off, beta_off, covered, beta_covered = part[:, 2:6].mean(axis=0)
        name = "0" if high == 0 else "all" if low < 0 else f"{low:g} to {high:g}"
        print(f"{'both' if speed is None else f'{speed * 1e6:g}':12}  {name:12}  {len(part):6}  {100 * off:+11.3f}"
              f"  {beta_off:+8.5f}  {covered:11.3f}  {beta_covered:12.3f}")  # fmt: skip
        bad |= abs(off) > 5e-3 or abs(beta_off) > 2e-3
        if speed is None and len(part) >= FEWEST:
            slack = 0.0 if low < 0 else 1.96 * np.sqrt(0.95 * 0.05 / len(part))  # of a sixth of the curves
            bad |= not all(0.93 - slack <= share <= 0.97 + slack for share in (covered, beta_covered))
    taken = float(np.median(rows[:, 6]))
    print(f"{1e3 * taken:.2f} ms of processor time a fit (median; 95 %: {1e3 * np.quantile(rows[:, 6], 0.95):.2f})")
    gels, elastic = rows[rows[:, 1] >= 0.1], rows[rows[:, 1] == 0.0]
    named, wrong, blamed = gels[:, 7].mean(), elastic[:, 7].mean(), int(rows[:, 8].sum())
    print(f"an elastic law names {100 * named:.1f} % of the gels (beta >= 0.1) and {100 * wrong:.1f} % of the elastic "
          f"ones; {blamed} calibrations blamed")  # fmt: skip
    return int(bad or taken > 4e-3 or named < 0.95 or wrong > 0.02 or blamed > 0)


if __name__ == "__main__":
    sys.exit(main())
