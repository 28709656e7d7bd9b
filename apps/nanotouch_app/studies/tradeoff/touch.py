# SPDX-License-Identifier: BSD-3-Clause
"""The whole touch: error of the force at the hand against processor time per second of touch, over contact law, tier,
probe model, substep, loop rate, noise and calibration."""

from __future__ import annotations

import functools
import math
import time
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from nanotouch import Rig, Scene, Session, reference
from nanotouch.touch.operator import Hold
from nanotouch.touch.session import settings_for_path
from numpy.typing import NDArray

Floats = NDArray[np.float64]

METHOD = """The hand holds the master on a given path: approach through the jump-in, press, retract through the
pull-off. The force at the hand is what the motor is commanded, held between two ticks. Its error is the RMS difference
from a reference run, over the largest force of that run. The reference is the finest of everything: every law in full,
the dynamic probe at a fine substep, the fastest loop, no noise, no converter steps and a perfect calibration. Cost is
the processor time of the process, the least of several runs."""

RATES = (1e3, 10e3, 100e3)
RATE = 10e3
"""of a session that is given none [Hz]"""
SUBSTEPS = (0.25, 1.0, 4.0, 16.0, 60.0)
"""of the dynamic probe [rad]; 0.25 is the default"""
REFERENCE, QUICK_REFERENCE = 0.0125, 0.05
"""substep of the reference run [rad]"""
ORDER = 2
"""of the integrator: half the substep, a quarter of the error"""
TIERS = (0.3, 1e-2, 1e-3)
"""demands whose plans are tried, beside everything exact"""
DEMANDS = (1e-1, 1e-2, 1e-4)
"""demands for which the choice of a session is marked; its other options are the defaults"""
EXACT: dict[str, Any] = {"bound": "exact"}
"""a session whose plan has every law in full"""
CLEARANCE, DEPTH = 2e-9, 6e-9
"""of the tip at the start, and how far the hand moves the stage towards the sample and away [m]"""
JUMP = 0.05
"""a change of the tip's force within a period of the slowest loop that is a jump, over the largest force"""
BEFORE, AFTER = 2e-3, 5e-3
"""what is left out around a jump where only the smooth parts are looked at [s]"""
QUIET: dict[str, dict[str, float]] = {
    "probe": {"temperature": 0.0, "noise": 0.0, "resolution": 0.0},
    "stage": {"resolution": 0.0, "noise": 0.0, "command_resolution": 0.0},
    "master": {"resolution": 0.0, "gauge_noise": 0.0, "gauge_resolution": 0.0},
}
"""a rig whose sensors are perfect"""
RANGE = 1e-11
"""of adhesion where the contact is to be JKR's [m]"""


class Way(NamedTuple):
    """One way to run the touch."""

    axis: str
    """what is varied"""
    name: str
    rate: float
    options: dict[str, Any]
    """of the session"""
    rig: Mapping[str, dict[str, float]] = MappingProxyType({})
    """fields of the rig that differ from a quiet one"""
    force_scale: float = 1.0
    """what the calibration makes of a force [N/N]"""
    scene: Scene | None = None


class Run(NamedTuple):
    """What one run gave."""

    hand: Floats
    """force that the motor is commanded, tick by tick [N]"""
    tip: Floats
    """force on the tip [N]"""
    stage: Floats
    """travel towards the sample [m]"""
    cost: float
    """processor time per second of touch [s/s]"""
    session: Session


class Row(NamedTuple):
    """One way beside the reference."""

    axis: str
    name: str
    rate: float
    """of the loop [Hz]"""
    probe: str
    forms: str
    cost: float
    """processor time per second of touch [s/s]"""
    whole: float
    """RMS error of the force at the hand over the whole touch, over the largest force [-]"""
    smooth: float
    """the same without what lies around jump-in and pull-off"""


class Result(NamedTuple):
    """All ways, and what the reference is worth."""

    rows: list[Row]
    own: float
    """error of the reference run itself over the whole touch, by Richardson's extrapolation [-]"""
    independent: float
    """RMS of its tip force, away from the jumps, beside a probe at rest that is solved in Python on
    ``nanotouch.reference`` [-]"""


