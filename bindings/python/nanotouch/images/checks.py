# SPDX-License-Identifier: BSD-3-Clause
"""What is believed of an AFM image; anything else is a damaged header or a wrong unit, and refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import ReadError
from .filling import fill
from .topography import READY, Topography

SIDE_RANGE = (1e-9, 1.0)  # scan size [m]; profilers measure centimetres
HEIGHT_RANGE = (1e-12, 1e-2)  # highest minus lowest [m]
OFFSET_LIMIT = 1.0  # of any height from 0 [m]: a stage's travel
USUAL_SIDE = 1e-3  # of an AFM image; what is larger is told
MAX_STEEPNESS = 10.0  # height range over the longer side; above 1 it is told
PIXELS_PER_SIDE = (4, 16384)
MAX_PIXELS = 1 << 26  # 512 MiB of doubles
MAX_MISSING = 0.9  # fraction of pixels that may be filled from their neighbours
TOLD_MISSING = 0.01  # above which they are told
MAX_PIXEL_ASPECT = 128.0  # of dy and dx: a square scan of few lines has oblong pixels

LENGTHS = {
    "m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "nm": 1e-9, "Å": 1e-10, "A": 1e-10, "pm": 1e-12,
}  # fmt: skip


def check_shape(file: Path, shape: tuple[int, ...]) -> None:
    """Refuse what is no image of a size that is read, before anything is allocated."""
    low, high = PIXELS_PER_SIDE
    if len(shape) != 2 or not all(low <= n <= high for n in shape) or shape[0] * shape[1] > MAX_PIXELS:
        raise ReadError(
            f"{file}: {' x '.join(map(str, shape))} pixels; images of {low} .. {high} pixels per side and up to "
            f"{MAX_PIXELS >> 20} million in all are read"
        )


def check_scale(topography: Topography, file: Path) -> None:
    """Refuse a scan size, pixels or heights that no AFM image has."""
    check_shape(file, topography.shape)
    for side, length in zip("yx", topography.size, strict=True):
        if not SIDE_RANGE[0] <= length <= SIDE_RANGE[1]:
            raise ReadError(
                f"{file}: a scan of {length:.3g} m along {side}; an AFM image measures {SIDE_RANGE[0]:g} .. "
                f"{SIDE_RANGE[1]:g} m (damaged header or wrong unit?)"
            )
    dy, dx = topography.pixel_size
    if not 1 / MAX_PIXEL_ASPECT <= dy / dx <= MAX_PIXEL_ASPECT:
        raise ReadError(
            f"{file}: pixels of {dx:.3g} x {dy:.3g} m; one side at most {MAX_PIXEL_ASPECT:g} times the other is "
            "expected (damaged header?)"
        )
    height, limit = topography.height_range, min(HEIGHT_RANGE[1], MAX_STEEPNESS * max(topography.size))
    least = 0.0 if topography.channel == READY else HEIGHT_RANGE[0]  # a simulated scan of a flat
    if height != 0.0 and not least <= height <= limit:
        raise ReadError(
            f"{file}: heights over a range of {height:.3g} m in channel {topography.channel!r}; expected "
            f"{HEIGHT_RANGE[0]:g} .. {limit:.3g} m (damaged data or wrong unit?)"
        )
    if not np.abs(topography.heights).max() <= OFFSET_LIMIT:
        raise ReadError(
            f"{file}: heights of up to {np.abs(topography.heights).max():.3g} m in channel {topography.channel!r}; "
            f"expected up to {OFFSET_LIMIT:g} m (damaged data or wrong unit?)"
        )


def unusual(topography: Topography) -> tuple[str, ...]:
    """What is believed, but told."""
    notes, side, height = [], max(topography.size), topography.height_range
    missing = topography.masked_pixels / topography.heights.size
    if missing > TOLD_MISSING:
        notes.append(f"{100 * missing:.3g} % of the pixels are missing: filled from their neighbours and masked")
    if height == 0.0:
        notes.append("all heights are equal: nothing was measured in this channel")
    if side > USUAL_SIDE:
        notes.append(f"a scan of {side * 1e3:.4g} mm, more than an AFM's: a profiler's image, or a wrong unit")
    if height > side:
        notes.append(f"heights over {height:.3g} m, more than the longer side ({side:.3g} m): a spike, or a wrong unit")
    return tuple(notes)


def filled(values: NDArray[np.float64], file: Path) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Fill missing (not finite) pixels by the mean of their known neighbours, from the rim of each hole inwards."""
    count = int(np.count_nonzero(~np.isfinite(values)))
    if count > MAX_MISSING * values.size:
        raise ReadError(
            f"{file}: {100 * count / values.size:.3g} % of the pixels are missing (NaN); up to "
            f"{100 * MAX_MISSING:g} % are filled from their neighbours, crop the image instead"
        )
    return fill(values)
