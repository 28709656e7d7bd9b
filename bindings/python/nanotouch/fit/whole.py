# SPDX-License-Identifier: BSD-3-Clause
"""From a fit of a whole curve over time to a :class:`FitResult`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from nanotouch._io.words import times
from nanotouch.curves import CurveReport, ForceCurve
from nanotouch.errors import SolverError

from .drift import without_drift
from .models import Floats, extension
from .reporting import Sample, Tip
from .result import MISFIT, FitResult
from .rivals import doubt_of, widened
from .show import newton, with_sigma
from .ting import (
    BACKGROUND,
    DRAG_HEIGHT,
    EXACT_EXPONENT,
    NEAR,
    UNITS,
    Found,
    Law,
    Track,
    adheres,
    interval_of,
    shifts,
    solve,
)  # fmt: skip
from .uncertainties import Uncertainties

_WIDE = 0.5  # contact radius over that of a paraboloid
_THICK = 2.0  # contact radius over a layer's thickness
_WRONG = 0.05  # residual over the load from where a model is wrong
_FREE = (
    0.1  # of the approach: with less out of contact its level and tilt take the place of a contact that began before
)
_TOUCHED = 10.0  # of the noise
_CLEAN = 1.3  # sigma over that of white noise, of a law that describes all of a curve
_WEAK = 0.02  # arm over E* at rest, below which a curve hardly shows it
_STEEPEST = 0.99
_SLOW = 3.0  # a relaxation time beyond the record's length times this is none that it shows


class Whole(NamedTuple):
    """What is fitted."""

    curve: ForceCurve
    report: CurveReport
    law: Law
    track: Track
    dipping: Track | None = None
    """the same with a retraction that seems to adhere: a drift of the force may be all of it"""


class Spread(NamedTuple):
    """Values and what they are worth, by name."""

    values: dict[str, float]
    sigma: dict[str, float]
    statistical: dict[str, float]
    calibration: dict[str, float]
    interval: dict[str, tuple[float, float]]
    covariance: Floats


def _solved(whole: Whole) -> tuple[Whole, Found]:
    """The fit with any drift of the force taken off, and the curve without it."""
    law, track = whole.law, whole.track
    if (drifting := _drifting(whole)) is not None:
        return drifting
    try:
        found = solve(extension(), law, track)
    except SolverError as error:
        raise SolverError(f"{whole.curve.name}: {error}; {_cause(law, track)}") from error
    track, found = without_drift(law, track, found)
    return whole._replace(track=track), found


def _drifting(whole: Whole) -> tuple[Whole, Found] | None:
    """Where a drift is all that takes the retraction below the free level: the whole curve is then this law's."""
    if whole.dipping is None:
        return None
    law = whole.law
    try:
        track, found = without_drift(law, whole.dipping, solve(extension(), law, whole.dipping))
    except SolverError:
        return None
    if track.drift == 0.0 or not found.raw["converged"] or widened(found) > _CLEAN:
        return None
    return whole._replace(track=track, dipping=None), found


def _verdict(law: Law, track: Track, found: Found, notes: list[str]) -> tuple[str, str]:
    """Why it determines nothing, and what speaks against it; the latter is noted, too."""
    reason = _wrong(law, found, track)
    doubt = "" if reason else doubt_of(law, track, found)
    notes += [f"{doubt}: none of these is a property of the sample"] if doubt else []
    return reason, doubt


def fit_whole(
    whole: Whole, uncertainties: Uncertainties, sample: Sample, assumptions: list[str], tip: Tip
) -> FitResult:
    """Fit, and all that is known about it."""
    whole, found = _solved(whole)
    report, law, track = whole.report, whole.law, whole.track
    spread = _spread(whole, found, uncertainties)
    identifiable = _identifiable(law, found, track, spread)
    notes = list(report.notes) + _notes(whole, found)
    _turn(spread.values, spread.interval)
    if sample.poisson_ratio is not None:
        _add_youngs_modulus(sample, spread, uncertainties, notes, assumptions)
    rms = found.rms(track)
    reason, doubt = _verdict(law, track, found, notes)
    return FitResult(
        branch="approach" if len(track.starts) == 1 else "whole curve",
        values=spread.values,
        sigma=spread.sigma,
        sigma_statistical=spread.statistical,
        sigma_calibration=spread.calibration,
        interval=spread.interval,
        covariance=_signed(spread.covariance, found.free),
        free=found.free,
        identifiable=dict.fromkeys(identifiable, False) if reason else identifiable,
        z=-track.position[track.fitted],
        force=track.force[track.fitted],
        fitted=found.fitted[track.fitted],
        indentation=found.indentation[track.fitted],
        **_of_law(law),
        **_not_of_this_law(),
        measured_pull_off_force=report.pull_off_force,
        measured_snap_in_force=report.snap_in_force,
        residual_rms=rms,
        misfit=rms / law.noise,
        contact_radius=_contact_radius(law, found),
        converged=bool(found.raw["converged"]),
        iterations=int(found.raw["iterations"]),
        report=report,
        assumptions=tuple(assumptions),
        notes=tuple(notes),
        name=whole.curve.name,
        uncertainties=uncertainties,
        reason=reason,
        doubt=doubt,
        choice=tip.choice,
        rating=_rating(track, found, law.noise),
        radius_given=tip.radius_given,
        assumed_tip=tip.assumed,
        units={name: _unit(law, name) for name in spread.values},
        time=track.time[track.fitted],
    )