def run(way: Way, duration: float) -> Run:
    """One touch, the same every time; ``duration`` [s] is of approach and retraction together."""
    rig = Rig(**{part: QUIET.get(part, {}) | way.rig.get(part, {}) for part in QUIET})  # type: ignore[arg-type]
    settings = settings_for_path(rig, clearance=CLEARANCE)
    settings.gains.alpha_f *= way.force_scale
    session = Session(way.scene, rig, settings=settings, rate=way.rate, clearance=CLEARANCE, preflight=False,
                      **way.options)  # fmt: skip
    start, depth = session.core.master_start, DEPTH / session.settings.gains.alpha_p
    path = [
        Hold(start + depth, *session.path[0], 0.45 * duration),
        Hold(start - depth, *session.path[0], 0.4 * duration),
    ]
    begun = time.process_time()
    parts = [session.advance(0.5 * duration, hold) for hold in path]
    cost = (time.process_time() - begun) / duration
    names = ("motor_force", "tip_force", "stage_position")
    hand, tip, stage = (np.concatenate([part[name] for part in parts]) for name in names)
    return Run(hand, tip, stage, cost, session)


def ways(rates: tuple[float, ...], substeps: tuple[float, ...]) -> list[Way]:
    """All that is tried; where nothing else is said the probe is at rest at every tick and the demand is 1 %."""
    rest, sigma = {"probe_model": "quasi-static"}, calibration_sigma()
    made = [
        Way("plan", name, rate, rest | options)
        for rate in rates
        for name, options in (*((f"{100 * tier:g} %", {"relative_accuracy": tier}) for tier in TIERS), ("exact", EXACT))
    ]
    made += [Way("law", name, rate, rest, scene=scene) for rate in rates[1:] for name, scene in laws().items()]
    moving = {"probe_model": "dynamic", "relative_accuracy": 1e-2}
    made += [Way("probe", f"{step:g} rad", rate, moving | {"substep": step}) for rate in rates for step in substeps]
    usual = Rig()
    for name, parts in (
        ("detector", {"probe": {"noise": usual.probe.noise}}),
        ("converters", {
            "probe": {"resolution": usual.probe.resolution},
            "stage": {name: getattr(usual.stage, name) for name in ("resolution", "command_resolution")},
            "master": {"resolution": usual.master.resolution},
        }),
    ):  # fmt: skip
        made.append(Way("noise", name, RATE, rest, parts))
    made.append(
        Way("noise", "thermal", RATE, moving | {"substep": 1.0}, {"probe": {"temperature": usual.probe.temperature}})
    )
    for off in (0.01, sigma):
        made.append(Way("calibration", f"{100 * off:.2g} %", RATE, rest, force_scale=1.0 + off))
    made += [Way("choice", f"{100 * demand:g} %", RATE, {"relative_accuracy": demand}) for demand in DEMANDS]
    return made


def calibration_sigma() -> float:
    """Of a force by a usual calibration of spring constant and sensitivity [-]."""
    probe = Rig().probe
    return math.hypot(probe.spring_constant_sigma, probe.sensitivity_sigma)


def laws() -> dict[str, Scene]:
    """Other contact laws for the same bodies: no adhesion at all, and the same adhesion over no range."""
    work = Session(preflight=False).plan.explain()["work_of_adhesion"]
    dry: Any = {"relative_humidity": 0.0, "film_thickness": 0.0}
    return {
        "Hertz": Scene(medium=dry, adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0}),
        "JKR": Scene(
            medium=dry,
            adhesion={"work_of_adhesion": work, "hamaker_constant": 0.0, "equilibrium_distance": RANGE},
        ),
    }


def trade(quick: bool, progress: Callable[[float], None] = lambda done: None) -> Result:
    """All ways beside the reference; a minute, or some seconds."""
    duration, finest, runs = (0.1, QUICK_REFERENCE, 1) if quick else (0.2, REFERENCE, 3)
    rates = RATES[:2] if quick else RATES
    fine = [
        Way("reference", "", rates[-1], EXACT | {"probe_model": "dynamic", "substep": substep})
        for substep in (2.0 * finest, finest)
    ]
    coarser, best = (run(way, duration) for way in fine)
    calm = smooth(best.tip, rates[-1])
    own = differs(coarser.hand, best.hand)
    rows = []
    all_ways = ways(rates, SUBSTEPS[::2] if quick else SUBSTEPS)
    for number, way in enumerate(all_ways):
        found = min((run(way, duration) for _ in range(runs)), key=lambda one: one.cost)
        rows.append(_row(way, found, best, calm))
        progress((number + 1) / len(all_ways))
    return Result(rows, own / (2**ORDER - 1), differs(at_rest(best), best.tip, calm))


