# SPDX-License-Identifier: BSD-3-Clause
"""White and 1/f (flicker) noise of a record, told apart by how its means scatter (``nanotouch/curves.h``)."""

from __future__ import annotations

from typing import NamedTuple

from .. import _core
from .._arrays import Floats


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
    return Noise(*_core.split_noise(rest, scatter))


def point_noise(force: Floats) -> float:
    """Standard deviation of white noise, from differences of neighbours, so that no shape of the curve enters [N]."""
    return _core.point_noise(force)


def correlated_noise(noise: float, free: Noise, count: int) -> float:
    """Standard deviation of one point such that the mean of `count` independent ones would scatter as theirs [N].

    0 where the free cantilever does not show that they are not independent.
    """
    return _core.correlated_noise(noise, free, count)


def residual_correlation(rest: Floats) -> float:
    """By how much the residuals' correlation raises the variance of their mean; 1 where it is not evident."""
    return _core.residual_correlation(rest)
