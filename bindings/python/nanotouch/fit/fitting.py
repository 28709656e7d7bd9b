# SPDX-License-Identifier: BSD-3-Clause
"""Fit one contact model to one branch of a force curve: see :func:`fit_curve`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import ModuleType
from typing import Any, Literal, Protocol

import numpy as np

from nanotouch.contact import MODELS, Model
from nanotouch.curves import CurveReport, ForceCurve, Segment, analyse
from nanotouch.errors import InvalidValue, MissingExtra

from .result import Branch, FitResult, Floats, with_sigma

Loss = Literal["squares", "huber", "soft_l1", "cauchy"]

LOSSES: tuple[Loss, ...] = ("squares", "huber", "soft_l1", "cauchy")
ASSUMED_RADIUS = 20e-9  # m; common for new silicon and silicon nitride tips
ASSUMED_RANGE = 0.2e-9  # m; atomic adhesion
SENSITIVITY_UNCERTAINTY = 0.03  # relative; what repeated calibrations on a hard sample commonly scatter by
_LOSS_SCALE = 3.0  # times the noise
_STIFF = 5.0  # contact stiffness over spring constant, from where the cantilever rules the curve
_SMALL_CONTACT = 0.5  # a/R up to which a paraboloid on a half-space is believed
_MISFIT = 3.0  # residual over noise from where the model is said not to describe the curve
_WRONG = 0.05  # residual over the span of the force from where no parameter is believed
_BLOCKS = 20  # of residuals, whose means show how they hang together
_CORRELATED = 2.0  # of white noise this ratio is 1 +- 0.3
_MUCH_BETTER = 0.7  # ratio of residuals


class TipLike(Protocol):
    """A tip: ``radius`` [m], and where it is not taken as rigid ``youngs_modulus`` [Pa] and ``poisson_ratio``."""

    @property
    def radius(self) -> float: ...


def fit_curve(
    curve: ForceCurve,
    model: Model = "maugis",
    *,
    tip: TipLike | None = None,
    radius: float | None = None,
    poisson_ratio: float | None = None,
    contact_point: float | None = None,
    window: tuple[float, float] | None = None,
    branch: Branch | None = None,
    cohesive_range: float | Literal["free"] | None = None,
    sensitivity_uncertainty: float = SENSITIVITY_UNCERTAINTY,
    fixed: Mapping[str, float] | None = None,
    bounds: Mapping[str, tuple[float, float]] | None = None,
    fit_offset: bool = False,
    loss: Loss = "squares",
    loss_scale: float | None = None,
) -> FitResult:
    """Fit one contact model to one branch of a force curve.

    Parameters
    ----------
    curve : ForceCurve
        With forces and a spring constant.
    model : {"maugis", "jkr", "dmt", "hertz"}
        Adhesive models describe the retraction from the deepest point to the pull-off.
    tip : object with ``radius``, optional
        For instance ``scene.tip``; its ``youngs_modulus`` and ``poisson_ratio`` enter the sample's modulus.
    radius : float, optional
        R of the tip [m], in place of `tip`. Without either 20 nm is assumed, and the result says so.
    poisson_ratio : float, optional
        Of the sample: then its Young's modulus is reported beside E*.
    contact_point : float, optional
        z of the base [m] at which the undeformed bodies touch, held; fitted by default.
    window : (float, float), optional
        Only points with a force between these [N].
    branch : {"retract", "approach"}, optional
        Default: the retraction, for Hertz the approach.
    cohesive_range : float or "free", optional
        h0 = w/sigma0 of Maugis-Dugdale [m]; 0.2 nm (atoms) is assumed where it is not given.
    sensitivity_uncertainty : float
        Relative standard uncertainty of the deflection sensitivity; 0: exact.
    fixed : mapping, optional
        Parameters to hold, by name, at a value [SI].
    bounds : mapping, optional
        (minimum, maximum) of parameters by name [SI].
    fit_offset : bool
        Also fit a constant force offset on top of the baseline.
    loss : {"squares", "huber", "soft_l1", "cauchy"}
        All but the first resist outliers beyond `loss_scale` [N] (default three times the noise).

    Raises
    ------
    InvalidValue
        If an argument or the curve cannot be used; SolverError if no law of this kind comes near the curve;
        MissingExtra if the package was built without Ceres.
    """
    extension = _extension()
    _check_choice("model", model, MODELS)
    _check_choice("loss", loss, LOSSES)
    branch = branch or ("approach" if model == "hertz" else "retract")
    _check_choice("branch", branch, ("approach", "retract"))
    report = analyse(curve)
    points = _points(curve, report, branch, model, window)
    assumptions: list[str] = []

    options = extension.Options(MODELS.index(model))
    options.radius = _radius(tip, radius, assumptions)
    options.spring_constant = _spring_constant(curve)
    if model == "maugis":
        _set_range(options, cohesive_range, assumptions)
    for name, pair in (bounds or {}).items():
        options.bound(_known(extension, name), *_base_position(name, pair))
    held = dict(fixed or {}) | ({} if contact_point is None else {"contact_point": contact_point})
    for name, value in held.items():
        options.hold(_known(extension, name), -value if name == "contact_point" else value)
    if fit_offset:
        options.free("force_offset")
        options.start("force_offset", 0.0)
    options.loss = LOSSES.index(loss)
    options.loss_scale = loss_scale or max(_LOSS_SCALE * report.noise, 1e-18)
    _set_pull_off(options, points, report.noise)
    found, notes = _run(extension, options, points, sensitivity_uncertainty, assumptions)
    given = _Given(curve, model, branch, tip, poisson_ratio, assumptions, notes)
    return _result(extension, options, found, points, report, given)


@dataclass(frozen=True, eq=False)
class _Points:
    """What is fitted: z of the base [m], force without baseline [N]; the pull-off is the last one, if there is any."""

    z: Floats
    force: Floats
    ends_in_pull_off: bool


@dataclass(frozen=True, eq=False)
class _Given:
    """What a result says about its making."""

    curve: ForceCurve
    model: Model
    branch: Branch
    tip: TipLike | None
    poisson_ratio: float | None
    assumptions: list[str]
    notes: list[str]


def _extension() -> ModuleType:
    try:
        from nanotouch import _fit
    except ImportError as error:
        raise MissingExtra(
            "fitting needs the extension nanotouch._fit, which this build lacks: install Ceres (Debian, Ubuntu: "
            "apt install libceres-dev) and build nanotouch again from its sources"
        ) from error
    return _fit


def _check_choice(name: str, value: str, valid: tuple[str, ...]) -> None:
    if value not in valid:
        raise InvalidValue(f"{name} {value!r}: valid are {', '.join(valid)}")


def _known(extension: ModuleType, name: str) -> str:
    _check_choice("parameter", name, tuple(known for known, _ in extension.parameters))
    return name


def _base_position(name: str, pair: tuple[float, float]) -> tuple[float, float]:
    """Bounds of the contact point as positions towards the sample, which the C library counts in."""
    return (-pair[1], -pair[0]) if name == "contact_point" else pair


def _points(
    curve: ForceCurve, report: CurveReport, branch: Branch, model: Model, window: tuple[float, float] | None
) -> _Points:
    segment: Segment | None = {"approach": curve.approach, "retract": curve.retract}[branch]
    if segment is None or segment.force is None or branch not in report.baselines:
        raise InvalidValue(f"{curve.name}: no {branch} with force to fit")
    z, force = segment.z, segment.force - report.baselines[branch].at(segment.z)
    order = np.argsort(z, kind="stable")  # from the deepest point outwards
    z, force = z[order], force[order]
    dips = report.pull_off_force > 0 if branch == "retract" else report.snap_in_force > 0
    keep = slice(0, int(np.argmin(force)) + 1) if dips and model != "hertz" else _repulsive(z, force, dips)
    z, force = z[keep], force[keep]
    if window is not None:
        inside = (force >= window[0]) & (force <= window[1])
        z, force = z[inside], force[inside]
    if z.size < 16:
        raise InvalidValue(f"{curve.name}: {z.size} points of the {branch} are left to fit; at least 16 are needed")
    return _Points(z, force, bool(dips) and model != "hertz" and window is None and branch == "retract")


def _repulsive(z: Floats, force: Floats, dips: bool) -> slice:
    """Up to where attraction begins, which Hertz does not know; without attraction, a piece of the baseline as well."""
    deepest = int(np.argmax(force))
    below = np.flatnonzero(force[deepest:] <= 0.0)
    zero = deepest + int(below[0]) if below.size else z.size
    if dips:
        return slice(0, zero)
    beyond = z[0] + 1.5 * (z[min(zero, z.size - 1)] - z[0])
    return slice(0, max(zero, int(np.searchsorted(z, beyond))))


def _radius(tip: TipLike | None, radius: float | None, assumptions: list[str]) -> float:
    if tip is not None and radius is not None:
        raise InvalidValue("give tip or radius, not both")
    if tip is not None:
        return float(tip.radius)
    if radius is not None:
        return float(radius)
    assumptions.append(f"tip radius {ASSUMED_RADIUS * 1e9:g} nm (not given; E* goes as 1/sqrt(R), w as 1/R)")
    return ASSUMED_RADIUS


def _spring_constant(curve: ForceCurve) -> float:
    if curve.spring_constant is None:
        raise InvalidValue(f"{curve.name}: no spring constant; give it to curves.read")
    return curve.spring_constant


def _set_range(options: Any, cohesive_range: float | Literal["free"] | None, assumptions: list[str]) -> None:
    if cohesive_range == "free":
        options.free("cohesive_range")
        options.start("cohesive_range", np.nan)
        return
    if cohesive_range is None:
        assumptions.append(f"range of adhesion h0 = {ASSUMED_RANGE * 1e9:g} nm (atomic; not given)")
    options.hold("cohesive_range", ASSUMED_RANGE if cohesive_range is None else float(cohesive_range))


def _set_pull_off(options: Any, points: _Points, noise: float) -> None:
    """The contact broke between the last point and the next: on average half a step further on."""
    if noise == 0.0 or not points.ends_in_pull_off:
        return
    last = slice(-min(8, points.z.size), None)
    slope = abs(float(np.polyfit(points.z[last] - points.z[-1], points.force[last], 1)[0]))
    step = min(slope, options.spring_constant) * float(np.median(np.diff(points.z[last])))
    options.force_noise = noise
    options.pull_off_force = max(0.0, -float(points.force[-1]) + 0.5 * step)
    options.pull_off_sigma = float(np.hypot(noise, step / np.sqrt(12.0)))


def _run(
    extension: ModuleType, options: Any, points: _Points, sensitivity_uncertainty: float, assumptions: list[str]
) -> tuple[dict[str, Any], list[str]]:
    """Fit with an exact calibration; then once more with the scatter found and the calibration as uncertain as it is.

    Where the model does not describe the curve its residuals are larger than the noise and hang together; taken as the
    uncertainty of a point, they keep the calibration from being bent to mend the model, and widen sigma.
    """
    position = -points.z
    first = extension.run(options, position, points.force)
    scatter = _scatter(points.force - extension.evaluate(options, first["value"], position)[0])
    known = f"known to {100 * sensitivity_uncertainty:.3g} %" if sensitivity_uncertainty else "exact"
    assumptions.append(f"deflection sensitivity {known}")
    if scatter < 1e-9 * float(np.max(np.abs(points.force))):  # a computed curve: nothing to be weighed
        return first, []
    options.force_noise = scatter
    if sensitivity_uncertainty == 0.0:
        return extension.run(options, position, points.force), []
    options.free("compliance")
    options.compliance_sigma = sensitivity_uncertainty
    found = extension.run(options, position, points.force)
    options.compliance_sigma = 0.0
    notes = _doubt_calibration(found, extension.run(options, position, points.force))
    options.compliance_sigma = sensitivity_uncertainty
    return found, notes


def _scatter(residuals: Floats) -> float:
    """Standard deviation of one point such that N independent ones would scatter as the mean of these N does [N]."""
    rms = float(np.sqrt(np.mean(residuals**2)))
    blocks = np.array_split(residuals, max(2, min(_BLOCKS, residuals.size // 4)))
    correlation = float(np.mean([block.mean() ** 2 * block.size for block in blocks])) / rms**2 if rms > 0 else 1.0
    return rms * float(np.sqrt(correlation)) if correlation > _CORRELATED else rms


def _doubt_calibration(found: dict[str, Any], free: dict[str, Any]) -> list[str]:
    """Compare with a fit in which the sensitivity may be anything; a much better one puts the modulus in doubt."""
    modulus, other = found["value"][0], free["value"][0]
    better = free["residual_rms"] < _MUCH_BETTER * found["residual_rms"]
    if not better or abs(np.log(other / modulus)) < 0.5:
        return []
    found["identifiable"][0] = False
    return [
        "the curve disagrees with its calibration: with the deflection sensitivity free the residual falls from "
        f"{found['residual_rms'] * 1e12:.3g} to {free['residual_rms'] * 1e12:.3g} pN, at {free['value'][5]:.2g} times "
        f"the sensitivity given and E* = {with_sigma(other, 0.0, 'Pa')}; either it or the model is wrong"
    ]


def _result(
    extension: ModuleType, options: Any, found: dict[str, Any], points: _Points, report: CurveReport, given: _Given
) -> FitResult:
    names = [name for name, _ in extension.parameters]
    fitted, indentation = extension.evaluate(options, found["value"], -points.z)
    index = MODELS.index(given.model)
    present = [i for i, name in enumerate(names) if extension.model_has(index, name)]
    free = [i for i in present if options.is_free(names[i])]
    values = {names[i]: found["value"][i] for i in present}
    values["contact_point"] = -values["contact_point"]
    sigma = {names[i]: found["sigma"][i] for i in present}
    sign = np.where(np.array(names)[free] == "contact_point", -1.0, 1.0)
    identifiable = {names[i]: found["identifiable"][i] for i in free}
    misfit = found["residual_rms"] / report.noise if report.noise > 0.0 else np.inf
    notes = given.notes + list(report.notes) + _notes(options, found, identifiable, misfit)
    if misfit > _MISFIT and found["residual_rms"] > _WRONG * float(np.ptp(points.force)):
        identifiable = dict.fromkeys(identifiable, False)
        notes.append("the model is wrong for this curve: none of its parameters is a property of the sample")
    if given.poisson_ratio is not None:
        values["youngs_modulus"], sigma["youngs_modulus"] = _sample_modulus(
            values["effective_modulus"], sigma["effective_modulus"], given, notes
        )
    return FitResult(
        model=given.model,
        branch=given.branch,
        values=values,
        sigma=sigma,
        covariance=found["covariance"][np.ix_(free, free)] * np.outer(sign, sign),
        free=tuple(names[i] for i in free),
        identifiable=identifiable,
        z=points.z,
        force=points.force,
        fitted=fitted,
        indentation=indentation,
        misfit=misfit,
        measured_pull_off_force=report.pull_off_force,
        measured_snap_in_force=report.snap_in_force,
        radius=options.radius,
        spring_constant=options.spring_constant,
        report=report,
        assumptions=tuple(given.assumptions),
        notes=tuple(notes),
        name=given.curve.name,
        units=dict(extension.parameters) | {"youngs_modulus": "Pa"},
        **{key: found[key] for key in _PLAIN},
    )


_PLAIN = (
    "pull_off_force", "residual_rms", "contact_radius", "contact_stiffness", "transition_parameter",
    "converged", "iterations",
)  # fmt: skip


def _notes(options: Any, found: dict[str, Any], identifiable: Mapping[str, bool], misfit: float) -> list[str]:
    notes = []
    ratio = found["contact_stiffness"] / options.spring_constant
    if not identifiable.get("effective_modulus", True) and ratio > _STIFF:
        notes.append(
            f"the contact ({found['contact_stiffness']:.3g} N/m) is {ratio:.2g} times stiffer than the cantilever "
            f"({options.spring_constant:.3g} N/m), whose own slope the curve shows: it hardly depends on the modulus"
        )
    if misfit > _MISFIT and np.isfinite(misfit):
        notes.append(
            f"the residuals are {misfit:.2g} times the noise: this model does not describe the curve, and sigma covers "
            "only part of that"
        )
    if found["contact_radius"] > _SMALL_CONTACT * options.radius:
        notes.append(
            f"contact radius {found['contact_radius'] * 1e9:.3g} nm at a tip of {options.radius * 1e9:.3g} nm: "
            "a paraboloid on a half-space is not valid there"
        )
    if not found["converged"]:
        notes.append("the fit stopped before it converged")
    return notes


def _sample_modulus(modulus: float, sigma: float, given: _Given, notes: list[str]) -> tuple[float, float]:
    """E of the sample from 1/E* = (1 - nu^2)/E + (1 - nu_t^2)/E_t, and sigma [Pa]; NaN if the tip yields all."""
    ratio = given.poisson_ratio
    if ratio is None or not -1.0 < ratio <= 0.5:
        raise InvalidValue(f"poisson_ratio {ratio}: valid is above -1, up to 0.5")
    tip_modulus = getattr(given.tip, "youngs_modulus", np.inf)
    tip_compliance = 0.0
    if np.isfinite(tip_modulus):
        tip_compliance = (1.0 - float(getattr(given.tip, "poisson_ratio", 0.0)) ** 2) / tip_modulus
    else:
        given.assumptions.append("the tip is rigid (its modulus is not given)")
    compliance = 1.0 / modulus - tip_compliance
    if compliance <= 0.0:
        notes.append("E* reaches that of the tip on a rigid sample: no modulus of the sample follows from it")
        return np.nan, np.inf
    youngs_modulus = (1.0 - ratio**2) / compliance
    return youngs_modulus, youngs_modulus * sigma / (modulus**2 * compliance)
