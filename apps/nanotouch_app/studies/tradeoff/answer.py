# SPDX-License-Identifier: BSD-3-Clause
"""The user's question in one picture: what does accuracy of the force at the hand cost, and what limits it?"""

from __future__ import annotations

from typing import Any, NamedTuple

from nanotouch.plots import new_figure

from nanotouch_app.studies.tradeoff import touch
from nanotouch_app.studies.tradeoff.drawing import Label, label, logarithmic, settle
from nanotouch_app.studies.tradeoff.touch import Result, Row

AXES = {
    "plan": ("law and tier, by a plan's demand", "tab:blue"),
    "law": ("another contact law", "tab:red"),
    "probe": ("dynamic probe, by substep", "tab:green"),
    "noise": ("noise", "tab:purple"),
    "calibration": ("calibration, off by", "tab:brown"),
    "choice": ("what a session chooses", "goldenrod"),
}
"""what is varied, in words, and its colour"""
MARKERS = {1e3: "^", 10e3: "o", 100e3: "s"}
KINDS = {"whole": "whole touch, jump-in and pull-off included", "smooth": "away from jump-in and pull-off"}
FLOOR = 1e-12
"""smaller errors are drawn here"""


class Part(NamedTuple):
    """What one imperfection adds by itself."""

    name: str
    whole: float
    smooth: float


def parts(result: Result) -> list[Part]:
    """What each imperfection of a default session adds, all else as fine as the table has it."""
    finest = max(row.rate for row in result.rows)

    def of(words: str, axis: str, name: str, rate: float = touch.RATE) -> Part:
        row = next(row for row in result.rows if (row.axis, row.name, row.rate) == (axis, name, rate))
        return Part(words, row.whole, row.smooth)

    sigma = f"{100 * touch.calibration_sigma():.2g} %"
    return [
        of("no adhesion in the contact law", "law", "Hertz", finest),
        of("adhesion without range (JKR)", "law", "JKR", finest),
        of("detector noise", "noise", "detector"),
        of("converter steps", "noise", "converters"),
        of("thermal noise", "noise", "thermal"),
        of(f"calibration off by {sigma}", "calibration", sigma),
        of(f"a loop of {1e-3 * touch.RATE:g} kHz", "plan", "exact"),
        of("a plan within 1 %, its probe at rest", "plan", "1 %", finest),
        of("everything exact but a probe at rest", "plan", "exact", finest),
    ]


def sentences(result: Result) -> str:
    """What the picture says, from its numbers."""
    of_rig = [part for part in parts(result) if "adhesion" not in part.name]
    lines = []
    for kind, words in KINDS.items():
        ranked = sorted(of_rig, key=lambda part: -getattr(part, kind))
        listed = [f"{part.name} ({percent(getattr(part, kind))})" for part in ranked]
        lines.append(
            f"Error of the force at the hand, {words}: dominated by {listed[0]}; then {', '.join(listed[1:])}."
        )
    chosen = [row for row in result.rows if row.axis == "choice"]
    costs = ", ".join(f"{row.cost:.2g} s ({row.probe}) within {row.name}" for row in chosen)
    lines.append(f"Processor time per second of touch as a session chooses: {costs}.")
    return "\n".join(lines)


def percent(fraction: float) -> str:
    """Two digits."""
    return f"{100 * fraction:.2g} %"


def draw(result: Result) -> Any:
    """Error over cost, once for each kind of error; colours are what is varied, markers the loop rate."""
    figure = new_figure(15.0, 7.5)
    panels = figure.subplots(1, 2, sharex=True)
    for panel, (kind, words) in zip(panels, KINDS.items(), strict=True):
        draw_kind(panel, result.rows, kind)
        panel.set_title(words, loc="left", fontsize="medium")
        panel.set_xlabel("processor time per second of touch [s/s]")
    panels[0].set_ylabel("RMS error of the force at the hand, over its max [-]")
    handles, names = panels[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=5, fontsize="small", frameon=False)
    figure.suptitle(sentences(result), fontsize="small", ha="left", x=0.01, wrap=True)
    settle(figure)
    for panel, kind in zip(panels, KINDS, strict=True):
        label(panel, [Label(r.cost, max(getattr(r, kind), FLOOR), _text(r), AXES[r.axis][1]) for r in result.rows])
    return figure


def draw_kind(panel: Any, rows: list[Row], kind: str) -> None:
    """One kind of error over cost."""
    for axis, (words, colour) in AXES.items():
        for rate, marker in MARKERS.items():
            own = [row for row in rows if row.axis == axis and row.rate == rate]
            if not own:
                continue
            x, y = [row.cost for row in own], [max(getattr(row, kind), FLOOR) for row in own]
            look = {"marker": "*", "ms": 17, "zorder": 2, "label": words} if axis == "choice" else {
                "marker": marker, "ms": 8, "zorder": 3, "label": f"{words}; {1e-3 * rate:g} kHz"}  # fmt: skip
            panel.plot(x, y, color=colour, mec="k", mew=0.5, ls="none", alpha=0.9, **look)
    logarithmic(panel)


def _text(row: Row) -> str:
    return f"session {row.name}" if row.axis == "choice" else row.name


def section(result: Result) -> str:
    """Of the page on accuracy."""
    head = ("varied", "value", "loop", "probe", "plan", "s per s of touch", "error, whole", "error, away from jumps")
    lines = ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head)]
    for row in result.rows:
        cells = (
            AXES[row.axis][0], row.name, f"{1e-3 * row.rate:g} kHz", row.probe, row.forms, f"{row.cost:.2g}",
            percent(row.whole), percent(row.smooth),
        )  # fmt: skip
        lines.append("| " + " | ".join(cells) + " |")
    table, said = "\n".join(lines), "\n".join(f"- {line}" for line in sentences(result).splitlines())
    demands = ", ".join(percent(demand) for demand in touch.DEMANDS)
    return f"""## The answer: the whole touch

{said}

{touch.METHOD}

The reference itself errs by {percent(result.own)} (Richardson's extrapolation over the substep). Away from the jumps
its tip force is within {percent(result.independent)} of a probe at rest that is solved apart from it, on
`nanotouch.reference`. `tradeoff.png` draws the table: what is varied in colour, the loop rate by the marker, and as
stars what a session chooses by itself for {demands}.

{table}"""
