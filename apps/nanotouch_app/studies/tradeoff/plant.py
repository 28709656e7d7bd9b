# SPDX-License-Identifier: BSD-3-Clause
"""The simulated rig: what a period of touch costs and how far it is off, by loop rate, probe, sub-step and plan."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from nanotouch import Input, Plan, Rig, Session
from nanotouch.touch.session import Options, ProbeModel, settings_for_path
from numpy.typing import NDArray

Floats = NDArray[np.float64]

REFERENCE, QUICK_REFERENCE = 0.0125, 0.05
"""sub-steps that all others are compared with [rad]"""
SUBSTEPS = (0.25, 1.0, 4.0, 16.0, 60.0)
ORDER = 2
"""of the integrator: half the sub-step, a quarter of the error"""
CLEARANCE = 2e-9
RATE = 10e3
"""of the loop in which plans are compared [Hz]"""
SUBSTEP = 1.0
"""of the dynamic probe there [rad]"""
ACCURACIES = (0.3, 1e-2, 1e-3, 0.0)
"""accuracies asked of the plans; 0: everything exact, the truth of the others"""


class Row(NamedTuple):
    """One way to simulate the same touch: down, through the jump-in, pressed."""

    rate: float
    """of the loop [Hz]"""
    probe: str
    substep: float
    """NaN for the quasi-static probe [rad]"""
    cost: float
    """processor time per simulated time [-]"""
    peak: float
    """largest error of the tip's force over the whole run, over the largest force [-]"""
    rms: float
    """its root mean square over the whole run [-]"""
    reference_error: float
    """largest error of the reference itself, by Richardson's extrapolation [-]"""


class Planned(NamedTuple):
    """The same touch with one plan, beside the one in which everything is exact."""

    probe: str
    relative_accuracy: float
    forms: str
    bound: float
    """of the plan [-]"""
    share: float
    """of the loop's period that one period's work takes [-]"""
    peak: float
    """largest error of the force that is felt, over the largest [-]"""
    rms: float


class Touch(NamedTuple):
    """What one run gave."""

    tip: Floats
    felt: Floats
    """force on the tip and the force that the loop measures and hands to the hand [N]"""
    cost: float
    """processor time per simulated time [-]"""
    plan: Plan


def touch(rate: float, model: ProbeModel, substep: float, duration: float, accuracy: float | None = None) -> Touch:
    """One touch without thermal motion: the same every time."""
    rig = Rig(probe={"temperature": 0.0})
    options: Options = {"rate": rate, "clearance": CLEARANCE, "preflight": False, "probe_model": model}
    if model != "quasi-static":
        options["substep"] = substep
    if accuracy is not None:
        options["relative_accuracy"] = accuracy
    session = Session(rig=rig, settings=settings_for_path(rig, clearance=CLEARANCE), **options)
    push = Input(1.0, *session.path[0], 0.1 * duration)
    start = time.process_time()
    columns = session.advance(duration, push)
    cost = (time.process_time() - start) / duration
    return Touch(columns["tip_force"], columns["slave_force"], cost, session.plan)


def differs(found: Floats, truth: Floats) -> tuple[float, float]:
    """Largest and RMS difference over the whole run, over the largest force [-]."""
    difference, scale = found - truth, float(np.abs(truth).max())
    return float(np.abs(difference).max()) / scale, float(np.sqrt(np.mean(difference**2))) / scale


def trade(quick: bool, progress: Callable[[float], None] | None = None) -> list[Row]:
    """All ways at all rates; half a minute, or some seconds."""
    duration, finest = (0.05, QUICK_REFERENCE) if quick else (0.1, REFERENCE)
    ways: list[tuple[ProbeModel, float]] = [("quasi-static", np.nan), *(("dynamic", s) for s in SUBSTEPS)]
    rates = (1e3, 10e3) if quick else (1e3, 10e3, 100e3)
    rows: list[Row] = []
    for number, rate in enumerate(rates):
        coarser, reference = (touch(rate, "dynamic", step, duration).tip for step in (2.0 * finest, finest))
        own = differs(coarser, reference)[0] / (2**ORDER - 1)
        for model, substep in ways:
            found = touch(rate, model, substep, duration)
            rows.append(Row(rate, model, substep, found.cost, *differs(found.tip, reference), own))
        if progress is not None:
            progress((number + 1) / len(rates))
    return rows


