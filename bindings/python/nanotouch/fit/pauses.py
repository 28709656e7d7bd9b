# SPDX-License-Identifier: BSD-3-Clause
"""Relaxation E(t) and creep J(t) with their uncertainties: of a fitted kernel, and as a pause of a curve shows them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch._arrays import as_floats
from nanotouch.curves import ForceCurve
from nanotouch.errors import InvalidValue
from nanotouch.rheology import Rheology

from .models import Floats
from .over_time import rheology_of
from .result import FitResult

_PER_DECADE = 10  # means of a pause
_STEP = 1e-4  # standard uncertainties, for derivatives
_HALF = 0.5  # of the peak's force: the time from which a pause is counted


class Pause(NamedTuple):
    """What one pause shows, in means that are evenly spaced in the logarithm of time."""

    kind: Literal["relaxation", "creep"]
    """by what changed more: force or indentation"""
    time: Floats
    """since the load had risen to half [s]"""
    modulus: Floats
    """E(t), E* where the Poisson ratio was not given [Pa]"""
    modulus_sigma: Floats
    """[Pa]"""
    creep: Floats
    """J(t) [1/Pa]"""
    creep_sigma: Floats
    """[1/Pa]"""


def relaxation(result: FitResult, time: ArrayLike) -> tuple[Floats, Floats]:
    """E(t) of a fitted kernel at times [s], and its standard uncertainty [Pa]."""
    times = as_floats(time, "time")
    return _with_sigma(result, lambda kernel: np.asarray(kernel.relaxation(times)))


def creep(result: FitResult, time: ArrayLike) -> tuple[Floats, Floats]:
    """J(t) of a fitted kernel at times [s], and its standard uncertainty [1/Pa]."""
    times = as_floats(time, "time")
    return _with_sigma(result, lambda kernel: np.asarray(kernel.creep(times)))


def pauses(curve: ForceCurve, result: FitResult) -> tuple[Pause, ...]:
    """What each pause of a curve shows beside its fit over time.

    E(t) is that of the fit times measured over fitted force, J(t) that of the fit over the same: the time that the
    load took to rise is in the fit, and so not in them. Sigma has the noise of each mean, what the residuals of a
    pause scatter beyond it, and the fit's own uncertainty.
    """
    if result.time is None:
        raise InvalidValue(f"model {result.model!r} knows no time; ting_power, ting_sls and ting_prony do")
    found = []
    start = _risen(result)
    for segment in curve.segments:
        if segment.role != "pause" or len(segment) < 2:
            continue
        inside = (result.time >= segment.time[0]) & (result.time <= segment.time[-1]) & (result.fitted > 0.0)
        if np.count_nonzero(inside) > 1:
            found.append(_pause(result, np.flatnonzero(inside), start))
    return tuple(found)


def _risen(result: FitResult) -> float:
    """When the load had risen to half of its peak [s]."""
    assert result.time is not None
    top = int(np.argmax(result.fitted))
    return float(result.time[int(np.argmax(result.fitted >= _HALF * result.fitted[top]))])


def _pause(result: FitResult, places: NDArray[np.intp], start: float) -> Pause:
    assert result.time is not None
    elapsed = result.time[places] - start
    decades = np.log10(elapsed[-1] / elapsed[0])
    number = np.floor((np.log10(elapsed / elapsed[0])) * max(_PER_DECADE, 4 / decades)).astype(int)
    groups = [places[number == one] for one in np.unique(number)]
    mean = np.array([[np.mean(part[group]) for group in groups] for part in (result.time, result.force, result.fitted)])
    time, ratio = mean[0] - start, mean[1] / mean[2]
    spread = max(result.report.noise, float(np.std(result.residuals[places])))
    noise = spread / np.sqrt([len(group) for group in groups]) / mean[2]
    modulus, modulus_sigma = relaxation(result, time)
    compliance, compliance_sigma = creep(result, time)
    return Pause(
        _kind(result, places),
        time,
        modulus * ratio,
        modulus * np.hypot(noise, modulus_sigma / modulus),
        compliance / ratio,
        compliance * np.hypot(noise, compliance_sigma / compliance),
    )


def _kind(result: FitResult, places: NDArray[np.intp]) -> Literal["relaxation", "creep"]:
    ends = [places[: max(len(places) // 20, 1)], places[-max(len(places) // 20, 1) :]]
    force = [float(np.mean(result.force[end])) for end in ends]
    depth = [float(np.mean(result.indentation[end])) for end in ends]
    return "relaxation" if abs(force[1] / force[0] - 1.0) > abs(depth[1] / depth[0] - 1.0) else "creep"


def _with_sigma(result: FitResult, quantity: Callable[[Rheology], Floats]) -> tuple[Floats, Floats]:
    """Of a fitted kernel, and its standard uncertainty by the covariance of what was fitted."""
    value = quantity(result.rheology)
    slopes = []
    for name in result.free:
        step = _STEP * result.sigma[name]
        values = dict(result.values)
        values[name] += step
        if name == "effective_modulus" and "youngs_modulus" in values:  # one factor for both
            values["youngs_modulus"] *= values[name] / result.values[name]
        own = name == "exponent" or "modulus" in name or "time" in name
        slopes.append(
            (quantity(rheology_of(result.model, values)) - value) / step if own and step > 0.0 else 0.0 * value
        )
    by = np.stack(slopes)
    return value, np.sqrt(np.einsum("i...,ij,j...->...", by, result.covariance, by).clip(0.0))
