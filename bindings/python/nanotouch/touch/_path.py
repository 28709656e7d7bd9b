# SPDX-License-Identifier: BSD-3-Clause
"""Where the tip goes: checked paths over a surface."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, get_args

from nanotouch.errors import InvalidValue

if TYPE_CHECKING:
    from nanotouch.scene.surface import Surface

Mode = Literal["point", "scan", "topography", "approach", "curve", "tapping"]
MODES: tuple[Mode, ...] = get_args(Mode)
STANDING: tuple[Mode, ...] = ("point", "approach", "curve")
"""modes that stay at one place"""

Point = tuple[float, float]


def core_mode(mode: Mode) -> str:
    """The touch step's name for it: points and paths are both touched."""
    return "touch" if mode in ("point", "scan") else mode


def check_inside(surface: Surface | None, x: float, y: float, what: str) -> None:
    """Raise :class:`~nanotouch.errors.InvalidValue` for a place outside the surface."""
    if surface is None:
        return
    width, height = surface.size
    if not (0.0 <= x <= width and 0.0 <= y <= height):
        raise InvalidValue(
            f"{what}: ({x * 1e6:.6g} um, {y * 1e6:.6g} um) is outside the surface; "
            f"valid is x 0 .. {width * 1e6:.6g} um, y 0 .. {height * 1e6:.6g} um"
        )


def checked_path(mode: Mode, path: Sequence[Point] | None, surface: Surface | None) -> list[Point]:
    """The points of a path [m] that suits the mode; by default the middle of the surface or a line across it."""
    if path is None:
        path = _default_path(mode, surface)
    points = [(float(x), float(y)) for x, y in path]
    if mode in STANDING and len(points) != 1:
        raise InvalidValue(f"mode {mode!r} takes one point as its path, not {len(points)}")
    if mode not in STANDING and len(points) < 2:
        raise InvalidValue(f"mode {mode!r} needs at least two points in its path, not {len(points)}")
    for x, y in points:
        if not (math.isfinite(x) and math.isfinite(y)):
            raise InvalidValue(f"path: ({x} m, {y} m) is not finite")
        check_inside(surface, x, y, "path")
    if mode not in STANDING and len(set(points)) == 1:
        raise InvalidValue(f"mode {mode!r} needs a path with a length; all its points are the same")
    return points


def _default_path(mode: Mode, surface: Surface | None) -> list[Point]:
    width, height = surface.size if surface is not None else (1e-6, 0.0)
    if mode in STANDING:
        return [(0.5 * width, 0.5 * height)]
    return [(0.02 * width, 0.5 * height), (0.98 * width, 0.5 * height)]