def plans(quick: bool, progress: Callable[[float], None] | None = None) -> list[Planned]:
    """The default scene's plans in the loop, each with both probes; some ten seconds, or two."""
    models: tuple[ProbeModel, ...] = ("quasi-static", "dynamic")
    duration, runs = (0.05, 1) if quick else (0.2, 3)
    rows: list[Planned] = []
    for number, model in enumerate(models):
        found = {accuracy: _cheapest(model, duration, accuracy, runs) for accuracy in ACCURACIES}
        for accuracy, made in found.items():
            forms = ", ".join(f"{term.name.replace('_', ' ')} {term.form}" for term in made.plan.terms)
            rows.append(
                Planned(model, accuracy, forms, made.plan.bound, made.cost, *differs(made.felt, found[0.0].felt))
            )
        if progress is not None:
            progress((number + 1) / len(models))
    return rows


def _cheapest(model: ProbeModel, duration: float, accuracy: float, runs: int) -> Touch:
    """Of several equal runs: whatever else a machine does only adds."""
    return min((touch(RATE, model, SUBSTEP, duration, accuracy) for _ in range(runs)), key=lambda made: made.cost)


def columns(rows: list[Row]) -> dict[str, list[object]]:
    """The trade as a table."""
    headers = (
        "loop rate [Hz]", "probe (name)", "sub-step [rad]", "processor time per time [-]", "largest force error [-]",
        "RMS force error [-]", "largest error of the reference itself [-]",
    )  # fmt: skip
    return {header: list(values) for header, values in zip(headers, zip(*rows, strict=True), strict=True)}


def plan_columns(rows: list[Planned]) -> dict[str, list[object]]:
    """The plans in the loop as a table."""
    headers = (
        "probe (name)", "demanded [-]", "plan (name)", "bound [-]", "share of the period [-]",
        "largest error of the felt force [-]", "RMS error of the felt force [-]",
    )  # fmt: skip
    return {header: list(values) for header, values in zip(headers, zip(*rows, strict=True), strict=True)}


def summary(rows: list[Row]) -> str:
    """A table for the terminal."""
    lines = ["loop [Hz]  probe         sub-step [rad]  times real time  largest error  RMS error  of the reference"]
    for row in rows:
        substep = "" if np.isnan(row.substep) else f"{row.substep:g}"
        lines.append(
            f"{row.rate:9.0f}  {row.probe:12s}  {substep:>14s}  {1.0 / row.cost:15.3g}  {row.peak:13.2g}  "
            f"{row.rms:9.2g}  {row.reference_error:16.1g}"
        )
    return "\n".join(lines)


def section(rows: list[Row]) -> str:
    """Of the page on accuracy."""
    lines = ["| loop | probe | sub-step | times real time | largest error | RMS error |", "|" + " --- |" * 6]
    for row in rows:
        substep = "" if np.isnan(row.substep) else f"{row.substep:g} rad"
        lines.append(
            f"| {row.rate / 1e3:g} kHz | {row.probe} | {substep} | {1.0 / row.cost:.2g} | {100 * row.peak:.2g} % | "
            f"{100 * row.rms:.2g} % |"
        )
    worst = max(row.reference_error for row in rows)
    return f"""## The simulated rig: probe model and sub-step

The same touch, down through the jump-in and pressed. Errors are those of the tip's force over the whole run, jump-in
included, over its largest value. The reference is the dynamic probe at {REFERENCE:g} rad; its own largest error is
{100 * worst:.1g} %, by Richardson's extrapolation. `plant.csv` holds the numbers.

{chr(10).join(lines)}"""
