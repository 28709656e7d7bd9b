# SPDX-License-Identifier: BSD-3-Clause
"""Heights along a straight line over an image, and how often each height occurs."""

from __future__ import annotations

import csv
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import Floats
from .._io.drawing import BLUE, new_figure, saved
from .._io.writing import replacing
from ..errors import InvalidValue, require
from ..units import engineering
from .topography import Topography

_MOST_BINS = 100_000
_NARROWEST = 1e-6  # of the range, where rounding would make the bins


@dataclass(frozen=True, eq=False)
class Section:
    """Heights [m] over a distance [m] from the start; or, of a histogram, the share of pixels per metre over a height.

    Attributes
    ----------
    over, values : ndarray, shape (n,)
        Distance and height, or height and density [1/m].
    """

    over: Floats
    values: Floats
    _names: tuple[str, str]

    def to_csv(self, path: str | os.PathLike[str]) -> None:
        """A row for each point, SI."""
        with replacing(Path(path)) as part, part.open("w", encoding="utf-8", newline="") as stream:
            table = csv.writer(stream)
            table.writerow(self._names)
            table.writerows((float(x), float(y)) for x, y in zip(self.over, self.values, strict=True))

    def draw(self, save: str | os.PathLike[str] | None = None) -> Any:
        """One panel; also written to `save`, whole or not at all."""
        figure = new_figure(7.0, 3.6)
        panel = figure.subplots()
        unit, scale = engineering("m", self.over)
        panel.set_xlabel(f"{self._names[0].partition(' [')[0]} ({unit})")
        if self._names[1].endswith("[m]"):
            other, factor = engineering("m", self.values)
            panel.plot(self.over * scale, self.values * factor, color=BLUE)
            panel.set_ylabel(f"{self._names[1].partition(' [')[0]} ({other})")
        else:
            panel.fill_between(self.over * scale, self.values / scale, color=BLUE, step="mid", linewidth=0)
            panel.set_ylabel(f"share of the pixels per {unit}")
        return saved(figure, save, dpi=130)


def section(
    topography: Topography, start: tuple[float, float], end: tuple[float, float], *, width: float = 0.0
) -> Section:
    """Heights along a straight line, interpolated between the pixels, as far apart as the pixels are.

    Parameters
    ----------
    topography : Topography
        The image.
    start, end : (float, float)
        (x, y) of the two ends [m], as everywhere: (0, 0) is the lower left pixel.
    width : float
        Mean over so much to either side together [m]; 0: the line alone.

    Returns
    -------
    Section
        Heights over the distance from `start`; filled pixels count as they were filled.
    """
    ends = np.array([start, end], dtype=np.float64)
    height, breadth = topography.size
    if not (np.isfinite(ends).all() and (ends >= 0.0).all() and (ends <= [breadth, height]).all()):
        raise InvalidValue(f"line from {start} to {end} m: the image reaches from 0 to ({breadth:g}, {height:g}) m")
    length, pixel = float(np.hypot(*(ends[1] - ends[0]))), min(topography.pixel_size)
    if not length >= pixel:
        raise InvalidValue(f"line of {length:g} m: at least a pixel of {pixel:g} m")
    if not 0.0 <= width <= min(height, breadth):
        raise InvalidValue(f"width {width:g} m: valid is 0 to {min(height, breadth):g} m")
    distance = np.linspace(0.0, length, int(np.ceil(length / pixel)) + 1)
    along = (ends[1] - ends[0]) / length
    lanes = int(width / pixel) + 1
    aside = (np.arange(lanes) - 0.5 * (lanes - 1)) * pixel
    x = ends[0, 0] + distance * along[0] - aside[:, None] * along[1]
    y = ends[0, 1] + distance * along[1] + aside[:, None] * along[0]
    dy, dx = topography.pixel_size
    places = np.array([y / dy, x / dx])
    heights = require("scipy.ndimage", "images").map_coordinates(topography.heights, places, order=1, mode="nearest")
    return Section(distance, np.asarray(heights.mean(axis=0)), ("distance [m]", "height [m]"))


def histogram(topography: Topography, bins: int = 256) -> Section:
    """Share of the measured pixels per metre of height: its integral is 1.

    Parameters
    ----------
    topography : Topography
        The image, levelled.
    bins : int
        2 to 100 000, equally wide, from the lowest height to the highest.
    """
    if not 2 <= bins <= _MOST_BINS:
        raise InvalidValue(f"bins {bins}: valid is 2 to {_MOST_BINS}")
    measured = topography.heights[~topography.mask] if topography.masked_pixels else topography.heights
    low, high = float(measured.min()), float(measured.max())
    if not high - low > _NARROWEST * max(abs(low), abs(high)):
        raise InvalidValue(f"heights of {high - low:g} m over {high:g} m: all are equal")
    density, edges = np.histogram(measured, bins=bins, range=(low, high), density=True)
    return Section(0.5 * (edges[1:] + edges[:-1]), density, ("height [m]", "density [1/m]"))
