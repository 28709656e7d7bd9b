# SPDX-License-Identifier: BSD-3-Clause
"""Make an image touchable without inventing or erasing structure: take out the tilt, then isolated wrong pixels.

The tilt is what flat pieces of the surface agree on. A plane through all pixels is pulled by steps (a grating with
unequal ridges and grooves keeps a false tilt), and aligning rows erases a grating that runs along them. So the image is
cut along its steep places into terraces, and one common tilt is fitted with a height of its own for every terrace. On a
surface without steps that is one piece and the ordinary (robust) plane. Rows are never aligned here.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValue, require
from .topography import Topography

_ROUNDS = 4  # cutting and fitting alternate; two rounds settle a grating, the others are for rough films
_STEEP = 4.0  # a place is steep where the slope differs from the tilt by more than this many standard deviations
_SMALLEST_PIECE = 16  # [pixel]
_ENOUGH = 1 << 17  # [pixel]
_HUBER = 1.345  # 95 % efficiency on Gaussian noise
_SPECKLE = 6.0  # standard deviations from the surroundings: one in 5e8 pixels of Gaussian noise
_SPECKLE_SIZE = 2  # [pixel]; more pixels in one piece are a structure
_MAD = 1.4826  # standard deviation over median absolute deviation, for Gaussian noise


@dataclass(frozen=True)
class LevelReport:
    """What levelling took away.

    Attributes
    ----------
    method : str
        As given to :func:`level`.
    tilt : tuple of float
        Slopes of the removed plane ``(dz/dy, dz/dx)`` [-].
    offset : float
        Removed mean height [m].
    removed_range : float
        Highest minus lowest height of the removed plane over the image [m].
    range_before, range_after : float
        Highest minus lowest height of the image [m].
    pieces : int
        Number of pieces the image was cut into along its steep places.
    """

    method: str
    tilt: tuple[float, float]
    offset: float
    removed_range: float
    range_before: float
    range_after: float
    pieces: int

    def __str__(self) -> str:
        degrees = np.degrees(np.arctan(np.hypot(*self.tilt)))
        return (
            f"{self.method} levelling removed a tilt of {degrees:.3g} degrees ({self.removed_range * 1e9:.4g} nm over "
            f"the image); height range {self.range_before * 1e9:.4g} nm before, {self.range_after * 1e9:.4g} nm after"
        )


@dataclass(frozen=True)
class DespeckleReport:
    """What despeckling replaced.

    Attributes
    ----------
    pixels : int
        Number of pixels replaced by the median of their surroundings.
    threshold : float
        Smallest distance from the surroundings that counted as a speckle [m].
    largest : float
        Largest change of a pixel [m].
    """

    pixels: int
    threshold: float
    largest: float

    def __str__(self) -> str:
        if not self.pixels:
            return f"no speckles above {self.threshold * 1e9:.3g} nm"
        return f"{self.pixels} speckled pixels repaired, the worst {self.largest * 1e9:.3g} nm off its surroundings"


def prepare(topography: Topography) -> tuple[Topography, tuple[LevelReport, DespeckleReport]]:
    """Level by a plane and despeckle: what ``nanotouch touch`` does to an image before it is touched."""
    levelled, level_report = level(topography)
    clean, despeckle_report = despeckle(levelled)
    return clean, (level_report, despeckle_report)


def level(
    topography: Topography, method: str = "plane", *, mask: NDArray[np.bool_] | None = None
) -> tuple[Topography, LevelReport]:
    """Take out the tilt and the mean height, keeping every step.

    Parameters
    ----------
    topography : Topography
        The image.
    method : {"plane"}
        The only method so far; rows are never aligned.
    mask : ndarray, shape (ny, nx), bool, optional
        True where a pixel shall not take part in the fit; pixels that were filled in never do.

    Returns
    -------
    topography : Topography
        Mean height 0.
    report : LevelReport
        The plane that was removed.
    """
    if method != "plane":
        raise InvalidValue(f"method: {method!r}, expected 'plane'")
    z = topography.heights
    used = ~topography.mask
    if mask is not None:
        if np.shape(mask) != z.shape:
            raise InvalidValue(f"mask: shape {np.shape(mask)}, expected {z.shape}")
        used &= ~np.asarray(mask, dtype=bool)
    if np.count_nonzero(used) < _SMALLEST_PIECE:
        raise InvalidValue(f"mask: leaves {np.count_nonzero(used)} pixels, expected at least {_SMALLEST_PIECE}")
    slope_y, slope_x, pieces = _common_tilt(z, used)
    ny, nx = z.shape
    flat = z - slope_y * np.arange(ny)[:, None] - slope_x * np.arange(nx)
    offset = float(flat[~topography.mask].mean())
    levelled = replace(topography, heights=flat - offset)
    dy, dx = topography.pixel_size
    plane_mean = 0.5 * (slope_y * (ny - 1) + slope_x * (nx - 1))
    return levelled, LevelReport(
        method,
        (slope_y / dy, slope_x / dx),
        offset + plane_mean,
        abs(slope_y) * (ny - 1) + abs(slope_x) * (nx - 1),
        topography.height_range,
        levelled.height_range,
        pieces,
    )


def despeckle(topography: Topography) -> tuple[Topography, DespeckleReport]:
    """Replace isolated wrong pixels by the median of their surroundings; edges, corners and lines stay.

    A pixel is a speckle when it lies more than six robust standard deviations off the 3 x 3 median, on the same side of
    every neighbour that is not itself off, and in a group of at most two such pixels. (At the corner of a terrace
    the pixels inward agree with it, and a line is a larger group.)
    """
    cv2 = require("cv2", "images")
    z = topography.heights
    # OpenCV's median filter takes float32: remove what would cost digits first, the mean and the scale.
    centre, scale = float(z.mean()), topography.height_range
    if scale == 0:
        return topography, DespeckleReport(0, 0.0, 0.0)
    normal = ((z - centre) / scale).astype(np.float32)
    smooth = cv2.medianBlur(normal, 3)
    off = normal - smooth
    # The floor keeps single steps of a coarsely digitised image from counting as speckles.
    threshold = _SPECKLE * max(_MAD * float(np.median(np.abs(off))), 1e-3 * float(np.ptp(smooth)))
    suspect = np.abs(off) > threshold
    speckle = suspect & _small_groups(suspect, cv2) & _apart(normal, suspect, threshold, cv2)
    count = int(np.count_nonzero(speckle))
    heights = z.copy()
    heights[speckle] = smooth[speckle].astype(np.float64) * scale + centre
    largest = float(np.abs(heights - z).max()) if count else 0.0
    report = DespeckleReport(count, threshold * scale, largest)
    return replace(topography, heights=heights, mask=topography.mask | speckle), report


def _small_groups(suspect: NDArray[np.bool_], cv2: object) -> NDArray[np.bool_]:
    _, labels, stats, _ = cv2.connectedComponentsWithStats(suspect.astype(np.uint8), connectivity=8)  # type: ignore[attr-defined]
    small = stats[:, cv2.CC_STAT_AREA] <= _SPECKLE_SIZE  # type: ignore[attr-defined]
    small[0] = False
    return np.asarray(small[labels], dtype=bool)


def _apart(z: NDArray[np.float32], suspect: NDArray[np.bool_], threshold: float, cv2: object) -> NDArray[np.bool_]:
    """Where a pixel lies beyond all its unsuspected neighbours by more than `threshold`."""
    ring = np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]], dtype=np.uint8)
    big = np.float32(4.0)  # beyond any normalised height
    highest = cv2.dilate(np.where(suspect, -big, z), ring)  # type: ignore[attr-defined]
    lowest = cv2.erode(np.where(suspect, big, z), ring)  # type: ignore[attr-defined]
    return np.asarray((z > highest + threshold) | (z < lowest - threshold), dtype=bool)


def _common_tilt(z: NDArray[np.float64], used: NDArray[np.bool_]) -> tuple[float, float, int]:
    """The tilt that the flat pieces agree on [m/pixel along y, along x], and their number."""
    steps_y, steps_x = np.diff(z, axis=0), np.diff(z, axis=1)
    pairs_y, pairs_x = used[1:] & used[:-1], used[:, 1:] & used[:, :-1]
    slope = np.array([_middle(steps_y[pairs_y]), _middle(steps_x[pairs_x])])
    height_range = float(np.ptp(z[used]))
    small = 1e-3 * height_range
    floor_y, floor_x = (max(small, _digit(v, height_range)) for v in (steps_y[pairs_y], steps_x[pairs_x]))
    pieces = 1
    for _ in range(_ROUNDS):
        flat = used.copy()
        flat[:-1] &= _gentle(steps_y - slope[0], pairs_y, floor_y)
        flat[:, :-1] &= _gentle(steps_x - slope[1], pairs_x, floor_x)
        labels, pieces = _cut(flat, used)
        change = _fit_change(z, slope, labels)
        slope += change
        if np.abs(change).max() * max(z.shape) < 1e-6 * small:
            break
    return float(slope[0]), float(slope[1]), pieces


def _middle(values: NDArray[np.float64]) -> float:
    return float(np.median(_sample(values))) if values.size else 0.0


def _sample(values: NDArray[Any]) -> NDArray[Any]:
    """Every n-th value of many: 2^17 tell a tilt to a tenth of the noise. n is odd, so that it does not follow rows."""
    return values[:: values.size // _ENOUGH | 1]


def _digit(steps: NDArray[np.float64], height_range: float) -> float:
    """One and a half steps of the digitiser: the smallest difference there is, unless it is a structure's."""
    size = np.abs(steps)
    smallest = 1.5 * float(size[size > 0].min(initial=np.inf))
    return smallest if smallest < 0.05 * height_range else 0.0


