# SPDX-License-Identifier: BSD-3-Clause
"""Roughness of a levelled image."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ._robust import used_pixels
from .topography import Topography


@dataclass(frozen=True)
class Roughness:
    """Height parameters of ISO 25178-2, about the mean height of the pixels counted.

    Attributes
    ----------
    arithmetic : float
        Sa, mean absolute height [m].
    rms : float
        Sq, root of the mean square height [m].
    peak_to_peak : float
        Highest minus lowest height (Sz) [m]: b of the force laws.
    """

    arithmetic: float
    rms: float
    peak_to_peak: float


def roughness(topography: Topography, mask: NDArray[np.bool_] | None = None) -> Roughness:
    """Sa, Sq and b of what was measured; level the image first, as nothing is subtracted here but the mean.

    Parameters
    ----------
    topography : Topography
        The image.
    mask : ndarray, shape (ny, nx), bool, optional
        True where a pixel shall not count; pixels that were filled in never do.
    """
    used = used_pixels(topography, mask)
    z = topography.heights if used is None else topography.heights[used]
    off = z - z.mean()
    return Roughness(float(np.abs(off).mean()), float(np.sqrt((off**2).mean())), float(np.ptp(z)))