def _wrong(law: Law, found: Found, track: Track) -> str:
    """Why none of the values is a property of the sample, as of all fits; else empty."""
    if not found.raw["converged"]:
        return f"the fit stopped before it converged{_open_end(law, found, track)}"
    if found.rms(track) > max(MISFIT * law.noise, _WRONG * float(found.raw["peak"])):
        return "the model does not describe the curve"
    last = track.starts[1] if len(track.starts) > 1 else track.time.size
    free = float(np.mean(found.indentation[:last] <= 0.0))
    return f"only {100.0 * free:.2g} % of the approach is out of contact" if free < _FREE else ""


def _cause(law: Law, track: Track) -> str:
    """Why no law of this kind comes near, as far as the force shows it."""
    most = float(track.force[track.fitted].max())
    if most < _TOUCHED * law.noise:
        return f"the force rises by {newton(most)} over a noise of {newton(law.noise)}: nothing is touched"
    return f"the force rises to {newton(most)}, in no way that this model knows with this tip and lever"


def _open_end(law: Law, found: Found, track: Track) -> str:
    """Which parameter has no end to which the fit could go: what the curve does not show."""
    length, step = float(np.ptp(track.time)), float(np.median(np.diff(track.time)))
    said = []
    for parameter in law.model.parameters:
        name, value = parameter.name, found.values[parameter.name]
        if "time" in name and not step < value < _SLOW * length:
            said.append(f"{name} of {value:.2g} s in a record of {length:.2g} s")
        elif "arm" in name and value < _WEAK * found.values["effective_modulus"]:
            said.append(f"{name} is {value / found.values['effective_modulus']:.1g} of E*")
        elif name == "exponent" and value > _STEEPEST * parameter.maximum:
            said.append(f"{name} at its bound {parameter.maximum:g}")
    if not said:
        return ""
    return f": {', '.join(said)}; a kernel with fewer arms, or another, may do"


def _of_law(law: Law) -> dict[str, Any]:
    return {
        "model": law.model.name,
        "title": law.model.title,
        "valid": law.model.valid,
        "radius": law.radius,
        "half_angle": law.half_angle,
        "spring_constant": law.spring_constant,
    }


def _not_of_this_law() -> Any:
    return dict.fromkeys(("pull_off_force", "contact_stiffness", "transition_parameter"), np.nan)


def _spread(whole: Whole, found: Found, uncertainties: Uncertainties) -> Spread:
    """What noise and calibration leave of each value."""
    law = whole.law
    moved = shifts(extension(), law, whole.track, uncertainties, found)
    cross = np.zeros_like(found.covariance)
    if "sensitivity" in moved and "spring_constant" in moved:
        cross = uncertainties.correlation * np.outer(moved["sensitivity"], moved["spring_constant"])
    calibrated = sum((np.outer(shift, shift) for shift in moved.values()), cross + cross.T)
    values = found.values | ({DRAG_HEIGHT: law.drag_height} if law.drag_height > 0.0 else {})
    sigma, statistical, calibration = (
        dict.fromkeys(values, 0.0) | dict(zip(found.free, np.sqrt(np.diag(part).clip(0.0)).tolist(), strict=True))
        for part in (found.covariance + calibrated, found.covariance, calibrated)
    )
    unbounded = found.raw["free_exponent"]
    interval = {name: interval_of(name, value, sigma[name], unbounded) for name, value in values.items()}
    return Spread(values, sigma, statistical, calibration, interval, found.covariance + calibrated)


def _unit(law: Law, name: str) -> str:
    own = {one.name: one.unit for one in law.model.parameters}
    return (own | UNITS | {DRAG_HEIGHT: "m", "youngs_modulus": "Pa"})[name]


def _turn(values: dict[str, float], interval: dict[str, tuple[float, float]]) -> None:
    """The contact point as z of the base."""
    values["contact_point"] *= -1.0
    low, high = interval["contact_point"]
    interval["contact_point"] = -high, -low


def _signed(covariance: Any, free: tuple[str, ...]) -> Any:
    sign = np.where([name == "contact_point" for name in free], -1.0, 1.0)
    return covariance * np.outer(sign, sign)


