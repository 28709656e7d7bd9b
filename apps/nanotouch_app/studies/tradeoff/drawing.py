# SPDX-License-Identifier: BSD-3-Clause
"""The error maps of the contact models, with the paper's thresholds."""

from __future__ import annotations

from typing import Any

import numpy as np
from nanotouch.errors import require
from nanotouch.plots import new_figure

from nanotouch_app.studies.tradeoff import errors
from nanotouch_app.studies.tradeoff.errors import CONTROLS, Control
from nanotouch_app.studies.tradeoff.measure import Maps
from nanotouch_app.studies.tradeoff.rules import HERTZ_LOAD, SPREAD, THRESHOLDS
from nanotouch_app.studies.tradeoff.solvers import HERTZ


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
