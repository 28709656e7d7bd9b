# SPDX-License-Identifier: BSD-3-Clause
"""White and 1/f (flicker) noise of a record, told apart by how its means scatter.

Half the mean squared difference of neighbouring means of m points is the Allan variance, w/m of white noise and a
constant of flicker noise, which no number of points averages away. Both are fitted to the octaves of m by maximum
likelihood (for Gaussian noise each difference is one draw), coarse ones only: in fine ones the electronics have their
say.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .._arrays import Floats

_FINEST = 8  # points of a mean: what is smeared over fewer counts as white
_FEWEST = 4  # differences of an octave
_OCTAVES = 5
_EVIDENT = 1.0  # gain in ln L: white noise passes for flicker once in 20 to 30 records
_OF_THE_MEAN = 0.6  # variance of a mean over Allan's, of flicker noise about a line, 0.5 .. 0.7 for 10 .. 50 % of it
_RATIOS = np.concatenate([[0.0], np.geomspace(1e-3, 1e3, 121)])  # of flicker to white noise in the first octave
_SHAPES = 1.0 + np.outer(_RATIOS, 2.0 ** np.arange(_OCTAVES))  # of white noise alone, in each octave
_LOGARITHMS = np.log(_SHAPES)


class Noise(NamedTuple):
    """The mean of n neighbouring points has the variance ``white/n + flicker``.

    Attributes
    ----------
    white, flicker : float
        [N^2].
    """

    white: float
    flicker: float


def split_noise(rest: Floats, scatter: float) -> Noise:
    """Of residuals in their order of time with a robust standard deviation `scatter`, which white is no less than."""
    octaves = _octaves(rest)
    if len(octaves) < 2:
        return Noise(scatter**2, 0.0)
    size, count, variance = np.array(octaves).T
    white = (1.0 / _SHAPES[:, : size.size]) @ (variance * count) / count.sum()
    if white[0] == 0.0:
        return Noise(scatter**2, 0.0)
    gain = -0.5 * (np.log(white / white[0]) * count.sum() + _LOGARITHMS[:, : size.size] @ count)
    best = int(np.argmax(gain))
    if gain[best] <= _EVIDENT:
        best = 0
    flicker = _OF_THE_MEAN * white[best] * _RATIOS[best] / size[0]
    return Noise(max(float(white[best]), scatter**2), float(flicker))


def _octaves(rest: Floats) -> list[tuple[int, int, float]]:
    """Points of a mean, number of differences, m times the Allan variance; the coarsest octaves."""
    found, size, means = [], 1, rest
    while means.size >= 2 * _FEWEST:
        pairs = means[: means.size // 2 * 2].reshape(-1, 2)
        if size >= _FINEST:
            difference = pairs[:, 0] - pairs[:, 1]
            found.append((size, difference.size, 0.5 * size * float(difference @ difference) / difference.size))
        size, means = 2 * size, 0.5 * (pairs[:, 0] + pairs[:, 1])
    return found[-_OCTAVES:]
