# SPDX-License-Identifier: BSD-3-Clause
"""The error maps of the contact models, with the paper's thresholds; axes and labels of all pictures of the study."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

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


TICKS = (1.0, 2.0, 5.0)
"""of an axis that spans little more than a decade"""
CHARACTER, LINE = 3.9, 9.0
"""width and height of a character of a label [typographic points]"""
NEAR = (20.0, 7.0)
"""points that are no farther apart share a label [typographic points]"""
ROOM = ((8.0, 2.0), (8.0, -9.0), (8.0, 11.0), (8.0, -18.0), (8.0, 20.0))
"""where a label may stand beside its point, best first [typographic points]"""


def logarithmic(panel: Any) -> None:
    """Both axes, with limits from the data and room around it."""
    ticker = require("matplotlib.ticker", "app")
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.margins(0.12)
    low, high = panel.get_xlim()
    if high < 100.0 * low:
        panel.xaxis.set_major_locator(ticker.LogLocator(subs=TICKS))
        panel.xaxis.set_major_formatter(ticker.FormatStrFormatter("%g"))
        panel.xaxis.set_minor_formatter(ticker.NullFormatter())
    panel.yaxis.set_minor_formatter(ticker.NullFormatter())
    panel.grid(alpha=0.3)


def settle(figure: Any) -> None:
    """Give all axes their place, which labels are put by."""
    figure.get_layout_engine().execute(figure)


class Label(NamedTuple):
    """What is written beside a point [data]."""

    x: float
    y: float
    text: str
    colour: str = "black"


def label(panel: Any, labels: Iterable[Label]) -> None:
    """Name points, those of a colour that lie together in one text; limits and :func:`settle` come before."""
    groups: list[tuple[Any, Label, list[str]]] = []
    for one in labels:
        at = panel.transData.transform(one[:2]) * 72.0 / panel.figure.dpi
        close = [group for group in groups if np.all(np.abs(at - group[0]) < NEAR) and group[1].colour == one.colour]
        if not close:
            groups.append((at, one, [one.text]))
        elif one.text not in close[0][2]:
            close[0][2].append(one.text)
    left, right = panel.transAxes.transform([(0.0, 0.0), (1.0, 0.0)])[:, 0] * 72.0 / panel.figure.dpi
    taken: list[tuple[float, float, float]] = []
    for at, one, names in groups:
        text = "; ".join(names)
        width = CHARACTER * len(text)
        boxes = [(at[0] + dx, at[1] + dy, width) for dx, dy in ROOM]
        boxes += [(at[0] - dx - width, at[1] + dy, width) for dx, dy in ROOM]
        inside = [box for box in boxes if left < box[0] and box[0] + width < right] or boxes[:1]
        box = next((box for box in inside if not any(_meet(box, other) for other in taken)), inside[0])
        taken.append(box)
        note = panel.annotate(text, one[:2], xytext=(box[0] - at[0], box[1] - at[1]), textcoords="offset points",
                              fontsize="x-small", color=one.colour)  # fmt: skip
        note.set_in_layout(False)


def _meet(one: tuple[float, float, float], other: tuple[float, float, float]) -> bool:
    return abs(one[1] - other[1]) < LINE and one[0] < other[0] + other[2] and other[0] < one[0] + one[2]
