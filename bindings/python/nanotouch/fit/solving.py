# SPDX-License-Identifier: BSD-3-Clause
"""One model, one set of points: the fit itself, with an uncertain calibration and baseline."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np

from nanotouch.curves.flicker import Noise, residual_correlation

from .models import Floats, Model
from .points import Points
from .uncertainties import Uncertainties

_EXACT = 1e-9  # of the largest force: residuals of a computed curve, in which nothing is to be weighed
_AS_GIVEN = 0.05  # relative difference of the scatter from the noise that changes nothing
_TORN_ELSEWHERE = 2.5  # standard deviations of the tear's place
_PLACES = 5  # of the model's own parameters and the contact point
_STEP = 1e-3  # relative, of what is calibrated, for the derivatives of the result by it


@dataclass(frozen=True)
class Setup:
    """What a fit is given besides its points; values in SI, contact point and bounds as positions of the base."""

    model: Model
    radius: float
    half_angle: float
    spring_constant: float
    held: Mapping[str, float] = field(default_factory=dict)
    bounds: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    free_range: bool = False
    fit_offset: bool = False
    loss: int = 0
    loss_scale: float = 1e-9

    def options(self, extension: ModuleType) -> Any:
        """For the C library."""
        options = self.model.options(extension, self.radius)
        options.half_angle = self.half_angle
        options.spring_constant = self.spring_constant
        options.loss, options.loss_scale = self.loss, self.loss_scale
        if self.free_range:
            options.free("cohesive_range")
            options.start("cohesive_range", np.nan)
        for name, (minimum, maximum) in self.bounds.items():
            options.bound(name, minimum, maximum)
        for parameter in self.model.parameters:
            if parameter.initial is not None and parameter.name in self.bounds:  # a start has to lie within
                options.start(parameter.name, float(np.clip(parameter.initial, *self.bounds[parameter.name])))
        for name, value in self.held.items():
            options.hold(name, value)
        return options


@dataclass(frozen=True, eq=False)
class Solution:
    """What the C library found, and the options it was found with."""

    found: dict[str, Any]
    options: Any
    scatter: float
    fitted: Floats
    indentation: Floats
    held: Any
    exact: bool

    @property
    def rms(self) -> float:
        """Of the residuals [N]."""
        return float(self.found["residual_rms"])


def solve(extension: ModuleType, setup: Setup, points: Points, uncertainties: Uncertainties) -> Solution:
    """Fit with the noise from point to point; then once more with the scatter that was found.

    Where the model does not describe the curve its residuals are larger than the noise and hang together. Taken as
    the uncertainty of a point, they widen sigma, and keep calibration and baseline from being bent to mend the model.
    """
    options = setup.options(extension)
    noise = max(points.noise, points.correlated_noise)
    if noise > _EXACT * float(np.max(np.abs(points.force))):
        let_vary(options, setup, points, uncertainties, noise)
    solution = _run(extension, options, points)
    if not solution.exact and options.force_noise > 0.0 and abs(solution.scatter / noise - 1.0) > _AS_GIVEN:
        options.force_noise = solution.scatter
        solution = _run(extension, options, points)
    if not _contradicts_tear(extension, solution):
        return solution
    options.tear_sigma, options.force_noise = 0.0, noise
    solution = _run(extension, options, points)
    if abs(solution.scatter / noise - 1.0) <= _AS_GIVEN:
        return solution
    options.force_noise = solution.scatter
    return _run(extension, options, points)


def _contradicts_tear(extension: ModuleType, solution: Solution) -> bool:
    """Whether the tip was torn off elsewhere than where such a contact lets go: by a shock, or it is another contact.

    Between two samples it would be at most sqrt(3) standard deviations off.
    """
    options = solution.options
    if options.tear_sigma == 0.0:
        return False
    off = extension.tear_position(options, solution.found["value"]) - options.tear_position
    return bool(abs(off) > _TORN_ELSEWHERE * options.tear_sigma)


def steep_part(extension: ModuleType, solution: Solution) -> float:
    """How far before the tear the model is only a straight continuation [m]; 0 where the tear is not used.

    What was measured there is left out, by its distance from the measured tear: the model must not choose its points.
    """
    return steep_width(extension, solution) if solution.options.tear_sigma > 0.0 else 0.0


def steep_width(extension: ModuleType, solution: Solution) -> float:
    """How far before its own tear the model is only a straight continuation [m]."""
    options, value = solution.options, solution.found["value"]
    distance = np.geomspace(1e-13, 1e-7, 100)
    held = extension.evaluate(options, value, extension.tear_position(options, value) + distance)[2]
    return float(distance[np.argmax(held)])


def let_vary(options: Any, setup: Setup, points: Points, uncertainties: Uncertainties, noise: float) -> None:
    """What is known to some uncertainty becomes a datum: sensitivity, level and tilt of the baseline, the tear."""
    options.force_noise = noise
    if uncertainties.sensitivity > 0.0 and "sensitivity" not in setup.held:
        options.know("sensitivity", 1.0, uncertainties.sensitivity)
    options.tilt_position = -points.baseline_z
    if setup.fit_offset:
        options.free("force_offset")
    elif points.level_sigma > 0.0 and "force_offset" not in setup.held:
        options.know("force_offset", 0.0, points.level_sigma)
    if points.tilt_sigma > 0.0 and "force_tilt" not in setup.held:
        options.know("force_tilt", 0.0, points.tilt_sigma)
    adhesive = any(parameter is not None and parameter[0] == "work_of_adhesion" for parameter in options.parameters)
    if points.tear is not None and setup.model.force is None and adhesive:
        options.tear_position, options.tear_sigma = -points.tear[0], points.tear[1]


def _run(extension: ModuleType, options: Any, points: Points) -> Solution:
    found = extension.run(options, -points.z, points.force)
    fitted, indentation, held = extension.evaluate(options, found["value"], -points.z)
    scatter = max(scatter_of(points.force - fitted), points.correlated_noise)
    exact = scatter < _EXACT * float(np.max(np.abs(points.force)))
    return Solution(found, options, scatter, fitted, indentation, held, exact)


def scatter_of(residuals: Floats) -> float:
    """Standard deviation of one point such that N independent ones would scatter as the mean of these N does [N]."""
    return float(np.sqrt(np.mean(residuals**2) * residual_correlation(residuals)))


def with_free_sensitivity(
    extension: ModuleType, solution: Solution, points: Points, uncertainties: Uncertainties
) -> dict[str, Any]:
    """The same fit with a deflection sensitivity that may be anything."""
    options = solution.options
    options.know("sensitivity", 1.0, 0.0)
    found: dict[str, Any] = extension.run(options, -points.z, points.force)
    options.know("sensitivity", 1.0, uncertainties.sensitivity)
    return found


def calibration_shifts(
    extension: ModuleType, setup: Setup, points: Points, solution: Solution, uncertainties: Uncertainties
) -> dict[str, Floats]:
    """By what calibration changes: shift of all parameters with one standard uncertainty of it, shape (parameters,).

    Finite differences of the whole fit, so that they hold for every model, whatever else is free or held.
    """
    base = solution.found["value"]
    changes: dict[str, tuple[float, Callable[[float], tuple[Setup, float]]]] = {
        "spring_constant": (
            uncertainties.spring_constant,
            lambda e: (_changed(setup, spring_constant=setup.spring_constant * (1.0 + e)), 1.0 + e),
        ),
        "radius": (uncertainties.radius, lambda e: (_changed(setup, radius=setup.radius * (1.0 + e)), 1.0)),
        "half_angle": (uncertainties.half_angle, lambda e: (_changed(setup, half_angle=setup.half_angle + e), 1.0)),
    }
    shifts = {}
    for name, (spread, change) in changes.items():
        if spread == 0.0:
            continue
        changed, scale = change(_STEP)
        moved = _refit(extension, changed, points, solution, uncertainties, scale)
        shifts[name] = (moved - base) / _STEP * spread
    return shifts


def _changed(setup: Setup, **changes: float) -> Setup:
    return Setup(**(setup.__dict__ | changes))


def _refit(
    extension: ModuleType, setup: Setup, points: Points, solution: Solution, uncertainties: Uncertainties, scale: float
) -> Floats:
    """The values with every force, and all that is known of forces, `scale` times as large; start: the solution."""
    options = setup.options(extension)
    noise = solution.options.force_noise
    scaled = Points(
        points.z, points.force * scale, noise * scale, Noise(*(scale**2 * part for part in points.free)), points.tear,
        points.baseline_z, points.level_sigma * scale, points.tilt_sigma * scale,
    )  # fmt: skip
    if noise > 0.0:
        let_vary(options, setup, scaled, uncertainties, noise * scale)
        options.tear_sigma = solution.options.tear_sigma
    for i, parameter in enumerate(options.parameters[:_PLACES]):
        if parameter is not None and options.is_free(parameter[0]):
            bounds = setup.bounds.get(parameter[0], parameter[2:])
            options.start(parameter[0], float(np.clip(solution.found["value"][i], *bounds)))  # off them by rounding
    return np.asarray(extension.run(options, -scaled.z, scaled.force)["value"])
