# SPDX-License-Identifier: BSD-3-Clause
"""Speed of `nanotouch.images` against scipy and SurfaceTopography on 1024 x 1024 pixels, in one run."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
import SurfaceTopography
from nanotouch import images
from scipy import ndimage

N, PIXEL, REACH = 1024, 1e-9, 16


def best(run: Callable[[], object], rounds: int = 3) -> float:
    """Shortest of a few runs [s]."""
    seconds = []
    for _ in range(rounds):
        start = time.perf_counter()
        run()
        seconds.append(time.perf_counter() - start)
    return min(seconds)


def main() -> None:
    z = np.random.default_rng(3).random((N, N)) * 10e-9
    topography = images.Topography(z, (PIXEL, PIXEL))
    tip = images.Paraboloid((REACH * PIXEL) ** 2 / (2 * topography.height_range))
    k = np.arange(-REACH, REACH + 1) * PIXEL
    structure = -(k[:, None] ** 2 + k**2) / (2 * tip.radius)
    ours = best(lambda: images.dilate(topography, tip))
    theirs = best(lambda: ndimage.grey_dilation(z, structure=structure, mode="constant", cval=-np.inf), 1)
    print(f"dilation by 33^2:   ours {1e3 * ours:7.1f} ms, scipy {1e3 * theirs:7.1f} ms, {theirs / ours:.1f} times")
    image = images.dilate(topography, tip)
    print(f"erosion, certainty: ours {1e3 * best(lambda: images.erode(image, tip)):7.1f} ms")
    peer = SurfaceTopography.Topography(z, (N * PIXEL, N * PIXEL), unit="m")
    ours = best(lambda: images.level(topography))
    theirs = best(lambda: peer.detrend("height").heights())
    print(f"plane levelling:    ours {1e3 * ours:7.1f} ms, SurfaceTopography {1e3 * theirs:7.1f} ms")


if __name__ == "__main__":
    main()
