# SPDX-License-Identifier: BSD-3-Clause
"""Scan the tip characteriser with a known tip, and find the sum of the radii of tip and spike in the image: how far
off, and how often inside its interval of 95 %? Beside it what blind reconstruction alone says. Each seed has its own
noise and its own place of the spike between the pixels."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from functools import lru_cache

import nanotouch as nt
import numpy as np
from nanotouch import images

SPIKE = 8e-9
LIMIT = 0.1


@lru_cache
def plan_of(radius: float) -> nt.Plan:
    scene = nt.Scene(tip={"radius": radius}, medium={"relative_humidity": 0.0})
    return scene.plan(0.3, surface=nt.Surface.touched_by(scene, nt.surface.spikes(300e-9, 300, radius=SPIKE)))


def scanned(seed: int, radius: float, noise: float, pixels: int = 48, width: float = 70e-9) -> images.Topography:
    """An image of the spike in tapping mode, with `noise` [m] of the z loop's reading and of the height itself."""
    random = np.random.default_rng(seed)
    x, y = 150e-9 - 0.5 * width + random.uniform(-1.0, 1.0, 2) * width / pixels
    settings = nt.Scan(
        zloop={"noise": noise, "rate": 5e3},
        raster={"x": x, "y": y, "width": width, "height": width, "pixels": pixels, "lines": pixels, "line_rate": 0.5},
    )
    lever = nt.Rig(probe={"spring_constant": 40.0, "quality": 200.0, "resonance": 300e3})
    image = nt.Scanner(plan_of(radius), settings, lever).run(seed).topography()
    return replace(image, heights=image.heights + noise * random.standard_normal(image.shape))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--noisier", action="store_true", help="with 0.2 nm of noise, too")
    wanted = parser.parse_args()
    outside = 0
    for radius in (5e-9, 10e-9, 20e-9):
        for noise in (0.05e-9, 0.2e-9)[: 1 + wanted.noisier]:
            off, blunt, inside = [], [], 0
            for seed in range(wanted.seeds):
                image = scanned(seed, radius, noise)
                found, true = images.apex_radius(image), radius + SPIKE
                off.append(found.radius / true - 1.0)
                inside += found.low <= true <= found.high
                blunt.append(images.estimate_tip(image, 15).radius(3e-9) / true - 1.0)
            outside += int((np.abs(off) > LIMIT).sum())
            print(
                f"tip {radius * 1e9:.3g} nm, noise {noise * 1e9:.2g} nm: middle off by {100 * min(off):+.1f} .. "
                f"{100 * max(off):+.1f} %, {inside} of {wanted.seeds} inside; blind alone {100 * min(blunt):+.0f} .. "
                f"{100 * max(blunt):+.0f} %",
                flush=True,
            )
    print(f"off by more than {100 * LIMIT:.0f} %: {outside}")
    return outside


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
