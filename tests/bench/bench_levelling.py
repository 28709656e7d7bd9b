# SPDX-License-Identifier: BSD-3-Clause
"""Everyday levelling against known truth: ``python tests/bench/bench_levelling.py --seeds 4``.

The surfaces and the scans are those of ``tests/python/synthetic_levelling.py``. Printed are medians of the rms error
[nm], and on how many images `auto` is worse than `plane+rows`, half of them without drift, offsets and bow.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python"))
import synthetic_levelling as known
from nanotouch import images

METHODS = ("plane+rows", "plane+medians", "auto")
PIXELS, FIRST = 200, 201
STILL = {"offsets": 0.0, "drift": 0.0, "bow": 0.0}


def errors(name: str, seed: int, scan: dict[str, float]) -> list[float]:
    """Rms error of each method about its mean [nm]."""
    rng = np.random.default_rng(seed)
    truth = known.SURFACES[name](rng, PIXELS)
    topography = images.Topography(known.scanned(truth, rng, **scan), (10e-6 / PIXELS,) * 2)
    return [float(np.std(images.level(topography, method)[0].heights - truth)) * 1e9 for method in METHODS]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=4)
    seeds = range(FIRST, FIRST + parser.parse_args().seeds)
    warnings.simplefilter("ignore", UserWarning)
    ratios = []
    print("| [nm] | " + " | ".join(f"`{method}`" for method in METHODS) + " |")
    print("|---|---|---|---|")
    for name in known.SURFACES:
        moved = np.array([errors(name, seed, {}) for seed in seeds])
        print(f"| {name} | " + " | ".join(f"{value:.3g}" for value in np.median(moved, axis=0)) + " |", flush=True)
        still = np.array([errors(name, seed, STILL) for seed in seeds])
        ratios += [*(moved[:, 2] / moved[:, 0]), *(still[:, 2] / still[:, 0])]
    worse = [100.0 * float(np.mean(np.array(ratios) > limit)) for limit in (1.02, 1.2)]
    print(f"{len(ratios)} images: auto is over 2 % worse on {worse[0]:.2g} %, over 20 % on {worse[1]:.2g} %")


if __name__ == "__main__":
    main()
