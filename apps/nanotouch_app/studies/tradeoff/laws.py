# SPDX-License-Identifier: BSD-3-Clause
"""Contact laws by themselves: error against processor time, in arrays and one by one, and the tiers at extremes."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from nanotouch.plots import new_figure

from nanotouch_app.studies.tradeoff import errors, timing
from nanotouch_app.studies.tradeoff.drawing import Label, label, logarithmic, settle
from nanotouch_app.studies.tradeoff.measure import ROUNDING, Row
from nanotouch_app.studies.tradeoff.solvers import EXACT, SOLVERS, Call, Floats, pull_off

SINGLE_LAMBDA = 0.12
"""of the single calls that are timed: their cost hardly depends on it"""
CALLS = 100
"""between two readings of the clock, which takes as long as a call"""
ARRAY, SINGLE = "in arrays", "single calls from Python"
LOOKS = {ARRAY: ("o", "tab:blue"), SINGLE: ("s", "tab:red")}
TIERS = tuple(solver for solver in SOLVERS if solver.name in ("MD table", "MD polished"))
EXTREMES = (1e-12, 1e12)
"""of lambda, and of the load in pull-off forces"""


class Point(NamedTuple):
    """One way to get a force."""

    kind: str
    name: str
    nanoseconds: float
    """processor time of one force"""
    error: float
    """of F(delta), P = 0 to 10 pull-off forces, worst over lambda [-]"""


class Extremes(NamedTuple):
    """Errors of the tiers far outside of what is met."""

    lambdas: Floats
    error: dict[str, Floats]
    """by tier: the largest over all loads, for each lambda; NaN counts as infinite"""
    tried: int
    wrong: int
    """results that are not finite"""


def points(rows: list[Row], runs: int) -> list[Point]:
    """All ways; single calls are timed here."""
    indentation = EXACT.indentation(SINGLE_LAMBDA, np.array([3.0 * pull_off(SINGLE_LAMBDA)]))
    single = timing.nanoseconds({s.name: _often(s.prepare(SINGLE_LAMBDA, indentation)) for s in SOLVERS}, runs)
    found = []
    for solver in SOLVERS:
        own = [row for row in rows if row.solver == solver.name]
        error = max(row.against_exact for row in own if row.loads == "moderate")
        array = float(np.median([row.nanoseconds for row in own]))
        found.append(Point(ARRAY, solver.name, array, error))
        found.append(Point(SINGLE, solver.name, single[solver.name] * timing.ELEMENTS / CALLS, error))
    return found


def _often(call: Call) -> Call:
    def calls() -> Floats:
        for _ in range(CALLS - 1):
            call()
        return call()

    return calls


def columns(found: list[Point]) -> dict[str, list[object]]:
    """As a table."""
    headers = ("called (name)", "law (name)", "processor time [ns]", "force error [-]")
    return {header: list(values) for header, values in zip(headers, zip(*found, strict=True), strict=True)}


def extremes() -> Extremes:
    """The tiers from lambda = 1e-12 to 1e12, at loads from -0.99 to 1e12 pull-off forces."""
    lambdas = np.geomspace(*EXTREMES, 49)
    error = {tier.name: np.empty(lambdas.size) for tier in TIERS}
    tried = wrong = 0
    for number, lam in enumerate(lambdas):
        pull = pull_off(float(lam))
        d = EXACT.indentation(float(lam), pull * np.concatenate([[-0.99], np.geomspace(*EXTREMES, errors.POINTS)]))
        truth = EXACT.force(float(lam), d)
        for tier in TIERS:
            off = np.abs(tier.force(float(lam), d) - truth) / np.maximum(np.abs(truth), pull)
            tried, wrong = tried + off.size, wrong + int(np.count_nonzero(~np.isfinite(off)))
            error[tier.name][number] = np.nan_to_num(off, nan=np.inf).max()
    return Extremes(lambdas, error, tried, wrong)


def sentence(found: Extremes) -> str:
    """What the extremes say."""
    worst = ", ".join(f"{name} {error.max():.1e}" for name, error in found.error.items())
    low, high = EXTREMES
    return (
        f"Extremes: λ = {low:g} .. {high:g}, P up to {high:g} P_c, {found.tried} forces: max error {worst}; "
        f"{found.wrong} results not finite."
    )


def draw(found: list[Point], far: Extremes) -> Any:
    """Error over processor time, each law named; beside it the extremes."""
    figure = new_figure(13.0, 6.0)
    panel, beside = figure.subplots(1, 2)
    for kind, (marker, colour) in LOOKS.items():
        x, y = zip(*((p.nanoseconds, max(p.error, ROUNDING)) for p in found if p.kind == kind), strict=True)
        panel.plot(x, y, marker, color=colour, ms=8, mec="k", mew=0.4, label=kind)
    logarithmic(panel)
    panel.set_xlabel("processor time of one force [ns], this machine")
    panel.set_ylabel("max error of the force under grips, against exact Maugis-Dugdale [-]")
    panel.legend(fontsize="small", loc="center")
    for name, error in far.error.items():
        beside.plot(far.lambdas, np.maximum(error, ROUNDING), "-o", ms=3, label=name)
    logarithmic(beside)
    beside.set_xlabel("λ [-]")
    beside.set_ylabel(f"max error over loads up to {EXTREMES[1]:g} pull-off forces [-]")
    beside.legend(fontsize="small")
    settle(figure)
    label(panel, [Label(p.nanoseconds, max(p.error, ROUNDING), p.name, LOOKS[p.kind][1]) for p in found])
    return figure
