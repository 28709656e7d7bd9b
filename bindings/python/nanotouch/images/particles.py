# SPDX-License-Identifier: BSD-3-Clause
"""Particles on a flat (quantum dots, grains) or pits in it: found, parted where they touch, and measured."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, fields, replace
from os import PathLike
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._io.words import counted
from .._io.writing import write_csv
from ..errors import InvalidValue, require
from ._robust import MAD, pixel_noise
from .parting import parted
from .topography import Topography
from .words import length, lengths

_STANDARD_DEVIATIONS = 5.0  # of the flat above which a pixel belongs to a particle
_STANDS_OUT = 10.0
_BINS = 512  # of Otsu's histogram
_FEW = 0.01  # share of the pixels: fewer are no class of Otsu's, but specks
_TILES = 4  # of the image along each side
_FILLED = 0.9  # share of a tile from which no flat is left in it; of dense grains 0.8 is found
_MOST = 0.5  # share of the image
_NOISY = 2.0  # standard deviations of a pixel
_BAND = 3.0  # standard deviations of the flat, within which its bands are
_ENOUGH = 0.2  # share of a row that is flat
_BANDED = 0.5  # rms of the bands over the standard deviation about them, below which there are none


@dataclass(frozen=True, eq=False)
class GrainTable:
    """Particles, highest first: arrays of one length.

    Attributes
    ----------
    x, y : ndarray
        Centre, weighted by height [m].
    height : ndarray
        Highest pixel over the base [m] (of pits: the depth).
    mean_height : ndarray
        Mean over the base [m].
    diameter : ndarray
        Of the circle of equal area [m], at the threshold.
    area : ndarray
        At the threshold [m^2].
    volume : ndarray
        Between base and surface [m^3], within that area.
    pixels : ndarray of int
        Number of pixels.
    border : ndarray of bool
        True for a particle that the border of the image cuts; leave those out of mean sizes.
    labels : ndarray, shape (ny, nx), int
        Number of the particle from 1 (row 0 of the table), 0 for the flat.
    base : float
        Height of the flat [m].
    threshold : float
        Height over the base above which pixels were counted [m].
    noise : float
        Standard deviation of the flat, or of the lower class [m].
    warnings : tuple of str
        Why the particles may be none, in words.
    pits : bool
        True if they are pits.
    """

    x: Floats
    y: Floats
    height: Floats
    mean_height: Floats
    diameter: Floats
    area: Floats
    volume: Floats
    pixels: NDArray[np.int64]
    border: NDArray[np.bool_]
    labels: NDArray[np.int32]
    base: float
    threshold: float
    noise: float
    warnings: tuple[str, ...] = ()
    pits: bool = False

    def __len__(self) -> int:
        return len(self.x)

    @property
    def coverage(self) -> float:
        """Share of the image that lies in particles [-]."""
        return float(np.count_nonzero(self.labels) / self.labels.size)

    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns by name, with their units: ``"height_m"``, ..."""
        units = {"area": "_m2", "volume": "_m3", "pixels": "", "border": ""}
        return {f.name + units.get(f.name, "_m"): getattr(self, f.name) for f in fields(self)[:9]}

    def to_csv(self, path: str | PathLike[str]) -> None:
        """Write the table, one line per particle, SI."""
        columns = self.columns() | {"border": self.border.astype(int)}
        write_csv(path, {"number": np.arange(1, len(self) + 1), **columns}, {})

    def __str__(self) -> str:
        what, beyond = ("pit", "deeper than") if self.pits else ("particle", "above")
        found = f"{counted(len(self), what)} {beyond} {length(self.threshold, 3)}"
        if len(self):
            cut = int(self.border.sum())
            found += f" ({cut} cut by the border), {100 * self.coverage:.3g} % of the area"
            if cut < len(self):
                found += f"; {'of the others ' if cut else ''}{self._sizes()}"
        return "\n".join([found, *(f"  warning: {text}" for text in self.warnings)])

    def _sizes(self) -> str:
        """Of those that the border does not cut."""
        return f"{'depth' if self.pits else 'height'} {_spread(self.height[~self.border])}, diameter " + _spread(
            self.diameter[~self.border]
        )


def _spread(values: Floats) -> str:
    """Median, and from the least to the largest where there are several."""
    middle = length(float(np.median(values)))
    return middle if values.size == 1 else f"{middle} ({lengths((values.min(), values.max()), 4, ' .. ')})"


