# SPDX-License-Identifier: BSD-3-Clause
"""Which model: by the evidence of the curve, and by the error that theory says each would make."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from nanotouch._io.words import times
from nanotouch.curves import ForceCurve, analyse
from nanotouch.curves.flicker import residual_correlation
from nanotouch.errors import InvalidValue, SolverError
from nanotouch.scene import Scene

from .fitting import ASSUMED_RANGE, fit_curve
from .models import find
from .result import FitResult

PARABOLOIDS = ("hertz", "dmt", "jkr", "maugis")
_BACKGROUND = ("force_offset", "force_tilt", "sensitivity")  # the same in all models, and known beforehand
_DECISIVE = 6.0  # difference in BIC: strong evidence (Kass and Raftery 1995)
_DISTANCE_PER_RANGE = 16.0 / (9.0 * 3.0**0.5)  # a0/h0: the largest stress of Lennard-Jones is 16 w/(9 sqrt(3) a0)
_RIGID = 1e13  # Pa: of a scene's tip, whose share of E* is in the sample's modulus already


@dataclass(frozen=True, eq=False)
class Candidate:
    """How well one model describes the points.

    Attributes
    ----------
    model : str
        Its name.
    parameters : int
        How many were fitted of its own, contact point included.
    chi_square : float
        Sum of squared residuals over the variance of a point, over the correlation of the residuals.
    aic, bic : float
        chi^2 + 2 k, chi^2 + k ln n; smaller is better.
    weight : float
        exp(-BIC/2), over that of all candidates: the probability of the model if one of them is right.
    result : FitResult or None
        The fit; None where no law of this kind comes near the curve.
    """

    model: str
    parameters: int
    chi_square: float
    aic: float
    bic: float
    weight: float
    result: FitResult | None


@dataclass(frozen=True, eq=False)
class Choice:
    """Which model to use, and why.

    Attributes
    ----------
    candidates : tuple of Candidate
        The best first.
    by_evidence : tuple of str
        Models that the curve does not tell from the best one (BIC within 6), the simplest first.
    by_plan : str or None
        The simplest law whose error stays below `relative_accuracy` of the force at the adhesion and modulus found;
        None where the best candidate does not describe a paraboloid.
    transition_parameter : float
        Maugis' lambda there; NaN without adhesion.
    errors : dict
        Error of each simpler law there, of the force over max(\\|F\\|, pull-off force).
    relative_accuracy : float
        What was asked.
    points, correlation, noise : float
        Number of points; by how much the correlation of the residuals lowers what they are worth; standard deviation of
        a point that was used [N].
    notes : tuple of str
        What the reader should know.
    """

    candidates: tuple[Candidate, ...]
    by_evidence: tuple[str, ...]
    by_plan: str | None
    transition_parameter: float
    errors: dict[str, float]
    relative_accuracy: float
    points: int
    correlation: float
    noise: float
    notes: tuple[str, ...]

    @property
    def best(self) -> FitResult:
        """The fit with the smallest BIC."""
        result = self.candidates[0].result
        assert result is not None
        return result

    def __str__(self) -> str:
        lines = [f"{'model':10} {'k':>2} {'chi^2':>10} {'AIC':>10} {'BIC':>10} {'weight':>7}  residual"]
        for c in self.candidates:
            if c.result is None:
                lines.append(f"{c.model:10} no such contact comes near the curve")
                continue
            lines.append(
                f"{c.model:10} {c.parameters:2} {c.chi_square:10.1f} {c.aic:10.1f} {c.bic:10.1f} {c.weight:7.3f}  "
                f"{c.result.residual_rms * 1e12:.3g} pN"
            )
        lines.append(f"by evidence: {' or '.join(self.by_evidence)} ({self.points} points, worth "
                     f"{self.points / self.correlation:.0f}, of {self.noise * 1e12:.3g} pN)")  # fmt: skip
        if self.by_plan is not None:
            errors = ", ".join(f"{name} errs by {100 * error:.2g} %" for name, error in self.errors.items())
            asked = f"{100 * self.relative_accuracy:.2g} %"
            lines.append(f"by plan: {self.by_plan} for {asked} (lambda {self.transition_parameter:.3g}; "
                         f"{errors})")  # fmt: skip
        return "\n".join(lines + [f"note: {text}" for text in self.notes])


def choose_model(
    curve: ForceCurve, models: tuple[str, ...] = PARABOLOIDS, *, relative_accuracy: float = 0.01, **options: Any
) -> Choice:
    """Fit several models to the same points and compare them.

    Parameters
    ----------
    curve : ForceCurve
        With forces and a spring constant.
    models : tuple of str
        Names of :func:`nanotouch.fit.models`.
    relative_accuracy : float
        Error of the force that is still acceptable, for the choice by plan.
    **options
        As of :func:`nanotouch.fit.fit_curve`, the same for all.
    """
    report = options.pop("report", None) or analyse(curve, baseline=options.pop("baseline", "auto"))
    options.setdefault("branch", "retract" if "retract" in report.branches else "approach")
    fits: dict[str, FitResult | None] = {}
    for name in models:
        try:
            fits[name] = fit_curve(curve, replace(find(name), adhesive=True), report=report, **options)
        except SolverError:
            fits[name] = None
    found = {name: result for name, result in fits.items() if result is not None}
    if not found:
        raise SolverError(f"{curve.name}: none of {', '.join(models)} comes near the curve")
    closest = min(found.values(), key=lambda result: result.residual_rms)
    noise = max(report.noise, closest.residual_rms)
    correlation = residual_correlation(closest.residuals)
    candidates = _weighed(fits, noise, correlation)
    best = candidates[0]
    alike = [c for c in candidates if c.bic - best.bic < _DECISIVE]
    notes = _notes(closest, report.noise, alike)
    try:
        by_plan, transition, errors = _planned(best.result, _range_of(options), relative_accuracy)
    except InvalidValue as error:  # what was found is no scene: a modulus at its bound, for instance
        by_plan, transition, errors = None, np.nan, {}
        notes = (*notes, f"no choice by plan: {error}")
    return Choice(
        candidates=candidates,
        by_evidence=tuple(c.model for c in sorted(alike, key=lambda c: c.parameters)),
        by_plan=by_plan,
        transition_parameter=transition,
        errors=errors,
        relative_accuracy=relative_accuracy,
        points=min(result.z.size for result in found.values()),
        correlation=correlation,
        noise=noise,
        notes=notes,
    )


def _weighed(fits: dict[str, FitResult | None], noise: float, correlation: float) -> tuple[Candidate, ...]:
    rows = []
    shared = min(result.z.size for result in fits.values() if result is not None)  # from the deepest outwards
    for name, result in fits.items():
        if result is None:
            rows.append(Candidate(name, 0, np.inf, np.inf, np.inf, 0.0, None))
            continue
        own = sum(free not in _BACKGROUND for free in result.free)
        chi_square = float(np.sum((result.residuals[:shared] / noise) ** 2)) / correlation
        worth = max(shared / correlation, 2.0)
        bic = chi_square + own * float(np.log(worth))
        rows.append(Candidate(name, own, chi_square, chi_square + 2 * own, bic, 0.0, result))
    lowest = min(row.bic for row in rows)
    total = sum(np.exp(0.5 * (lowest - row.bic)) for row in rows)
    weighed = [replace(row, weight=float(np.exp(0.5 * (lowest - row.bic)) / total)) for row in rows]
    return tuple(sorted(weighed, key=lambda row: row.bic))


def _notes(closest: FitResult, noise: float, alike: list[Candidate]) -> tuple[str, ...]:
    notes = []
    if noise > 0.0 and closest.residual_rms > 1.5 * noise:
        notes.append(
            f"even the closest model leaves {times(closest.residual_rms / noise)} the noise: that is taken as the "
            "uncertainty of a point, and none may be right"
        )
    moduli = [c.result.values["effective_modulus"] for c in alike
              if c.result is not None and "effective_modulus" in c.result.values]  # fmt: skip
    if len(moduli) > 1:
        notes.append(
            f"the models that the curve does not tell apart differ by a factor {max(moduli) / min(moduli):.2g} in E*"
        )
    return tuple(notes)


def _range_of(options: dict[str, Any]) -> float:
    """Range of the adhesion that was given, or that of atoms."""
    given = options.get("cohesive_range")
    return float(given) if isinstance(given, (int, float)) else ASSUMED_RANGE


def _planned(
    result: FitResult | None, cohesive_range: float, relative_accuracy: float
) -> tuple[str | None, float, dict[str, float]]:
    """The rules of a plan, at the adhesion and modulus that were found, up to the largest load of the curve."""
    if result is None or result.model not in PARABOLOIDS:
        return None, np.nan, {}
    work = result.values.get("work_of_adhesion", 0.0)
    distance = result.values.get("cohesive_range", cohesive_range) * _DISTANCE_PER_RANGE
    scene = Scene(
        tip={"radius": result.radius, "youngs_modulus": _RIGID, "poisson_ratio": 0.0},
        sample={"youngs_modulus": result.values["effective_modulus"], "poisson_ratio": 0.0},
        medium={"relative_humidity": 0.0},
        adhesion={"work_of_adhesion": work, "hamaker_constant": 0.0, "equilibrium_distance": distance},
        range={"maximum_load": float(result.force.max())},
    )
    facts = scene.plan(relative_accuracy=relative_accuracy).explain()
    errors = {name: float(error) for name, error in facts["rivals"].items()}
    by_plan = next(
        (name for name in ("hertz", "dmt", "jkr") if errors.get(name, np.inf) <= relative_accuracy), "maugis"
    )
    return by_plan, float(facts["lambda"]), errors
