# SPDX-License-Identifier: BSD-3-Clause
"""Radius of the tip's apex as an interval, from the sharpest spikes of an image.

The image of a spike is the spike widened by the tip: over spheres of R_s and R its apex is one of R_s + R. No tip that
took the image is blunter than its sharpest spike. Blind reconstruction finds that bound pixel by pixel, so its noise
threshold flattens the apex; here a sphere that runs into a cone is fitted to the whole apex, and the noise averages.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from ..errors import InvalidValue, require
from ._robust import pixel_noise
from .tips import rounded_cone
from .topography import Topography
from .words import length, lengths

_LEAST = 24  # pixels of an apex, for five parameters
_SURE = 1.96  # standard deviations of an interval of 95 %
_TALL = 20.0  # standard deviations of the noise that a spike stands over what is around it, at least
_DEEP = 1.0  # depth of what is fitted below the apex, over its radius: sphere and the beginning of the cone
_MOST = 25  # spikes, the highest first
_ROUNDS = 8  # of choosing that depth
_APART = 31  # side of the window in which a spike is highest [pixel]
_WIDEST = 101  # of the window of what is fitted [pixel]
_NO_SPHERE = 1.5  # times what the curvature of the outermost apex has otherwise
_SERIES = 0.02  # of a curvature, which a sphere has more terms than counted for
_BETWEEN = 0.1  # of a pixel: what the heights between pixels can change the radius by, found with exact spikes


@dataclass(frozen=True)
class ApexRadius:
    """Radius of the tip and of the sharpest spikes together, which is the bound of the tip's own.

    Attributes
    ----------
    radius : float
        R + R_s [m].
    low, high : float
        Interval of 95 % [m].
    no_sphere : float
        Share of the half interval that stands for an apex that is no sphere on a cone: its outermost part alone has
        another radius [m]; 0 where noise explains that.
    half_angle : float
        Of the cone that goes on from the sphere [rad].
    spikes : int
        How many agree with the sharpest; those count.
    threshold : float
        How high a spike had to stand, of the noise found [m].
    """

    radius: float
    low: float
    high: float
    no_sphere: float
    half_angle: float
    spikes: int
    threshold: float

    def __str__(self) -> str:
        return (
            f"apex and sharpest spikes: radius {length(self.radius, 3)}, "
            f"{lengths((self.low, self.high), 3, ' .. ')} (95 %), of {self.spikes} spike{'s' * (self.spikes != 1)}"
            + "; the apex is no sphere: its top has another radius"
            * (self.no_sphere > 0.0)
        )


def apex_radius(topography: Topography) -> ApexRadius:
    """The sum of the radii of tip and spike, from the sharpest spikes of an image.

    Despeckle and repair scars first: a wrong pixel passes for a spike. Spikes that are sharper than a few pixels are
    passed over. The interval holds noise, also along the lines, a tenth of a pixel, the differences of the spikes, and
    by how much the curvature of the top alone differs, 1.5 times; not what the z loop did, nor an error of the
    scanner's scale.

    Parameters
    ----------
    topography : Topography
        The image.

    Raises
    ------
    InvalidValue
        If the image holds no spike whose apex spans 24 pixels.
    """
    threshold = _TALL * pixel_noise(topography.heights)
    peaks = _peaks(topography, threshold)
    seen = [(one, at) for at in peaks if (one := _widened(topography, at)) is not None]
    found = [one for one, _ in seen]
    if not found:
        raise InvalidValue(
            f"no spike over {length(threshold, 2)} of noise whose apex spans {_LEAST} pixels: smaller pixels, or a "
            "sample with sharper spikes"
        )
    radius, sigma, angle = np.array(found).T
    agree = radius - 2.0 * sigma <= (radius + 2.0 * sigma).min()
    weight = agree / sigma**2
    mean = float(weight @ radius / weight.sum())
    count = int(agree.sum())
    sharpest = [at for (_, at), counts in zip(seen, agree, strict=True) if counts]
    no_sphere = _NO_SPHERE * _differs(topography, sharpest, mean)
    scatter = float(weight @ (radius - mean) ** 2) / max(count - 1, 1)
    spread = _SURE * float(np.sqrt(max(scatter, 1.0) / weight.sum())) + _BETWEEN * max(topography.pixel_size)
    spread += no_sphere
    half_angle = float(weight @ angle / weight.sum())
    return ApexRadius(mean, max(mean - spread, 0.0), mean + spread, no_sphere, half_angle, count, threshold)


def _differs(topography: Topography, places: list[tuple[int, int]], radius: float) -> float:
    """By how much the curvature of the outermost apex alone has another radius [m]; 0 where noise explains it."""
    curved = [one for at in places if (one := _curvature(topography, at, radius)) is not None]
    if not curved:
        return 0.0
    curvature, sigma = np.array(curved).T
    weight = 1.0 / sigma**2
    known = _SURE / np.sqrt(weight.sum()) + (_BETWEEN * max(topography.pixel_size) + _SERIES * radius) / radius**2
    mean = float(weight @ curvature / weight.sum())
    return abs(1.0 / max(mean, 0.3 / radius) - radius) if abs(mean - 1.0 / radius) > known else 0.0


def _curvature(topography: Topography, at: tuple[int, int], radius: float) -> tuple[float, float] | None:
    """Curvature of a spike at its top [1/m] and its standard deviation: z = c + a x + b y - r^2/(2R) + d r^4 + e r^6,
    a quarter of R deep, where a sphere has not gone over into a cone; None where that spans too few pixels."""
    dy, dx = topography.pixel_size
    half = min(int(radius / min(dx, dy)) + 1, at[0], at[1],
               *(n - 1 - i for n, i in zip(topography.shape, at, strict=True)))  # fmt: skip
    z = topography.heights[at[0] - half : at[0] + half + 1, at[1] - half : at[1] + half + 1]
    y, x = (np.arange(-half, half + 1) * d / radius for d in (dy, dx))
    used = z > z.max() - 0.25 * radius
    if used.sum() < _LEAST:
        return None
    u, v = (one[used] for one in np.meshgrid(x, y))
    r2 = u**2 + v**2
    terms = np.stack([np.ones_like(u), u, v, -0.5 * r2, r2**2, r2**3], axis=1)
    found, *_ = np.linalg.lstsq(terms, z[used] / radius, rcond=None)
    rows = np.broadcast_to(np.arange(len(z))[:, None], z.shape)[used]
    sigma = _deviation(terms, terms @ found - z[used] / radius, rows)[3]
    return float(found[3] / radius), max(float(sigma), 1e-6) / radius


def _peaks(topography: Topography, threshold: float) -> list[tuple[int, int]]:
    """Pixels that are highest in a window and stand high over its lowest, away from borders and filled pixels."""
    cv2, z = require("cv2", "images"), topography.heights
    size = min(_APART, (min(z.shape) // 2 - 1) | 1)
    around, half = np.ones((size, size), np.uint8), size // 2
    is_peak = (z == cv2.dilate(z, around)) & (z - cv2.erode(z, around) > max(threshold, 1e-12 * np.abs(z).max()))
    is_peak &= cv2.dilate(topography.mask.astype(np.uint8), around) == 0
    inner = np.zeros_like(is_peak)
    inner[half:-half, half:-half] = True
    places = np.argwhere(is_peak & inner)
    kept: list[tuple[int, int]] = []
    for j, i in places[np.argsort(-z[tuple(places.T)], kind="stable")]:
        if len(kept) < _MOST and all(max(abs(j - v), abs(i - u)) > half for v, u in kept):  # equal pixels: one peak
            kept.append((int(j), int(i)))
    return kept


def _widened(topography: Topography, at: tuple[int, int]) -> tuple[float, float, float] | None:
    """R, its standard deviation and the half angle of one spike, in a window that grows until the sphere ends in it."""
    room = min(at[0], at[1], *(n - 1 - i for n, i in zip(topography.shape, at, strict=True)), _WIDEST // 2)
    half = min(_APART // 3, room)
    while True:
        one = _fitted(topography, at, 2 * half + 1)
        if one is None or one[0] * np.cos(one[2]) <= half * min(topography.pixel_size):
            return one
        if half == room:
            return None
        half = min(2 * half, room)


def _fitted(topography: Topography, at: tuple[int, int], size: int) -> tuple[float, float, float] | None:
    """R, its standard deviation and the half angle of one spike; None where its apex is not resolved."""
    optimize = require("scipy.optimize", "images")
    half, (dy, dx) = size // 2, topography.pixel_size
    z = topography.heights[at[0] - half : at[0] + half + 1, at[1] - half : at[1] + half + 1]
    top = z.max()
    y, x = (np.arange(-half, half + 1) * d for d in (dy, dx))
    rows = np.broadcast_to(np.arange(size)[:, None], z.shape)
    guess = np.array([0.0, 0.0, 0.0, 3.0 * max(dx, dy), 0.5])  # x0, y0, height over the top, R, half angle
    scale = np.array([dx, dy, dx, dx, 1.0])
    depth = 0.5 * float(np.ptp(z))
    for _ in range(_ROUNDS):
        used = z > top + guess[2] - depth

        def off(p: Floats, used: Floats = used) -> Floats:
            r = np.hypot(y[:, None] - p[1], x - p[0])[used]
            return np.asarray((top + p[2] - rounded_cone(r, p[3], p[4]) - z[used]) / dx)

        if used.sum() < _LEAST:
            return None
        bounds = (-3 * dx, -3 * dy, -dx - depth, 0.1 * dx, 0.05), (3 * dx, 3 * dy, dx + depth, 1e3 * dx, 1.5)
        fit = optimize.least_squares(off, np.clip(guess, *bounds), bounds=bounds, x_scale=scale, method="trf")
        guess, wanted = fit.x, _DEEP * fit.x[3]
        if abs(wanted - depth) < 0.05 * depth:
            break
        depth = wanted
    sphere = np.pi * (guess[3] * np.cos(guess[4])) ** 2 / (dx * dy)
    if sphere < _LEAST or not fit.success:
        return None
    sigma = _deviation(fit.jac * scale, fit.fun, rows[used])[3] * dx
    return float(guess[3]), max(sigma, 1e-6 * guess[3]), float(guess[4])


def _deviation(jacobian: Floats, residual: Floats, rows: NDArray[np.intp]) -> Floats:
    """Standard deviations of the parameters: residuals of one line of the scan hang together (clusters)."""
    inverse = np.linalg.pinv(jacobian.T @ jacobian)
    scores = np.zeros((int(rows.max()) + 1, jacobian.shape[1]))
    np.add.at(scores, rows, jacobian * residual[:, None])
    free = max(len(residual) - jacobian.shape[1], 1)
    plain = np.diag(inverse) * float(residual @ residual) / free
    together = np.diag(inverse @ (scores.T @ scores) @ inverse) * len(residual) / free
    return np.asarray(np.sqrt(np.maximum(plain, together)))
