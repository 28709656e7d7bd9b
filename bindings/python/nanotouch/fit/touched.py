# SPDX-License-Identifier: BSD-3-Clause
"""What was fitted becomes a scene that can be touched: tip, modulus and adhesion of the fit."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from nanotouch.errors import InvalidValue
from nanotouch.scene import Scene

from .models import built_in

#: w/sigma0 of the atomic law over its equilibrium distance z0
_RANGE_OVER_Z0 = 9.0 * math.sqrt(3.0) / 16.0


class FittedLaw(NamedTuple):
    """A contact as a fit has it, SI."""

    model: str
    radius: float
    half_angle: float
    effective_modulus: float
    work_of_adhesion: float
    """0 without adhesion"""
    cohesive_range: float
    """h0; NaN: the model says it"""
    largest_load: float


def scene_of(law: FittedLaw, poisson_ratio: float) -> Scene:
    """A dry scene of this contact, without forces that were not fitted."""
    scene = Scene()
    scene.medium.relative_humidity = scene.adhesion.hamaker_constant = 0.0
    scene.sample.poisson_ratio = poisson_ratio
    scene.sample.youngs_modulus = youngs_modulus(scene, law.effective_modulus)
    scene.adhesion.work_of_adhesion = law.work_of_adhesion
    model = built_in()[law.model]
    scene.tip.shape = model.tip
    if model.sides is not None:
        scene.tip.sides, scene.tip.half_angle = model.sides, law.half_angle
    else:
        scene.tip.radius = law.radius
    if law.work_of_adhesion > 0.0:
        scene.adhesion.equilibrium_distance = _range_of(law) / _RANGE_OVER_Z0
    scene.range.maximum_load = law.largest_load
    return scene


def youngs_modulus(scene: Scene, effective_modulus: float) -> float:
    """E of a sample [Pa] with the scene's tip and Poisson ratio whose E* [Pa] this is."""
    tip = (1.0 - scene.tip.poisson_ratio**2) / scene.tip.youngs_modulus
    if not effective_modulus * tip < 1.0:
        raise InvalidValue(
            f"E* = {effective_modulus:g} Pa: with this tip it stays below {1.0 / tip:g} Pa; raise tip.youngs_modulus"
        )
    return float((1.0 - scene.sample.poisson_ratio**2) / (1.0 / effective_modulus - tip))


def _range_of(law: FittedLaw) -> float:
    """h0 [m] by lambda = 2 w/h0 (R/(pi w K^2))^(1/3) where the model has none."""
    if math.isfinite(law.cohesive_range):
        return law.cohesive_range
    stiffness = 4.0 / 3.0 * law.effective_modulus
    length = 2.0 * law.work_of_adhesion * np.cbrt(law.radius / (math.pi * law.work_of_adhesion * stiffness**2))
    reach = length / built_in()[law.model].transition
    field = Scene().fields["adhesion.equilibrium_distance"]
    return float(np.clip(reach, field.minimum * _RANGE_OVER_Z0 * 1.000001, field.maximum * _RANGE_OVER_Z0))


__all__ = ["FittedLaw", "scene_of", "youngs_modulus"]
