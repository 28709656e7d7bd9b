# SPDX-License-Identifier: BSD-3-Clause
"""What a curve cannot tell, and where its model is not to be believed: what the C library found, in words."""

from __future__ import annotations

from types import ModuleType
from typing import NamedTuple

import numpy as np

from nanotouch._io.words import times

from .models import built_in
from .result import MISFIT
from .show import with_sigma
from .solving import Setup, Solution
from .uncertainties import Uncertainties

_WIDEST = 0.8  # contact radius over R: a sphere's force is then 7 % off a paraboloid's
_THICK = 2.0  # contact radius over thickness up to which the laws of layers hold
_MISFITS = {"calibration", "misfit", "uneven", "wrong_model"}  # what a sample that relaxes shows to an elastic law
_OTHER_POWER = "the force rises with another power of the indentation than this law's"
_IMPRECISE = "noise and baseline leave E* a 95 % interval of more than +-20 %: it counts as not determined"
_LOST = ": other values fit as well, so that none of these is a result"
_OF_THE_SAMPLE = 5  # places of the model's own parameters and the contact point; then the force offset


class Doubts(NamedTuple):
    """Which fitted parameters the curve determines, by name (not those of baseline and calibration, which are known
    beforehand); why it does not determine the others; and in a few words, where that is another reason than that it
    says too little (then no bounds follow either)."""

    identifiable: dict[str, bool]
    notes: list[str]
    reason: str


def doubts(extension: ModuleType, setup: Setup, solution: Solution, uncertainties: Uncertainties) -> Doubts:
    """What is to be told of a solution."""
    found, options = solution.found, solution.options
    asked = [*range(_OF_THE_SAMPLE)] + ([_OF_THE_SAMPLE] if setup.fit_offset else [])
    identifiable = {
        options.parameters[i][0]: bool(found["identifiable"][i])
        for i in asked
        if options.parameters[i] is not None and options.is_free(options.parameters[i][0])
    }
    flagged = {name for name, bit in extension.flags.items() if solution.made.flags & bit}
    notes, reason = [], ""
    relaxes = setup.time is not None and setup.time.relaxes
    if setup.time is not None and (relaxes or flagged & _MISFITS):
        notes.append(setup.time.note)
    if "calibration" in flagged and not relaxes:
        notes.append(_calibration(solution, uncertainties))
        reason = "the curve disagrees with its calibration"
    if "stiff" in flagged:
        stiffness, stated = found["contact_stiffness"], options.spring_constant
        notes.append(
            f"the contact ({stiffness:.3g} N/m) is {times(stiffness / stated)} stiffer than the cantilever "
            f"({stated:.3g} N/m), whose own slope the curve shows: it hardly depends on the modulus"
        )
    if "wide" in flagged:
        notes.append(_wide(setup, solution))
    if "torn_elsewhere" in flagged:
        notes.append(
            "the tip was torn off elsewhere than where this contact and cantilever let go (by a shock, or the model is "
            "wrong): where it happened is not used"
        )
    misfit = solution.rms / solution.points.noise if solution.points.noise > 0.0 else np.inf
    if MISFIT < misfit < np.inf:
        share = 100.0 * solution.rms / float(np.max(np.abs(solution.points.force)))
        notes.append(
            f"the residuals are {times(misfit)} the noise and {share:.2g} % of the load: "
            + ("this model does not describe the curve" if "misfit" in flagged else "the model is near")
            + ", and sigma covers only part of that"
        )
    if "uneven" in flagged and not relaxes:
        notes.append(_uneven(solution, identifiable.get("effective_modulus", True)))
    if "other_power" in flagged and not relaxes:
        reason = reason if "uneven" in flagged else _OTHER_POWER  # the halves bound it
        notes.append(_power(setup, solution))
    notes += [_IMPRECISE] * ("imprecise" in flagged)
    if "wrong_model" in flagged:
        reason = "the model does not describe the curve"
        notes.append("the model is wrong for this curve: none of its parameters is a property of the sample")
    if "not_converged" in flagged:
        notes.append("the fit stopped before it converged" + ("" if any(identifiable.values()) else _LOST))
    if setup.time is not None and relaxes:
        reason, identifiable = setup.time.reason, dict.fromkeys(identifiable, False)
    return Doubts(identifiable, notes, reason)


def _uneven(solution: Solution, determined: bool) -> str:
    shallow, deep = (with_sigma(modulus, 0.0, "Pa") for modulus in solution.made.half_modulus)
    return (
        f"the shallow half of the contact asks for E* = {shallow}, the deep half for {deep}, each with a contact "
        "point of its own: a slip, a bow of the scanner or another law; sigma covers half of the difference"
        + ("" if determined else ", and so E* is not determined")
    )


def beyond(setup: Setup, solution: Solution) -> str:
    """Why the law is not that of this contact, though the curve determines what it asks for; empty where it is."""
    model, radius = setup.model, solution.found["contact_radius"]
    if model.tip in ("paraboloid", "sphere") and model.name in built_in() and radius > _WIDEST * setup.radius:
        return f"the contact radius is {radius / setup.radius:.2g} times the tip's"
    if model.is_layer and radius > _THICK * setup.held.get("thickness", np.inf):
        return "the contact radius is more than twice the layer's thickness"
    return ""


def _power(setup: Setup, solution: Solution) -> str:
    power, sigma = solution.made.power
    said = f"the force rises with the power {power:.2f} +- {sigma:.2f} of the indentation, by this law with "
    said += f"{setup.model.exponent:g}, or another tip's law describes it better: "
    if power > setup.model.exponent:
        return said + "a sharper tip, a layer on a stiff ground (layer) or a soft film on the sample"
    return said + "adhesion (dmt, jkr), a sample that flows, a blunter tip or a detector that saturates"


def _wide(setup: Setup, solution: Solution) -> str:
    radius = solution.found["contact_radius"]
    said = f"contact radius {radius * 1e9:.3g} nm at a tip of {setup.radius * 1e9:.3g} nm: "
    if setup.model.is_layer and radius > _THICK * setup.held["thickness"]:
        thickness = setup.held["thickness"] * 1e9
        return f"contact radius {radius * 1e9:.3g} nm, more than twice the layer's {thickness:.3g} nm: not valid there"
    if setup.model.tip == "sphere":
        return said + "strains above 10 %, where linear elasticity is not valid"
    return said + f"a paraboloid on a {'layer' if setup.model.is_layer else 'half-space'} is not valid there"


def _calibration(solution: Solution, uncertainties: Uncertainties) -> str:
    made = solution.made
    if np.isnan(made.any_rms):
        return (
            f"the curve disagrees with its calibration: it asks for {solution.found['value'][-1]:.3g} times the "
            f"deflection sensitivity given, known to {100 * uncertainties.sensitivity:.2g} %; either it or the model "
            "is wrong"
        )
    return (
        "the curve disagrees with its calibration: with the deflection sensitivity free the residual falls from "
        f"{solution.rms * 1e12:.3g} to {made.any_rms * 1e12:.3g} pN, at {made.any_sensitivity:.2g} times "
        f"the sensitivity given and E* = {with_sigma(made.any_modulus, 0.0, 'Pa')}; either it or the model is wrong"
    )