def grains(
    topography: Topography,
    threshold: float | str = "auto",
    *,
    smallest: int = 9,
    split: bool = True,
    pits: bool = False,
) -> GrainTable:
    """Find particles on a levelled image and measure them.

    Parameters
    ----------
    topography : Topography
        The image, levelled (:func:`level` leaves particles out by itself).
    threshold : float or {"auto", "flat", "otsu"}
        Height over the base above which a pixel belongs to a particle [m].

        ``"flat"``: five standard deviations of the flat; base is the most frequent height, and the half of the heights
        below it, which particles do not reach, gives the standard deviation. ``"otsu"``, for grains so dense that there
        is no flat: what parts the heights best into two classes (Otsu 1979); base is the median of the lower one.
        ``"auto"``: ``"flat"`` if the highest pixel in a thousand stands ten standard deviations over it, or if Otsu's
        height is below two of a pixel's noise, else ``"otsu"``.
    smallest : int
        Particles of fewer pixels are noise.
    split : bool
        Part particles that touch. Two peaks are two particles where the saddle between them lies lower than the lower
        one by a fifth of its height, and by five standard deviations of the noise of a pixel.
    pits : bool
        Look for pits in place of particles.

    Warns
    -----
    UserWarning
        Where what was found is more likely a terrace, a bow of the scanner or noise: ``table.warnings``.
    """
    if smallest < 1:
        raise InvalidValue(f"smallest: {smallest} pixels, expected 1 or more")
    z = -topography.heights if pits else topography.heights
    jitter = pixel_noise(z)
    base, noise, least = _base(z[~topography.mask], threshold, jitter)
    bands = _bands(z, topography.mask, base, noise) if threshold in ("auto", "flat") else np.zeros((1, 1))
    if bands.any():
        z = z - bands
        base, noise, least = _base(z[~topography.mask], threshold, jitter)
    cv2 = require("cv2", "images")
    over = z - base
    count, labels = cv2.connectedComponents((over > least).astype(np.uint8), connectivity=8)
    if split and count > 1:
        labels = parted(over, labels, _STANDARD_DEVIATIONS * jitter)
    labels, unseen = _seen(labels, topography.mask)
    labels = _numbered(over, labels, smallest)
    doubts = _doubts(labels, least / jitter if jitter > 0.0 else np.inf, pits)
    if unseen:
        doubts += (f"left out: {counted(unseen, 'pit' if pits else 'particle')} of pixels that were mostly filled in",)
    if np.ptp(bands) > least:
        doubts += (
            f"the flat stood {length(np.ptp(bands), 3)} higher in some rows than in others, which was taken off: "
            "drift or the bow of a scanner that levelling left",
        )
    for text in doubts:
        warnings.warn(text, stacklevel=2)
    return replace(
        _measured(topography, over, labels, (-base if pits else base, least, noise)), warnings=doubts, pits=pits
    )