def _row(way: Way, found: Run, best: Run, calm: NDArray[np.bool_]) -> Row:
    held = np.repeat(found.hand, len(best.hand) // len(found.hand))
    forms = ", ".join(f"{term.name.replace('_', ' ')} {term.form}" for term in found.session.plan.terms)
    errors = differs(held, best.hand), differs(held, best.hand, calm)
    return Row(way.axis, way.name, way.rate, found.session.probe_model, forms, found.cost, *errors)


def differs(found: Floats, truth: Floats, where: NDArray[np.bool_] | None = None) -> float:
    """RMS difference over the largest of the truth [-], over all or over a part."""
    difference = (found - truth) if where is None else (found - truth)[where]
    return float(np.sqrt(np.mean(difference**2)) / np.abs(truth).max())


def smooth(tip: Floats, rate: float) -> NDArray[np.bool_]:
    """Where the tip's force does not jump, nor soon will, nor just did."""
    within = round(rate / RATES[0])
    change = np.abs(tip[within:] - tip[:-within])
    away = np.ones(tip.size, bool)
    for tick in np.flatnonzero(change > JUMP * np.abs(tip).max()):
        away[max(0, tick - round(BEFORE * rate)) : tick + round(AFTER * rate)] = False
    return away


def at_rest(best: Run) -> Floats:
    """The tip's force along the stage's path of a run, from each equilibrium to the next, where the force over the gap
    is that of ``nanotouch.reference``: neither plan nor simulated rig are asked. It knows no inertia."""
    facts, spring = best.session.plan.explain(), float(best.session.rig.probe.spring_constant)
    capture, release = facts["capture_gap"], facts["release_gap"]
    deep = 1.2 * DEPTH
    gaps = np.unique(np.concatenate([
        np.linspace(-1e-9, 2e-9, 6001), np.linspace(2e-9, CLEARANCE + deep, 2001),
        *(edge + np.array([-1e-15, 1e-15]) for edge in (capture, release)),
    ]))  # fmt: skip
    laws_ = [np.asarray(reference.force(best.session.scene, gaps, history=h)) for h in ("approach", "retract")]
    force = [functools.partial(np.interp, xp=gaps, fp=law) for law in laws_]
    gap, held, found = CLEARANCE, False, np.empty_like(best.stage)
    for tick, base in enumerate(CLEARANCE - best.stage):
        gap, held = _next(force, spring, float(base), (gap, held), (capture, release))
        found[tick] = force[held](gap)
    return found


STEP = 2e-11
"""within which a change of sign of the net force is looked for [m]"""


def _next(force: list[Any], spring: float, base: float, now: tuple[float, bool], edges: tuple[float, float]) -> Any:
    """Downhill from a gap to the next equilibrium of spring and force; contact is taken and lost at the edges."""
    gap, held = now
    for _ in range(2000):
        held = gap <= edges[0] or (held and gap <= edges[1])
        net = spring * (base - gap) + force[held](gap)
        ahead = gap + math.copysign(STEP, net)
        if not held and gap > edges[0] >= ahead:
            ahead = edges[0]
        elif held and gap <= edges[1] < ahead:
            ahead = edges[1] + 1e-15
        if net * (spring * (base - ahead) + force[held](ahead)) <= 0.0:
            return _bisect(lambda at: net * (spring * (base - at) + force[held](at)), gap, ahead), held  # noqa: B023
        gap = ahead
    return gap, held


def _bisect(falls: Callable[[float], float], start: float, end: float) -> float:
    for _ in range(40):
        middle = 0.5 * (start + end)
        start, end = (middle, end) if falls(middle) > 0.0 else (start, middle)
    return 0.5 * (start + end)


def columns(result: Result) -> dict[str, list[object]]:
    """The trade as a table."""
    headers = (
        "varied (name)", "value (name)", "loop rate [Hz]", "probe (name)", "plan (name)",
        "processor time per second of touch [s/s]", "RMS error of the force at the hand [-]",
        "RMS error away from the jumps [-]",
    )  # fmt: skip
    return {header: list(values) for header, values in zip(headers, zip(*result.rows, strict=True), strict=True)}
