# SPDX-License-Identifier: BSD-3-Clause
"""The two pictures: cost against error with the Pareto fronts, and error maps with the paper's thresholds."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from nanotouch.errors import require
from nanotouch.plots import new_figure

from nanotouch_app.tradeoff import errors
from nanotouch_app.tradeoff.errors import CONTROLS, Control
from nanotouch_app.tradeoff.measure import ROUNDING, Maps, Row, front
from nanotouch_app.tradeoff.rules import HERTZ_LOAD, SPREAD, THRESHOLDS
from nanotouch_app.tradeoff.solvers import HERTZ

MARKERS = "svD^o*Ph"


def trade(rows: list[Row]) -> Any:
    """Error against cost: adhesive and moderate loads (rows), against exact MD and Lennard-Jones (columns)."""
    figure = new_figure(13.0, 9.5)
    panels = figure.subplots(2, 2, sharex=True)
    truths: tuple[tuple[str, Callable[[Row], float]], ...] = (
        ("exact Maugis-Dugdale", lambda row: row.against_exact),
        ("Lennard-Jones sphere, indentation from zero load", lambda row: row.against_lennard_jones_rezeroed),
    )
    for line, within in zip(panels, ("adhesive", "moderate"), strict=True):
        for panel, (truth, error) in zip(line, truths, strict=True):
            _trade_panel(panel, [row for row in rows if row.loads == within], error)
            panel.set_title(f"against {truth}\n{errors.WORDS[within]}", loc="left", fontsize="medium")
    for panel in panels[:, 0]:
        panel.set_ylabel("largest |ΔF| / max(|F|, |F_pull-off|) under grips [-]")
    for panel in panels[-1]:
        panel.set_xlabel("time per element of an array [ns], this machine, through Python")
    _trade_legends(figure, rows)
    return figure


def _trade_panel(panel: Any, rows: list[Row], error: Callable[[Row], float]) -> None:
    lambdas = sorted({row.lam for row in rows})
    names = _names(rows)
    for lam in lambdas:
        group = [row for row in rows if row.lam == lam and not math.isnan(error(row))]
        if not group:
            continue
        colour = _colour(lam, lambdas)
        for row in group:
            marker = MARKERS[names.index(row.solver)]
            panel.plot(row.nanoseconds, max(error(row), ROUNDING), marker, color=colour, ms=7, mec="k", mew=0.4)
        best = front(group, error)
        height = [max(error(row), ROUNDING) for row in best]
        panel.step([row.nanoseconds for row in best], height, where="post", color=colour, lw=1.1, alpha=0.8)
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.xaxis.set_minor_formatter(require("matplotlib.ticker", "app").NullFormatter())
    panel.grid(alpha=0.3)


def _trade_legends(figure: Any, rows: list[Row]) -> None:
    line = require("matplotlib.lines", "app").Line2D
    lambdas, names = sorted({row.lam for row in rows}), _names(rows)
    shapes = [line([], [], color="0.4", marker=MARKERS[i], ls="", label=name) for i, name in enumerate(names)]
    fronts = [line([], [], color=_colour(lam, lambdas), label=f"λ = {lam:g}") for lam in lambdas]
    title = "steps: Pareto front of a λ"
    figure.legend(handles=[*shapes, *fronts], loc="outside right center", frameon=False, title=title, fontsize="small")


def _names(rows: list[Row]) -> list[str]:
    return list(dict.fromkeys(row.solver for row in rows))


def _colour(lam: float, lambdas: list[float]) -> Any:
    place = lambdas.index(lam) / max(len(lambdas) - 1, 1)
    return require("matplotlib", "app").colormaps["turbo"](0.05 + 0.9 * place)


def maps(found: Maps) -> Any:
    """Error over lambda and load of every model (columns), for grips and for load control (rows)."""
    names = list(dict.fromkeys(name for _, name in found.error))
    matplotlib = require("matplotlib", "app")
    figure = new_figure(3.6 * len(names) + 1.2, 8.5)
    panels = figure.subplots(2, len(names), sharex=True, sharey=True)
    norm = require("matplotlib.colors", "app").LogNorm(1e-10, 1.0)
    for line, control in zip(panels, CONTROLS, strict=True):
        for panel, name in zip(line, names, strict=True):
            mesh = _map_panel(panel, found, found.error[control, name], norm, matplotlib.colormaps["magma_r"])
            _threshold(panel, control, name)
            what = "F at given indentation (grips)" if control == "grips" else "a at given load"
            panel.set_title(f"{name}: {what}", loc="left", fontsize="medium")
        line[0].set_ylabel("load [pull-off forces]")
    for panel in panels[-1]:
        panel.set_xlabel("λ [-]")
    figure.colorbar(mesh, ax=panels, label="error against exact MD [-]; lines: 1 % and 10 %", extend="both", pad=0.01)
    return figure


def _map_panel(panel: Any, found: Maps, error: Any, norm: Any, colours: Any) -> Any:
    drawn = np.clip(error.T, 1e-12, None)
    mesh = panel.pcolormesh(found.lambdas, found.loads, drawn, norm=norm, cmap=colours, shading="nearest")
    if drawn.max() > 0.01:
        panel.contour(found.lambdas, found.loads, drawn, [0.01, 0.1], colors="white", linewidths=(0.8, 1.4))
    panel.set_xscale("log")
    panel.set_yscale("symlog", linthresh=1.0, linscale=0.8)
    return mesh


def _threshold(panel: Any, control: Control, name: str) -> None:
    """The paper's rule for this model and what it is worth, measured at the very threshold."""
    box = {"boxstyle": "round", "fc": "white", "ec": "none", "alpha": 0.85}
    where = panel.transAxes
    quantity = "F" if control == "grips" else "a"
    for solver, lam in THRESHOLDS:
        if solver.name == name:
            below, above = (errors.worst(solver, control, lam, within) for within in ("adhesive", "moderate"))
            panel.axvline(lam, color="tab:cyan", lw=2.0)
            text = f"paper: λ = {lam:g}\nerror of {quantity} there\npressed: {above:.1%}\nadhesive: {below:.1%}"
            panel.text(0.03, 0.97, text, va="top", fontsize="small", bbox=box, transform=where)
    if name == HERTZ.name:
        at = np.array([HERTZ_LOAD])
        found = [float(errors.error(HERTZ, control, lam, at)[0]) for lam in SPREAD]
        panel.axhline(HERTZ_LOAD, color="tab:cyan", lw=2.0)
        text = f"paper: P = {HERTZ_LOAD:g} P_a\nerror of {quantity} there\n{min(found):.1%} to {max(found):.1%}"
        panel.text(0.03, 0.97, text, va="top", fontsize="small", bbox=box, transform=where)
