# SPDX-License-Identifier: BSD-3-Clause
"""Plans, the loop and fits of the matrix of extremes. Truth of a plan is the oracle's; of the loop the law of its plan
at the gaps where it was, of a fit the modulus that its curve was made with."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any

import nanotouch as nt
import numpy as np
import random_scenes
from extremes import DECADES, Refused
from nanotouch.curves import ForceCurve, Segment
from nanotouch.errors import Error
from nanotouch.units import from_si, key_spellings

DEMAND = 1e-2
ARITHMETIC = 1e-11
"""of the oracle, in double precision"""
TINY = 1e-300
"""beside zero, and a normal number still: the oracle squares and divides"""
TICKS, CLEARANCE = 100, 3e-9
FIT_ERROR = 0.02
"""of a modulus: noise-free curves, whose baseline is fitted, too"""
Trial = tuple[str, Callable[[], str]]

BASES: dict[str, dict[str, Any]] = {
    "dry": {"medium": {"relative_humidity": 0.0, "film_thickness": 0.0}, "adhesion": {"work_of_adhesion": 0.05}},
    "humid": {},
    "in water": {
        "medium": {"kind": "liquid", "ionic_strength": 10.0}, "tip": {"surface_potential": -0.03},
        "sample": {"surface_potential": -0.05}, "adhesion": {"work_of_adhesion": 0.05, "hamaker_constant": 1e-20},
    },
}  # fmt: skip


def _numbers(described: Any) -> dict[str, Any]:
    return {name: field for name, field in described.fields.items() if "|" not in field.unit}


def values(kind: str, field: Any, usual: float, rng: np.random.Generator) -> Iterable[float]:
    """Of a field: its edges are where what is valid folds over into what is not."""
    if kind == "zeros":
        yield from (0.0, -0.0, TINY)
    elif kind == "infinities":
        yield from (math.inf, -math.inf, math.nan)
    elif kind == "folds":
        for edge, out in ((field.minimum, -math.inf), (field.maximum, math.inf)):
            beside = (
                math.copysign(TINY, way) if edge == 0.0 else float(np.nextafter(edge, way)) for way in (out, -out)
            )
            yield from (edge, *beside)
    else:
        yield (usual or math.sqrt(max(field.minimum, 1e-12) * field.maximum)) * 10.0 ** rng.uniform(-DECADES, DECADES)


# --- plans ---


def plans(kind: str, base: str, rng: np.random.Generator, count: int) -> Iterable[Trial]:
    """Every field of a scene at an extreme, one at a time."""
    scene = nt.Scene(**BASES[base])
    fields = _numbers(scene)
    if kind == "units":
        for name in fields:
            for key, factor in key_spellings(name.partition(".")[2], fields[name].unit).items():
                yield f"{name} as {key}", lambda name=name, key=key, factor=factor: _spelled(scene, name, key, factor)  # type: ignore[misc]
        return
    for _ in range(count if kind == "30 decades" else 1):
        for name, field in fields.items():
            for value in values(kind, field, float(scene[name]), rng):
                yield f"{name} = {value!r}", lambda name=name, value=value: _planned(base, name, value)  # type: ignore[misc]


def _planned(base: str, name: str, value: float) -> str:
    scene = nt.Scene(**BASES[base])
    scene[name] = value
    if not math.isfinite(value):
        scene.plan(DEMAND)
        return "not refused"
    found = random_scenes.compare(scene, DEMAND, count=12)
    if isinstance(found, Error):
        raise found
    if math.isfinite(found.plan.bound) and found.error > found.plan.bound + ARITHMETIC:
        return f"error {found.error:.3g}, bound {found.plan.bound:.3g}"
    return "" if found.folds_hold else "folds are not where they are said to be"


# --- the loop ---


def loop(kind: str, rng: np.random.Generator, count: int) -> Iterable[Trial]:
    """Every field of the rig at an extreme, one at a time."""
    rig = nt.Rig()
    if kind == "units":
        for name, field in _numbers(rig).items():
            for key, factor in key_spellings(name.partition(".")[2], field.unit).items():
                yield f"{name} as {key}", lambda name=name, key=key, factor=factor: _spelled(rig, name, key, factor)  # type: ignore[misc]
        return
    for _ in range(count if kind == "30 decades" else 1):
        for name, field in _numbers(rig).items():
            for value in values(kind, field, float(rig[name]), rng):
                yield f"{name} = {value!r}", lambda name=name, value=value: _ran(name, value)  # type: ignore[misc]


def _spelled(made: Any, name: str, key: str, factor: float) -> str:
    """The same value in another unit is the same number."""
    value = float(made[name])
    read = float(type(made).from_tables({name.partition(".")[0]: {key: from_si(value, factor)}})[name])
    return "" if math.isclose(read, value, rel_tol=1e-14, abs_tol=1e-300) else f"{value} comes back as {read}"


def _ran(name: str, value: float) -> str:
    """All that is recorded is a number, and the force on the tip that of the plan on one of its branches."""
    rig = nt.Rig()
    rig[name] = value
    session = nt.Session(rig=rig, clearance=CLEARANCE)
    if not math.isfinite(value):
        return "not refused"
    x, y = session.path[0]
    columns = session.advance(TICKS / session.rate, nt.Input(1.0, x, y, 0.5 * TICKS / session.rate))
    for column, found in columns.items():
        if not np.isfinite(found).all() and not column.startswith("operator_force_"):  # sideways: not measured
            return f"{column} is not finite"
    gaps, force = columns["gap"], columns["tip_force"]
    law = [np.asarray(session.plan.force(gaps, history)) for history in ("approach", "retract")]  # type: ignore[arg-type]
    off = np.minimum(*(np.abs(one - force) for one in law)).max()
    rounding = 1e-9 * np.abs(force).max() + session.plan.maximum_stiffness * 1e-21  # of a place, at a micrometer
    return "" if off <= rounding else f"tip force off by {off:.3g} N"


# --- fits ---

PRESSED = {"radius": 1e-6, "modulus": 1e6, "spring constant": 0.5, "depth": 5e-8}
"""of Hertz' curve that is fitted [m, Pa, N/m, m]"""
SAMPLES = 1000
"""to either side of first touch"""


