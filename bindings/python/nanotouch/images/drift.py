# SPDX-License-Identifier: BSD-3-Clause
"""Drift and offsets of scan lines, told apart from structures that run along them.

The offsets that do not last are those of rows.py. What lasts, the profile of the rows p (sums of the median differences
from row to row), may be drift of the instrument or a structure along the fast axis. It is

* a structure, and stays, where p is a grating: a line in the spectrum of its steps, or three and more jumps of like
  height. A jump counts that is ten rows wide at most, six standard deviations of its neighbours high, lasts, and is
  seen by both halves of the image;
* a step, and stays, where there are one or two jumps, or one that dwarfs the others;
* drift for the rest, as far as (1) both halves of the columns agree on it and (2) it exceeds by far what the same
  surface does the other way: the profile of the columns, which drift does not enter, is the null of every band of
  frequencies (less a straight line, which may be tilt). The share taken out is 2c/(1 + c), c the correlation of the
  halves, times 1 - 3 P_columns/P_rows.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from ..errors import require
from . import rows
from ._robust import MAD
from .rows import RowProfile

_LINE = 25.0  # times the median of its neighbours a frequency is one of a grating
_FINE = 24.0  # [row]; below this period no bow can be told from the grating
_HIGH = 6.0  # standard deviations that a jump is high
_WIDE = 10.0  # [row] that it takes, at most: its height over its steepest step
_NEAR = 16  # [row] on either side, of which the standard deviation is
_LASTS = 0.6  # of its height that is left between the medians of six rows on either side
_LIKE = 0.2  # scatter of the heights of a grating, over their median
_DWARFS = 3.0  # times the median of the others
_NULL = 3.0  # times the power of the columns must be exceeded
_NEIGHBOURS = 2  # bands on either side whose power may be a surface's too
_AGREED = 0.3  # correlation of the halves below which nothing is drift


@dataclass(frozen=True)
class Drift:
    """What stands out along the rows.

    Attributes
    ----------
    offsets : ndarray, shape (ny,)
        To be taken out: drift, and what rows.py calls offsets [m].
    lasting : float
        Range of the drift [m]; 0 where a structure forbids to tell.
    jumps : tuple of float
        Steps across whole rows that are kept [m].
    structure : bool
        Whether a grating along the rows was found.
    period : float or None
        Its period [row], by its spectrum.
    rows : RowProfile
        What rows.py tells of the same strips.
    """

    offsets: Floats
    lasting: float
    jumps: tuple[float, ...]
    structure: bool
    period: float | None
    rows: RowProfile

    @property
    def fine(self) -> bool:
        """Whether the grating is too fine for a bow to be told from it."""
        return self.period is not None and self.period < _FINE


def analyse(strips: Floats) -> Drift:
    """Tell drift from structure. strips: (ny, columns), means over blocks along x [m], NaN where not to count."""
    profile = rows.summed(np.diff(strips, axis=0))
    found = rows.analyse(strips)
    period = _period(profile) or found.period
    if period is not None:
        return Drift(found.offsets, 0.0, (), True, period, found)
    jumps = _jumps(strips, profile)
    heights = np.abs([height for *_, height in jumps])
    if len(jumps) > 2:
        middle = float(np.median(heights))
        if MAD * float(np.median(np.abs(heights - middle))) <= _LIKE * middle:
            return Drift(found.offsets, 0.0, tuple(h for *_, h in jumps), True, None, found)
        jumps = [jump for jump in jumps if abs(jump[2]) > _DWARFS * middle]
    rest = strips - found.offsets[:, None]
    steps = _steps(rows.summed(np.diff(rest, axis=0)), jumps)
    lasting = _drift(rest, steps)
    return Drift(found.offsets + lasting, float(np.ptp(lasting)), tuple(h for *_, h in jumps), False, None, found)


def anisotropy(strips: Floats) -> float:
    """Power of the profile of the rows over that of the columns, about straight lines [-]."""
    powers = []
    for values in (strips, strips.T):
        profile = rows.summed(np.diff(values, axis=0))
        x = np.arange(len(profile))
        powers.append(float(np.var(profile - np.polyval(np.polyfit(x, profile, 1), x))))
    return powers[0] / powers[1] if powers[1] > 0.0 else np.inf


def _period(profile: Floats) -> float | None:
    """Of the lowest frequency of the steps that stands out of its neighbours [row]; walls have harmonics."""
    steps = np.diff(profile)
    if len(steps) < 2 * _NEAR:
        return None
    power = np.abs(np.fft.rfft((steps - steps.mean()) * np.hanning(len(steps)))) ** 2
    k = np.arange(3, len(power) - 1)
    usual = _middle_of_neighbours(power, k)
    lines = (power[k] > _LINE * np.maximum(usual, 1e-300)) & (power[k] >= power[k + 1])
    return len(steps) / int(k[np.argmax(lines)]) if lines.any() else None


def _middle_of_neighbours(power: Floats, k: NDArray[np.int_]) -> Floats:
    """Median over the eight frequencies from two away on either side; the mean is no neighbour."""
    place = k[:, None] + np.r_[-10:-2, 3:11]
    inside = (place >= 1) & (place < len(power))
    near = np.sort(np.where(inside, power[np.clip(place, 0, len(power) - 1)], np.inf), axis=1)
    count, row = inside.sum(axis=1), np.arange(len(k))
    return np.asarray(0.5 * (near[row, np.maximum(count - 1, 0) // 2] + near[row, count // 2 - (count == 0)]))


def _jumps(strips: Floats, profile: Floats) -> list[tuple[int, int, float]]:
    """First row, last row and height [m] of each jump that both halves of the image show."""
    steps = np.diff(profile)
    spread = MAD * float(np.median(np.abs(steps - np.median(steps))))
    half = strips.shape[1] // 2
    sides = [rows.summed(np.diff(part, axis=0)) for part in (strips[:, :half], strips[:, half:])]
    found = []
    for first, last in _runs(steps, 2.0 * spread):
        height = float(profile[last] - profile[first])
        near = np.concatenate(
            [steps[max(0, first - _NEAR - 1) : max(0, first - 1)], steps[last + 1 : last + _NEAR + 1]]
        )
        noise = max(spread, MAD * float(np.median(np.abs(near)))) if near.size else spread
        if abs(height) <= _HIGH * noise or abs(height) > _WIDE * float(np.abs(steps[first:last]).max()):
            continue
        inside = first >= 6 and last < len(profile) - 6
        lasting = float(np.median(profile[last : last + 6]) - np.median(profile[max(0, first - 5) : first + 1]))
        seen = min((float(side[last] - side[first]) / height for side in sides), default=0.0)
        if inside and lasting / height > _LASTS and seen > 0.5:
            found.append((first, last, height))
    return found


def _runs(steps: Floats, least: float) -> list[tuple[int, int]]:
    """Runs of steps of one sign above `least`, as first and last row."""
    sign = np.where(np.abs(steps) > least, np.sign(steps), 0.0)
    edges = np.flatnonzero(np.diff(np.concatenate([[0.0], sign, [0.0]])))
    return [(int(a), int(b)) for a, b in pairwise(edges) if sign[a] != 0.0]


def _steps(profile: Floats, jumps: list[tuple[int, int, float]]) -> Floats:
    """The kept jumps as a staircase."""
    stairs = np.zeros_like(profile)
    for first, last, _ in jumps:
        after, before = profile[last : last + 6], profile[max(0, first - 5) : first + 1]
        height = float(np.median(after) - np.median(before))
        stairs[first : last + 1] += np.linspace(0.0, height, last - first + 1)
        stairs[last + 1 :] += height
    return stairs


def _drift(strips: Floats, stairs: Floats) -> Floats:
    """What of the profile of the rows is drift [m]."""
    ny, half = len(strips), strips.shape[1] // 2
    own = _spectrum(strips, stairs)
    pairs = [
        [_spectrum(part, stairs) for part in parts]
        for parts in ((strips[:, :half], strips[:, half:]), (strips[:, ::2], strips[:, 1::2]))
    ]
    bands = _bands(ny)
    null = _null(strips, bands)
    gain = np.zeros(ny)
    for number, (a, b) in enumerate(bands):
        surface = max(null[max(0, number - _NEIGHBOURS) : number + _NEIGHBOURS + 1])
        agreed = min(_correlation(left[a:b], right[a:b]) for left, right in pairs)
        power = _power(own[a:b]) / ny
        if agreed > _AGREED and power > _NULL * surface:
            sure = min(1.0, power / (_NULL * surface) - 1.0) if surface > 0.0 else 1.0
            gain[a:b] = sure * 2.0 * agreed / (1.0 + agreed) * (1.0 - null[number] / power)
    return np.asarray(require("scipy.fft", "images").idct(own * gain, norm="ortho"))


def _spectrum(strips: Floats, stairs: Floats) -> Floats:
    """Cosine transform of the profile of the rows, less `stairs`; the mean is left out."""
    profile = rows.summed(np.diff(strips, axis=0))
    return _transform(profile - stairs)


def _transform(profile: Floats) -> Floats:
    return np.asarray(require("scipy.fft", "images").dct(profile - profile.mean(), norm="ortho"))


def _null(strips: Floats, bands: list[tuple[int, int]]) -> list[float]:
    """What the surface does along x in each band [m^2]; a tilt that levelling has left, a straight line, is none."""
    profile = rows.summed(np.diff(strips.T, axis=0))
    x = np.arange(len(profile))
    level = _transform(profile - np.polyval(np.polyfit(x, profile, 1), x))
    raw = _transform(profile)
    # power per frequency; amplitudes of a cosine transform of n samples grow as the square root of n
    return [min(_power(raw[a:b]), _power(level[a:b])) / len(raw) for a, b in bands]


def _bands(n: int) -> list[tuple[int, int]]:
    """Half octaves from the third frequency on."""
    edges = [1, 2, 3, 4, 6, *(round(8 * 2 ** (k / 2)) for k in range(2 * n.bit_length()))]
    kept = [edge for edge in edges if edge < n] + [n]
    return list(pairwise(kept))


def _power(amplitudes: Floats) -> float:
    return float(np.mean(amplitudes**2)) if amplitudes.size else 0.0


def _correlation(one: Floats, other: Floats) -> float:
    power = float(np.sqrt((one @ one) * (other @ other)))
    return float(one @ other) / power if power > 0.0 else 0.0


def bends(strips: Floats) -> bool:
    """Whether the slope along the rows changes steadily from left to right, as a scanner's bow makes it.

    Median slopes of tiles are fitted by a line on every other tile: it has to explain the other tiles, both ways, and
    with the same curvature.
    """
    slopes, x = _tile_slopes(strips)
    if slopes.shape[1] < 4 or not np.isfinite(slopes).all():
        return False
    even = (np.indices(slopes.shape).sum(axis=0) % 2) == 0
    places = np.broadcast_to(x, slopes.shape)
    curvatures = []
    for fitted, held_out in ((even, ~even), (~even, even)):
        line = _robust_line(places[fitted], slopes[fitted])
        left = float(np.median(np.abs(slopes[held_out] - np.polyval(line, places[held_out]))))
        before = float(np.median(np.abs(slopes[held_out] - np.median(slopes[fitted]))))
        if not left < 0.8 * before:
            return False
        curvatures.append(line[0])
    one, other = curvatures
    return bool(abs(one - other) < 0.15 * abs(one + other))


def _tile_slopes(strips: Floats) -> tuple[Floats, Floats]:
    """Median slopes along x of 8 rows of tiles [m per block], and where the tiles lie."""
    width = max(1, strips.shape[1] // 64)
    count = strips.shape[1] // width
    blocks = strips[:, : count * width].reshape(len(strips), count, width).mean(axis=2)
    steps = _without_walls(np.diff(blocks, axis=1))
    tall, wide = np.array_split(np.arange(len(steps)), 8), np.array_split(np.arange(count - 1), min(16, count // 4))
    slopes = [[_known_median(steps[np.ix_(j, i)]) for i in wide] for j in tall]
    return np.array(slopes), np.array([i.mean() for i in wide])


def _without_walls(steps: Floats) -> Floats:
    """NaN where a step stands out of all by far: of the few in a narrow tile half may lie on the walls of a grating."""
    off = np.abs(steps - _known_median(steps))
    limit = _HIGH * MAD * _known_median(off)
    return np.where(off > limit, np.nan, steps) if limit > 0.0 else steps


def _known_median(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else np.nan


def _robust_line(x: NDArray[np.float64], y: NDArray[np.float64]) -> Floats:
    """Huber-weighted straight line: slope, offset."""
    weight, line = np.ones(y.size), np.zeros(2)
    for _ in range(5):
        line = np.polyfit(x, y, 1, w=np.sqrt(weight))
        off = np.abs(y - np.polyval(line, x))
        limit = 1.345 * MAD * float(np.median(off))
        if limit == 0.0:
            break
        weight = np.minimum(1.0, limit / np.maximum(off, limit))
    return np.asarray(line)
