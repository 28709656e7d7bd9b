# SPDX-License-Identifier: BSD-3-Clause
"""What a loop written in ten minutes costs: Hertz and JKR by numba, as a user would write them instead of ours.

Run: pip install numba; python peer_loops.py FOLDER    (writes peers.json: nanoseconds of an element, by the names of
bench_contact.c; speed.py takes them up)
"""

from __future__ import annotations

import functools
import importlib
import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from timing import least

Floats = NDArray[np.float64]

COUNT, REPEATS = 4096, 50


def repeated(loop: Any, depths: Floats, out: Floats) -> None:
    """Long enough for a clock."""
    for _ in range(REPEATS):
        loop(depths, out)


def measured() -> dict[str, float]:
    """Nothing where numba is not installed."""
    try:
        numba: Any = importlib.import_module("numba")
    except ImportError:
        return {}

    def hertz(depths: Floats, out: Floats) -> None:
        for i in range(len(depths)):
            out[i] = depths[i] * math.sqrt(depths[i]) if depths[i] > 0.0 else 0.0

    def jkr(depths: Floats, out: Floats) -> None:
        """Newton in s, s^2 = a: s^4 - 4/sqrt(6) s = d; P = a^3 - sqrt(6) s^3."""
        for i in range(len(depths)):
            s = 1.3 + 0.5 * math.sqrt(depths[i] + 1.0)
            for _ in range(50):
                step = (s**4 - 4.0 / math.sqrt(6.0) * s - depths[i]) / (4.0 * s**3 - 4.0 / math.sqrt(6.0))
                s -= step
                if abs(step) < 1e-15 * s:
                    break
            out[i] = s**6 - math.sqrt(6.0) * s**3

    depths, out = np.random.default_rng(1).uniform(-0.9, 9.1, COUNT), np.empty(COUNT)
    found = {}
    for name, written in (("hertz law array", hertz), ("jkr law array", jkr)):
        loop = numba.njit(written)
        loop(depths, out)  # compiled
        time = least(functools.partial(repeated, loop, depths, out), 7)
        found[name] = float(f"{1e9 * time / (REPEATS * COUNT):.4g}")
    return found


def main() -> None:
    """Print and keep them."""
    found = measured()
    if not found:
        print("numba is not here: its loops are not measured")
        return
    (Path(sys.argv[1]) / "peers.json").write_text(json.dumps(found))
    for name, time in found.items():
        print(f"numba loop, {name:<36}{time:8.3g} ns")


if __name__ == "__main__":
    main()