def _doubts(labels: NDArray[np.int32], over_noise: float, pits: bool) -> tuple[str, ...]:
    """Why the particles may be none; over_noise: the threshold over the noise of a pixel."""
    inside = labels > 0
    ny, nx = inside.shape
    tiles = [inside[j * ny // _TILES : (j + 1) * ny // _TILES, i * nx // _TILES : (i + 1) * nx // _TILES].mean()
             for j in range(_TILES) for i in range(_TILES)]  # fmt: skip
    found = []
    if over_noise < _NOISY:
        found.append(f"the threshold is only {over_noise:.2g} times the noise of a pixel: most of it may be noise")
    if max(tiles) > _FILLED:
        found.append(
            "a sixteenth of the image or more lies in particles as a whole: a terrace, the bow of a scanner or one "
            "large particle; level with poly2 (a bow), or give a threshold above the terraces"
        )
    if inside.mean() > _MOST:
        other = "leave pits out" if pits else "look for pits"
        found.append(
            f"{100 * inside.mean():.3g} % of the image lies in {'pits' if pits else 'particles'}: the base is hardly a "
            f"flat; {other} if what lies between them is meant"
        )
    return tuple(found)


def _flat(z: Floats) -> tuple[float, float]:
    """The most frequent height, and the standard deviation of what lies below it."""
    low, high = np.quantile(z, [0.001, 0.999])
    if low == high:
        return float(low), 0.0
    step = (high - low) / _BINS
    histogram = np.histogram(z, _BINS, (low, high))[0].astype(float)
    smooth = np.convolve(histogram, np.hanning(27), "same")
    base = low + (float(smooth.argmax()) + 0.5) * step
    base = float(np.median(z[np.abs(z - base) <= 2.0 * step]))  # exact where the flat is narrower than a bin
    below = base - z[z < base]
    noise = MAD * float(np.median(below)) if below.size else 0.0
    near = z[np.abs(z - base) <= 2.0 * noise]
    return (float(np.median(near)) if near.size else base), noise


def _base(z: Floats, threshold: float | str, jitter: float) -> tuple[float, float, float]:
    """Height of the base, standard deviation about it, height over it from which a pixel counts; jitter: a pixel's."""
    base, noise = _flat(z)
    if threshold == "auto":
        stands_out = np.quantile(z, 0.999) - base >= _STANDS_OUT * noise
        threshold = "flat" if stands_out or _parting(z)[1] < _NOISY * jitter else "otsu"
    if threshold == "flat":
        return base, noise, max(_STANDARD_DEVIATIONS * noise, 1e-3 * float(np.ptp(z)))
    if threshold == "otsu":
        lower, least = _parting(z)
        return float(np.median(lower)), float(lower.std()), least
    if isinstance(threshold, str) or not 0.0 < threshold < np.inf:
        raise InvalidValue(f"threshold: {threshold!r}, expected a positive height [m], 'auto', 'flat' or 'otsu'")
    return base, noise, float(threshold)


def _bands(z: Floats, missing: NDArray[np.bool_], base: float, noise: float) -> Floats:
    """What levelling left of bands along the rows, (ny, 1) [m]: medians of the flat of each row about the base.

    The flat is what lies within three standard deviations of the base; rows with too little of it get what lies between
    those of their neighbours. Bands of less than half a standard deviation are none.
    """
    flat = (np.abs(z - base) <= _BAND * noise) & ~missing
    enough = np.flatnonzero(flat.mean(axis=1) > _ENOUGH)
    if not enough.size:
        return np.zeros((len(z), 1))
    middle = np.array([np.median(z[j][flat[j]]) for j in enough]) - base
    bands = np.interp(np.arange(len(z)), enough, middle)
    within = MAD * float(np.median(np.abs((z - bands[:, None] - base)[flat])))
    return np.asarray(bands[:, None] if float(np.std(middle)) > _BANDED * within else np.zeros((len(z), 1)))


def _parting(z: Floats) -> tuple[Floats, float]:
    """The lower class of heights, and how far over its median the upper one begins [m]."""
    lower = z[z <= (parting := _otsu(z))]
    return lower, parting - float(np.median(lower))


def _otsu(z: Floats) -> float:
    """The height that leaves the least variance within the two classes it makes; specks are none."""
    low, high = np.quantile(z, [_FEW, 1.0 - _FEW])
    z = z[(z >= low) & (z <= high)]
    histogram, edges = np.histogram(z, _BINS)
    share, middle = histogram / z.size, 0.5 * (edges[1:] + edges[:-1])
    below, moment = np.cumsum(share), np.cumsum(share * middle)
    with np.errstate(divide="ignore", invalid="ignore"):
        between = (moment[-1] * below - moment) ** 2 / (below * (1.0 - below))
    return float(edges[1 + int(np.nanargmax(between[:-1]))])


def _seen(labels: NDArray[np.int32], filled: NDArray[np.bool_]) -> tuple[NDArray[np.int32], int]:
    """Without those of which more than half was filled in and not measured; how many they were."""
    if not filled.any():
        return labels, 0
    pixels = np.bincount(labels.ravel())
    invented = 2 * np.bincount(labels[filled], minlength=pixels.size) > pixels
    invented[0] = False
    return np.where(invented[labels], 0, labels), int(np.count_nonzero(invented))


def _numbered(over: Floats, labels: NDArray[np.int32], smallest: int) -> NDArray[np.int32]:
    """Numbers from 1 by falling height; 0 for particles of fewer than `smallest` pixels."""
    inside = np.flatnonzero(labels)
    which = labels.ravel()[inside]
    top = np.full(int(which.max(initial=0)) + 1, -np.inf)
    np.maximum.at(top, which, over.ravel()[inside])
    keep = np.bincount(which, minlength=len(top)) >= smallest
    number = np.zeros(len(top), np.int32)
    order = np.argsort(np.where(keep, -top, np.inf), kind="stable")[: np.count_nonzero(keep)]
    number[order] = np.arange(1, len(order) + 1)
    out = np.zeros(labels.size, np.int32)
    out[inside] = number[which]
    return out.reshape(labels.shape)


def _measured(
    topography: Topography, over: Floats, labels: NDArray[np.int32], flat: tuple[float, float, float]
) -> GrainTable:
    (dy, dx), (ny, nx) = topography.pixel_size, topography.shape
    inside = np.flatnonzero(labels)
    which, high = labels.ravel()[inside] - 1, over.ravel()[inside]
    j, i = np.divmod(inside, nx)
    count = int(labels.max(initial=0))
    pixels = np.bincount(which, minlength=count)
    total = np.bincount(which, high, count)
    top = np.zeros(count)
    np.maximum.at(top, which, high)
    edge = (j == 0) | (j == ny - 1) | (i == 0) | (i == nx - 1)
    area = np.asarray(pixels * (dy * dx), np.float64)
    return GrainTable(
        np.bincount(which, high * i, count) / total * dx,
        np.bincount(which, high * j, count) / total * dy,
        top,
        total / pixels,
        2.0 * np.sqrt(area / np.pi),
        area,
        np.asarray(total * (dy * dx)),
        pixels,
        np.bincount(which, edge, count) > 0,
        labels,
        *flat,
    )
