# SPDX-License-Identifier: BSD-3-Clause
"""The user's question in one picture: what does accuracy cost, of a law by itself and felt in the loop?"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from nanotouch.errors import require
from nanotouch.plots import new_figure

from nanotouch_app.studies.tradeoff import errors, plant, timing
from nanotouch_app.studies.tradeoff.measure import ROUNDING, Row
from nanotouch_app.studies.tradeoff.solvers import EXACT, SOLVERS, pull_off

PERIOD = 1.0 / plant.RATE
SINGLE_LAMBDA = 0.12
"""of the single calls that are timed: their cost hardly depends on it"""


class Point(NamedTuple):
    """One way to get a force: its share of the loop's period, and its error."""

    kind: str
    name: str
    share: float
    error: float
    """of a law: of F(delta), P = 0 to 10 pull-off forces, worst over lambda; in the loop: RMS of the felt force [-]"""


ARRAY, SINGLE = "a law, in arrays", "a law, single calls from Python"
LOOP = {"quasi-static": "a plan in the loop, quasi-static probe", "dynamic": "a plan in the loop, dynamic probe"}
LOOKS = {ARRAY: ("o", "tab:blue"), SINGLE: ("s", "tab:cyan"), LOOP["quasi-static"]: ("D", "tab:orange"),
         LOOP["dynamic"]: ("^", "tab:red")}  # fmt: skip


def points(rows: list[Row], planned: list[plant.Planned], runs: int) -> list[Point]:
    """All ways; single calls are timed here."""
    indentation = EXACT.indentation(SINGLE_LAMBDA, np.array([3.0 * pull_off(SINGLE_LAMBDA)]))
    single = timing.nanoseconds({s.name: s.prepare(SINGLE_LAMBDA, indentation) for s in SOLVERS}, runs)
    found = []
    for solver in SOLVERS:
        own = [row for row in rows if row.solver == solver.name]
        error = max(row.against_exact for row in own if row.loads == "moderate")
        array = float(np.median([row.nanoseconds for row in own]))
        found.append(Point(ARRAY, solver.name, 1e-9 * array / PERIOD, error))
        found.append(Point(SINGLE, solver.name, 1e-9 * single[solver.name] * timing.ELEMENTS / PERIOD, error))
    found += [Point(LOOP[row.probe], row.forms, row.share, row.rms) for row in planned]
    return found


def sentences(found: list[Point]) -> str:
    """What the picture says, from its numbers."""
    array = {point.name: point.share for point in found if point.kind == ARRAY}
    spread = {}
    for kind in LOOP.values():
        shares = [point.share for point in found if point.kind == kind]
        spread[kind] = (min(shares), max(shares))
    still, moving = (spread[kind] for kind in LOOP.values())
    return (
        f"In arrays the table of Maugis-Dugdale costs {array['MD table'] / array['Hertz']:.2g} times what Hertz costs, "
        f"and in a quasi-static loop every plan takes {percent(still[0])} to {percent(still[1])} of the period: there "
        f"is no trade, take the accurate one.\nWith the dynamic probe ({plant.SUBSTEP:g} rad) plans take "
        f"{percent(moving[0])} to {percent(moving[1])} of the period, a factor of {moving[1] / moving[0]:.2g}: "
        "there the cheapest plan that keeps your bound is worth having."
    )


def percent(share: float) -> str:
    """Two digits, or a whole number."""
    return f"{100 * share:.2g} %" if share < 1.0 else f"{100 * share:.0f} %"


def draw(found: list[Point]) -> Any:
    """Error over share of the period, every law named once."""
    figure = new_figure(11.0, 6.5)
    panel = figure.subplots()
    for kind, (marker, colour) in LOOKS.items():
        own = [point for point in found if point.kind == kind]
        panel.plot([p.share for p in own], [max(p.error, ROUNDING) for p in own], marker, color=colour, ms=8, mec="k",
                   mew=0.4, label=kind)  # fmt: skip
        named = sorted(own, key=lambda point: point.error) if kind == SINGLE else []
        for number, point in enumerate(named):
            panel.annotate(point.name, (point.share, max(point.error, ROUNDING)), xytext=(7, -14 if number % 2 else 6),
                           textcoords="offset points", fontsize="small")  # fmt: skip
    panel.axvline(1.0, color="0.5", ls="--", lw=1.0)
    panel.text(0.9, 3e-11, f"the period of {1e-3 / PERIOD:g} kHz", rotation=90, ha="right", color="0.4")
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.yaxis.set_minor_formatter(require("matplotlib.ticker", "app").NullFormatter())
    panel.set_xlabel("share of the loop's period [-], this machine")
    panel.set_ylabel("error: of the force of a law; RMS of the felt force in the loop [-]")
    panel.set_title(sentences(found), loc="left", fontsize="small", wrap=True)
    panel.grid(alpha=0.3)
    panel.legend(loc=(0.12, 0.3), fontsize="small")
    return figure


def columns(found: list[Point]) -> dict[str, list[object]]:
    """The picture as a table."""
    headers = ("kind (name)", "law or plan (name)", "share of the period [-]", "error [-]")
    return {header: list(values) for header, values in zip(headers, zip(*found, strict=True), strict=True)}


def section(found: list[Point], planned: list[plant.Planned]) -> str:
    """Of the page on accuracy."""
    lines = ["| probe | plan | bound | share of the period | felt: largest | felt: RMS |", "|" + " --- |" * 6]
    for row in planned:
        lines.append(
            f"| {row.probe} | {row.forms} | {row.bound:.1e} | {percent(row.share)} | {_error(row.peak)} | "
            f"{_error(row.rms)} |"
        )
    return f"""## The answer

{sentences(found)}

`tradeoff.png` draws both beside the laws in arrays and in single calls. Felt is the force that the loop hands to the
hand, beside the same touch with everything exact, over the whole run, jump-in included.

{chr(10).join(lines)}"""


def _error(error: float) -> str:
    return "none" if error == 0.0 else f"{error:.1e}" if not math.isnan(error) else ""


def extremes(lambdas: tuple[float, float] = (1e-12, 1e12), loads: tuple[float, float] = (1e-12, 1e12)) -> str:
    """The tiers of Maugis-Dugdale far outside of what is met: one sentence."""
    made = [s for s in SOLVERS if s.name in ("MD table", "MD polished")]
    worst, wrong, tried = {s.name: 0.0 for s in made}, 0, 0
    for lam in np.geomspace(*lambdas, 49):
        pull = pull_off(float(lam))
        P = pull * np.concatenate([[-0.99], np.geomspace(*loads, errors.POINTS)])
        d = EXACT.indentation(float(lam), P)
        truth = EXACT.force(float(lam), d)
        for solver in made:
            force = solver.force(float(lam), d)
            wrong += int(np.count_nonzero(~np.isfinite(force)))
            tried += force.size
            error = np.abs(force - truth) / np.maximum(np.abs(truth), pull)
            worst[solver.name] = max(worst[solver.name], float(np.nanmax(error)))
        wrong += int(np.count_nonzero(~np.isfinite(truth)))
    errors_ = ", ".join(f"{name} {error:.1e}" for name, error in worst.items())
    return (
        f"Extremes: λ = {lambdas[0]:g} .. {lambdas[1]:g}, P up to {loads[1]:g} P_c, {tried} forces: largest error "
        f"{errors_}; {wrong} results not finite."
    )
