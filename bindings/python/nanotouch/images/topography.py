# SPDX-License-Identifier: BSD-3-Clause
"""A measured height map on a regular grid, in SI, the right way up."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._arrays import as_floats, as_mask, is_masked
from ..errors import InvalidValue
from .words import length, lengths

READY = "Surface, ready to touch"
"""channel of heights from which tip and tilt have been taken: ``auto`` leaves them as they are"""


@dataclass(frozen=True, eq=False)
class Topography:
    """Heights over a rectangle: x to the right, y up, z away from the sample.

    Attributes
    ----------
    heights : ndarray, shape (ny, nx), float64
        Heights [m], read-only. ``heights[j, i]`` lies at ``x = i dx``, ``y = j dy``: row 0 is the lower edge of the
        picture (show it with ``origin="lower"``).
    pixel_size : tuple of float
        ``(dy, dx)`` [m], the scan size over the number of pixels (N, not N - 1).
    name : str
        The file's name without its folder, or any other title.
    channel : str
        The channel that was read.
    source : str
        What read it, as ``"nanotouch/asylum-image"``.
    mask : ndarray, shape (ny, nx), bool
        True where a height was not measured but filled in from its neighbours; nowhere if not given.
    notes : tuple of str
        What reading left out or supplied, and what is unusual of the file.
    """

    heights: NDArray[np.float64]
    pixel_size: tuple[float, float]
    name: str = ""
    channel: str = ""
    source: str = ""
    mask: NDArray[np.bool_] = field(default_factory=lambda: np.zeros((0, 0), bool))
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        heights = _frozen(self.heights, np.float64)
        if heights.ndim != 2 or min(heights.shape) < 4:
            raise InvalidValue(f"heights: shape {heights.shape}, expected two dimensions of at least 4 pixels each")
        if not np.isfinite(heights).all():
            raise InvalidValue("heights: not finite everywhere; fill missing pixels (nanotouch.images.fill) or crop")
        dy, dx = (float(d) for d in self.pixel_size)
        if not (0 < dy < np.inf and 0 < dx < np.inf):
            raise InvalidValue(f"pixel_size: ({dy:g}, {dx:g}) m, expected two positive lengths (dy, dx)")
        mask = _frozen(np.zeros(heights.shape, bool) if np.size(self.mask) == 0 else self.mask, np.bool_)
        if mask.shape != heights.shape:
            raise InvalidValue(f"mask: shape {mask.shape}, expected that of heights, {heights.shape}")
        for key, value in (("heights", heights), ("pixel_size", (dy, dx)), ("mask", mask)):
            object.__setattr__(self, key, value)

    @property
    def shape(self) -> tuple[int, int]:
        """``(ny, nx)`` [pixel]."""
        return self.heights.shape[0], self.heights.shape[1]

    @property
    def size(self) -> tuple[float, float]:
        """Scan size ``(Ly, Lx)`` [m]."""
        return self.shape[0] * self.pixel_size[0], self.shape[1] * self.pixel_size[1]

    @property
    def height_range(self) -> float:
        """Highest minus lowest height [m]."""
        return float(np.ptp(self.heights))

    @property
    def masked_pixels(self) -> int:
        """Number of pixels that were filled in rather than measured."""
        return int(np.count_nonzero(self.mask))

    def __repr__(self) -> str:
        (ny, nx), (ly, lx) = self.shape, self.size
        return (
            f"Topography({self.name!r}, channel {self.channel!r}, {nx} x {ny} pixels, "
            f"{lengths((lx, ly))}, height range {length(self.height_range)}, "
            f"{self.masked_pixels} masked)"
        )


def _frozen(array: ArrayLike, dtype: type[np.generic]) -> NDArray[np.generic]:
    """A read-only C-ordered view (or copy, where the layout or type differs); the caller's own array stays writable."""
    if is_masked(array):
        raise InvalidValue("masked arrays are not accepted: fill them and pass `mask`")
    checked = as_mask(array, "the mask") if dtype is np.bool_ else as_floats(array, "the image")
    view = np.ascontiguousarray(checked, dtype=dtype).view()
    view.flags.writeable = False
    return view
