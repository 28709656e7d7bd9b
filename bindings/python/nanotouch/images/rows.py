# SPDX-License-Identifier: BSD-3-Clause
"""Offsets from row to row, told apart from structures that run along the rows.

Aligning every row to the same median, a common default, erases a grating whose lines run along the fast axis. What is
an offset is decided here on the profile of the rows, p: sums of the median differences from row to row, in which
steps across the rows do not show. Kept of it is what lasts: a smoothing that follows slopes and stops at jumps. It
takes local lines, weighted by distance and by likeness of a running median, so a level of four rows or more stays.
The rest is taken for offsets if

* the left and the right half of the image agree on it, so that it is of the rows and not of what lies on them;
* no frequency stands out of it (Fisher's test), else it is a fine grating.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from ._robust import MAD, middle

_HALF = 3  # [row]; half the window of the running median: levels of four rows stay
_REACH = 10  # [row]; standard deviation of the weights by distance
_LIKE = 3.0  # standard deviations of the offsets by which neighbours may differ and still be of one level
_FAR = 6.0  # standard deviations beyond which one row is a structure or a disturbance rather than an offset
_AGREED = 0.4  # correlation of the halves; above 1/3 taking the offsets out removes more than it brings in
_FINE = 4  # frequencies tried between two of the transform, so that none falls between them
_CHANCE = 1e-4  # that a white profile passes for a periodic one


@dataclass(frozen=True)
class RowProfile:
    """What the rows stand at, and which part of it is offset.

    Attributes
    ----------
    offsets : ndarray, shape (ny,)
        The part taken for offsets [m]; 0 everywhere if `agreed` is False or `period` is not None.
    lasting : float
        Range of the part that lasts: steps, slopes, waves [m].
    jumps : int
        Steps across whole rows in the kept part.
    highest_jump : float
        The highest of them [m].
    single : tuple of int
        Rows far off both sides, among the offsets.
    highest_single : float
        The furthest of them [m].
    period : float or None
        Of a fine grating along the rows [row], if the test found one.
    wave : float
        Range of the means of the rows, all of which an alignment of every row would erase [m].
    agreed : bool
        Whether both halves of the image show the same offsets.
    """

    offsets: Floats
    lasting: float
    jumps: int
    highest_jump: float
    single: tuple[int, ...]
    highest_single: float
    period: float | None
    wave: float
    agreed: bool


def analyse(strips: Floats) -> RowProfile:
    """Tell offsets from structures. strips: (ny, columns), means over blocks along x [m], NaN where not to count."""
    steps = np.diff(strips, axis=0)
    half = steps.shape[1] // 2
    profile = summed(steps)
    guide = _running_median(profile)
    rounding = 1e-9 * float(np.nanmax(strips) - np.nanmin(strips))
    spread = max(MAD * float(np.median(np.abs(profile - guide))), rounding)
    usual = np.abs(profile - guide) <= _FAR * spread
    weights = _weights(guide, usual, spread)
    kept = _straightened(_local_lines(profile, weights), profile, guide, usual, spread)
    offsets = profile - kept
    left, right = (p - _local_lines(p, weights) for p in (summed(steps[:, :half]), summed(steps[:, half:])))
    power = float(np.sqrt((left @ left) * (right @ right)))
    agreed = power > len(profile) * rounding**2 and left @ right >= max(_AGREED, 4.0 / np.sqrt(len(profile))) * power
    period = _period(offsets) if agreed else None
    if not agreed or period is not None:
        offsets = np.zeros_like(profile)
    means = _means(strips)  # the profile is a sum of ny medians, whose errors add up
    within = MAD * middle(np.abs(steps[np.isfinite(steps)]))
    jumps = _runs(np.diff(guide), max(_FAR * spread, _FAR * within, 1e-3 * float(np.ptp(profile))))
    far = np.flatnonzero(np.abs(offsets) > _FAR * spread)
    return RowProfile(
        offsets,
        float(np.ptp(_local_lines(means, weights))),
        len(jumps),
        max(map(abs, jumps), default=0.0),
        tuple(int(j) for j in far),
        float(np.abs(offsets[far]).max(initial=0.0)),
        period,
        float(np.ptp(means)),
        bool(agreed),
    )


def summed(steps: Floats) -> Floats:
    """Sums of the medians from row to row; pairs of rows without a known difference count as level."""
    ordered = np.sort(steps, axis=1)  # NaN last
    known = np.count_nonzero(np.isfinite(steps), axis=1)
    row = np.arange(len(steps))
    low, high = np.maximum(known - 1, 0) // 2, known // 2
    medians = 0.5 * (ordered[row, low] + ordered[row, np.minimum(high, steps.shape[1] - 1)])
    return np.concatenate([[0.0], np.cumsum(np.where(known > 0, medians, 0.0))])


def _running_median(profile: Floats) -> Floats:
    """Over seven rows; the ends go on in mirror image about their height, which keeps slopes."""
    low = 2 * profile[0] - profile[_HALF:0:-1]
    high = 2 * profile[-1] - profile[-2 : -_HALF - 2 : -1]
    padded = np.concatenate([low, profile, high])
    return np.asarray(np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * _HALF + 1), axis=1))


def _weights(guide: Floats, usual: NDArray[np.bool_], spread: float) -> Floats:
    """Of the rows around each row: (ny, 2 reach + 1); 0 beyond the ends, across jumps and for unusual rows.

    A row with nothing like it counts for itself.
    """
    reach = 3 * _REACH
    distance = np.arange(-reach, reach + 1)
    level = np.pad(np.where(usual, guide, np.inf), reach, constant_values=np.inf)
    unlike = np.abs(np.lib.stride_tricks.sliding_window_view(level, 2 * reach + 1) - guide[:, None])
    weights = np.exp(-0.5 * (distance / _REACH) ** 2) * (unlike <= _LIKE * spread)
    weights[~weights.any(axis=1), reach] = 1.0
    return np.asarray(weights)


def _local_lines(profile: Floats, weights: Floats) -> Floats:
    """At each row the weighted least-squares line through the rows around it; their mean where they give no line."""
    reach = weights.shape[1] // 2
    x = np.arange(-reach, reach + 1)
    values = np.lib.stride_tricks.sliding_window_view(np.pad(profile, reach), 2 * reach + 1)
    moments = weights @ np.stack([np.ones(len(x)), x, x**2], axis=1)
    s0, s1, s2 = moments.T
    t0 = np.einsum("ij,ij->i", weights, values)
    t1 = np.einsum("ij,ij,j->i", weights, values, x.astype(float))
    determinant = s0 * s2 - s1**2
    line = determinant > 1e-9 * s0 * s2
    return np.asarray(np.where(line, s2 * t0 - s1 * t1, t0) / np.where(line, determinant, s0))


def _straightened(kept: Floats, profile: Floats, guide: Floats, usual: NDArray[np.bool_], spread: float) -> Floats:
    """Between jumps one straight line, where the local ones differ from it by no more than white offsets explain."""
    kept = kept.copy()
    ends = np.flatnonzero(np.abs(np.diff(guide)) > _LIKE * spread) + 1
    explained = 5.0 * spread / np.sqrt(2.0 * np.sqrt(np.pi) * _REACH)  # five standard deviations of a weighted mean
    for part in np.split(np.arange(len(profile)), ends):
        if len(part) >= 4 * _REACH:
            inside = part[usual[part]]
            line = np.polyval(np.polyfit(inside, profile[inside], 1), part)
            if np.abs(kept[part] - line).max() < explained:
                kept[part] = line
    return kept


def _period(offsets: Floats) -> float | None:
    """Of the one frequency that stands out, if white noise would give it less than once in a million [row]."""
    n = len(offsets)
    power = np.abs(np.fft.rfft(offsets, _FINE * n))[_FINE:] ** 2
    if not power.any():
        return None
    share, m = float(power.max() / (power.sum() / _FINE)), n // 2
    # Fisher (1929): the chance that the largest of m shares exceeds g is below m (1 - g)^(m - 1)
    chance = _FINE * m * max(1.0 - share, 0.0) ** (m - 1)
    return _FINE * n / (_FINE + int(power.argmax())) if chance < _CHANCE else None


def _runs(steps: Floats, least: float) -> list[float]:
    """Heights of the jumps: neighbouring steps of one sign, each above a third of `least`, together above it."""
    found: list[float] = []
    total = 0.0
    for step in [*steps, 0.0]:
        counts = abs(step) > least / 3
        if counts and step * total >= 0:
            total += step
            continue
        if abs(total) > least:
            found.append(float(total))
        total = float(step) if counts else 0.0
    return found


def _means(strips: Floats) -> Floats:
    """Mean of each row [m]; where none of it is known, between its neighbours'."""
    known = np.isfinite(strips)
    count, row = known.sum(axis=1), np.arange(len(strips))
    total = np.where(known, strips, 0.0).sum(axis=1)
    return np.asarray(np.interp(row, row[count > 0], total[count > 0] / count[count > 0]))


def medians(strips: Floats) -> Floats:
    """Median of each row about their mean [m]; 0 where a row has no known block."""
    known = np.isfinite(strips)
    ordered = np.sort(strips, axis=1)
    count, row = known.sum(axis=1), np.arange(len(strips))
    last = strips.shape[1] - 1
    middle = 0.5 * (ordered[row, np.maximum(count - 1, 0) // 2] + ordered[row, np.minimum(count // 2, last)])
    middle[count == 0] = np.nan
    return np.asarray(np.nan_to_num(middle - np.nanmean(middle)))
