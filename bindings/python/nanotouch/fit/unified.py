# SPDX-License-Identifier: BSD-3-Clause
"""The interval of a quantity that cannot be negative, measured with a Gaussian error (Feldman and Cousins 1998)."""

from __future__ import annotations

from functools import cache
from math import erf, inf, sqrt

import numpy as np

from .models import Floats

_LEVEL = 0.95
_GAUSSIAN = 1.959963984540054
_ONE_SIDED = 1.6448536269514722
_FAR = 4.0  # standard deviations from 0 beyond which the bound does not matter
_STEPS = 50


def unified_interval(measured: float, sigma: float) -> tuple[float, float]:
    """95 % of a true value >= 0 by its unbounded estimate, which may be negative, and that one's standard deviation.

    It covers 95 % whatever the true value: an upper limit near 0 goes over into two ends by itself.
    """
    if not np.isfinite(sigma):
        return 0.0, inf
    x = measured / sigma
    if x > _FAR:
        return measured - _GAUSSIAN * sigma, measured + _GAUSSIAN * sigma
    true, lower, upper = _belt()
    x = max(x, -_FAR)  # farther out is no Gaussian error
    low = 0.0 if x <= _ONE_SIDED else float(np.interp(x, upper, true))
    return low * sigma, float(np.interp(x, lower, true)) * sigma


@cache
def _belt() -> tuple[Floats, Floats, Floats]:
    """True values, and between which two measurements each accepts 95 %: ends of equal likelihood ratio, all in
    standard deviations."""
    true = np.linspace(0.0, _FAR + 3.0, 701)[1:]
    above = np.array([_half_width(float(mu)) for mu in true])  # of the upper end
    lower = np.array([_lower(float(mu), float(up)) for mu, up in zip(true, above, strict=True)])
    return true, lower, true + above


def _half_width(true: float) -> float:
    low, high = 0.0, 6.0
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        if _normal(middle) - _normal(_lower(true, middle) - true) < _LEVEL:
            low = middle
        else:
            high = middle
    return high


def _lower(true: float, above: float) -> float:
    """The measurement x with the likelihood ratio of true + above: exp(-(x - mu)^2/2), below 0 exp(x mu - mu^2/2)."""
    symmetric = true - above
    return symmetric if symmetric >= 0.0 else 0.5 * true - 0.5 * above**2 / true


def _normal(x: float) -> float:
    return 0.5 * (1.0 + erf(x / sqrt(2.0)))
