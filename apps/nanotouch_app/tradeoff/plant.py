# SPDX-License-Identifier: BSD-3-Clause
"""Loop rate, probe model and sub-step of the simulated rig: what a second of touch costs, and how far it is off."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from nanotouch import Input, Rig, Session
from nanotouch.session import ProbeModel, settings_for_path
from numpy.typing import NDArray

REFERENCE = 0.1
"""sub-step that all others are compared with [rad]"""
SUBSTEPS = (0.25, 1.0, 4.0, 16.0, 60.0)
CLEARANCE = 2e-9


class Row(NamedTuple):
    """One way to simulate the same touch: down, through the jump-in, pressed."""

    rate: float
    """of the loop [Hz]"""
    probe: str
    substep: float
    """NaN for the quasi-static probe [rad]"""
    cost: float
    """processor time per simulated time [-]"""
    force_error: float
    """RMS of the tip's force against the finest sub-step at this rate, over its largest value; in the second half, once
    the ringing of the jump-in is over [-]"""


def _touch(rate: float, model: ProbeModel, substep: float, duration: float) -> tuple[NDArray[np.float64], float]:
    """Force on the tip over time, and processor time per simulated time. No thermal motion: the same every time."""
    rig = Rig(probe={"temperature": 0.0})
    settings = settings_for_path(rig, clearance=CLEARANCE)
    session = Session(
        rig=rig, settings=settings, rate=rate, clearance=CLEARANCE, preflight=False, probe_model=model, substep=substep
    )
    push = Input(1.0, *session.path[0], 0.1 * duration)
    start = time.process_time()
    force = session.advance(duration, push)["tip_force"]
    return force, (time.process_time() - start) / duration


def trade(quick: bool, progress: Callable[[float], None] | None = None) -> list[Row]:
    """All ways; some ten seconds, or two."""
    duration = 0.05 if quick else 0.1
    ways: list[tuple[ProbeModel, float]] = [("quasi-static", np.nan), *(("dynamic", s) for s in SUBSTEPS)]
    rates = (1e3, 10e3) if quick else (1e3, 10e3, 100e3)
    rows: list[Row] = []
    for number, rate in enumerate(rates):
        reference, _ = _touch(rate, "dynamic", REFERENCE, duration)
        scale = float(np.abs(reference).max())
        for model, substep in ways:
            force, cost = _touch(rate, model, SUBSTEPS[0] if np.isnan(substep) else substep, duration)
            difference = (force - reference)[len(force) // 2 :]
            error = float(np.sqrt(np.mean(difference**2))) / scale
            rows.append(Row(rate, model, substep, cost, error))
        if progress is not None:
            progress((number + 1) / len(rates))
    return rows


def columns(rows: list[Row]) -> dict[str, list[object]]:
    """The trade as a table."""
    headers = ("loop rate [Hz]", "probe (name)", "sub-step [rad]", "processor time per time [-]", "force error [-]")
    return {header: list(values) for header, values in zip(headers, zip(*rows, strict=True), strict=True)}


def summary(rows: list[Row]) -> str:
    """A table for the terminal."""
    lines = ["loop [Hz]  probe         sub-step [rad]  times real time  force error"]
    for row in rows:
        substep = "" if np.isnan(row.substep) else f"{row.substep:g}"
        lines.append(
            f"{row.rate:9.0f}  {row.probe:12s}  {substep:>14s}  {1.0 / row.cost:15.3g}  {row.force_error:11.2g}"
        )
    return "\n".join(lines)
