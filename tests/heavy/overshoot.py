# SPDX-License-Identifier: BSD-3-Clause
"""Random scenes that are scanned in tapping mode or by phase feedback: is any tap of the scan harder than the bound
that the forecast tells (`any tap`, docs/scan.md)?

Resumable: ``--first SEED``. A violation prints the seed that makes the case again.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from collections import Counter
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import images, scan
from nanotouch.errors import Error

PIXELS, LINES, SAMPLES = 24, 4, 64
MOST_TICKS = 80_000


def relief(rng: np.random.Generator, size: float) -> images.Topography:
    """Waves, a rough surface, a step, or bumps."""
    x = np.arange(SAMPLES) / SAMPLES * size
    kind = rng.integers(4)
    if kind == 0:
        z = np.tile(10e-9 * rng.random() * np.cos(2.0 * np.pi * x / size * rng.integers(1, 4)), (SAMPLES, 1))
    elif kind == 1:
        k = np.hypot(*np.meshgrid(*[np.fft.fftfreq(SAMPLES, 1.0 / SAMPLES)] * 2))
        rough = np.fft.fft2(rng.normal(size=k.shape)) * np.exp(-((k / rng.uniform(3.0, 10.0)) ** 2))
        z = np.fft.ifft2(rough).real
        z *= rng.uniform(1e-9, 8e-9) / z.std()
    elif kind == 2:
        z = np.tile(rng.uniform(1e-9, 20e-9) * (x > size / 2), (SAMPLES, 1))
    else:
        bumps = rng.random((8, 3))
        away = [((x - cx * size) ** 2 + (x[:, None] - cy * size) ** 2) / (8e-9 + 32e-9 * r) ** 2 for cx, cy, r in bumps]
        z = rng.uniform(3e-9, 15e-9) * np.max(np.exp(-0.5 * np.array(away)), axis=0)
    return images.Topography(z, (x[1], x[1]))


def made_of(rng: np.random.Generator, scene: nt.Scene, shape: tuple[int, ...]) -> dict[str, Any]:
    """Two materials, with or without an edge between them: E apart by up to 100, w by up to 10."""
    across, along = np.meshgrid(*[np.arange(n) / n for n in shape], indexing="ij")
    share = 0.5 + 0.5 * np.sin(2.0 * np.pi * (rng.integers(1, 5) * along + rng.integers(0, 3) * across + rng.random()))
    share = np.round(share) if rng.random() < 0.5 else share
    modulus, work = scene["sample.youngs_modulus"], float(0.02 * 5.0 ** rng.random())
    most = float(np.clip(100.0 ** rng.uniform(-1.0, 1.0), 3e8 / modulus, 1.5e11 / modulus))
    given = {
        "youngs_modulus": modulus * most**share,
        "work_of_adhesion": work * float(10.0 ** rng.uniform(-0.5, 0.5)) ** share,
    }
    kind = rng.integers(3)
    return {name: values for i, (name, values) in enumerate(given.items()) if kind in (2, i)}


def scanned(seed: int, maps: bool = False) -> tuple[nt.Scanner, nt.Scene, nt.Surface]:
    """A scanner over a random surface, so fast that its loop lags by 2 to 100 % of the free amplitude."""
    rng = np.random.default_rng(seed)

    def between(low: float, high: float) -> float:
        return float(low * (high / low) ** rng.random())

    scene = nt.Scene(tip={"radius": between(3e-9, 30e-9)}, sample={"youngs_modulus": between(3e8, 1.5e11)})
    scene.medium.relative_humidity = float(rng.uniform(0.2, 0.7)) if rng.random() < 0.3 else 0.0
    if maps:  # a soft place of a map may deform under van der Waals' force, which no plan has
        scene.adhesion.hamaker_constant = 0.0
    ground = relief(rng, between(0.2e-6, 1e-6))
    surface = nt.Surface.touched_by(scene, ground, **(made_of(rng, scene, ground.heights.shape) if maps else {}))
    quality = between(30.0, 1000.0)
    probe: Any = {"spring_constant": between(2.0, 60.0), "quality": quality, "resonance": between(60e3, 400e3)}
    rig = nt.Rig(probe=probe, stage={"resonance": between(2e3, 40e3), "quality": between(1.0, 15.0)})
    A0 = between(5e-9, 60e-9)
    drive = nt.Drive(drive={"at": "base" if rng.random() < 0.5 else "tip", "free_amplitude": A0})
    loop: Any = {"mode": "phase" if rng.random() < 0.15 else "tapping", "set_amplitude": float(rng.uniform(0.3, 0.95)),
                 "set_phase": float(rng.uniform(0.3, 1.3))}  # fmt: skip
    loop["rate"] = min(50e3, max(20.0 * rig["stage.resonance"], rig["probe.resonance"] / math.sqrt(quality)))
    width, height = surface.size
    raster: Any = {"width": width, "height": height, "pixels": PIXELS, "lines": LINES, "line_rate": 1e-3}
    settings, plan = nt.Scan(zloop=loop, raster=raster), scene.plan(0.3, surface=surface)
    slow = nt.Scanner(plan, settings, rig, drive)
    slope = max(scan.steepest(slow, surface)[0], 1e-3)
    rate = slow.integral * between(0.02, 1.0) * A0 / slope / (2.0 * width)
    slowest = loop["rate"] * LINES / (MOST_TICKS / 8 if maps else MOST_TICKS)
    settings["raster.line_rate"] = min(max(rate, slowest), 0.25 * loop["rate"] / PIXELS)
    return nt.Scanner(plan, settings, rig, drive), scene, surface


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--maps", action="store_true", help="over maps of modulus and adhesion")
    wanted = parser.parse_args()
    kinds: Counter[str] = Counter()
    shares: list[float] = []
    broken, start = 0, time.monotonic()
    for seed in range(wanted.first, wanted.first + wanted.count):
        try:
            scanner, scene, surface = scanned(seed, wanted.maps)
            told = scan.peak_bounds(scanner, scene, surface)[0]
            image = scanner.run(seed)
        except Error as refusal:
            kinds[f"refused: {str(refusal)[:40]}"] += 1
            continue
        peak = float(max(channels.peak_force.max() for channels in (image.trace, image.retrace)))
        mode = str(scanner.scan.zloop.mode)
        if math.isinf(told):
            kinds[f"{mode}, no bound"] += 1
            continue
        kinds[mode] += 1
        shares.append(peak / told)
        if peak > told:
            broken += 1
            print(f"  VIOLATION: seed {seed}: {peak * 1e9:.4g} nN, told {told * 1e9:.4g} nN", flush=True)
        if (seed + 1) % 20 == 0:
            print(f"  to seed {seed}: {dict(kinds)}; reached over told: median {np.median(shares):.2g}, largest "
                  f"{max(shares):.2g}", flush=True)  # fmt: skip
    touched = [share for share in shares if share > 1e-3]
    print(f"{wanted.count} cases from seed {wanted.first} in {time.monotonic() - start:.0f} s: {dict(kinds)}")
    print(f"violations: {broken}; reached over told: median {np.median(shares):.2g}, of the {len(touched)} that touch "
          f"{np.median(touched):.2g}, largest {max(shares):.2g}")  # fmt: skip
    return broken


if __name__ == "__main__":
    sys.exit(1 if main() else 0)
