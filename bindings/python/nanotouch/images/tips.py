# SPDX-License-Identifier: BSD-3-Clause
"""What the tip does to an image, and what can be undone of it (Villarrubia, J. Res. NIST 102, 425, 1997).

An image is the surface dilated by the tip: ``i(x) = max_p s(p) - t(p - x)``, t the height of the tip above its apex.
Eroding it, ``r(p) = min_x i(x) + t(p - x)``, gives the highest surface that would have given this image. The true one
lies below, and is the same wherever the tip at some place touches this one point only.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats, as_floats, check_between
from ..errors import InvalidValue
from .topography import Topography

_BLOCK = 64  # [pixel]; 64 columns of 1024 rows stay in the cache
_ROUNDING = 1e-12  # two touches closer than this part of the heights cannot be told apart


@dataclass(frozen=True)
class Paraboloid:
    """A tip ``r^2 / 2R``: the sphere of the contact laws, where it is exact and quick (separable).

    Attributes
    ----------
    radius : float
        R of the apex [m].
    """

    radius: float

    def __post_init__(self) -> None:
        check_between("radius", self.radius, "m", above=0.0, up_to=1e-3)


@dataclass(frozen=True)
class RoundedCone:
    """A sphere that runs tangentially into a cone.

    Attributes
    ----------
    radius : float
        R of the apex [m].
    half_angle : float
        psi of the cone [rad].
    """

    radius: float
    half_angle: float

    def __post_init__(self) -> None:
        check_between("radius", self.radius, "m", above=0.0, up_to=1e-3)
        check_between("half_angle", self.half_angle, "rad", above=0.0, up_to=1.5)


Tip = Paraboloid | RoundedCone | Floats
"""A shape, or an array of the tip's heights above its apex [m] on the image's pixels: both sides odd, apex (0) in the
middle, infinite where there is no tip."""


def dilate(topography: Topography, tip: Tip) -> Topography:
    """The image that `tip` takes of a surface; nothing outside the image counts.

    Parameters
    ----------
    topography : Topography
        The true surface.
    tip : Paraboloid, RoundedCone or ndarray of odd shape
        The tip, see :data:`Tip`.

    Returns
    -------
    Topography
        Heights of the apex at first touch [m], exact on the pixels.
    """
    z, (dy, dx) = topography.heights, topography.pixel_size
    if isinstance(tip, Paraboloid):
        heights = _paraboloid(_paraboloid(z.T, dx, tip.radius).T, dy, tip.radius)
    else:
        heights = dilated(z, _raster(tip, topography))
    return replace(topography, heights=heights)


def erode(topography: Topography, tip: Tip) -> tuple[Topography, NDArray[np.bool_]]:
    """The highest surface from which `tip` would have taken this image, and where it is the true one.

    Parameters
    ----------
    topography : Topography
        The image.
    tip : Paraboloid, RoundedCone or ndarray of odd shape
        The tip, see :data:`Tip`.

    Returns
    -------
    topography : Topography
        Upper bound of the true surface [m].
    certain : ndarray, shape (ny, nx), bool
        True where some position of the tip touches this pixel alone (so the true surface is there). Near the border
        the surface outside might have been touched instead; it is taken to be no higher than the highest pixel.
    """
    if isinstance(tip, Paraboloid | RoundedCone):
        mirrored = dilate(replace(topography, heights=-topography.heights), tip)
        heights = -mirrored.heights
    else:
        heights = eroded(topography.heights, _checked(tip))
    certain = _touched_alone(topography.heights, heights, _raster(tip, topography))
    return replace(topography, heights=heights), certain & ~topography.mask


def dilated(z: NDArray[Any], tip: Floats) -> NDArray[Any]:
    """``max_d z(x + d) - t(d)`` with any raster tip, in the precision of `z`; nothing outside counts.

    Block by block, the lowest pixels of the tip first: once the highest pixel around cannot lift the block's lowest any
    more, the rest cannot either.
    """
    (ky, kx), nx = (n // 2 for n in tip.shape), z.shape[1]
    padded = np.pad(z, ((ky, ky), (kx, kx)), constant_values=-np.inf)
    order = np.argsort(tip, axis=None, kind="stable")[: np.count_nonzero(np.isfinite(tip))]
    rows, columns = np.divmod(order, tip.shape[1])
    places = list(zip(tip.ravel()[order].tolist(), rows.tolist(), columns.tolist(), strict=True))
    out = z.copy()
    for first in range(0, len(z), _BLOCK):
        block = out[first : first + _BLOCK]
        around = padded[first : first + len(block) + 2 * ky]
        top, apex = around.max(), np.empty_like(block)
        for number, (height, j, i) in enumerate(places):
            if number % _BLOCK == 0 and top - height <= block.min():
                break
            np.subtract(around[j : j + len(block), i : i + nx], height, out=apex)
            np.maximum(block, apex, out=block)
    return out


def eroded(z: NDArray[Any], tip: Floats) -> NDArray[Any]:
    """``min_x z(x) + t(p - x)``: the dilation of the image turned over by the tip turned round."""
    return np.asarray(-dilated(-z, tip[::-1, ::-1]))


def rounded_cone(r: Floats, radius: float, half_angle: float) -> Floats:
    """How far from the apex the surface of a :class:`RoundedCone` is, along its axis, at distances r from it [m]."""
    tangent = radius * np.cos(half_angle)
    inside = np.minimum(r, tangent)
    sphere = inside**2 / (radius + np.sqrt(radius**2 - inside**2))
    return np.asarray(sphere + np.maximum(r - tangent, 0.0) / np.tan(half_angle))


def _checked(tip: Floats) -> Floats:
    heights = as_floats(tip, "tip")
    if heights.ndim != 2 or not all(n % 2 for n in heights.shape):
        raise InvalidValue(f"tip: shape {heights.shape}, expected two dimensions, both odd")
    if heights[heights.shape[0] // 2, heights.shape[1] // 2] != 0 or not (heights >= 0).all():
        raise InvalidValue("tip: expected heights above the apex: 0 in the middle, nowhere below [m]")
    return heights


def _paraboloid(z: Floats, pixel: float, radius: float) -> Floats:
    """Dilate along the first axis, in blocks of columns, as far as a block's range of heights can reach."""
    out = np.empty(z.shape)
    for first in range(0, z.shape[1], _BLOCK):
        block = np.ascontiguousarray(z[:, first : first + _BLOCK])
        highest, apex = block.copy(), np.empty_like(block)
        reach = np.sqrt(2.0 * radius * np.ptp(block)) / pixel
        for k in range(1, min(int(reach) + 1, len(block) - 1) + 1):
            np.subtract(block, (k * pixel) ** 2 / (2.0 * radius), out=apex)
            np.maximum(highest[:-k], apex[k:], out=highest[:-k])
            np.maximum(highest[k:], apex[:-k], out=highest[k:])
        out[:, first : first + _BLOCK] = highest
    return out


