# SPDX-License-Identifier: BSD-3-Clause
"""Everything that is measured: cost and error of every solver, and error maps over lambda and load."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from nanotouch_app.studies.tradeoff import errors
from nanotouch_app.studies.tradeoff.errors import CONTROLS, RANGES, Control, Range
from nanotouch_app.studies.tradeoff.solvers import EXACT, MAPPED, SOLVERS, Floats, pull_off
from nanotouch_app.studies.tradeoff.timing import ELEMENTS, nanoseconds

#: of the trade: hard and small to soft and large, those in 0.06 .. 5 in reach of the Lennard-Jones table
LAMBDAS = (1e-4, 1e-3, 0.01, 0.06, 0.12, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0, 1e3)
MAP_LAMBDAS = (1e-6, 1e3)
MAP_POINTS = 67
ROUNDING = 1e-15
"""smaller errors are those of the inputs' own rounding"""
QUICK_LAMBDAS = (0.01, 0.12, 1.0, 5.0)


class Row(NamedTuple):
    """One solver at one lambda, in one range of loads."""

    lam: float
    loads: Range
    solver: str
    nanoseconds: float
    """per element of an array of indentations"""
    against_exact: float
    """largest error of the force under grips, against exact Maugis-Dugdale"""
    against_lennard_jones: float
    """the same against the Lennard-Jones sphere; NaN where its table does not reach"""
    against_lennard_jones_rezeroed: float
    """the same with both indentations counted from zero load"""


class Maps(NamedTuple):
    """Errors over lambda and load."""

    lambdas: Floats
    loads: Floats
    """[pull-off forces]"""
    error: dict[tuple[Control, str], Floats]
    """by control and solver: [lambda, load]"""


def trade(quick: bool, progress: Callable[[float], None]) -> list[Row]:
    """Cost and error of every solver at every lambda in every range of loads."""
    lambdas = QUICK_LAMBDAS if quick else LAMBDAS
    cells = [(lam, within) for lam in lambdas for within in RANGES]
    rows = []
    for number, (lam, within) in enumerate(cells):
        rows += _rows(lam, within, 2 if quick else 8)
        progress((number + 1) / len(cells))
    return rows


def _rows(lam: float, within: Range, runs: int) -> list[Row]:
    edges = errors.loads(within)[[0, -1]] * pull_off(lam)
    low, high = EXACT.indentation(lam, edges)
    d = np.linspace(low, high, ELEMENTS)
    cost = nanoseconds({s.name: s.prepare(lam, d) for s in SOLVERS}, runs)
    return [
        Row(
            lam,
            within,
            s.name,
            cost[s.name],
            errors.worst(s, "grips", lam, within),
            errors.to_lennard_jones(s, lam, within),
            errors.to_lennard_jones(s, lam, within, rezeroed=True),
        )
        for s in SOLVERS
    ]


def maps(quick: bool, progress: Callable[[float], None]) -> Maps:
    """Errors of everything but the exact solver, from deep adhesion to high loads."""
    low, high = np.log10(MAP_LAMBDAS)
    lambdas = np.logspace(low, high, round((high - low) * (4 if quick else 12)) + 1)
    loads = np.unique(np.concatenate([errors.loads(within, MAP_POINTS) for within in RANGES]))
    error: dict[tuple[Control, str], Floats] = {
        (control, s.name): np.empty((lambdas.size, loads.size)) for control in CONTROLS for s in MAPPED
    }
    for i, lam in enumerate(lambdas):
        for control in CONTROLS:
            for s in MAPPED:
                error[control, s.name][i] = errors.error(s, control, float(lam), loads)
        progress((i + 1) / lambdas.size)
    return Maps(lambdas, loads, error)


def map_columns(found: Maps) -> dict[str, Floats]:
    """The maps as a table, header with unit to values; lambda varies slowest."""
    lam, load = np.meshgrid(found.lambdas, found.loads, indexing="ij")
    quantity = {"grips": "|dF|/max(|F|;|F_pull-off|) [-]", "load": "|da|/a [-]"}
    columns = {"lambda [-]": lam.ravel(), "load over pull-off force [-]": load.ravel()}
    for (control, name), error in found.error.items():
        columns[f"{name} {control}: {quantity[control]}"] = error.ravel()
    return columns


def trade_columns(rows: list[Row]) -> dict[str, list[object]]:
    """The trade as a table."""
    headers = (
        "lambda [-]",
        "load range (name)",
        "solver (name)",
        "time per element [ns]",
        "force error against MD exact [-]",
        "force error against Lennard-Jones [-]",
        "force error against Lennard-Jones from zero load [-]",
    )
    return {header: list(values) for header, values in zip(headers, zip(*rows, strict=True), strict=True)}
