# SPDX-License-Identifier: BSD-3-Clause
"""How far a solver is from exact Maugis-Dugdale and from the Lennard-Jones sphere.

An error belongs to a control and a quantity. Grips hold the indentation; the error is that of the force,
|dF|/max(|F|, |F_pull-off|). A dead weight holds the load; the error is that of the radius, |da|/a, and 1 where the
model sees no contact. Loads are in pull-off forces of the truth.
"""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np
from nanotouch import reference

from nanotouch_app.studies.tradeoff.solvers import EXACT, Floats, Solver, pull_off

Control = Literal["grips", "load"]
CONTROLS: tuple[Control, ...] = get_args(Control)
Range = Literal["adhesive", "moderate", "high"]
RANGES: tuple[Range, ...] = get_args(Range)
POINTS = 201
"""in a range: enough that the tiers answer from their tables (fewer points are solved exactly)"""
WORDS = {
    "adhesive": "-0.95 to 0 pull-off forces",
    "moderate": "0 to 10 pull-off forces",
    "high": "10 to 10 000 pull-off forces",
}


def loads(within: Range, points: int = POINTS) -> Floats:
    """Loads of a range, in pull-off forces."""
    if within == "adhesive":
        return np.linspace(-0.95, 0.0, points)
    if within == "moderate":  # dense below 1, where the errors of a force that is small beside pull-off peak
        low = np.linspace(0.0, 1.0, points // 2 + 1)
        return np.concatenate([low, np.geomspace(1.0, 10.0, points - low.size + 1)[1:]])
    return np.geomspace(10.0, 1e4, points)


def error(solver: Solver, control: Control, lam: float, over_pull_off: Floats, rezeroed: bool = False) -> Floats:
    """Error against exact Maugis-Dugdale, load by load; ``rezeroed`` counts indentations from zero load."""
    scale = pull_off(lam)
    P = over_pull_off * scale
    if control == "load":
        a = EXACT.radius(lam, P)
        found = solver.radius(lam, P)
        return np.asarray(np.where(np.isnan(found), 1.0, np.abs(found - a) / a))
    shift = _zero(solver, lam) - _zero(EXACT, lam) if rezeroed else 0.0
    found = solver.force(lam, EXACT.indentation(lam, P) + shift)
    return np.asarray(np.abs(found - P) / np.maximum(np.abs(P), scale))


def worst(solver: Solver, control: Control, lam: float, within: Range, rezeroed: bool = False) -> float:
    """The largest error in a range of loads."""
    return float(np.max(error(solver, control, lam, loads(within), rezeroed)))


def to_lennard_jones(solver: Solver, lam: float, within: Range, rezeroed: bool = False) -> float:
    """Largest error of the force under grips against the Lennard-Jones sphere; NaN where its table does not reach."""
    mu = lam / reference.LAMBDA_PER_MU
    low, high = reference.mu_range()
    if not low <= mu <= high:
        return float("nan")
    truth = reference.lennard_jones(mu)
    scale = -truth.pull_off_load
    P = loads(within) * scale
    if P[-1] > truth.P[-1]:
        return float("nan")
    shift = _zero(solver, lam) - truth.zero_load_indentation if rezeroed else 0.0
    found = solver.force(lam, np.asarray(truth.indentation(P)) + shift)
    return float(np.max(np.abs(found - P) / np.maximum(np.abs(P), scale)))


def _zero(solver: Solver, lam: float) -> float:
    return float(solver.indentation(lam, np.zeros(1))[0])
