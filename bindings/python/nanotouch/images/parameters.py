# SPDX-License-Identifier: BSD-3-Clause
"""Areal parameters of ISO 25178-2 and profile parameters of ISO 21920-2 of a levelled image.

No filter is applied but the levelling that the image had: areal ones are of the S-F surface as it stands, profile ones
of the primary profile (P) of each row, averaged over the rows.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from ..errors import require
from ._robust import used_pixels
from .topography import Topography

_CORE = 0.4  # share of the material curve through which the core's line goes
_PEAKS, _PITS = 0.1, 0.8  # material ratios that part peaks, core and pits for the volumes
_DECAY = 0.2  # of the autocorrelation, for Sal and Str
_FEWEST = 16  # pixels


@dataclass(frozen=True)
class Parameter:
    """One parameter: its value [SI] (NaN: the image does not tell it), its unit, and what it is."""

    value: float
    unit: str
    meaning: str


def parameters(topography: Topography, mask: NDArray[np.bool_] | None = None) -> dict[str, Parameter]:
    """Areal and profile parameters by their standard's symbol, as ``found["Sdq"].value``.

    Parameters
    ----------
    topography : Topography
        The image, levelled: nothing is subtracted here but the mean.
    mask : ndarray, shape (ny, nx), bool, optional
        True where a pixel shall not count; pixels that were filled in never do.
    """
    some = used_pixels(topography, mask, _FEWEST)
    used = np.ones(topography.shape, bool) if some is None else some
    z = topography.heights - topography.heights[used].mean()
    material = np.sort(z[used])[::-1]
    return {
        **_named(_moments(material), "S", "of the surface"),
        **_slopes(z, used, topography.pixel_size),
        **_lengths(np.where(used, z, 0.0), used, topography.pixel_size),
        **_functional(material),
        **_profiles(z, used, topography.pixel_size[1]),
    }


def _moments(z: Floats) -> dict[str, tuple[float, str, str]]:
    """Of heights about their mean: symbol without its first letter, value, unit, meaning."""
    rms = float(np.sqrt(np.mean(z**2)))
    skew, kurtosis = (float(np.mean((z / rms) ** power)) if rms > 0.0 else np.nan for power in (3, 4))
    high, low = float(z.max()), float(-z.min())
    return {
        "a": (float(np.abs(z).mean()), "m", "mean absolute height"),
        "q": (rms, "m", "root mean square height"),
        "sk": (skew, "", "skewness"),
        "ku": (kurtosis, "", "kurtosis, 3 for Gaussian heights"),
        "p": (high, "m", "highest peak"),
        "v": (low, "m", "deepest pit"),
        "z": (high + low, "m", "highest minus lowest"),
    }


def _named(found: dict[str, tuple[float, str, str]], letter: str, where: str) -> dict[str, Parameter]:
    return {letter + key: Parameter(value, unit, f"{what} {where}") for key, (value, unit, what) in found.items()}


def _slopes(z: Floats, used: NDArray[np.bool_], pixel_size: tuple[float, float]) -> dict[str, Parameter]:
    """Over the cells between four pixels that all count: mean slopes along x and y."""
    a, b, c, d = z[:-1, :-1], z[:-1, 1:], z[1:, :-1], z[1:, 1:]
    whole = used[:-1, :-1] & used[:-1, 1:] & used[1:, :-1] & used[1:, 1:]
    dy, dx = pixel_size
    along_x, along_y = ((b - a, d - c), (c - a, d - b))
    squares = 0.5 * ((along_x[0] ** 2 + along_x[1] ** 2) / dx**2 + (along_y[0] ** 2 + along_y[1] ** 2) / dy**2)
    # two triangles a cell, cut both ways
    areas = [np.sqrt(1.0 + (p / dx) ** 2 + (q / dy) ** 2) for p in along_x for q in along_y]
    known = bool(whole.any())
    gradient = float(np.sqrt(np.mean(squares[whole]))) if known else np.nan
    developed = float(np.mean(np.mean(areas, axis=0)[whole])) - 1.0 if known else np.nan
    return {
        "Sdq": Parameter(gradient, "", "root mean square gradient"),
        "Sdr": Parameter(developed, "", "developed area over projected area, less 1"),
    }


def _lengths(z: Floats, used: NDArray[np.bool_], pixel_size: tuple[float, float]) -> dict[str, Parameter]:
    """Shortest way on which the autocorrelation falls to 0.2, and its ratio to the longest."""
    ndimage = require("scipy.ndimage", "images")
    ny, nx = z.shape
    size = (2 * ny, 2 * nx)
    pairs = np.fft.irfft2(np.abs(np.fft.rfft2(used.astype(float), size)) ** 2, size)
    products = np.fft.irfft2(np.abs(np.fft.rfft2(z, size)) ** 2, size)
    half = (slice(ny // 2, ny // 2 + ny + 1), slice(nx // 2, nx // 2 + nx + 1))  # lags up to half the image
    pairs, products = np.fft.fftshift(pairs)[half], np.fft.fftshift(products)[half]
    enough = pairs > 0.5
    middle = (ny - ny // 2, nx - nx // 2)
    variance = products[middle] / pairs[middle]
    correlation = np.where(enough, products / np.where(enough, pairs, 1.0), 0.0)
    y, x = ((np.arange(n) - m) * step for n, m, step in zip(correlation.shape, middle, pixel_size, strict=True))
    distance = np.hypot(y[:, None], x[None, :])
    shortest = ratio = np.nan
    if variance > 0.0:
        lobes, _ = ndimage.label(correlation >= _DECAY * variance)
        lobe = lobes == lobes[middle]
        edge = ndimage.binary_dilation(lobe) & ~lobe
        rim = np.concatenate([lobe[0], lobe[-1], lobe[:, 0], lobe[:, -1]])
        if edge.any():
            shortest = float(distance[edge].min())
            ratio = np.nan if rim.any() else shortest / float(distance[edge].max())
    return {
        "Sal": Parameter(shortest, "m", "shortest way on which the autocorrelation falls to 0.2, to a pixel"),
        "Str": Parameter(ratio, "", "Sal over the longest such way: 1 isotropic, 0 lines"),
    }


def _functional(material: Floats) -> dict[str, Parameter]:
    """From the material curve, heights from the highest down: core, peaks, pits, and their volumes."""
    count = material.size
    share = (np.arange(count) + 0.5) / count
    top, bottom, upper, lower = _core(material, share)
    above, below = material[material > top] - top, bottom - material[material < bottom]
    peaks = 2.0 * above.sum() / count / upper if upper > 0.0 else 0.0
    pits = 2.0 * below.sum() / count / (1.0 - lower) if lower < 1.0 else 0.0
    high, low = (float(np.interp(level, share, material)) for level in (_PEAKS, _PITS))
    solid = [float(np.maximum(material - level, 0.0).mean()) for level in (high, low)]
    void = [float(np.maximum(level - material, 0.0).mean()) for level in (high, low)]
    return {
        "Sk": Parameter(top - bottom, "m", "height of the core"),
        "Spk": Parameter(float(peaks), "m", "reduced height of the peaks"),
        "Svk": Parameter(float(pits), "m", "reduced depth of the pits"),
        "Smr1": Parameter(upper, "", "material ratio above which there are peaks"),
        "Smr2": Parameter(lower, "", "material ratio below which there are pits"),
        "Vmp": Parameter(solid[0], "m^3/m^2", "material of the peaks, to 10 %"),
        "Vmc": Parameter(solid[1] - solid[0], "m^3/m^2", "material of the core, 10 to 80 %"),
        "Vvc": Parameter(void[0] - void[1], "m^3/m^2", "void of the core, 10 to 80 %"),
        "Vvv": Parameter(void[1], "m^3/m^2", "void of the pits, from 80 %"),
    }


def _core(material: Floats, share: Floats) -> tuple[float, float, float, float]:
    """Top and bottom of the core [m] and their material ratios. The flattest secant over 40 % of the material, the
    first of several, says where; the line of least squares through that part is drawn to 0 and 100 % (ISO 13565-2)."""
    starts = np.linspace(share[0], share[-1] - _CORE, 601) if share[-1] - share[0] > _CORE else share[:1]
    left, right = (np.interp(at, share, material) for at in (starts, starts + _CORE))
    slopes = (right - left) / _CORE
    start = starts[np.flatnonzero(slopes >= slopes.max() - 1e-9 * abs(slopes.max()))[0]]
    part = (share >= start) & (share <= start + _CORE)
    x, z = share[part] - share[part].mean(), material[part] - material[part].mean()
    slope = float(x @ z / (x @ x)) if np.count_nonzero(part) > 1 else float(slopes.max())
    top = float(material[part].mean() - slope * share[part].mean())
    bottom = top + slope
    return top, bottom, float(np.mean(material > top)), float(np.mean(material >= bottom))


def _profiles(z: Floats, used: NDArray[np.bool_], step: float) -> dict[str, Parameter]:
    """Means over the rows of which at least half counts, each about its own mean."""
    rows = [row[kept] - row[kept].mean() for row, kept in zip(z, used, strict=True) if 2 * kept.sum() >= kept.size]
    both = used[:, 1:] & used[:, :-1]
    squares = ((np.diff(z, axis=1) / step) ** 2)[both]
    slope = float(np.sqrt(squares.mean())) if squares.size else np.nan
    found = [_moments(row) for row in rows]
    means = {
        key: (float(np.mean([one[key][0] for one in found])), *found[0][key][1:]) for key in (found[0] if found else ())
    }
    means["dq"] = (slope, "", "root mean square slope")
    if "z" in means:
        means["t"] = means.pop("z")
    return _named(means, "P", "of a row, mean of the rows")
