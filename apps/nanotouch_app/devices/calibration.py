# SPDX-License-Identifier: BSD-3-Clause
"""What a guided calibration has found of a haptic device, in a file of its own: where its middle is, how its axes lie,
what it weighs, and from which force on a hand feels anything."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from nanotouch.errors import InvalidValue

NOTHING = (0.0, 0.0, 0.0)
Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Calibration:
    """In the axes in which the device's module reports: right, away, down."""

    centre: Vector = NOTHING
    """that becomes the origin; 0 along an axis that it has not [m]"""
    axes: tuple[Vector, Vector, Vector] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    """where right, away and down lie: unit vectors"""
    weight: Vector = NOTHING
    """the force that keeps the free handle where it is [N]"""
    friction: float = 0.0
    """a smaller force does not move the handle: it is shown, not compensated, for what does would push by itself [N]"""
    noise: float = 0.0
    """standard deviation of a place at rest [m]"""

    def place(self, position: Sequence[float]) -> Vector:
        """Of the hand, from what the device reports [m]."""
        given = np.asarray(position) - self.centre
        is_missing = np.isnan(given)
        x, y, z = np.asarray(self.axes) @ np.where(is_missing, 0.0, given)
        return tuple(math.nan if gone else float(v) for gone, v in zip(is_missing, (x, y, z), strict=True))  # type: ignore[return-value]

    def force(self, wanted: Sequence[float]) -> Vector:
        """For the device, from what the hand is to feel [N]: its weight is carried."""
        x, y, z = np.asarray(self.axes).T @ np.asarray(wanted) + self.weight
        return float(x), float(y), float(z)


def path_of(device: str) -> Path:
    """Where the calibration of a device is kept."""
    folder = Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config")
    return folder / "nanotouch" / "hands" / f"{device}.json"


def write(path: Path, found: Calibration) -> None:
    """Keep it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(asdict(found), indent=1) + "\n", encoding="utf-8")


def read(path: Path) -> Calibration:
    """What was kept; a file that holds something else is refused."""
    try:
        given = json.loads(path.read_text(encoding="utf-8"))
        rows = [tuple(map(float, row)) for row in given["axes"]]
        found = Calibration(tuple(map(float, given["centre"])), tuple(rows), tuple(map(float, given["weight"])),  # type: ignore[arg-type]
                            float(given["friction"]), float(given["noise"]))  # fmt: skip
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise InvalidValue(f"{path} is no calibration of a hand ({error}): calibrate again, or remove it") from error
    axes, numbers = np.asarray(found.axes), (*found.centre, *found.weight, found.friction, found.noise)
    if axes.shape != (3, 3) or len(numbers) != 8 or not all(map(math.isfinite, numbers)):
        raise InvalidValue(f"{path} is no calibration of a hand: calibrate again, or remove it")
    if not np.allclose(axes @ axes.T, np.eye(3), atol=1e-6):
        raise InvalidValue(f"{path}: its axes are not perpendicular: calibrate again, or remove it")
    return found
