# SPDX-License-Identifier: BSD-3-Clause
"""Accuracy demanded against cost reached: the plans of every preset, each beside the reference of its scene."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import groupby
from typing import Any, NamedTuple

import numpy as np
from nanotouch import Plan, Scene, presets, reference
from nanotouch.errors import InvalidValue
from nanotouch.plots import BLUE, VERMILION, new_figure
from numpy.typing import NDArray

from nanotouch_app.common.scenes import LIBRARY
from nanotouch_app.studies.tradeoff.drawing import Label, label, logarithmic, settle

PRESETS = tuple(name for name in LIBRARY if getattr(presets, name)()[0].rheology.kind == "elastic")
"""those whose force is a function of the gap; one that relaxes depends on time (docs/rheology.md)"""
ACCURACIES = tuple(float(f"{digit}e{power}") for power in range(-1, -11, -1) for digit in (3, 1))
"""0.3 .. 1e-10"""
ROUNDING = 1e-12
"""smaller errors are those of arithmetic, on this machine"""
POINTS = 150
DEFORMS = ", the sample deforms"
REFUSED = "refused: the best bound is as given"


class Row(NamedTuple):
    """The plan of a preset for a demand of its force."""

    preset: str
    relative_accuracy: float
    cost: float
    """of one evaluation [Hertz evaluations]"""
    full_cost: float
    """of everything on, exact"""
    bound: float
    deformation: float
    """its part for a sample that is taken as rigid, which the reference takes as rigid, too"""
    error: float
    """largest |dF|/max(|F|, scale) against the reference, away from folds"""
    forms: str


def trade(quick: bool, progress: Callable[[float], None] = lambda done: None) -> list[Row]:
    """The plans of all presets at all demands; some seconds."""
    accuracies = ACCURACIES[::4] if quick else ACCURACIES
    rows: list[Row] = []
    for number, name in enumerate(PRESETS):
        rows += _rows(name, getattr(presets, name)()[0], accuracies)
        progress((number + 1) / len(PRESETS))
    return rows


def _rows(name: str, scene: Scene, accuracies: tuple[float, ...]) -> Iterator[Row]:
    exact = scene.plan(bound="exact")
    gaps = _gaps(exact, scene)
    paths = {"approach": gaps[::-1], "retract": gaps}
    truth = {history: np.asarray(reference.force(scene, path, history=history)) for history, path in paths.items()}  # type: ignore[arg-type]
    for accuracy in accuracies:
        try:
            plan = scene.plan(relative_accuracy=accuracy)
        except InvalidValue:  # not even everything exact has a bound that small
            yield Row(name, accuracy, math.nan, exact.cost, exact.bound, 0.0, math.nan, REFUSED)
            continue
        facts = plan.explain()
        deforms = facts["deforms"]  # measured by tests/heavy/deformation.py: its truth is slow
        error = (
            math.nan if deforms else max(_error(plan, path, truth[history], history) for history, path in paths.items())
        )
        forms = ", ".join(f"{term.name.replace('_', ' ')} {term.form}" for term in plan.terms)
        forms += DEFORMS if deforms and "deformed" not in forms else ""
        rigid = facts["rigid_error"] + facts["around_error"]
        yield Row(name, accuracy, plan.cost, exact.cost, plan.bound, rigid, error, forms)


def _gaps(plan: Plan, scene: Scene) -> NDArray[np.float64]:
    """From the largest load to 1 cm, rising; denser where the force changes."""
    facts = plan.explain()
    near = max(abs(facts["release_gap"]), abs(facts["capture_gap"]), 1e-10)
    deepest = facts["largest_indentation"]
    gaps = np.concatenate([
        -np.geomspace(deepest, 1e-3 * deepest, POINTS),
        np.linspace(-1.2 * near, 1.2 * near, POINTS),
        np.geomspace(1e-3 * near, 1e-2, POINTS),
    ])  # fmt: skip
    return np.unique(gaps[(gaps >= scene.range.minimum_gap) & (gaps >= -deepest)])


def _error(plan: Plan, gaps: NDArray[np.float64], truth: NDArray[np.float64], history: Any) -> float:
    facts = plan.explain()
    folds = np.array([facts["capture_gap"], facts["release_gap"]])
    away = np.abs(gaps[:, None] - folds).min(axis=1) > 1e-9 * np.abs(folds).max() + plan.fold_shift_m
    planned = np.asarray(plan.force(gaps, history))
    return float((np.abs(planned - truth) / np.maximum(np.abs(truth), plan.scale))[away].max())


def steps(rows: list[Row]) -> list[list[Row]]:
    """Rows of one preset with one plan together: a step of its curve."""
    return [list(group) for _, group in groupby(rows, key=lambda row: (row.preset, row.forms))]


def columns(rows: list[Row]) -> dict[str, list[object]]:
    """The trade as a table."""
    headers = (
        "preset (name)", "demanded [-]", "cost [Hertz]", "cost of everything exact [Hertz]", "bound [-]",
        "of it for a sample taken as rigid [-]", "error against the reference [-]", "plan (name)",
    )  # fmt: skip
    return {header: list(values) for header, values in zip(headers, zip(*rows, strict=True), strict=True)}


def number(error: float) -> str:
    """Two digits; what is rounding is called so."""
    if math.isnan(error):
        return ""
    return f"{error:.1e}" if error > ROUNDING else "rounding"


def section(rows: list[Row]) -> str:
    """Of the page on accuracy; it does not depend on the machine."""
    lines = ["| preset | demanded | cost | of exact | bound | error | computed |", "|" + " --- |" * 7]
    for step in steps(rows):
        first, last = step[0], step[-1]
        loosest, tightest = first.relative_accuracy, last.relative_accuracy
        demanded = f"{loosest:g}" if len(step) == 1 else f"{loosest:g} .. {tightest:g}"
        costs = ["", ""] if first.forms == REFUSED else [f"{first.cost:g}", f"{first.cost / first.full_cost:.0%}"]
        errors = [number(first.bound), number(first.error)]
        lines.append("| " + " | ".join([first.preset, demanded, *costs, *errors, first.forms]) + " |")
    table = "\n".join(lines)
    return f"""## Plans: accuracy demanded against cost reached

