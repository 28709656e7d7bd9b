# SPDX-License-Identifier: BSD-3-Clause
"""Closed paths over every preset: does the surface ever give out energy, and is what it takes booked? ``make heavy``

Random walks of the gap over a flat and laps in x, y, z over bumpy surfaces, each on a state of its own; work by
Gauss-Legendre quadrature of the force (tests/python/cycles.py), over the largest force times the extent of the paths.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))

import cycles
from nanotouch import presets
from nanotouch.errors import InvalidValue
from random_scenes import PRESETS

TOLERANCE = 1e-8  # of quadrature and of the tables' joins, over the scale
COARSE = 1e-6  # of quadrature over the cells of a sample that deforms; with 24 points in place of 8 it is 2.4e-8
CHUNK = 1000  # paths at once
SURFACE_LAPS = 5000  # over one surface, then another


def walks_of(name: str, count: int) -> list[cycles.Balance]:
    scene, _ = getattr(presets, name)()
    plan, rng = scene.plan(), np.random.default_rng(1)
    return [cycles.random_walks(plan, scene, rng, CHUNK) for _ in range(0, count, CHUNK)]


def laps_of(name: str, count: int, kind: str) -> list[cycles.Balance]:
    """With the radius of each place (``"curved"``), on the same surface with the tip's own (``"flat"``), or with a
    modulus and an adhesion of each place, too (``"made"``)."""
    scene, _ = getattr(presets, name)()
    rng, made = np.random.default_rng(2), []
    for index in range(0, count, CHUNK):
        if index % SURFACE_LAPS == 0:
            surface = cycles.bumpy(scene, index // SURFACE_LAPS)
            if kind == "flat":
                surface = cycles.without_radii(surface)
            elif kind == "made":
                surface = cycles.made_of(scene, surface, index // SURFACE_LAPS, contrast=(5.0, 5.0))
            plan = scene.plan(surface=surface)
        made.append(cycles.random_laps(plan, scene, surface, rng, CHUNK))
    return made


def report(name: str, what: str, balances: list[cycles.Balance], tolerance: float) -> bool:
    """One row of the table; whether it fails."""
    out, off = np.max([(b.net_out, b.imbalance) for b in balances], axis=0)  # max() may lose a NaN
    most = max(b.dissipated.max() / b.scale for b in balances)
    count = sum(len(b.work) for b in balances)
    print(f"{name:16} {what:12} {count:7}  {out:10.2g} {off:14.2g} {most:15.2g}", flush=True)
    return not (out <= tolerance and off <= tolerance)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--paths", type=int, default=100_000, help="of each kind for each preset")
    parser.add_argument("--presets", nargs="*", default=PRESETS)
    options = parser.parse_args()
    failed = False
    print(f"{'preset':16} {'paths':12} {'number':>7}  {'most given':>10} {'area - booked':>14} {'most dissipated':>15}")
    for name in options.presets:
        scene, _ = getattr(presets, name)()
        laps = COARSE if scene.plan().explain()["deforms"] else TOLERANCE
        failed |= report(name, "walks", walks_of(name, options.paths), TOLERANCE)
        failed |= report(name, "laps, curved", laps_of(name, options.paths, "curved"), laps)
        try:
            failed |= report(name, "laps, made", laps_of(name, options.paths // 2, "made"), laps)
        except InvalidValue as refusal:  # a sample that deforms under forces before contact
            print(f"{name:16} laps, made   refused: {refusal}", flush=True)
        failed |= report(name, "laps, flat", laps_of(name, options.paths // 10, "flat"), laps)
        moved, share = cycles.largest_step(scene.plan(), np.random.default_rng(3), options.paths)
        print(
            f"{name:16} a move of 1 pm changes the force by at most {moved:.3g} N, {share:.6f} of k x 1 pm", flush=True
        )
        failed |= not share <= 1.0 + 1e-6
    return failed


if __name__ == "__main__":
    sys.exit(main())
