# SPDX-License-Identifier: BSD-3-Clause
"""From what the C library found to a :class:`FitResult`."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from nanotouch.curves import CurveReport, ForceCurve
from nanotouch.errors import InvalidValue

from .bound import bounds_of
from .doubts import beyond, doubts
from .models import Floats, extension
from .points import Branch
from .result import FitResult
from .solving import Setup, Solution
from .uncertainties import Uncertainties, quantile

_PLAIN = (
    "pull_off_force", "residual_rms", "contact_radius", "contact_stiffness", "transition_parameter",
    "converged", "iterations",
)  # fmt: skip
_BOUNDED = ("effective_modulus", "work_of_adhesion")
_LOGARITHM = 300.0  # beyond, an exponent means "anything"


@dataclass(frozen=True)
class Sample:
    """What turns E* into a modulus of the sample."""

    poisson_ratio: float | None
    tip: Any

    def youngs_modulus(self, modulus: float, notes: list[str], assumptions: list[str]) -> tuple[float, float, float]:
        """E from 1/E* = (1 - nu^2)/E + (1 - nu_t^2)/E_t [Pa], d ln E/d ln E*, dE/dnu; NaN if the tip is all of it."""
        ratio = self.poisson_ratio
        if ratio is None or not -1.0 < ratio <= 0.5:
            raise InvalidValue(f"poisson_ratio {ratio}: valid is above -1, up to 0.5")
        tip_modulus = getattr(self.tip, "youngs_modulus", np.inf)
        tip_compliance = 0.0
        if np.isfinite(tip_modulus):
            tip_compliance = (1.0 - float(getattr(self.tip, "poisson_ratio", 0.0)) ** 2) / tip_modulus
        else:
            assumptions.append("the tip is rigid (its modulus is not given)")
        compliance = 1.0 / modulus - tip_compliance
        if compliance <= 0.0:
            notes.append("E* reaches that of the tip on a rigid sample: no modulus of the sample follows from it")
            return np.nan, np.inf, np.inf
        return (1.0 - ratio**2) / compliance, 1.0 / (modulus * compliance), -2.0 * ratio / compliance

    def with_bounds(self, bounds: dict[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        """With those of E from those of E* [Pa]; infinite where all of it is the tip's."""
        if "effective_modulus" not in bounds:
            return bounds
        ends = bounds["effective_modulus"]
        low, high = (self.youngs_modulus(end, [], [])[0] if 0.0 < end < np.inf else end for end in ends)
        return bounds | {"youngs_modulus": (0.0 if np.isnan(low) else low, np.inf if np.isnan(high) else high)}


@dataclass
class Table:
    """Values and uncertainties by name."""

    values: dict[str, float]
    statistical: dict[str, float]
    calibration: dict[str, float]
    from_step: dict[str, float]
    positive: dict[str, bool]

    def sigma(self) -> dict[str, float]:
        """All together."""
        return {key: float(np.hypot(self.statistical[key], self.calibration[key])) for key in self.values}

    def interval(self) -> dict[str, tuple[float, float]]:
        """95 %, of positive quantities symmetric in the logarithm."""
        made = {}
        for key, sigma in self.sigma().items():
            value, half = self.values[key], quantile(sigma, self.from_step[key])
            if self.positive[key] and value > 0.0:
                factor = float(np.exp(min(half / value, _LOGARITHM)))
                made[key] = (value / factor, value * factor)
            else:
                made[key] = (value - half, value + half)
        return made


class Tip(NamedTuple):
    """What was said of tip and law."""

    choice: str
    """why this law, where it was left open"""
    radius_given: bool
    assumed: bool
    """its radius or half angle was not given and had to be assumed"""


def _bounds(
    identifiable: dict[str, bool], solution: Solution, uncertainties: Uncertainties, table: Table
) -> dict[str, tuple[float, float]]:
    """Of E* and w where the curve does not determine them: with an uncertain sensitivity only, as only that rules how
    much of the slope is the cantilever's."""
    if uncertainties.sensitivity <= 0.0 or solution.options.force_noise <= 0.0:
        return {}
    asked = [name for name in _BOUNDED if not identifiable.get(name, True)]
    if solution.made.flags & extension().flags["imprecise"]:  # its own interval bounds it
        return {"effective_modulus": table.interval()["effective_modulus"]} | {
            name: bounds_of(name, solution, uncertainties) for name in asked if name != "effective_modulus"
        }
    made = {name: bounds_of(name, solution, uncertainties) for name in asked}
    if "effective_modulus" in made and np.isfinite(solution.made.half_modulus[0]):  # the halves of the contact differ
        (low, high), (least, most) = made["effective_modulus"], table.interval()["effective_modulus"]
        made["effective_modulus"] = min(low, least), max(high, most)
    return made


def _shifts(extension: ModuleType, solution: Solution, uncertainties: Uncertainties) -> dict[str, Floats]:
    """By what calibration changes: shift of all parameters with one standard uncertainty of it, shape (parameters,)."""
    known = {name: float(getattr(uncertainties, name)) for name in extension.calibrations}
    changes = extension.calibrations
    return {name: solution.shift(name, changes) * spread for name, spread in known.items() if spread > 0.0}


