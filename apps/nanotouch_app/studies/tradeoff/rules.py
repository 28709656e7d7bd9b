# SPDX-License-Identifier: BSD-3-Clause
"""The paper's rules for choosing a model, which state no error, and where a model really meets a tolerance."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from nanotouch_app.studies.tradeoff import errors
from nanotouch_app.studies.tradeoff.errors import Control, Range
from nanotouch_app.studies.tradeoff.measure import Maps
from nanotouch_app.studies.tradeoff.solvers import DMT, HERTZ, JKR, Floats, Solver

#: the lambda from which on a model is said to hold: DMT below, JKR above
THRESHOLDS: tuple[tuple[Solver, float], ...] = ((DMT, 0.12), (JKR, 5.8))
HERTZ_LOAD = 20.0
"""the load above which adhesion is said not to matter, in pull-off forces"""
SPREAD = (1e-6, 0.12, 1.0, 1e3)
"""lambdas at which that is asked"""
TOLERANCES = (1e-3, 0.01, 0.05, 0.1)


class Limit(NamedTuple):
    """Where a model meets a tolerance: below or above ``at``; NaN there if it does everywhere, or nowhere."""

    at: float
    everywhere: bool


def limit(x: Floats, error: Floats, tolerance: float, below: bool) -> Limit:
    """The x below (or above) which an error stays within a tolerance for good, interpolated in logarithms."""
    if not below:
        x, error = x[::-1], error[::-1]
    error = np.maximum.accumulate(np.maximum(error, 1e-300))  # one that dips again farther on gives no licence there
    over = int(np.searchsorted(error, tolerance, side="right"))
    if over in (0, error.size):
        return Limit(float("nan"), over == error.size)
    part = np.log(tolerance / error[over - 1]) / np.log(error[over] / error[over - 1])
    return Limit(float(x[over - 1] * (x[over] / x[over - 1]) ** part), False)


def lambda_limits(solver: Solver, maps: Maps, control: Control, within: Range, rezeroed: bool = False) -> list[Limit]:
    """For each tolerance: DMT holds below, JKR above."""
    error = np.array([errors.worst(solver, control, float(lam), within, rezeroed) for lam in maps.lambdas])
    return [limit(maps.lambdas, error, tolerance, solver is DMT) for tolerance in TOLERANCES]


def load_limits(maps: Maps, control: Control) -> list[Limit]:
    """For each tolerance: the load [pull-off forces] above which Hertz holds at every lambda."""
    pressed = maps.loads > 0.0
    error = maps.error[control, HERTZ.name][:, pressed].max(axis=0)
    return [limit(maps.loads[pressed], error, tolerance, False) for tolerance in TOLERANCES]