def _gentle(difference: NDArray[np.float64], counted: NDArray[np.bool_], floor: float) -> NDArray[np.bool_]:
    """Where a height difference from pixel to pixel is no more than noise and the digitiser's steps explain."""
    size = np.abs(difference)
    ups = size[counted]
    return np.asarray(size <= max(_STEEP * _MAD * _middle(ups), floor), dtype=bool)


def _cut(flat: NDArray[np.bool_], used: NDArray[np.bool_]) -> tuple[NDArray[np.int32], int]:
    """Label the connected flat pieces from 1; 0 is steep or too small. Without any piece all used pixels are one."""
    cv2 = require("cv2", "images")
    count, labels = cv2.connectedComponents(flat.astype(np.uint8), connectivity=4)
    area = np.bincount(labels.ravel(), minlength=count)
    kept = area >= _SMALLEST_PIECE
    kept[0] = False
    if not kept.any():
        return used.astype(np.int32), 1
    new_label = np.where(kept, np.cumsum(kept), 0).astype(np.int32)
    return new_label[labels], int(kept.sum())


def _fit_change(z: NDArray[np.float64], slope: NDArray[np.float64], labels: NDArray[np.int32]) -> NDArray[np.float64]:
    """Change of the common slope by Huber-weighted least squares with a free height for each piece.

    The least-norm solution leaves a direction alone in which no piece extends.
    """
    j, i = np.divmod(_sample(np.flatnonzero(labels)), z.shape[1])
    piece = np.unique(labels[j, i], return_inverse=True)[1]
    rest = z[j, i] - slope[0] * j - slope[1] * i
    weight = np.ones(rest.size)
    change = np.zeros(2)
    for _ in range(3):
        total = np.bincount(piece, weight)
        centred = [v - (np.bincount(piece, weight * v) / total)[piece] for v in (j, i, rest)]
        dj, di, dz = centred
        normal = np.array([[weight @ (dj * dj), weight @ (dj * di)], [weight @ (dj * di), weight @ (di * di)]])
        change = np.linalg.lstsq(normal, np.array([weight @ (dj * dz), weight @ (di * dz)]), rcond=1e-12)[0]
        residual = np.abs(dz - change[0] * dj - change[1] * di)
        limit = _HUBER * _MAD * float(np.median(residual))
        if limit == 0.0:
            break
        weight = np.minimum(1.0, limit / np.maximum(residual, limit))
    return change
