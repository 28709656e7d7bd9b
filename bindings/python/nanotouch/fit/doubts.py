# SPDX-License-Identifier: BSD-3-Clause
"""What a curve cannot tell, and where its model is not to be believed."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from nanotouch._words import times

from .models import Model
from .points import Points
from .result import MISFIT
from .show import with_sigma
from .solving import Setup, Solution, with_free_sensitivity
from .uncertainties import Uncertainties

_STIFF = 5.0  # contact stiffness over spring constant, from where the cantilever rules the curve
_SMALL_CONTACT = 0.5  # a/R up to which a paraboloid on a half-space is believed
_WRONG = 0.05  # residual over the span of the force from where no parameter is believed
_MUCH_BETTER = 0.7  # ratio of residuals
_CONTRADICTION = 4.0  # standard deviations
_SHIFT = 0.5  # of ln E*
_OF_THE_SAMPLE = 5  # places of the model's own parameters and the contact point; then the force offset
_SHARP = ("cone", "pyramid")


def doubts(
    extension: ModuleType, setup: Setup, points: Points, solution: Solution, uncertainties: Uncertainties
) -> tuple[dict[str, bool], list[str], str]:
    """Which fitted parameters the curve determines, by name; why it does not determine the others, as notes; and in a
    few words, where that is another reason than that it says too little (then no bounds follow either).

    Not those of baseline and calibration, which are known beforehand.
    """
    found, options, model, fit_offset = solution.found, solution.options, setup.model, setup.fit_offset
    asked = [*range(_OF_THE_SAMPLE)] + ([_OF_THE_SAMPLE] if fit_offset else [])
    identifiable = {
        options.parameters[i][0]: bool(found["identifiable"][i])
        for i in asked
        if options.parameters[i] is not None and options.is_free(options.parameters[i][0])
    }
    misfit = solution.rms / points.noise if points.noise > 0.0 else np.inf
    notes = _doubt_calibration(extension, points, solution, uncertainties, misfit, identifiable)
    reason = "the curve disagrees with its calibration" if notes else ""
    notes += _doubt_contact(model, found, options, identifiable)
    tear_unused = points.tear is not None and "work_of_adhesion" in identifiable and options.tear_sigma == 0.0
    if tear_unused and not solution.exact:
        notes.append(
            "the tip was torn off elsewhere than where this contact and cantilever let go (by a shock, or the model is "
            "wrong): where it happened is not used"
        )
    if misfit > MISFIT and np.isfinite(misfit):
        rating = extension.rating(solution.indentation, points.force, solution.fitted, points.noise)
        share = 100.0 * solution.rms / float(np.max(np.abs(points.force)))
        notes.append(
            f"the residuals are {times(misfit)} the noise and {share:.2g} % of the load: "
            + ("this model does not describe the curve" if rating < extension.good_rating else "the model is near")
            + ", and sigma covers only part of that"
        )
        if tear_unused or solution.rms > _WRONG * float(np.ptp(points.force)):
            identifiable = dict.fromkeys(identifiable, False)
            reason = "the model does not describe the curve"
            notes.append("the model is wrong for this curve: none of its parameters is a property of the sample")
    if not found["converged"]:
        notes.append("the fit stopped before it converged")
    return identifiable, notes, reason


def _doubt_calibration(
    extension: ModuleType,
    points: Points,
    solution: Solution,
    uncertainties: Uncertainties,
    misfit: float,
    identifiable: dict[str, bool],
) -> list[str]:
    """A sensitivity far from the one given, or a much better fit with one that may be anything, puts E* in doubt."""
    calibrated = uncertainties.sensitivity > 0.0 and solution.options.is_free("sensitivity")
    if "effective_modulus" not in identifiable or not calibrated or solution.exact:
        return []
    sensitivity = solution.found["value"][-1]
    if abs(np.log(sensitivity)) > _CONTRADICTION * uncertainties.sensitivity:
        identifiable.update({name: False for name in ("effective_modulus", "work_of_adhesion") if name in identifiable})
        return [
            f"the curve disagrees with its calibration: it asks for {sensitivity:.3g} times the deflection sensitivity "
            f"given, known to {100 * uncertainties.sensitivity:.2g} %; either it or the model is wrong"
        ]
    if misfit < 1.0 / _MUCH_BETTER:
        return []
    free = with_free_sensitivity(extension, solution, points, uncertainties)
    modulus, other = solution.found["value"][0], free["value"][0]
    if free["residual_rms"] > _MUCH_BETTER * solution.rms or abs(np.log(other / modulus)) < _SHIFT:
        return []
    identifiable["effective_modulus"] = False
    return [
        "the curve disagrees with its calibration: with the deflection sensitivity free the residual falls from "
        f"{solution.rms * 1e12:.3g} to {free['residual_rms'] * 1e12:.3g} pN, at {free['value'][-1]:.2g} times "
        f"the sensitivity given and E* = {with_sigma(other, 0.0, 'Pa')}; either it or the model is wrong"
    ]


def _doubt_contact(model: Model, found: dict[str, Any], options: Any, identifiable: dict[str, bool]) -> list[str]:
    notes = []
    ratio = found["contact_stiffness"] / options.spring_constant
    if not identifiable.get("effective_modulus", True) and ratio > _STIFF:
        notes.append(
            f"the contact ({found['contact_stiffness']:.3g} N/m) is {times(ratio)} stiffer than the cantilever "
            f"({options.spring_constant:.3g} N/m), whose own slope the curve shows: it hardly depends on the modulus"
        )
    if model.name not in _SHARP and found["contact_radius"] > _SMALL_CONTACT * options.radius:
        notes.append(
            f"contact radius {found['contact_radius'] * 1e9:.3g} nm at a tip of {options.radius * 1e9:.3g} nm: "
            "a paraboloid on a half-space is not valid there"
        )
    return notes
