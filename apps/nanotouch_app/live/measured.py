# SPDX-License-Identifier: BSD-3-Clause
"""The scene of a measured force curve. What the curve does not determine is assumed, and told: a person wants to touch
what was measured, and most curves determine a pull-off, but not both a modulus and a work of adhesion."""

from __future__ import annotations

import dataclasses
import math
from typing import cast

import nanotouch as nt
from nanotouch import contact
from nanotouch.fit import FitResult
from nanotouch.fit.fitting import ASSUMED_RANGE
from nanotouch.units import in_words

HARD = 10e9  # E* of a sample that a curve tells to be stiff against its lever, and no more [Pa]
TRUE = 0.05  # a fit whose lever's sensitivity is off by more than this tells no modulus
SANE = 1e2, 1e11  # [Pa]; beyond, a fitted modulus is where its search has ended
ABOVE = 2.0  # times the pull-off is the least load that is planned for: a limit below it would stop each pull
ROOM = 1.5  # the range of the lever's sensor over the deflection under the largest load
ROUNDS = 20  # of the work of adhesion, until its pull-off is the measured one


def scene_of(result: FitResult) -> tuple[nt.Scene, str]:
    """Scene and what is felt there, in words."""
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
