# SPDX-License-Identifier: BSD-3-Clause
"""Images as pictures, side by side."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np

from .._io.drawing import new_figure, plain, saved
from ..errors import InvalidValue
from ..units import engineering
from .particles import GrainTable
from .topography import Topography

_WIDTH = 4.2  # of one picture [inch]
_CUT = 0.25  # [%] of the pixels at either end that do not set the colours


def draw(
    pictures: Topography | Mapping[str, Topography],
    *,
    grains: GrainTable | None = None,
    save: str | os.PathLike[str] | None = None,
) -> Any:
    """Draw images side by side, each with its own height scale; repaired pixels are marked in blue.

    Parameters
    ----------
    pictures : Topography or mapping of str to Topography
        What to draw, by title.
    grains : GrainTable, optional
        Particles, outlined in the last picture.
    save : str or path, optional
        Where to write the figure, as ``"image.png"``.

    Returns
    -------
    matplotlib.figure.Figure
    """
    shown = {pictures.name: pictures} if isinstance(pictures, Topography) else dict(pictures)
    if not shown:
        raise InvalidValue("pictures: none given, expected at least one")
    figure = new_figure(_WIDTH * len(shown), 3.6)
    axes = figure.subplots(1, len(shown), squeeze=False)[0]
    for axis, (title, topography) in zip(axes, shown.items(), strict=True):
        _picture(figure, axis, topography)
        axis.set_title(plain(title), fontsize="medium")
    if grains is not None and len(grains):
        _outlines(axes[-1], list(shown.values())[-1], grains)
    return saved(figure, save, dpi=90)


def _extent(topography: Topography) -> tuple[str, tuple[float, float, float, float]]:
    height, width = topography.size
    unit, scale = engineering("m", [width, height])
    return unit, (0.0, width * scale, 0.0, height * scale)


def _picture(figure: Any, axis: Any, topography: Topography) -> None:
    unit, extent = _extent(topography)
    measured = topography.heights[~topography.mask]
    low, high = np.percentile(measured if measured.size else topography.heights, [_CUT, 100.0 - _CUT])
    z_unit, z_scale = engineering("m", high - low or high)  # of what is shown: one speck may be a hundred times as deep
    heights, low, high = topography.heights * z_scale, low * z_scale, high * z_scale
    drawn = axis.imshow(heights, origin="lower", extent=extent, cmap="afmhot", vmin=low, vmax=high)
    figure.colorbar(drawn, ax=axis, label=f"height [{z_unit}]", shrink=0.9)
    if topography.masked_pixels:
        cover = np.zeros((*topography.shape, 4))
        cover[topography.mask] = (0.2, 0.6, 1.0, 1.0)
        axis.imshow(cover, origin="lower", extent=extent)
    axis.set_xlabel(f"x [{unit}]")
    axis.set_ylabel(f"y [{unit}]")


def _outlines(axis: Any, topography: Topography, grains: GrainTable) -> None:
    """Pixels of a particle beside another one or the flat."""
    labels = np.pad(grains.labels, 1)
    inner = labels[1:-1, 1:-1]
    edge = (inner > 0) & ((labels[2:, 1:-1] != inner) | (labels[1:-1, 2:] != inner)
                          | (labels[:-2, 1:-1] != inner) | (labels[1:-1, :-2] != inner))  # fmt: skip
    cover = np.zeros((*topography.shape, 4))
    cover[edge] = (0.1, 0.9, 0.5, 1.0)
    axis.imshow(cover, origin="lower", extent=_extent(topography)[1])
