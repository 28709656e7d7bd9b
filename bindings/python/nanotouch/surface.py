# SPDX-License-Identifier: BSD-3-Clause
"""The surface that is touched: any Topography, dilated by the tip and made C2; and the built-in samples."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import as_floats, check_between, plain
from nanotouch.errors import InvalidValue
from nanotouch.images import Topography

if TYPE_CHECKING:
    from nanotouch.scene import Scene


class Surface:
    """A touchable surface: where the apex of a tip stands at first touch, interpolated by cubic B-splines.

    Parameters
    ----------
    topography : Topography
        Heights (ny, nx) [m], row 0 at y = 0.
    tip_radius : float, optional
        R of the tip [m]; with ``tip_half_angle`` [rad] the heights are dilated by the tip (sphere into cone). Without
        it the heights are taken as they are.
    """

    def __init__(self, topography: Topography, tip_radius: float | None = None, tip_half_angle: float = 0.3) -> None:
        dy, dx = topography.pixel_size
        heights = np.pad(topography.heights, ((0, 1), (0, 1)), mode="edge")
        if tip_radius is not None:
            heights = _core.dilate(heights, dy, dx, tip_radius, tip_half_angle)
        self.topography = topography
        self.tip_radius = tip_radius
        self.tip_half_angle = tip_half_angle
        self.core = _core.Surface(heights, dy, dx, overwrite=True)  # `heights` is nobody else's

    @classmethod
    def touched_by(cls, scene: Scene, topography: Topography) -> Surface:
        """Dilated by the tip of a scene, as a session or a plan of that scene needs it."""
        return cls(topography, scene.tip.radius, scene.tip.half_angle)

    def __reduce__(self) -> Any:
        return type(self), (self.topography, self.tip_radius, self.tip_half_angle)

    @property
    def size(self) -> tuple[float, float]:
        """Extent (x, y) that can be touched [m]: the scan size; beyond its middle the last pixel goes on level."""
        height, width = self.topography.size
        return width, height

    def height(self, x: ArrayLike, y: ArrayLike) -> Any:
        """Height [m] of the apex at first touch over (x, y) [m], broadcast."""
        xs, ys = np.broadcast_arrays(as_floats(x, "x"), as_floats(y, "y"))
        return plain(self.core.heights(np.array(xs, order="C"), np.array(ys, order="C")))

    @cached_property
    def radius_map(self) -> RadiusMap:
        """Effective radius of the contact over the surface, made at first use."""
        return RadiusMap(self)


class Radii(NamedTuple):
    """Effective radius and its slopes; arrays of the broadcast shape, or floats."""

    radius: Any
    """[m]"""
    dx: Any
    """dR/dx [-]"""
    dy: Any
    """dR/dy [-]"""


class RadiusMap:
    """The effective radius of the contact over a dilated surface: less than the tip's on a bump, more in a hollow.

    Parameters
    ----------
    surface : Surface
        Dilated by a tip.
    minimum, maximum : float
        Limits of the ratio of effective to tip radius: an edge that is sharper than a pixel has none.
    """

    def __init__(self, surface: Surface, minimum: float = 0.1, maximum: float = 10.0) -> None:
        if surface.tip_radius is None:
            raise InvalidValue("a radius map needs a surface that was dilated by a tip: give it a tip_radius [m]")
        self.core = _core.RadiusMap(surface.core, surface.tip_radius, minimum, maximum)

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and largest effective radius anywhere [m]."""
        return self.core.minimum, self.core.maximum

    @property
    def limited(self) -> int:
        """Pixels whose ratio was beyond the limits."""
        return self.core.limited

    def radius(self, x: ArrayLike, y: ArrayLike) -> Radii:
        """Effective radius [m] and its slopes over (x, y) [m], broadcast."""
        xs, ys = np.broadcast_arrays(as_floats(x, "x"), as_floats(y, "y"))
        columns = self.core.radii(np.array(xs, order="C"), np.array(ys, order="C"))
        return Radii(*(plain(column) for column in columns))


def grating(
    size: float = 6e-6,
    pixels: int = 512,
    *,
    period: float = 3e-6,
    height: float = 480e-9,
    duty: float = 0.5,
    offset: float = 0.75e-6,
) -> Topography:
    """A square grating like TGZ-03 (lines along y, 3 um period, 480 nm), sampled on pixels x pixels of ``size`` [m]."""
    pixel = _pixel(size, pixels)
    check_between("period", period, "m", above=0.0, up_to=1e-3)
    check_between("height", height, "m", above=0.0, up_to=1e-3)
    check_between("duty", duty, "", above=0.0, up_to=1.0)
    heights = _core.grating(pixels, pixels, pixel, pixel, period, height, duty, offset)
    return Topography(heights=heights, pixel_size=(pixel, pixel), name="grating")


def dots(size: float = 500e-9, pixels: int = 512, *, count: int = 24, seed: int = 1) -> Topography:
    """Quantum dots of 10 to 30 nm on a flat, as in the paper's second sample; the same for the same seed."""
    pixel = _pixel(size, pixels)
    heights = _core.dots(pixels, pixels, pixel, pixel, count, size, seed)
    return Topography(heights=heights, pixel_size=(pixel, pixel), name="quantum dots")


def flat(size: float = 6e-6, pixels: int = 64) -> Topography:
    """A flat at z = 0."""
    pixel = _pixel(size, pixels)
    return Topography(heights=np.zeros((pixels, pixels)), pixel_size=(pixel, pixel), name="flat")


def _pixel(size: float, pixels: int) -> float:
    check_between("size", size, "m", above=0.0, up_to=1e-3)
    if not 4 <= pixels <= 16384:
        raise InvalidValue(f"pixels = {pixels}: valid is 4 .. 16384")
    return size / pixels
