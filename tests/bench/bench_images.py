# SPDX-License-Identifier: BSD-3-Clause
"""`nanotouch.images` beside scipy, SurfaceTopography and pySPM on 1024 x 1024 pixels, in one run.

Speeds first, each with what the results differ by, then what every row alignment leaves of a grating. pySPM is an
optional dependency of this bench. Run: pip install pySPM; OMP_NUM_THREADS=1 python bench_images.py
"""

from __future__ import annotations

import importlib
import time
import tracemalloc
import warnings
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
from nanotouch import Surface, images
from scipy import ndimage

N, PIXEL, REACH = 1024, 1e-9, 16
Work = Callable[[], Any]


def module(name: str) -> Any:
    """A peer, or None where it is not installed."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


ST, PYSPM = module("SurfaceTopography"), module("pySPM.SPM")


def least(*works: Work, rounds: int = 7) -> list[tuple[float, float]]:
    """Shortest wall and processor time of each [ms], measured in turns, so that a busy machine is fair to all."""
    best = [(np.inf, np.inf)] * len(works)
    for _ in range(rounds):
        for k, work in enumerate(works):
            wall, cpu = time.perf_counter(), time.process_time()
            work()
            spent = time.perf_counter() - wall, time.process_time() - cpu
            best[k] = (min(best[k][0], 1e3 * spent[0]), min(best[k][1], 1e3 * spent[1]))
    return best


def compare(title: str, ours: Work, peers: dict[str, Work], rounds: int = 7) -> None:
    """One line per peer: both times, wall and processor, and their ratios."""
    times = least(ours, *peers.values(), rounds=rounds)
    if not peers:
        print(f"{title:<36}{times[0][0]:9.1f}{times[0][1]:9.1f}")
    for (name, _), (wall, cpu) in zip(peers.items(), times[1:], strict=True):
        ratios = f"{wall / times[0][0]:8.1f}{cpu / times[0][1]:8.1f}"
        print(f"{title:<36}{times[0][0]:9.1f}{times[0][1]:9.1f}  {name:<34}{wall:9.1f}{cpu:9.1f}{ratios}")


def film(seed: int = 3) -> images.Topography:
    """A rough film on a slope with offsets from row to row."""
    rng = np.random.default_rng(seed)
    rough = cv2.GaussianBlur(rng.standard_normal((N, N)), (0, 0), 2.0) * 10e-9 + 0.2e-9 * rng.standard_normal((N, N))
    slope = np.add.outer(2e-8 * np.linspace(0, 1, N), 5e-8 * np.linspace(0, 1, N))
    return images.Topography(rough + slope + 1e-9 * rng.standard_normal((N, 1)), (PIXEL, PIXEL))


def scarred(count: int, seed: int = 4) -> images.Topography:
    """The same level, with scars of one to three rows."""
    rng = np.random.default_rng(seed)
    z = np.array(images.level(film(seed), "plane+rows")[0].heights)
    for _ in range(count):
        j, i, rows = rng.integers(2, N - 5), rng.integers(0, N - 200), rng.integers(1, 4)
        z[j : j + rows, i : i + rng.integers(30, 200)] += rng.choice([-1, 1]) * 40e-9
    return images.Topography(z, (PIXEL, PIXEL))


def peer_of(topography: images.Topography) -> Any:
    return ST.Topography(topography.heights.T, (N * PIXEL, N * PIXEL), unit="m")


def levelling() -> None:
    image = film()
    peers: dict[str, Work] = {}
    if ST is not None:
        peer = peer_of(image)
        peers["SurfaceTopography plane, degree 0"] = lambda: peer.detrend("height").scan_line_align(degree=0).heights()
        peers["SurfaceTopography plane, degree 1"] = lambda: peer.detrend("height").scan_line_align().heights()
    compare("level plane+rows", lambda: images.level(image, "plane+rows"), peers)
    if ST is not None:
        plane: dict[str, Work] = {"SurfaceTopography plane": lambda: peer.detrend("height").heights()}
        compare("level plane", lambda: images.level(image, "plane"), plane)
        theirs = peer.detrend("height").scan_line_align(degree=0).heights().T
        off = images.level(image, "plane+rows")[0].heights - theirs
        print(f"{'':4}difference {off.std() * 1e9:.2g} nm rms of {theirs.std() * 1e9:.3g} nm (offsets were 1 nm rms)")
    if PYSPM is not None:
        flat = image.heights.copy()

        def plane_and_lines() -> None:
            PYSPM.SPM_image(flat.copy(), real={"x": 1, "y": 1, "unit": "um"}).correct_plane().correct_lines()

        compare("level plane+rows", lambda: images.level(image, "plane+rows"), {"pySPM plane, lines": plane_and_lines})
    compare("level poly2+rows", lambda: images.level(image, "poly2+rows"), {})


def scars() -> None:
    for count in (0, 20, 200):
        image = scarred(count)
        peers: dict[str, Work] = {}
        if PYSPM is not None:
            spm = PYSPM.SPM_image(image.heights.copy(), real={"x": 1, "y": 1, "unit": "um"})
            peers["pySPM filter_scars_removal"] = lambda s=spm: s.filter_scars_removal(inline=False)  # type: ignore[misc]
        compare(f"repair_scars, {count} scars", lambda i=image: images.repair_scars(i), peers)  # type: ignore[misc]
        print(f"{'':4}{images.repair_scars(image)[1]}")


def tips() -> None:
    z = np.random.default_rng(3).random((N, N)) * 10e-9
    image = images.Topography(z, (PIXEL, PIXEL))
    tip = images.Paraboloid((REACH * PIXEL) ** 2 / (2 * image.height_range))
    k = np.arange(-REACH, REACH + 1) * PIXEL
    raster = np.add.outer(k**2, k**2) / (2 * tip.radius)
    scipy: dict[str, Work] = {
        "scipy.ndimage.grey_dilation": lambda: ndimage.grey_dilation(
            z, structure=-raster, mode="constant", cval=-np.inf
        )
    }
    compare("dilate, paraboloid 33^2", lambda: images.dilate(image, tip), scipy, 3)
    compare("dilate, any tip 33^2", lambda: images.dilate(image, raster), scipy, 3)
    compare("dilate, rounded cone", lambda: images.dilate(image, images.RoundedCone(tip.radius, 0.3)), {}, 3)
    dilated = images.dilate(image, tip)
    compare("erode and certainty", lambda: images.erode(dilated, tip), {}, 3)
    part = images.Topography(images.dilate(film(), raster).heights[:256, :256], (PIXEL, PIXEL))
    compare("estimate_tip, 15^2, of 256^2", lambda: images.estimate_tip(part, 15), {}, 1)


def rest() -> None:
    image = images.level(film(), "plane+rows")[0]
    for name in ("despeckle", "grains", "roughness", "mip_levels"):
        compare(name, lambda name=name: getattr(images, name)(image), {}, 3)  # type: ignore[misc]
    compare("gaussian, 3 pixels", lambda: images.gaussian(image, 3 * PIXEL), {}, 3)
    big = images.Topography(np.random.default_rng(1).random((4096, 4096)) * 1e-9, (PIXEL, PIXEL))
    tracemalloc.start()
    start = time.perf_counter()
    surface = Surface(big)
    seconds = time.perf_counter() - start
    kept, most = tracemalloc.get_traced_memory()
    print(f"Surface of 4096 x 4096: {seconds:.2f} s, keeps {kept / big.heights.nbytes:.2f} and needs "
          f"{most / big.heights.nbytes:.2f} times the image's memory, size {surface.size[0] * 1e6:.3g} um")  # fmt: skip


def step_left(heights: np.ndarray[Any, Any], ridge: np.ndarray[Any, Any]) -> float:
    """Median of the ridges over that of the grooves [nm]."""
    return float(np.median(heights[ridge]) - np.median(heights[~ridge])) * 1e9


def gratings() -> None:
    """480 nm, 3 um period on 10 um, 0.3 nm of noise, 1 nm offsets of rows, a slope of 5 degrees."""
    rng = np.random.default_rng(5)
    x = (np.arange(N) + 0.5) * 10e-6 / N
    ridge = np.tile((x - 0.75e-6) % 3e-6 < 1.2e-6, (N, 1))
    print(f"{'step left of 480 nm':<36}{'lines across the rows':>22}{'along the rows':>16}")
    answers: dict[str, list[float]] = {}
    for lines in (ridge, ridge.T):
        z = np.where(lines, 480e-9, 0.0) + 0.3e-9 * rng.standard_normal((N, N)) + 1e-9 * rng.standard_normal((N, 1))
        z = z + np.add.outer(0.05 * x, 0.07 * x)
        ways: dict[str, Work] = {}
        for method in ("plane", "plane+rows", "plane+medians"):
            image = images.Topography(z, (x[1] - x[0], x[1] - x[0]))
            ways[f"ours, {method}"] = lambda m=method, i=image: images.level(i, m)[0].heights  # type: ignore[misc]
        if ST is not None:
            peer = ST.Topography(z.T, (10e-6, 10e-6), unit="m")
            ways["SurfaceTopography plane"] = lambda p=peer: p.detrend("height").heights().T  # type: ignore[misc]
            aligned = peer.detrend("height").scan_line_align(degree=0)
            ways["SurfaceTopography plane, degree 0"] = lambda a=aligned: a.heights().T  # type: ignore[misc]
        if PYSPM is not None:
            spm = PYSPM.SPM_image(z.copy(), real={"x": 1, "y": 1, "unit": "um"}).correct_plane().correct_lines()
            ways["pySPM plane, lines"] = lambda s=spm: s.pixels  # type: ignore[misc]
        for name, way in ways.items():
            answers.setdefault(name, []).append(step_left(np.asarray(way()), lines))
    for name, (across, along) in answers.items():
        print(f"{name:<36}{across:22.2f}{along:16.2f}")


def main() -> None:
    """Print everything."""
    warnings.simplefilter("ignore")
    missing = [name for name, peer in (("SurfaceTopography", ST), ("pySPM", PYSPM)) if peer is None]
    if missing:
        print(f"not installed, left out: {', '.join(missing)}")
    print(f"{'1024 x 1024 [ms]':<36}{'wall':>9}{'cpu':>9}  {'peer':<34}{'wall':>9}{'cpu':>9}{'ratio':>8}{'of cpu':>8}")
    for part in (levelling, scars, tips, rest, gratings):
        part()


if __name__ == "__main__":
    main()
