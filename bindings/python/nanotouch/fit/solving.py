# SPDX-License-Identifier: BSD-3-Clause
"""One model, one set of points: what the C library is given, and what it found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from .models import Floats, Model
from .points import Points
from .uncertainties import Uncertainties


class AboutTime(NamedTuple):
    """What both branches of a curve say about time."""

    relaxes: bool
    """the sample: no elastic law holds for it"""
    note: str
    reason: str
    """in a few words, where it relaxes"""


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
    time: AboutTime | None = None

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

    def known(self, extension: ModuleType, points: Points, uncertainties: Uncertainties) -> Any:
        """What is known of points beforehand, for the C library."""
        known = extension.Known()
        known.noises(points.noise, *points.free)
        known.baseline(-points.baseline_z, points.level_sigma, points.tilt_sigma)
        if points.tear is not None:
            known.tear(-points.tear[0], points.tear[1])
        known.sensitivity_sigma = uncertainties.sensitivity
        known.fit_offset = self.fit_offset
        for place, parameter in enumerate(self.options(extension).parameters):
            if parameter is not None and parameter[0] in self.held:
                known.hold(place)
        return known


@dataclass(frozen=True, eq=False)
class Solution:
    """What the C library found, of which points, with which options; `made` is its own."""

    made: Any
    points: Points
    found: dict[str, Any]
    options: Any
    fitted: Floats
    indentation: Floats

    @property
    def rms(self) -> float:
        """Of the residuals [N]."""
        return float(self.found["residual_rms"])

    def shift(self, calibration: str, changes: Mapping[str, int]) -> Floats:
        """By what all parameters move with a unit of a calibration, by its name among `changes`."""
        moved: Floats = self.made.shift(-self.points.z, self.points.force, changes[calibration])
        return moved

    def bounds(self, name: str) -> tuple[float, float]:
        """Least and most that a positive parameter can be (95 %), SI; 0 and infinity where nothing bounds it."""
        place = next(i for i, p in enumerate(self.options.parameters) if p is not None and p[0] == name)
        low, high = self.made.bounds(-self.points.z, self.points.force, place)
        return float(low), float(high)


def solve(extension: ModuleType, setup: Setup, points: Points, uncertainties: Uncertainties) -> Solution:
    """Fit the points of which something is known beforehand; those close to a tear may be left out."""
    known = setup.known(extension, points, uncertainties)
    made = extension.solve(setup.options(extension), known, -points.z, points.force)
    kept = replace(points, z=points.z[: made.count], force=points.force[: made.count])
    options, found = made.options, made.found
    fitted, indentation, _ = extension.evaluate(options, found["value"], -kept.z)
    return Solution(made, kept, found, options, fitted, indentation)
