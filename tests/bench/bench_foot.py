# SPDX-License-Identifier: BSD-3-Clause
"""How often the 95 % interval of the contact point holds the truth: plain, under a squeeze film, over a bowed baseline.

``python tests/bench/bench_foot.py --curves 200``. A generator of its own: Hertz' foot by Newton's method, the film of
a sphere and of a lever whose exponent is drawn, bows of second and third order, white and slow noise (AR 1).
"""

from __future__ import annotations

import argparse
from typing import Any

import numpy as np
from nanotouch import curves, fit

Array = np.ndarray
STIFFNESS, RADIUS, DEPTH, FREE, POINTS = 0.08, 2e-6, 6e-7, 2.2e-6, 1600  # N/m, m, m, m, -
KINDS = ("plain", "film", "bow", "film and bow")
GAUSSIAN = 1.96


def hertz(travel: Array, modulus: float) -> Array:
    """Force [N] where the base is `travel` [m] beyond first touch: c (travel - F/k)^1.5."""
    scale = 4.0 / 3.0 * modulus * np.sqrt(RADIUS)
    depth = np.maximum(travel, 0.0)
    for _ in range(100):
        excess = depth + scale * depth**1.5 / STIFFNESS - np.maximum(travel, 0.0)
        depth = np.maximum(depth - excess / (1.0 + 1.5 * scale * np.sqrt(depth) / STIFFNESS), 0.0)
    return scale * depth**1.5


def slow(rng: np.random.Generator, count: int, memory: float) -> Array:
    """AR(1) of standard deviation 1."""
    kicks = rng.standard_normal(count) * np.sqrt(1.0 - memory**2)
    found = np.empty(count)
    state = rng.standard_normal()
    for i, kick in enumerate(kicks):
        state = memory * state + kick
        found[i] = state
    return found


def curve_of(kind: str, seed: int) -> tuple[curves.ForceCurve, float, float]:
    """A curve, z of first touch [m] and E* [Pa]."""
    rng = np.random.default_rng(seed)
    touch, modulus = rng.uniform(2e-7, 9e-7), 10.0 ** rng.uniform(3.0, 4.5)
    noise = rng.uniform(5e-12, 25e-12)
    height = np.linspace(FREE, -DEPTH, POINTS)
    film = rng.uniform(20e-12, 90e-12) if "film" in kind else 0.0
    gap, power = rng.uniform(80e-9, 350e-9), rng.uniform(0.8, 1.6)
    bow = rng.uniform(-150e-12, 150e-12) if "bow" in kind else 0.0
    third = bow * rng.uniform(-0.4, 0.4)
    drag, offset, tilt = rng.uniform(3e-12, 30e-12), rng.uniform(-1e-9, 1e-9), rng.uniform(-1e-4, 1e-4)
    segments = []
    for role, above, sign in (("approach", height, 1.0), ("retract", height[::-1], -1.0)):
        x = above / FREE
        force = hertz(-above, modulus) + offset + tilt * above + bow * x**2 + third * x**3
        force = force + sign * (drag + film * (1.0 + np.maximum(above, 0.0) / gap) ** -power)
        force = force + noise * rng.standard_normal(POINTS) + 0.15 * noise * slow(rng, POINTS, 0.95)
        time = np.full(POINTS, np.nan)
        segments.append(curves.Segment(role, time, touch + above, "height (measured)", force))  # type: ignore[arg-type]
    return curves.ForceCurve(tuple(segments), {"spring constant": STIFFNESS}, kind), touch, modulus


def one(kind: str, seed: int) -> tuple[float, float, float, float]:
    """Error and sigma of the contact point: of the reading, of the fit [m]."""
    curve, touch, _ = curve_of(kind, seed)
    report = curves.analyse(curve)
    result = fit.fit_curve(curve, "hertz", radius=RADIUS, report=report)
    low, high = result.interval["contact_point"]
    return (
        report.contact_point - touch, report.sigma["contact_point"],
        result.values["contact_point"] - touch, (high - low) / (2.0 * GAUSSIAN),
    )  # fmt: skip


def rows(count: int, first: int) -> dict[str, Any]:
    """By kind: error and sigma of `count` curves, shape (count, 4)."""
    return {
        kind: np.array([one(kind, first + 10_000 * number + i) for i in range(count)])
        for number, kind in enumerate(KINDS)
    }


def held(error: Array, sigma: Array) -> float:
    """Share within 95 %; an unknown contact point holds nothing."""
    return float(np.mean(np.abs(error) < GAUSSIAN * sigma))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--curves", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    print("| kind | read: median error [nm] | sigma [nm] | held [%] | fitted: median error | sigma | held [%] |")
    print("|---|---|---|---|---|---|---|")
    for kind, found in rows(args.curves, 1_000_000 * args.seed).items():
        numbers = []
        for error, sigma in (found.T[:2], found.T[2:]):
            numbers.append(f"{1e9 * np.nanmedian(np.abs(error)):.1f} | {1e9 * np.nanmedian(sigma):.1f} | "
                           f"{100 * held(error, sigma):.1f}")  # fmt: skip
        print(f"| {kind} | {numbers[0]} | {numbers[1]} |")


if __name__ == "__main__":
    main()
