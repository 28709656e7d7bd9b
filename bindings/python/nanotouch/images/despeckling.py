# SPDX-License-Identifier: BSD-3-Clause
"""Isolated wrong pixels go; edges, corners and lines stay."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .._io.words import counted
from ..errors import require
from ._robust import MAD
from .topography import Topography
from .words import length

_SPECKLE = 6.0  # standard deviations from the surroundings: one in 5e8 pixels of Gaussian noise
_HIGHER = (4.0, 16.0)  # times the threshold, at which groups are looked at again
_SPECKLE_SIZE = 2  # [pixel]; more pixels in one piece are a structure


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
            return f"no speckles above {length(self.threshold, 3)}"
        repaired = f"{counted(self.pixels, 'speckled pixel')} repaired"
        return f"{repaired}, the worst {length(self.largest, 3)} off its surroundings"


def despeckle(topography: Topography) -> tuple[Topography, DespeckleReport]:
    """Replace isolated wrong pixels by the median of their surroundings; edges, corners and lines stay.

    A pixel is a speckle when it lies more than six robust standard deviations off the 3 x 3 median. It has to lie on
    the same side of every neighbour that is not itself off, and in a group of at most two such pixels.
    (At the corner of a terrace the pixels inward agree with it, and a line is a larger group.)
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
    threshold = _SPECKLE * max(MAD * float(np.median(np.abs(off))), 1e-3 * float(np.ptp(smooth)))
    speckle = np.zeros(z.shape, bool)
    for least in (threshold, *(threshold * factor for factor in _HIGHER)):  # a spike may stand among lesser suspects
        suspect = np.abs(off) > least
        speckle |= suspect & _small_groups(suspect, cv2) & _apart(normal, suspect, least, cv2)
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