def _raster(tip: Tip, topography: Topography) -> Floats:
    """The tip's heights on the pixels [m], as far as the image's range of heights reaches."""
    if not isinstance(tip, Paraboloid | RoundedCone):
        return _checked(tip)
    height, radius = topography.height_range, tip.radius
    flank = height * np.tan(tip.half_angle) if isinstance(tip, RoundedCone) else 0.0
    reach = np.sqrt(2.0 * radius * height) + flank
    y, x = (
        np.arange(-k, k + 1) * d
        for n, d in zip(topography.shape, topography.pixel_size, strict=True)
        for k in [min(int(reach / d) + 1, n - 1)]
    )
    r = np.hypot(y[:, None], x)
    if isinstance(tip, Paraboloid):
        return np.asarray(r**2 / (2.0 * radius))
    return rounded_cone(r, radius, tip.half_angle)


def _touched_alone(image: Floats, surface: Floats, tip: Floats) -> NDArray[np.bool_]:
    """Where one position of the tip or more touches this pixel of `surface` and no other."""
    ky, kx = tip.shape[0] // 2, tip.shape[1] // 2
    # What lies outside is not known: it may be touched if it can be as high as the highest pixel.
    padded = np.pad(surface, ((ky, ky), (kx, kx)), constant_values=surface.max())
    certain = np.zeros(padded.shape, bool)
    tolerance = _ROUNDING * max(np.ptp(image), np.abs(image).max())
    order = np.argsort(tip, axis=None)
    for j in range(0, image.shape[0], _BLOCK):
        for i in range(0, image.shape[1], _BLOCK):
            apex = image[j : j + _BLOCK, i : i + _BLOCK] - tolerance
            around = padded[j : j + len(apex) + 2 * ky, i : i + apex.shape[1] + 2 * kx]
            near = order[: np.searchsorted(tip.ravel()[order], around.max() - apex.min(), side="right")]
            touches, where = _touches(apex, around, tip, near)
            y, x = np.nonzero(touches == 1)
            dy, dx = np.divmod(where[y, x], tip.shape[1])
            certain[j + y + dy, i + x + dx] = True
    return certain[ky : ky + image.shape[0], kx : kx + image.shape[1]]


def _touches(
    apex: Floats, around: Floats, tip: Floats, near: NDArray[np.intp]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """How many pixels the tip touches from each place, and (one of) which, as an index into the tip's array."""
    ny, nx = apex.shape
    count, where = np.zeros(apex.shape, np.int32), np.zeros(apex.shape, np.int32)
    gap, touch = np.empty(apex.shape), np.empty(apex.shape, bool)
    for index in near:
        dy, dx = divmod(int(index), tip.shape[1])
        np.subtract(around[dy : dy + ny, dx : dx + nx], tip[dy, dx], out=gap)
        np.greater_equal(gap, apex, out=touch)
        count += touch
        where[touch] = index
    return count, where
