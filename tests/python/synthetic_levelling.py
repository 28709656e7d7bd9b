# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces that are known, and what a scan adds to them: tilt, bow, drift, offsets of rows, noise.

Heights in metres, row 0 at the bottom; rows are the fast axis.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

Array = NDArray[np.float64]
Rng = np.random.Generator
NM = 1e-9


def _rough(rng: Rng, n: int, rms: float, length: float) -> Array:
    film = ndimage.gaussian_filter(rng.standard_normal((n, n)), length, mode="wrap")
    return film * (rms / film.std())


def _grid(n: int) -> tuple[Array, Array]:
    y, x = np.meshgrid(np.arange(n, dtype=float), np.arange(n, dtype=float), indexing="ij")
    return y, x


def _grating(n: int, period: float, duty: float, angle: float, height: float = 480 * NM, width: float = 1.5) -> Array:
    """Lines at `angle` [rad] from the fast axis, walls `width` pixels wide."""
    y, x = _grid(n)
    across = y * np.cos(angle) - x * np.sin(angle) + 0.3 * period
    phase = (across / period) % 1.0
    ridge = (phase < duty).astype(float)
    return height * (
        ndimage.gaussian_filter1d(ridge, width, axis=0, mode="nearest")
        if abs(angle) < 0.8
        else ndimage.gaussian_filter1d(ridge, width, axis=1, mode="nearest")
    )


def dna(rng: Rng, n: int) -> Array:
    z = _rough(rng, n, 0.08 * NM, 1.5)
    for _ in range(12):
        walk = np.cumsum(
            np.cumsum(0.15 * rng.standard_normal((2, 150)), axis=1) * 0.2 + rng.standard_normal((2, 1)) * 0.3, axis=1
        )
        j, i = (walk + rng.uniform(0, n, (2, 1))).astype(int) % n
        line = np.zeros((n, n))
        line[j, i] = 1.0
        z += 2 * NM * np.minimum(ndimage.gaussian_filter(line, 1.5) * 8, 1.0)
    return z


def particles(rng: Rng, n: int) -> Array:
    z, (y, x) = _rough(rng, n, 0.2 * NM, 2.0), _grid(n)
    for _ in range(40):
        r, cy, cx = rng.uniform(3, 12), *rng.uniform(0, n, 2)
        z = np.maximum(z, r * NM * np.sqrt(np.maximum(1 - ((y - cy) ** 2 + (x - cx) ** 2) / r**2, 0)))
    return z


def flakes(rng: Rng, n: int, share: float = 0.4) -> Array:
    film = ndimage.gaussian_filter(rng.standard_normal((n, n)), n / 12, mode="wrap")
    up = film > np.quantile(film, 1 - share)
    return 8 * NM * ndimage.gaussian_filter(up.astype(float), 1.0) + _rough(rng, n, 0.2 * NM, 2.0)


def pits(rng: Rng, n: int) -> Array:
    y, x = _grid(n)
    pitch = n / 8
    hole = np.hypot((y + 5) % pitch - pitch / 2, (x + 9) % pitch - pitch / 2) < 0.3 * pitch
    return -100 * NM * ndimage.gaussian_filter(hole.astype(float), 1.0) + _rough(rng, n, 0.3 * NM, 2.0)


def island(rng: Rng, n: int) -> Array:
    """One terrace over most of the image."""
    y, x = _grid(n)
    up = np.hypot(y - 0.5 * n, x - 0.55 * n) < 0.5 * n
    return 10 * NM * ndimage.gaussian_filter(up.astype(float), 1.0) + _rough(rng, n, 0.15 * NM, 2.0)


def diagonal_step(rng: Rng, n: int) -> Array:
    y, x = _grid(n)
    return 5 * NM * (y > 0.3 * n + 0.5 * x) + _rough(rng, n, 0.1 * NM, 2.0)


def step_along(rng: Rng, n: int) -> Array:
    """One step along the fast axis, over the whole width."""
    y, _ = _grid(n)
    return 20 * NM * (y > 0.4 * n) + _rough(rng, n, 0.15 * NM, 2.0)


def staircase(rng: Rng, n: int) -> Array:
    y, x = _grid(n)
    return 3 * NM * np.floor((y + 0.15 * x) / (n / 5)) + _rough(rng, n, 0.1 * NM, 2.0)


def wave(rng: Rng, n: int) -> Array:
    y, x = _grid(n)
    return 15 * NM * np.sin(2 * np.pi * (y + 0.3 * x) / (n / 4)) + _rough(rng, n, 0.3 * NM, 2.0)


def cell(rng: Rng, n: int) -> Array:
    y, x = _grid(n)
    dome = np.maximum(1 - ((y - 0.45 * n) / (0.33 * n)) ** 2 - ((x - 0.5 * n) / (0.4 * n)) ** 2, 0)
    return 3000 * NM * dome**0.7 + _rough(rng, n, 5 * NM, 4.0)


def atomic_terraces(rng: Rng, n: int) -> Array:
    """Ångström steps that meander from the left to the right."""
    y, x = _grid(n)
    bend = 0.06 * n * np.sin(2 * np.pi * x / n + rng.uniform(0, 6)) + 6 * _rough(rng, n, 1.0, 8.0)
    return 0.3 * NM * np.floor((y + bend) / (n / 6)) + _rough(rng, n, 0.03 * NM, 1.0)


def _lines(period: float, duty: float, angle: float, height: float = 480 * NM) -> Callable[[Rng, int], Array]:
    return lambda rng, n: _grating(n, period, duty, np.radians(angle), height) + _rough(rng, n, 0.3 * NM, 2.0)


SURFACES: dict[str, Callable[[Rng, int], Array]] = {
    "DNA": dna,
    "particles": particles,
    "flakes 40 %": flakes,
    "flakes 65 %": lambda rng, n: flakes(rng, n, 0.65),
    "pits": pits,
    "island": island,
    "diagonal step": diagonal_step,
    "step along": step_along,
    "staircase": staircase,
    "atomic terraces": atomic_terraces,
    "wave": wave,
    "cell": cell,
    "rough": lambda rng, n: _rough(rng, n, 3 * NM, 6.0),
    "rough, fine": lambda rng, n: _rough(rng, n, 1 * NM, 1.5),
    "grating across": _lines(60, 0.5, 90),
    "grating 20 degrees": _lines(60, 0.5, 20),
    "grating 3 degrees": _lines(60, 0.4, 3),
    "grating along 50 %": _lines(64, 0.5, 0),
    "grating along 30 %": _lines(75, 0.3, 0),
    "grating along, 12 rows": _lines(12, 0.5, 0),
    "shallow grating along": _lines(50, 0.5, 0, 5 * NM),
}


def scanned(z: Array, rng: Rng, *, offsets: float = 1 * NM, drift: float = 0.3 * NM, bow: float = 4 * NM,
            noise: float = 0.1 * NM, creep: float = 0.0) -> Array:  # fmt: skip
    """What a scanner makes of it: offsets (white) and drift (a random walk) of rows, a bow, a tilt, noise."""
    n = len(z)
    y, x = _grid(n)
    rows = offsets * rng.standard_normal(n) + drift * np.cumsum(rng.standard_normal(n))
    rows += creep * np.exp(-np.arange(n) / (0.1 * n))
    u, v = y / n - 0.5, x / n - 0.5
    curved = bow * 4 * (v**2 + 0.3 * u**2)
    return np.asarray(z + rows[:, None] + curved + 40 * NM * u - 60 * NM * v + noise * rng.standard_normal(z.shape))
