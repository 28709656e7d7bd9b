# SPDX-License-Identifier: BSD-3-Clause
"""Scars: streaks along the fast axis where the tip jumped or slipped, repaired from the rows above and below."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._io.words import counted
from ..errors import require
from ._robust import MAD, block_means, digit, middle
from .topography import Topography
from .words import length

_HIGHEST = 3  # [row]; what is broader across the rows is a structure
_SHORTEST = 17  # [pixel], odd for OpenCV; what is shorter along the row is a particle
_GAP = 2  # [pixel]; noise may interrupt a scar for so long
_STANDARD_DEVIATIONS = 3.0  # of the difference from row to row; seventeen in line do not come from noise
_MOST = 0.05  # of the image; more is a texture
_BLOCK = 8  # [pixel]; one lies wholly within every scar, so a scar shows in the means over blocks
_ROWS = 64  # that tell the noise


@dataclass(frozen=True)
class ScarReport:
    """What the repair of scars replaced.

    Attributes
    ----------
    scars : int
        Number of scars repaired.
    pixels : int
        Number of pixels replaced.
    threshold : float
        Smallest jump between rows that counted [m].
    largest : float
        Largest change of a pixel [m].
    lines : int
        Streaks left as they are because they cross the whole image: a structure along the fast axis, or a row offset.
    refused : bool
        True if so much looked like scars that it must be a texture; nothing was repaired.
    """

    scars: int
    pixels: int
    threshold: float
    largest: float
    lines: int
    refused: bool

    def __str__(self) -> str:
        if self.refused:
            return "no scars repaired: too many to be anything but the surface"
        kept = f"; {counted(self.lines, 'line')} across the whole image left" if self.lines else ""
        if not self.scars:
            return f"no scars{kept}"
        repaired = f"{counted(self.scars, 'scar')} ({self.pixels} pixels) repaired"
        return f"{repaired}, up to {length(self.largest, 3)} removed{kept}"


def repair_scars(topography: Topography) -> tuple[Topography, ScarReport]:
    """Replace streaks along the fast axis by what the rows above and below say.

    A scar is one to three rows high and 17 pixels or longer. It stands out on the same side of the row above it and of
    that below, by three standard deviations. It stands out by more than those two differ from each other, so the edge
    of a step is none. A streak across the whole image is never taken for a scar, and an image where more than 5 % look
    like scars is returned as it is; both give a :class:`UserWarning`. The first and the last row are not repaired.

    Returns
    -------
    topography : Topography
        Repaired pixels are masked; all others keep their value.
    report : ScarReport
        What was replaced.
    """
    z = topography.heights
    slope, threshold = _slope_and_threshold(z)
    means = (block_means(z, _BLOCK, 1) - slope * np.arange(len(z))[:, None]).astype(np.float32)
    found = np.zeros(z.shape, np.uint8)
    for sign in (1, -1):
        _mark_streaks(found, z, sign * means, sign, (slope, threshold))
    if not found.any():
        return topography, ScarReport(0, 0, threshold, 0.0, 0, False)
    scar, scars, lines = _without_lines(found)
    if lines:
        like = counted(lines, "line along the fast axis looks like a scar", "lines along the fast axis look like scars")
        warnings.warn(f"{like} across the whole image: left", stacklevel=2)
    if np.count_nonzero(scar) > _MOST * z.size:
        share = 100 * np.count_nonzero(scar) / z.size
        warnings.warn(f"{share:.3g} % of the image look like scars: taken for its texture and left", stacklevel=2)
        return topography, ScarReport(0, 0, threshold, 0.0, lines, True)
    heights, largest = _bridged(z, scar)
    report = ScarReport(scars, int(np.count_nonzero(scar)), threshold, largest, lines, False)
    return replace(topography, heights=heights, mask=topography.mask | scar), report


def _slope_and_threshold(z: Floats) -> tuple[float, float]:
    """The tilt across the rows [m/row], and what neither noise nor the digitiser's steps explain of a jump [m]."""
    row = np.arange(0, len(z) - 1, len(z) // _ROWS | 1)
    steps = (z[row + 1] - z[row]).ravel()
    slope = middle(steps)
    noise = MAD * middle(np.abs(steps - slope))
    height_range = float(np.ptp(z))
    return slope, max(_STANDARD_DEVIATIONS * noise, 1e-3 * height_range, digit(steps, height_range))


def _stands_out(before: NDArray[Any], inner: NDArray[Any], after: NDArray[Any], threshold: float) -> NDArray[np.bool_]:
    """Where rows stand above those before and after, by more than these differ from each other."""
    excess = inner - np.maximum(before, after)
    return np.asarray((excess > threshold) & (excess > np.abs(before - after)))


def _mark_streaks(
    found: NDArray[np.uint8], z: Floats, means: NDArray[np.float32], sign: int, limits: tuple[float, float]
) -> None:
    """Mark where one to three rows stand above (sign 1) the row before and the row after, for long enough along them.

    What stands out pixel by pixel does so in the mean: only the blocks that do, and those beside them, are looked at.
    """
    cv2 = require("cv2", "images")
    slope, threshold = limits
    for rows in range(1, min(_HIGHEST, len(z) - 2) + 1):
        lowest = means[1 : len(z) - rows]
        for k in range(1, rows):
            lowest = np.minimum(lowest, means[1 + k : len(z) - rows + k])
        blocks = _stands_out(means[: -rows - 1], lowest, means[rows + 1 :], threshold)
        lines = np.flatnonzero(blocks.any(axis=1))
        if not lines.size:
            continue
        near = cv2.dilate(np.pad(blocks[lines].astype(np.uint8), ((0, 0), (0, 1))), np.ones((1, 5), np.uint8))
        line, block = np.nonzero(near)
        column = np.minimum(block[:, None] * _BLOCK + np.arange(_BLOCK), z.shape[1] - 1)
        first = 1 + lines[line][:, None]
        before, *inner, after = (sign * (z[first + r, column] - slope * r) for r in range(-1, rows + 1))
        out = np.zeros((lines.size, z.shape[1]), np.uint8)
        out[line[:, None], column] = _stands_out(before, np.minimum.reduce(inner), after, threshold)
        out = cv2.morphologyEx(out, cv2.MORPH_CLOSE, np.ones((1, _GAP + 1), np.uint8))
        out = cv2.morphologyEx(out, cv2.MORPH_OPEN, np.ones((1, _SHORTEST), np.uint8))
        for row in range(rows):
            found[1 + lines + row] |= out


def _without_lines(found: NDArray[np.uint8]) -> tuple[NDArray[np.bool_], int, int]:
    """The streaks that do not cross the whole image, their number, and that of those that do."""
    cv2 = require("cv2", "images")
    marked = found.any(axis=1)
    rows = np.flatnonzero(marked | np.roll(marked, 1))  # with an empty one after each group; the last is never marked
    # half the memory takes a third of the time, where so many scars do not fit
    kind = cv2.CV_16U if found.size < _SHORTEST << 16 else cv2.CV_32S
    _, labels, stats, _ = cv2.connectedComponentsWithStats(found[rows], connectivity=8, ltype=kind)
    across = stats[:, cv2.CC_STAT_WIDTH] >= found.shape[1] - 2 * _GAP
    lines, streaks = int(across[1:].sum()), int((~across[1:]).sum())
    scar = found.view(np.bool_)
    if lines:
        kept = ~across
        kept[0] = False
        scar[rows] = kept[labels]
    return scar, streaks, lines


def _bridged(z: Floats, scar: NDArray[np.bool_]) -> tuple[Floats, float]:
    """Marked pixels from the nearest others above and below in their column, linearly; and the largest change [m]."""
    marked, z_in, nx = scar.ravel(), z.ravel(), z.shape[1]
    at = np.flatnonzero(marked)
    low, high = at - nx, at + nx
    while True:
        low_in, high_in = marked[low], marked[high]
        if not (low_in.any() or high_in.any()):
            break
        low, high = low - nx * low_in, high + nx * high_in
    share = (at - low) / (high - low)
    bridge = (1 - share) * z_in[low] + share * z_in[high]
    heights = z.copy()
    heights.ravel()[at] = bridge
    return heights, float(np.abs(bridge - z_in[at]).max(initial=0.0))