def make_result(
    compiled: ModuleType,
    curve: ForceCurve,
    setup: Setup,
    solution: Solution,
    uncertainties: Uncertainties,
    report: CurveReport,
    branch: Branch,
    sample: Sample,
    assumptions: list[str],
    tip: Tip,
) -> FitResult:
    """All that is known about a fit."""
    points, found, options = solution.points, solution.found, solution.options
    names = {i: parameter[0] for i, parameter in enumerate(options.parameters) if parameter is not None}
    free = [i for i in names if options.is_free(names[i])]
    identifiable, notes, reason = doubts(compiled, setup, solution, uncertainties)
    shifts = _shifts(compiled, solution, uncertainties)
    together = _together(found, max(names), shifts, uncertainties)
    covariance = found["covariance"] + sum((np.outer(s, s) for s in shifts.values()), together)
    table = _table(found, options, names, shifts, np.diag(together))
    if sample.poisson_ratio is not None and "effective_modulus" in table.values:
        _add_youngs_modulus(table, sample, uncertainties, notes, assumptions)
    bounds = {} if reason else _bounds(identifiable, solution, uncertainties, table)
    notes += _remark(setup, table, float(points.force.max()))
    return FitResult(
        model=setup.model.name,
        title=setup.model.title or setup.model.name,
        valid=setup.model.valid,
        branch=branch,
        values=table.values,
        sigma=table.sigma(),
        sigma_statistical=table.statistical,
        sigma_calibration=table.calibration,
        interval=table.interval(),
        covariance=_of_free(covariance, names, free),
        free=tuple(names[i] for i in free),
        identifiable=identifiable,
        z=points.z,
        force=points.force,
        fitted=solution.fitted,
        indentation=solution.indentation,
        misfit=solution.rms / points.noise if points.noise > 0.0 else np.inf,
        rating=solution.made.rating,
        measured_pull_off_force=report.pull_off_force,
        measured_snap_in_force=report.snap_in_force,
        radius=setup.radius,
        half_angle=setup.half_angle,
        spring_constant=setup.spring_constant,
        report=report,
        assumptions=tuple(assumptions),
        notes=tuple(list(report.notes) + notes),
        name=curve.name,
        uncertainties=uncertainties,
        bounds=sample.with_bounds(bounds) if "youngs_modulus" in table.values else bounds,
        reason=reason,
        doubt=beyond(setup, solution),
        choice=tip.choice,
        radius_given=tip.radius_given,
        assumed_tip=tip.assumed,
        units={names[i]: options.parameters[i][1] for i in names} | {"youngs_modulus": "Pa"},
        **{key: found[key] for key in _PLAIN},
    )


def _remark(setup: Setup, table: Table, load: float) -> list[str]:
    """What the model itself has to say."""
    return [] if setup.model.remark is None else [setup.model.remark(setup.radius, table.values, load)]


def _of_free(covariance: Floats, names: dict[int, str], free: list[int]) -> Floats:
    """Of the free parameters, the contact point as z of the base."""
    sign = np.where([names[i] == "contact_point" for i in free], -1.0, 1.0)
    return np.asarray(covariance[np.ix_(free, free)] * np.outer(sign, sign))


def _by_sensitivity(found: dict[str, Any], place: int) -> Floats:
    """Shift of all parameters with one standard uncertainty of the sensitivity, shape (parameters,)."""
    covariance = found["covariance"]
    if not (np.isfinite(covariance[place, place]) and covariance[place, place] > 0.0):
        return np.zeros(covariance.shape[0])
    return np.asarray(np.nan_to_num(covariance[:, place]) / np.sqrt(covariance[place, place]))


def _together(found: dict[str, Any], place: int, shifts: dict[str, Floats], known: Uncertainties) -> Floats:
    """What correlated errors of sensitivity and spring constant add to the covariance."""
    one, other = _by_sensitivity(found, place), shifts.get("spring_constant", np.zeros(found["covariance"].shape[0]))
    return np.asarray(known.correlation * (np.outer(one, other) + np.outer(other, one)))


def _table(
    found: dict[str, Any], options: Any, names: dict[int, str], shifts: dict[str, Floats], together: Floats
) -> Table:
    """Statistical: with the sensitivity known exactly, C_ii - C_is^2/C_ss. Calibration: all the rest."""
    table = Table({}, {}, {}, {}, {})
    covariance, last = found["covariance"], max(names)
    by_sensitivity = _by_sensitivity(found, last)
    for i, name in names.items():
        variance = float(covariance[i, i])
        part = min(float(by_sensitivity[i]) ** 2, variance)
        calibration = part + sum(float(shift[i]) ** 2 for shift in shifts.values())
        calibration = max(calibration + float(together[i]), 0.0)
        table.values[name] = float(found["value"][i])
        table.statistical[name] = float(np.sqrt(variance - part)) if np.isfinite(variance) else np.inf
        table.calibration[name] = float(np.sqrt(calibration))
        total = variance + calibration - part
        table.from_step[name] = float(found["from_tear"][i]) * variance / total if 0.0 < total < np.inf else 0.0
        table.positive[name] = options.parameters[i][2] > 0.0
    table.values["contact_point"] *= -1.0
    return table


def _add_youngs_modulus(
    table: Table, sample: Sample, uncertainties: Uncertainties, notes: list[str], assumptions: list[str]
) -> None:
    modulus = table.values["effective_modulus"]
    value, gain, by_ratio = sample.youngs_modulus(modulus, notes, assumptions)
    scale = gain * value / modulus if np.isfinite(value) else np.inf
    table.values["youngs_modulus"] = value
    table.statistical["youngs_modulus"] = table.statistical["effective_modulus"] * scale
    table.calibration["youngs_modulus"] = (
        float(np.hypot(table.calibration["effective_modulus"] * scale, by_ratio * uncertainties.poisson_ratio))
        if np.isfinite(scale)
        else np.inf
    )
    table.from_step["youngs_modulus"] = table.from_step["effective_modulus"]
    table.positive["youngs_modulus"] = True
