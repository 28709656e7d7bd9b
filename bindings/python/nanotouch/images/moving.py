# SPDX-License-Identifier: BSD-3-Clause
"""A map that follows its particles: what a push did is drawn before the next scan shows it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .._arrays import Floats
from ..errors import InvalidValue, require
from .particles import GrainTable
from .topography import Topography

_RIM = 2  # pixels about a particle that go with it
_WHOLE = 1e-9  # of a pixel: rounding of the places


def moved(topography: Topography, particles: GrainTable, number: int, to: tuple[float, float]) -> Topography:
    """The map after a particle has gone elsewhere.

    Its heights over the base go with it, with a rim of two pixels, between the pixels by bicubic interpolation; the
    base stays where it was. Where it lands the higher one is drawn.

    Parameters
    ----------
    topography : Topography
        The map, as :func:`nanotouch.images.grains` saw it.
    particles : GrainTable
        What it found there.
    number : int
        Which particle: its row in the table, from 1, as in ``particles.labels``.
    to : tuple of float
        Where its centre is now, x and y [m].

    Raises
    ------
    InvalidValue
        No such particle; pits; the table of another map; a particle that the border cuts before or after.
    """
    _check(topography, particles, number)
    cv2 = require("cv2", "images")
    (dy, dx), (ny, nx) = topography.pixel_size, topography.shape
    taken = cv2.dilate((particles.labels == number).astype(np.uint8), np.ones((2 * _RIM + 1,) * 2, np.uint8)) > 0
    taken &= (particles.labels == number) | (particles.labels == 0)
    over = np.where(taken, topography.heights - particles.base, 0.0)
    shift = (to[0] - particles.x[number - 1]) / dx, (to[1] - particles.y[number - 1]) / dy
    rows, columns = (np.flatnonzero(taken.any(axis=axis)) for axis in (1, 0))
    ends = [(columns, shift[0], nx, dx, "x"), (rows, shift[1], ny, dy, "y")]
    for held, way, most, pitch, name in ends:
        low, high = 1 - held[0], most - 3 - held[-1]
        if not low <= way <= high:
            at = getattr(particles, name)[number - 1]
            raise InvalidValue(
                f"to: {name} = {to[name == 'y']:g} m: valid is {at + low * pitch:.6g} .. {at + high * pitch:.6g} m, "
                "where the particle lies in the map as a whole"
            )
    landed, share = (_shifted(_shifted(one, shift[0], 1), shift[1], 0) for one in (over, taken.astype(np.float64)))
    where = share > 0.5
    left = np.where(taken, particles.base, topography.heights)
    return replace(topography, heights=np.where(where, np.maximum(left, particles.base + landed), left))


def _shifted(values: Floats, way: float, axis: int) -> Floats:
    """Along an axis by so many pixels: cubic convolution (Keys 1981, a = -1/2), exact for whole ones."""
    whole = int(np.floor(way + _WHOLE))
    t = max(way - whole, 0.0)
    weights = (0.5 * (t**3 - t**2), 0.5 * (t + 4.0 * t**2 - 3.0 * t**3), 1.0 - 2.5 * t**2 + 1.5 * t**3,
               0.5 * (2.0 * t**2 - t - t**3))  # fmt: skip
    parts = (weight * np.roll(values, whole + 2 - k, axis) for k, weight in enumerate(weights))
    return np.asarray(sum(parts))


def _check(topography: Topography, particles: GrainTable, number: int) -> None:
    if particles.pits:
        raise InvalidValue("particles: these are pits; valid are particles")
    if particles.labels.shape != topography.shape:
        raise InvalidValue(f"particles: of a map of {particles.labels.shape} pixels, not {topography.shape}")
    if not 1 <= number <= len(particles):
        raise InvalidValue(f"number = {number}: valid is 1 .. {len(particles)}")
    if particles.border[number - 1]:
        raise InvalidValue(f"number = {number}: the border of the map cuts this particle")