def fits(kind: str, rng: np.random.Generator, count: int) -> Iterable[Trial]:
    """A Hertz curve made by its own formula, with what it is made of at an extreme."""
    if kind == "units":
        for _ in range(count):
            length, force = 10.0 ** rng.uniform(-1.5, 1.5), 10.0 ** rng.uniform(-4.0, 4.0)
            scaled = {
                "radius": length,
                "depth": length,
                "modulus": force / length**2,
                "spring constant": force / length,
            }
            point = {name: PRESSED[name] * by for name, by in scaled.items()}
            yield f"lengths x {length:.3g}, forces x {force:.3g}", lambda point=point: _fitted(point)  # type: ignore[misc]
    elif kind == "30 decades":
        for _ in range(count):
            for name in PRESSED:
                point = PRESSED | {name: PRESSED[name] * 10.0 ** rng.uniform(-DECADES, DECADES)}
                yield f"{name} = {point[name]:.3g}", lambda point=point: _fitted(point)  # type: ignore[misc]
    elif kind == "folds":
        for touching in (0, 1, 2, 3, 5, 10, 30, SAMPLES):
            yield f"{touching} samples in contact", lambda touching=touching: _fitted(PRESSED, touching)  # type: ignore[misc]
    else:
        for value in (0.0, -0.0, 5e-324) if kind == "zeros" else (math.inf, -math.inf, math.nan):
            for name in PRESSED:
                yield f"{name} = {value}", lambda name=name, value=value: _fitted(PRESSED | {name: value})  # type: ignore[misc]
            yield f"a force of {value}", lambda value=value: _fitted(PRESSED, spoiled=value)  # type: ignore[misc]


def _fitted(point: dict[str, float], touching: int = SAMPLES, spoiled: float | None = None) -> str:
    """Even steps of height; beyond first touch the indentation is looked up in a fine table of height over it."""
    radius, modulus, spring, depth = (point[name] for name in PRESSED)
    with np.errstate(all="ignore"):
        delta = depth * np.linspace(0.0, 1.0, 20_001) ** 2
        pressed = 4.0 / 3.0 * modulus * math.sqrt(max(radius, 0.0)) * delta**1.5
        below = delta + pressed / np.float64(spring)
        height = below[-1] / SAMPLES * np.arange(SAMPLES, -touching - 1, -1)
        force = np.interp(-height, below, pressed, left=0.0)
        deflection = force / np.float64(spring)
    if spoiled is not None:
        force[-1] = spoiled
    nowhere = np.full(force.size, np.nan)
    segment = Segment("approach", nowhere, height, "height (measured)", force, deflection)
    curve = ForceCurve((segment,), {"spring constant": spring}, "extreme")
    result = nt.fit.fit_curve(curve, "hertz", branch="approach", radius=radius)
    found = result.values["effective_modulus"]
    if result.status != "ok":
        raise Refused(f"status: {result.status}")
    if spoiled == 0.0 or abs(found / modulus - 1.0) <= FIT_ERROR:
        return ""
    return f"E* = {found:.4g}, true {modulus:.4g}, status {result.status}"