Every preset with no topography, its force within {ACCURACIES[0]:g} to {ACCURACIES[-1]:g} of max(|F|, pull-off force)
(docs/plan.md). A row says what the plan computes, what an evaluation costs in Hertz evaluations (`make bench`), and the
bound that it states. The error is the largest against `nanotouch.reference`, on approach and retraction, from 1 cm to
the largest load, away from folds (where the force jumps). A plan serves all demands of its row. `plans.png` shows the
same, `plans.csv` all demands.

{table}"""


def summary(rows: list[Row]) -> str:
    """A table for the terminal."""
    lines = [f"{'preset':16} {'demanded':>9} {'Hertz':>6} {'bound':>9} {'error':>9}  computed"]
    for step in steps(rows):
        row = step[0]
        if row.forms == REFUSED:
            lines.append(
                f"{row.preset:16} {row.relative_accuracy:9.0e} {'':6} {number(row.bound):>9} {'':9}  {row.forms}"
            )
            continue
        lines.append(
            f"{row.preset:16} {row.relative_accuracy:9.0e} {row.cost:6g} {number(row.bound):>9} {number(row.error):>9}"
            f"  {row.forms}"
        )
    return "\n".join(lines)


def draw(rows: list[Row]) -> Any:
    """A panel for each preset: what a plan promises and how far it really is off, over what it costs. Points bear the
    forms of contact and van der Waals."""
    figure = new_figure(16.0, 8.0)
    panels = figure.subplots(2, math.ceil(len(PRESETS) / 2), sharex=True, sharey=True).ravel()
    for panel, name in zip(panels, PRESETS, strict=False):
        kinds = [step[0] for step in steps(rows) if step[0].preset == name and step[0].forms != REFUSED]
        measured = [row for row in kinds if not math.isnan(row.error)]
        panel.plot([row.cost for row in kinds], [row.bound for row in kinds], "o", color=BLUE, label="bound of a plan")
        if measured:
            panel.plot([row.cost for row in measured], [max(row.error, ROUNDING) for row in measured], "x",
                       color=VERMILION, label="its error against nanotouch.reference")  # fmt: skip
        logarithmic(panel)
        panel.set_title(name.replace("_", " "), loc="left", fontsize="small")
    for panel in panels[-(len(panels) // 2) :]:
        panel.set_xlabel("cost of one evaluation [Hertz evaluations]")
    figure.supylabel("over max(|F|, pull-off force) [-]", fontsize="medium")
    handles, names = panels[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper center", ncols=2, frameon=False, fontsize="small")
    settle(figure)
    for panel, name in zip(panels, PRESETS, strict=False):
        kinds = [step[0] for step in steps(rows) if step[0].preset == name and step[0].forms != REFUSED]
        label(panel, [Label(row.cost, row.bound, _short(row)) for row in kinds])
    return figure


def _short(row: Row) -> str:
    """The forms of contact and van der Waals, which every preset has, and how many other laws."""
    forms = [form.removeprefix("contact ").removeprefix("vdw ") for form in row.forms.removesuffix(DEFORMS).split(", ")]
    more = f" + {len(forms) - 2}" if len(forms) > 2 else ""
    return ", ".join(forms[:2]) + more + (", deforms" if row.forms.endswith(DEFORMS) else "")
