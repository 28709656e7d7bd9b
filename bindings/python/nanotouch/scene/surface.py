# SPDX-License-Identifier: BSD-3-Clause
"""The surface that is touched: any Topography, dilated by the tip and made C2; and the built-in samples."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, as_floats, check_between, plain
from nanotouch.errors import InvalidValue
from nanotouch.images import Topography, ValueMap
from nanotouch.images.tips import rounded_cone
from nanotouch.scene import _properties
from nanotouch.scene._properties import on_pixels
from nanotouch.units import in_words

if TYPE_CHECKING:
    from nanotouch.scene import Scene


class Surface:
    """A touchable surface: where the apex of a tip stands at first touch, interpolated by cubic B-splines.

    Parameters
    ----------
    topography : Topography or ndarray (ny, nx)
        Heights [m], row 0 at y = 0; of an array ``pixel_size`` [m] has to be given, too: one length, or (dy, dx).
    tip_radius : float, optional
        R of the tip [m]; with ``tip_half_angle`` [rad] the heights are dilated by the tip (sphere into cone). Without
        it the heights are taken as they are.
    youngs_modulus, work_of_adhesion : ndarray (ny, nx) or images.ValueMap, optional
        E of the sample [Pa] and w [J/m^2] at each pixel, in place of the scene's, from a force map
        (:func:`nanotouch.maps.to_surface`), a channel of an image (:func:`nanotouch.images.read_values`) or drawn.
        Between the pixels they are as smooth as the heights and never
        outside their range; w is nowhere below a thousandth of its largest value.
    """

    def __init__(
        self,
        topography: Topography | ArrayLike,
        tip_radius: float | None = None,
        tip_half_angle: float = 0.3,
        *,
        pixel_size: float | tuple[float, float] | None = None,
        youngs_modulus: ArrayLike | ValueMap | None = None,
        work_of_adhesion: ArrayLike | ValueMap | None = None,
    ) -> None:
        topography = as_topography(topography, pixel_size)
        dy, dx = topography.pixel_size
        heights = _wider(topography.heights)
        if tip_radius is not None:
            heights = _core.dilate(heights, dy, dx, tip_radius, tip_half_angle)
        self.topography = topography
        self.tip_radius = tip_radius
        self.tip_half_angle = tip_half_angle
        self.core = _core.Surface(heights, dy, dx, overwrite=True)  # `heights` is nobody else's
        self.youngs_modulus = (
            None if youngs_modulus is None else on_pixels("youngs_modulus", youngs_modulus, topography)
        )
        self.work_of_adhesion = (
            None if work_of_adhesion is None else on_pixels("work_of_adhesion", work_of_adhesion, topography)
        )
        self.origin: dict[str, Any] | None = None
        """what files it was read from, by :class:`nanotouch.scene.surface_file.SurfaceFile`"""
        self.notes: tuple[str, ...] = ()
        """what reading its properties found"""
        given = [None if one is None else _wider(one) for one in (self.youngs_modulus, self.work_of_adhesion)]
        is_made = any(one is not None for one in given)
        self._properties = _core.Properties(self.core, *given) if is_made else None

    @classmethod
    def touched_by(
        cls,
        scene: Scene,
        topography: Topography | ArrayLike,
        is_dilated: bool = False,
        *,
        pixel_size: float | tuple[float, float] | None = None,
        **properties: Any,
    ) -> Surface:
        """Dilated by the tip of a scene, as a session or a plan of that scene needs it, unless it has been dilated.

        ``properties`` are arrays (ny, nx) or :class:`~nanotouch.images.ValueMap`: ``youngs_modulus`` or
        ``effective_modulus`` [Pa], ``work_of_adhesion`` [J/m^2] or ``pull_off_force`` [N], which becomes the w with
        which the scene pulls off with it.
        """
        unknown = set(properties) - set(_properties.UNITS)
        if unknown:
            raise TypeError(f"a surface has no {min(unknown)!r}; it has {', '.join(_properties.UNITS)}")
        topography = as_topography(topography, pixel_size)
        made_of = _properties.for_scene(scene, topography, properties, _pull_off_of)
        tip = () if is_dilated else (scene.tip.radius, scene.tip.half_angle)
        return cls(topography, *tip, **made_of)  # type: ignore[arg-type]

    def __repr__(self) -> str:
        (ny, nx), (width, height) = self.topography.shape, self.size
        tip = "as it is" if self.tip_radius is None else f"dilated by a tip of {in_words(self.tip_radius, 'm', 3)}"
        own = [name for name in ("youngs_modulus", "work_of_adhesion") if getattr(self, name) is not None]
        places = "".join(f", {name} of each place" for name in own)
        return (
            f"Surface({nx} x {ny} pixels, {in_words(width, 'm', 4)} x {in_words(height, 'm', 4)}, heights over "
            f"{in_words(self.topography.height_range, 'm', 3)}, {tip}{places})"
        )

    def __reduce__(self) -> Any:
        made_of = self.topography, self.tip_radius, self.tip_half_angle, self.youngs_modulus, self.work_of_adhesion
        return _again, (*made_of, self.origin, self.notes)

    @property
    def parts(self) -> tuple[_core.Surface, _core.RadiusMap | None, _core.Properties | None]:
        """What a plan or a session borrows: heights, effective radii (where a tip has dilated them), properties."""
        return self.core, None if self.tip_radius is None else self.radius_map.core, self._properties

    def properties(self, x: ArrayLike, y: ArrayLike) -> Properties:
        """What the sample is made of over (x, y) [m], broadcast."""
        xs, ys = np.broadcast_arrays(as_floats(x, "x"), as_floats(y, "y"))
        if self._properties is None:
            return Properties(None, None)
        columns = self._properties.at(self.core, np.array(xs, order="C"), np.array(ys, order="C"))
        given = (self.youngs_modulus, self.work_of_adhesion)
        return Properties(*(None if of is None else plain(one) for of, one in zip(given, columns, strict=True)))

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


class Properties(NamedTuple):
    """What a sample is made of; arrays of the broadcast shape, or floats; None where it is as the scene says."""

    youngs_modulus: Any
    """E of the sample [Pa]"""
    work_of_adhesion: Any
    """w [J/m^2]"""


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

    def __init__(self, surface: Surface, minimum: float = 0.1, maximum: float = 3.0) -> None:
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


def spikes(
    size: float = 6e-6,
    pixels: int = 400,
    *,
    radius: float = 8e-9,
    height: float = 300e-9,
    half_angle: float = 0.436,
    pitch: float = 2.12e-6,
) -> Topography:
    """Spikes like the tip characteriser TGT1: a square array of cones of 50 degrees with apexes of ``radius`` [m].

    One of them stands in the middle of the scan. To measure a tip, take one of them alone: a size of 400 nm.
    """
    pixel = _pixel(size, pixels)
    check_between("radius", radius, "m", above=0.0, up_to=1e-3)
    check_between("height", height, "m", above=0.0, up_to=1e-3)
    check_between("half_angle", half_angle, "rad", above=0.0, up_to=1.5)
    check_between("pitch", pitch, "m", above=0.0, up_to=1e-3)
    along = np.arange(pixels) * pixel - 0.5 * size
    away = along - pitch * np.round(along / pitch)
    depth = rounded_cone(np.hypot(away[:, None], away), radius, half_angle)
    return Topography(heights=np.maximum(height - depth, 0.0), pixel_size=(pixel, pixel), name="spikes")


def spheres(
    size: float = 4.8e-6,
    pixels: int = 480,
    *,
    radius: float = 250e-9,
    centres: Sequence[tuple[float, float]] = ((1.2e-6, 2.4e-6), (3.6e-6, 1.2e-6), (3.4e-6, 3.8e-6)),
) -> Topography:
    """Spheres of one ``radius`` [m] that lie on a flat at ``centres`` [m], as latex on glass; seen from above."""
    pixel = _pixel(size, pixels)
    check_between("radius", radius, "m", above=0.0, up_to=1e-3)
    along = np.arange(pixels) * pixel
    heights = np.zeros((pixels, pixels))
    for x, y in centres:
        inside = radius**2 - ((along - x)[None, :] ** 2 + (along - y)[:, None] ** 2)
        heights = np.maximum(heights, np.where(inside > 0.0, radius + np.sqrt(np.maximum(inside, 0.0)), 0.0))
    return Topography(heights=heights, pixel_size=(pixel, pixel), name="spheres")


def flat(size: float = 6e-6, pixels: int = 64) -> Topography:
    """A flat at z = 0."""
    pixel = _pixel(size, pixels)
    return Topography(heights=np.zeros((pixels, pixels)), pixel_size=(pixel, pixel), name="flat")


def as_topography(heights: Topography | ArrayLike, pixel_size: float | tuple[float, float] | None) -> Topography:
    """A Topography as it is, or an array (ny, nx) [m] with the size of its pixels [m]: one length, or (dy, dx)."""
    if isinstance(heights, Topography):
        if pixel_size is not None:
            raise InvalidValue(f"pixel_size = {pixel_size}: a Topography has its own, {heights.pixel_size} m")
        return heights
    if pixel_size is None:
        raise InvalidValue(
            "pixel_size: an array of heights [m] needs the size of its pixels [m]: a length, or (dy, dx)"
        )
    size = np.atleast_1d(as_floats(pixel_size, "pixel_size"))
    if size.shape not in ((1,), (2,)):
        raise InvalidValue(f"pixel_size = {pixel_size}: valid is one length [m], or two, (dy, dx)")
    return Topography(as_floats(heights, "heights"), (float(size[0]), float(size[-1])))


def _wider(pixels: Floats) -> Floats:
    """With the last row and column once more: the extent is N pixels."""
    return np.pad(pixels, ((0, 1), (0, 1)), mode="edge")


def _again(
    topography: Topography,
    tip_radius: float | None,
    tip_half_angle: float,
    youngs_modulus: Floats | None,
    work_of_adhesion: Floats | None,
    origin: dict[str, Any] | None,
    notes: tuple[str, ...],
) -> Surface:
    made = Surface(
        topography, tip_radius, tip_half_angle, youngs_modulus=youngs_modulus, work_of_adhesion=work_of_adhesion
    )
    made.origin, made.notes = origin, notes
    return made


def _pull_off_of(scene: Scene) -> _properties.PullOff:
    """Of plans over a level surface of one w and E."""
    level = Topography(np.zeros((4, 4)), (1e-9, 1e-9))

    def pull_off(work: float, modulus: float | None) -> float:
        made_of = {"work_of_adhesion": work, "youngs_modulus": modulus}
        given = {name: np.full((4, 4), value) for name, value in made_of.items() if value is not None}
        surface = Surface(level, **given)  # type: ignore[arg-type]
        return scene.plan(bound="exact", surface=surface).pull_off_force

    return pull_off


def _pixel(size: float, pixels: int) -> float:
    check_between("size", size, "m", above=0.0, up_to=1e-3)
    if not 4 <= pixels <= 16384:
        raise InvalidValue(f"pixels = {pixels}: valid is 4 .. 16384")
    return size / pixels
