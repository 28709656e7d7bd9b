# SPDX-License-Identifier: BSD-3-Clause
"""The picture of maps.md: ``python docs/pictures/maps.py``. A sample that is known, nine of its curves spoilt."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from nanotouch import maps

SIDE = 48


def main() -> None:
    """Write map.png beside this file."""
    y, x = np.mgrid[:SIDE, :SIDE] / SIDE
    modulus = np.where((x // 0.25 + y // 0.25) % 2 == 0, 2e8, 1e9)
    work = np.where((x - 0.65) ** 2 + (y - 0.35) ** 2 < 0.2**2, 0.04, 0.015)
    height = np.where(x + 2 * y > 1.6, 5e-9, 0.0)
    sample = maps.synthesize(
        modulus, work, height, radius=20e-9, spring_constant=1.0, noise=30e-12, points=1000, depth=20e-9, tilt=1e-4
    )
    sample.values[5:8, 40:43, 100] = np.nan
    data = maps.fit(sample, "maugis", radius=20e-9, cohesive_range=0.2e-9, progress=True)
    maps.draw(data, save=Path(__file__).with_name("map.png"))
    for name, truth in (("effective_modulus", modulus), ("work_of_adhesion", work)):
        pull = (data[name].values - truth) / data[f"{name}_sigma"].values
        print(f"{name}: (value - truth)/sigma has median {np.nanmedian(pull):.2f}, deviation {np.nanstd(pull):.2f}")


if __name__ == "__main__":
    main()
