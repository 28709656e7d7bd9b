# SPDX-License-Identifier: BSD-3-Clause
"""The tip from the image alone: blind reconstruction (Villarrubia, J. Res. NIST 102, 425, 1997), in our own code.

Where the apex stands at x, the tip touches the surface at some offset e, so the surface at x + e is as high as
i(x) + t(e). With the apex at x + e - d the tip must not cut into it: i(x + e - d) + t(d) >= i(x) + t(e). Which e it
was is not known, but one it was, hence

    t(d) >= min over e of  i(x) + t(e) - i(x + e - d)      for every x and d,

e being possible only where the same holds for d = 0 (t(0) = 0): i(x) + t(e) <= i(x + e). Beginning with a flat, the
bluntest of all tips, raising it where an image point demands it never lifts it above the true one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from ..errors import InvalidValue, require
from ._robust import pixel_noise
from .tips import dilated, eroded
from .topography import Topography

_POINTS = 256  # image points per round, those first that the tip so far explains worst
_ROUNDS = 40
_IDLE = 2  # rounds that change nothing end it
_NOISE = 7.0  # standard deviations of the noise: differences of two pixels of 5 sigma of themselves


@dataclass(frozen=True, eq=False)
class TipEstimate:
    """The bluntest tip that could have taken an image; the true one is nowhere blunter.

    Attributes
    ----------
    heights : ndarray, shape of the window
        Above the apex [m], nowhere above the true tip's: what :func:`dilate` and :func:`erode` take.
    pixel_size : tuple of float
        ``(dy, dx)`` [m].
    threshold : float
        Noise that was allowed for [m].
    points : int
        Image points that formed the tip.
    converged : bool
        False if it was still changing when the rounds ran out.
    """

    heights: Floats
    pixel_size: tuple[float, float]
    threshold: float
    points: int
    converged: bool

    def radius(self, height: float) -> float:
        """R of the paraboloid through the apex that fits the lowest `height` [m] of the tip best [m]; inf if flat.

        It is an upper bound too, as far as pixels resolve the apex.
        """
        y, x = (np.arange(n) - n // 2 for n in self.heights.shape)
        r2 = (y[:, None] * self.pixel_size[0]) ** 2 + (x * self.pixel_size[1]) ** 2
        near = (self.heights <= height) & (r2 > 0)
        if not near.any():
            raise InvalidValue(f"height: {height:g} m, expected at least that of a pixel beside the apex")
        curvature = float((r2[near] @ self.heights[near]) / (r2[near] @ r2[near]))
        return 0.5 / curvature if curvature > 0 else float("inf")


def estimate_tip(topography: Topography, size: int = 21, threshold: float | None = None) -> TipEstimate:
    """Estimate the tip from the sharpest structures of an image.

    The surface must hold structures sharper than the tip (edges, spikes, small particles), or the estimate stays blunt;
    it is never too sharp as long as the noise stays below half of `threshold`. Despeckle and repair scars first: a
    wrong pixel passes for a spike. Eroding by an estimate that is too blunt gives a surface that is too low, not an
    upper bound.

    Parameters
    ----------
    topography : Topography
        The image.
    size : int
        Side of the window for the tip [pixel]: odd, 3 .. 101, and no more than half of the image.
    threshold : float, optional
        What the noise can add to a difference of two heights [m]; seven standard deviations of the pixel noise if not
        given, estimated from second differences along the rows.
    """
    z = topography.heights
    if size % 2 == 0 or not 3 <= size <= min(101, min(z.shape) // 2):
        raise InvalidValue(f"size: {size}, expected an odd number of 3 .. {min(101, min(z.shape) // 2)} pixels")
    if threshold is None:
        threshold = _NOISE * pixel_noise(z)
    if not 0.0 <= threshold < np.inf:
        raise InvalidValue(f"threshold: {threshold:g} m, expected 0 or more")
    threshold = max(float(threshold), 1e-12 * topography.height_range)  # rounding
    # nothing is known of filled pixels and beyond the border: the tip may stand there at any height
    image = np.pad(np.where(topography.mask, np.inf, z), size - 1, constant_values=np.inf)
    tip = np.zeros((size, size))
    done = np.ones(z.shape, bool)  # from near the border the tip may have touched what lies outside
    done[size // 2 : -(size // 2), size // 2 : -(size // 2)] = False
    outside = done | topography.mask
    done = outside.copy()
    used, idle, converged = 0, 0, False
    for _ in range(_ROUNDS):
        points = _worst_explained(topography, tip, threshold, done)
        converged = not len(points) or idle == _IDLE
        if converged:
            break
        raised = 0
        for j, i in points:
            better = _demanded(image[j : j + 2 * size - 1, i : i + 2 * size - 1], tip, threshold)
            raised += bool((better > tip).any())
            done[j, i] = True  # until others have raised the tip
            tip = better
        used += raised
        idle = 0 if raised else idle + 1
        if raised:
            done = outside.copy()
    return TipEstimate(tip, topography.pixel_size, threshold, used, converged)


def _worst_explained(
    topography: Topography, tip: Floats, threshold: float, done: NDArray[np.bool_]
) -> NDArray[np.intp]:
    """Points, (n, 2), where the image is higher than this tip could have shown it (its opening), worst first."""
    z = topography.heights - topography.heights.mean()
    scale = max(topography.height_range, 1e-15)
    narrow = (z / scale).astype(np.float32)  # quick, and 1e-7 of the heights is enough to choose points
    excess = narrow - dilated(eroded(narrow, tip / scale), tip / scale)
    excess[done] = 0.0
    peak = excess >= require("cv2", "images").dilate(excess, np.ones((3, 3), np.uint8))  # neighbours say the same
    candidates = np.flatnonzero(peak & (excess > max(2.0 * threshold / scale, 1e-6)))
    worst = candidates[np.argsort(-excess.ravel()[candidates], kind="stable")[:_POINTS]]
    return np.stack(np.divmod(worst, z.shape[1]), axis=1)


def _demanded(around: Floats, tip: Floats, threshold: float) -> Floats:
    """The tip raised as one image point demands. around: the image (2 size - 1)^2 with that point in the middle."""
    size = len(tip)
    half = size // 2
    middle = around[size - 1, size - 1]
    rises = around - middle  # i(x + f) - i(x), f = -(size - 1) .. size - 1
    inner = rises[half : half + size, half : half + size]  # f = e within the tip
    windows = np.lib.stride_tricks.sliding_window_view(rises, (size, size))
    bound = np.full(tip.shape, np.inf)
    for j, i in np.argwhere(tip <= inner + threshold):  # the possible e
        # i(x + e - d) - i(x) over d is the window that begins at e, turned round
        np.minimum(bound, tip[j, i] - windows[j, i][::-1, ::-1], out=bound)
    return np.maximum(tip, np.where(np.isfinite(bound), bound - threshold, 0.0))
