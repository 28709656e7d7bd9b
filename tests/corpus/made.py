# SPDX-License-Identifier: BSD-3-Clause
"""Truth of a generated file, and what all writers share: surfaces, force curves, random choices.

A writer is a function ``write(random, folder, plain=False) -> Made``, `plain` for the everyday variant. It follows the
maker's documentation or the header of a real file, and knows nothing of our readers. All values are SI; row 0 of an
image is its lower edge; z grows away from the sample; the truth is computed from the numbers that are stored, so that
rounding is part of it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Random = np.random.Generator


@dataclass(frozen=True)
class Plane:
    """One channel of heights that the file holds; NaN where nothing was measured."""

    name: str
    heights: Array  # [m]
    pixel: tuple[float, float]  # (dy, dx) [m]
    trace: bool | None = None  # None: the file does not tell
    free: bool = False  # heights are known up to a constant


@dataclass(frozen=True)
class Image:
    """What an image file holds."""

    defaults: tuple[Plane, ...]  # those that may be taken without being asked: the best, more where they are equal
    others: tuple[Plane, ...] = ()


@dataclass(frozen=True)
class Part:
    """One segment of a curve; a quantity that the file does not tell is None."""

    role: str  # approach, pause, retract
    z: Array  # [m]
    deflection: Array | None  # [m], + away from the sample
    force: Array | None  # [N], + repulsive
    duration: float | None = None  # [s]


@dataclass(frozen=True)
class Curve:
    parts: tuple[Part, ...]
    spring_constant: float | None  # [N/m]
    sensitivity: float | None  # [m/V]
    setpoint: float | None = None  # [N]; hangs on k and s
    place: tuple[int, int] | None = None  # (x, y) in a map
    free_z: bool = True  # z is known up to a constant
    cycle: bool = False  # one period, which may begin anywhere


@dataclass(frozen=True)
class Curves:
    curves: tuple[Curve, ...]
    missing: tuple[tuple[int, int], ...] = ()  # places of a map without a curve


@dataclass(frozen=True)
class Made:
    """One file: what it holds and how a reader may answer."""

    format: str
    path: Path
    variant: Mapping[str, Any]  # the choices that were made, for the report
    truth: Image | Curves
    given: Mapping[str, Any] = field(default_factory=dict)  # not in the file: has to be asked for
    told: tuple[tuple[str, ...], ...] = ()  # for each: one of these words has to stand in a note
    may_refuse: str = ""  # why a refusal is as right as reading
    must_refuse: str = ""  # why reading would be wrong


Writer = Callable[..., Made]


def chosen(random: Random, grid: Mapping[str, Sequence[Any]], plain: bool) -> dict[str, Any]:
    """One of each; the first of a row, which is the everyday one, in half of the files or, if `plain`, in all."""
    return {
        name: row[0] if plain or random.random() < 0.5 else row[int(random.integers(len(row)))]
        for name, row in grid.items()
    }


def surface(random: Random, shape: tuple[int, int], height: float) -> Array:
    """A surface that no flip, turn or transposition leaves as it is, heights over `height` [m]."""
    ny, nx = shape
    y, x = np.mgrid[0:ny, 0:nx]
    found = 0.6 * x / nx + 0.25 * (y / ny) ** 2 + 0.15 * random.standard_normal(shape)
    for _ in range(3):
        j, i, width = random.integers(ny), random.integers(nx), 1 + 0.15 * min(ny, nx)
        found = found + random.uniform(0.5, 1.5) * np.exp(-((y - j) ** 2 + (x - i) ** 2) / width**2)
    found = found - found.min()
    return np.asarray(height * (found / found.max() - 0.3))


def relief(random: Random, side: float) -> float:
    """Range of heights [m] that a scan of this side may show."""
    return float(max(side * 10 ** random.uniform(-2.5, -0.2), 2e-11))


def shape(random: Random) -> tuple[int, int]:
    ny, nx = (int(n) for n in random.integers(8, 41, 2))
    return ny, nx


@dataclass(frozen=True)
class Lever:
    spring_constant: float
    sensitivity: float


def lever(random: Random) -> Lever:
    """Numbers that nobody takes for placeholders."""
    k = float(f"{10 ** random.uniform(-1.7, 1.0):.4g}")
    s = float(f"{10 ** random.uniform(-7.8, -7.0):.4g}")
    return Lever(k, s)


def motion(
    random: Random, lever: Lever, points: Sequence[tuple[str, int]], travel: float | None = None
) -> list[tuple[str, Array, Array]]:
    """(role, z, deflection) of each segment over an elastic sample, z away from it, contact at z = 0.

    Roles are ``approach``, ``retract``, ``pause`` (constant height) and ``hold`` (constant force, while the sample
    creeps).
    """
    travel = travel or float(random.uniform(0.4e-6, 4e-6))
    deepest = -min(float(random.uniform(0.15, 0.4)) * travel, 8 * lever.sensitivity)  # detectors end at 10 V
    top = travel + deepest
    stiff = 10 ** float(random.uniform(-0.5, 0.7)) * lever.spring_constant
    noise = min(0.002 * travel, 0.2 * lever.sensitivity)
    approaches = [i for i, (role, _) in enumerate(points) if role == "approach"]
    found, z = [], top
    rest_of_detector = float(random.choice((-1, 1)) * random.uniform(0.05, 0.5)) * lever.sensitivity
    for number, (role, n) in enumerate(points):
        if role == "approach":
            later = sum(i > number for i in approaches)
            end = deepest + 0.3 * travel * later
            heights = np.linspace(z, end, n)
        elif role == "retract":
            last = not any(other == "retract" for other, _ in points[number + 1 :])
            heights = np.linspace(z, top if last else z + 0.3 * travel, n)
        elif role == "hold":
            creep = min(0.04 * travel, 0.5 * lever.sensitivity)
            heights = z - creep * (1 - np.exp(-np.linspace(0, 3, n)))
        else:
            heights = np.full(n, z)
        held = np.full(n, z) if role == "hold" else heights  # at constant force
        bend = _bend(held, lever, stiff)
        if role == "retract":
            bend = bend - 0.02 * travel * np.exp(-(((heights - 0.05 * travel) / (0.03 * travel)) ** 2))
        bend = bend + rest_of_detector + noise * random.standard_normal(n)
        found.append(("pause" if role in ("hold", "pause") else role, heights, bend))
        z = float(heights[-1])
    return found


def _bend(z: Array, lever: Lever, stiff: float) -> Array:
    """Deflection over a linear sample: k d = stiff (-z - d)."""
    return np.asarray(np.clip(-z, 0, None) * stiff / (stiff + lever.spring_constant))


def pressed(random: Random, lever: Lever, z: Array, contact: float) -> Array:
    """Deflection over an elastic sample that is met at z = `contact` [m], with noise."""
    stiff = 10 ** float(random.uniform(-0.5, 0.7)) * lever.spring_constant
    bend = np.minimum(_bend(z - contact, lever, stiff), 8 * lever.sensitivity)
    noise = min(0.004 * np.ptp(z), 0.2 * lever.sensitivity)
    return np.asarray(bend + 0.2 * lever.sensitivity + noise * random.standard_normal(len(z)))
