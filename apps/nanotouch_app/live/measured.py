# SPDX-License-Identifier: BSD-3-Clause
"""The scene of a measured force curve. What the curve does not determine is assumed, and told: a person wants to touch
what was measured, and most curves determine a pull-off, but not both a modulus and a work of adhesion."""

from __future__ import annotations

import dataclasses
import math
from typing import cast

import nanotouch as nt
import numpy as np
from nanotouch import contact
from nanotouch import fit as fitting
from nanotouch.fit import FitResult
from nanotouch.fit.fitting import ASSUMED_RANGE
from nanotouch.units import in_words

HARD = 10e9  # E* of a sample that a curve tells to be stiff against its lever, and no more [Pa]
TRUE = 0.05  # a fit whose lever's sensitivity is off by more than this tells no modulus
SANE = 1e2, 1e11  # [Pa]; beyond, a fitted modulus is where its search has ended
ABOVE = 2.0  # times the pull-off is the least load that is planned for: a limit below it would stop each pull
ROOM = 1.5  # the range of the lever's sensor over the deflection under the largest load
ADHERES = 0.01  # of the load, from which a pull-off is reported
ROUNDS = 20  # of the work of adhesion, until its pull-off is the measured one


CELLS = 40  # to a side, of the points of a curve that are drawn
RELAXES = "the sample relaxes"  # how the doubt of an elastic law begins
LONGEST = 100.0  # a touch [s]


def fit(curve: nt.ForceCurve, radius: float | None) -> FitResult:
    """By the law that ``nanotouch fit`` takes; of a sample that relaxes by Ting's, where that describes it."""
    result = fitting.fit_curve(curve, "auto", radius=radius)
    if not result.reason.startswith(RELAXES):
        return result
    over_time = fitting.fit_curve(curve, "ting_power", radius=radius, poisson_ratio=0.5)
    return over_time if over_time.status in ("ok", "misfit") and over_time.determined("exponent") else result


def accuracy_of(result: FitResult) -> float:
    """What forces are planned for: springs follow a steep power law less well."""
    return 0.01 if result.time is None else 0.02


def points_of(result: FitResult) -> tuple[tuple[float, float, float], ...]:
    """Gap, measured and fitted force, in the order in which they were measured: one point in each cell of a grid over
    the contact and as much again before it."""
    gap = result.z - result.values["contact_point"] + result.force / result.spring_constant
    rows = np.stack([gap, result.force, result.fitted], axis=1)
    rows = rows[np.isfinite(rows).all(axis=1)]
    rows = rows[rows[:, 0] < np.abs(rows[:, 0].min(initial=0.0))]
    size = np.ptp(rows[:, :2], axis=0) if len(rows) else np.ones(2)
    cells = np.floor(CELLS * rows[:, :2] / np.where(size > 0.0, size, 1.0)).astype(int)
    _, first = np.unique(cells, axis=0, return_index=True)
    return tuple((float(at), float(force), float(fitted)) for at, force, fitted in rows[np.sort(first)])


def relaxing_scene_of(result: FitResult) -> tuple[nt.Scene, str]:
    """The same of a sample that relaxes. What its retraction adhered with is left out: no such scene has it."""
    kernel, load = result.rheology, float(np.max(result.force))
    scene = nt.Scene(
        tip={"shape": "paraboloid", "radius": result.radius, "material": "silica"},
        sample={"poisson_ratio": 0.5}, rheology=kernel,
        medium={"kind": "liquid", "relative_humidity": 0.0},
        adhesion={"work_of_adhesion": 0.0, "hamaker_constant": 0.0},
        range={"maximum_load": load, "speed": 1e-6, "duration": LONGEST},
    )  # fmt: skip
    said = f"Your curve: E {in_words(kernel.modulus, 'Pa', 3)} at 1 s, it relaxes with beta {kernel.exponent:.2g}"
    pull = result.measured_pull_off_force
    adheres = math.isfinite(pull) and pull > ADHERES * load
    return scene, said + (f"; its pull-off of {in_words(pull, 'N', 3)} is left out" if adheres else "")


def scene_of(result: FitResult) -> tuple[nt.Scene, str]:
    """Scene and what is felt there, in words."""
    if result.time is not None:
        return relaxing_scene_of(result)
    values, assumed = dict(result.values), []
    pull = max(result.measured_pull_off_force, 0.0) if math.isfinite(result.measured_pull_off_force) else 0.0
    model, modulus = cast(contact.Model, result.model), values["effective_modulus"]
    adheres = "work_of_adhesion" in values
    if not adheres and pull > 0.0:  # tethers, of which no law was fitted: felt as one contact of this pull-off
        model = "maugis"
        values["cohesive_range"] = ASSUMED_RANGE
    if result.determined("effective_modulus") is False:
        off = abs(values.get("sensitivity", 1.0) - 1.0) > TRUE
        values["effective_modulus"] = HARD if off or not SANE[0] < modulus < SANE[1] else modulus
        told = in_words(values["effective_modulus"], "Pa", 3)
        assumed.append(f"E* {told} (assumed: stiff)" if values["effective_modulus"] == HARD else f"E* about {told}")
    else:
        assumed.append(f"E* {in_words(modulus, 'Pa', 3)}")
    taken = values["effective_modulus"] != modulus  # then the fitted w goes with another modulus
    if not adheres or result.determined("work_of_adhesion") is False or (taken and pull > 0.0):
        values["work_of_adhesion"] = _work(model, result.radius, values, pull)
        assumed.append(
            f"w {in_words(values['work_of_adhesion'], 'J/m^2', 3)} (from the pull-off)" if pull else "no adhesion"
        )
    else:
        assumed.append(f"w {in_words(values['work_of_adhesion'], 'J/m^2', 3)}")
    known = dataclasses.replace(result, model=model, values=values, identifiable=dict.fromkeys(values, True))
    scene = known.to_scene()
    scene["range.maximum_load"] = max(float(scene.range.maximum_load), ABOVE * pull)
    seen = f"pull-off {in_words(pull, 'N', 3)}" if pull else "no pull-off"
    return scene, f"Your curve: {seen}, {', '.join(assumed)}".replace("^2", "²")


def _work(model: contact.Model, radius: float, values: dict[str, float], pull: float) -> float:
    """The work of adhesion of this pull-off [N] by a law with the modulus and range that are taken [J/m^2]."""
    work = pull / (2.0 * math.pi * radius)
    for _ in range(ROUNDS if pull else 0):
        made = nt.Contact(radius=radius, effective_modulus=values["effective_modulus"], work_of_adhesion=work,
                          cohesive_range=values.get("cohesive_range", ASSUMED_RANGE))  # fmt: skip
        work *= pull / contact.pull_off_force(model, made)
    return work
