# SPDX-License-Identifier: BSD-3-Clause
"""Does the 95 % interval of a fit hold the truth 95 times in 100?

``python tests/bench/bench_coverage.py [--curves 2000] [--models hertz,jkr] [--noise flicker] [--seed 0]``: about 10 ms
a curve. Curves with noise, offset, tilt and drift, calibrated by an instrument that errs as much as the fit is told.
Noise: white; smeared over five samples; white with a third of 1/f noise; 1/f noise (flicker) alone.
"""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from typing import Any

import nanotouch as nt
import numpy as np

RADIUS, MODULUS, WORK, STIFFNESS, CONTACT, RANGE = 20e-9, 5e6, 0.05, 0.5, 3e-7, 2e-9
HALF_ANGLE = float(np.radians(25.0))
MODELS = ("hertz", "cone", "pyramid", "dmt", "jkr", "maugis")
NOISES = ("white", "smeared", "mixed", "flicker")
ADHESIVE = ("dmt", "jkr", "maugis")
NOISE, DRIFT = 30e-12, 0.02e-9  # N, m/s
CALIBRATION = nt.fit.Uncertainties(sensitivity=0.03, spring_constant=0.05, radius=0.04)
PARAMETERS = ("effective_modulus", "work_of_adhesion", "contact_point")


def record(kind: str, count: int, seed: int) -> Any:
    """Noise of standard deviation 1; flicker noise, whose deviation grows with the record, of that over this one."""
    rng = np.random.default_rng([seed, 99])
    white = rng.standard_normal(count + 4)
    if kind == "smeared":
        return np.convolve(white, np.full(5, 5**-0.5), "valid")
    long = np.fft.rfft(rng.standard_normal(16 * count))  # of which the record is a part, so that it does not close
    long[0] = 0.0
    flicker = np.fft.irfft(long / np.sqrt(np.maximum(np.arange(long.size), 1)))[:count]
    flicker /= flicker.std()
    return flicker if kind == "flicker" else white[:count] + flicker / 3.0


def noisy(curve: Any, noise: Any) -> Any:
    """The curve with a record of noise [N] added, approach and retraction one after the other."""
    parts = []
    for part in curve.segments:
        parts.append(replace(part, force=part.force + noise[: len(part)]))
        noise = noise[len(part) :]
    return replace(curve, segments=tuple(parts))


def synthetic(model: str, seed: int, stiffness: float = STIFFNESS, kind: str = "white") -> tuple[Any, dict[str, Any]]:
    """A curve, and what the fit is told about its tip."""
    rng = np.random.default_rng([seed, 77])
    error = np.exp(rng.standard_normal(3) * [CALIBRATION.sensitivity, CALIBRATION.spring_constant, CALIBRATION.radius])
    contact = nt.Contact(RADIUS, MODULUS, WORK if model in ADHESIVE else 0.0, cohesive_range=RANGE)
    told: dict[str, Any] = {"radius": RADIUS * error[2]}
    if model in ("cone", "pyramid"):
        told["half_angle"] = HALF_ANGLE
    if model == "maugis":
        told["cohesive_range"] = RANGE
    white = NOISE if kind == "white" else 0.0
    curve = nt.curves.synthesize(
        contact, model, spring_constant=stiffness, noise=white, offset=1e-9, tilt=1e-4 * rng.standard_normal(),
        drift=DRIFT * rng.standard_normal(), sensitivity_error=error[0], spring_constant_error=error[1],
        contact_point=CONTACT, seed=seed, half_angle=told.get("half_angle"),
        depth=60e-9 + 2e-9 * rng.random(),  # so that the tear lies anywhere between two samples
    )  # fmt: skip
    if kind != "white":
        curve = noisy(curve, NOISE * record(kind, sum(len(part) for part in curve.segments), seed))
    return curve, told


def inside(model: str, seed: int, kind: str = "white") -> dict[str, tuple[bool, float]]:
    """For each parameter whether its interval holds the truth, and (value - truth)/sigma."""
    curve, told = synthetic(model, seed, kind=kind)
    result = nt.fit.fit_curve(curve, model, uncertainties=CALIBRATION, **told)
    truth = {"effective_modulus": MODULUS, "work_of_adhesion": WORK, "contact_point": CONTACT}
    found = {}
    for name in PARAMETERS:
        if name in result.values:
            low, high = result.interval[name]
            pull = (result.values[name] - truth[name]) / result.sigma[name]
            found[name] = (bool(low <= truth[name] <= high), float(pull))
    return found


def coverage(model: str, curves: int, seed: int = 0, kind: str = "white") -> dict[str, tuple[float, float, float]]:
    """Part of the curves whose interval holds the truth, mean and standard deviation of the pulls, by parameter."""
    all_of = [inside(model, seed + i, kind) for i in range(curves)]
    table = {}
    for name in all_of[0]:
        held = np.array([row[name][0] for row in all_of])
        pulls = np.array([row[name][1] for row in all_of])
        table[name] = (float(held.mean()), float(pulls.mean()), float(pulls.std()))
    return table


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--curves", type=int, default=200)
    parser.add_argument("--models", default=",".join(MODELS))
    parser.add_argument("--noise", choices=NOISES, default="white")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--processes", type=int, default=1)
    args = parser.parse_args()
    models = args.models.split(",")
    what = "part of the 95 % intervals that hold the truth (pulls: mean, standard deviation)"
    print(f"{args.curves} curves, {args.noise} noise: {what}")
    with ProcessPoolExecutor(args.processes) as pool:
        tables = pool.map(partial(coverage, curves=args.curves, seed=args.seed, kind=args.noise), models)
        for model, table in zip(models, tables, strict=True):
            row = "  ".join(f"{name} {100 * p:.1f} % ({m:+.2f}, {s:.2f})" for name, (p, m, s) in table.items())
            print(f"{model:8} {row}", flush=True)


if __name__ == "__main__":
    main()