def _identifiable(law: Law, found: Found, track: Track, spread: Spread) -> dict[str, bool]:
    sigma, interval, made = spread.sigma, spread.interval, {}
    for name in found.free:
        if name in BACKGROUND[1:]:
            continue
        if name == "contact_point":
            made[name] = sigma[name] < NEAR * float(np.ptp(track.position))
        elif name == "exponent":
            made[name] = interval[name][1] - interval[name][0] < 4.0 * EXACT_EXPONENT
        else:
            made[name] = sigma[name] < NEAR * found.values[name]
            if "time" in name:
                made[name] &= found.values[name] < _SLOW * float(np.ptp(track.time))
    return made


def _rating(track: Track, found: Found, noise: float) -> float:
    """Of the approach, as of all fits."""
    last = track.starts[1] if len(track.starts) > 1 else track.time.size
    part = slice(0, last)
    order = np.argsort(-track.position[part], kind="stable")  # from the deepest outwards
    columns = (column[part][order].copy() for column in (found.indentation, track.force, found.fitted))
    return float(extension().rating(*columns, noise))


def _contact_radius(law: Law, found: Found) -> float:
    """At the deepest indentation, on a half-space [m]."""
    depth = max(float(found.raw["indentation"]), 0.0)
    if law.model.tip == "punch":
        return law.radius
    if law.model.tip == "cone":
        return float(2.0 / np.pi * np.tan(law.half_angle) * depth)
    return float(np.sqrt(law.radius * depth))


def _notes(whole: Whole, found: Found) -> list[str]:
    report, law, track = whole.report, whole.law, whole.track
    notes, raw = [], found.raw
    rms = found.rms(track)
    if law.noise > 0.0 and rms > MISFIT * law.noise:
        share = 100.0 * rms / max(float(raw["peak"]), 1e-30)
        notes.append(
            f"the residuals are {times(rms / law.noise)} the noise and {share:.2g} % of the load: sigma covers only "
            "part of that"
        )
    elif raw["chi_square"] > 1.5 * raw["bins"] or raw["correlation"] > 1.0:
        notes.append(f"neighbouring residuals hang together: sigma is {times(widened(found))} that of white noise")
    if not track.fitted.all():
        left = int(np.count_nonzero(~track.fitted))
        why = "by window"
        if track.gap > 0.0:
            why = f"nothing is recorded for {track.gap:.3g} s before the retraction: it is not fitted"
        elif adheres(report):
            why = f"the retraction adheres ({newton(report.pull_off_force)}): it is not fitted"
        notes.append(f"{left} points are left out: {why}")
    if track.drift != 0.0:
        notes.append(
            f"a drift of {with_sigma(track.drift, 0.0, 'N/s')} is taken off: the free parts before and after contact "
            "tilt by as much in time"
        )
    if report.snap_in_force > 0.0:
        notes.append(f"the approach snaps in by {newton(report.snap_in_force)}: this law knows no adhesion")
    radius = _contact_radius(law, found)
    if law.thickness > 0.0 and radius > _THICK * law.thickness:
        notes.append(f"contact radius {radius * 1e9:.3g} nm, more than twice the layer's thickness: not valid there")
    elif law.model.tip == "paraboloid" and law.thickness == 0.0 and radius > _WIDE * law.radius:
        notes.append(
            f"contact radius {radius * 1e9:.3g} nm at a tip of {law.radius * 1e9:.3g} nm: a paraboloid is not valid "
            f"there; {law.model.kernel}_sphere is"
        )
    if raw["by_springs"]:
        notes.append("the contact shrank and grew again: 128 springs followed it, to 3e-4 of the load")
    time = float(raw["contact_time"])
    if law.model.kernel == "ting_power" and time > 0.0:
        held = found.values["effective_modulus"] * time ** -found.values["exponent"]
        notes.append(f"at the {time:.2g} s that the load took to rise, E* is {with_sigma(held, 0.0, 'Pa')}")
    return notes


def _add_youngs_modulus(
    sample: Sample, spread: Spread, uncertainties: Uncertainties, notes: list[str], assumptions: list[str]
) -> None:
    values, sigma, statistical, calibration, interval, _ = spread
    modulus = values["effective_modulus"]
    value, gain, by_ratio = sample.youngs_modulus(modulus, notes, assumptions)
    scale = gain * value / modulus if np.isfinite(value) else np.inf
    values["youngs_modulus"] = value
    statistical["youngs_modulus"] = statistical["effective_modulus"] * scale
    calibration["youngs_modulus"] = float(
        np.hypot(calibration["effective_modulus"] * scale, by_ratio * uncertainties.poisson_ratio)
    )
    sigma["youngs_modulus"] = float(np.hypot(statistical["youngs_modulus"], calibration["youngs_modulus"]))
    interval["youngs_modulus"] = interval_of("youngs_modulus", value, sigma["youngs_modulus"], np.nan)
