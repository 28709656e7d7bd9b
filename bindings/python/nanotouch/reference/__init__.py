# SPDX-License-Identifier: BSD-3-Clause
"""What the models are measured against: slower and truer than anything that runs in a loop.

- :func:`force`: a scene with every term on, Maugis-Dugdale exact, composed here from the laws one by one; plans are
  measured against it.
- :func:`lennard_jones`: a sphere on an elastic half-space under the Lennard-Jones law, self-consistent;
  :func:`model_error` says what Hertz, DMT, JKR and Maugis-Dugdale are worth beside it;
- :class:`Deformation`: a paraboloid before and on an elastic half-space or layer under any pressure of the gap,
  self-consistent; what plans say of soft samples is measured against it.
"""

from nanotouch.reference._adhesive_scene import DeformedScene, deformed_scene
from nanotouch.reference._deformation import Deformation, Deformed
from nanotouch.reference._half_space import Layer
from nanotouch.reference._lennard_jones import (
    LAMBDA_PER_MU,
    PEAK_STRESS,
    LennardJones,
    TableError,
    lennard_jones,
    model_error,
    mu_range,
    pull_off,
    table_error,
    tabor_mu,
)
from nanotouch.reference._pressures import Pressure, brush, exponential, power, sum_of
from nanotouch.reference._scene import SceneForces, force, forces
from nanotouch.reference._soft_scene import deformed, deformed_force

__all__ = [
    "LAMBDA_PER_MU",
    "PEAK_STRESS",
    "Deformation",
    "Deformed",
    "DeformedScene",
    "Layer",
    "LennardJones",
    "Pressure",
    "SceneForces",
    "TableError",
    "brush",
    "deformed",
    "deformed_force",
    "deformed_scene",
    "exponential",
    "force",
    "forces",
    "lennard_jones",
    "model_error",
    "mu_range",
    "power",
    "pull_off",
    "sum_of",
    "table_error",
    "tabor_mu",
]

_RENAMED = {"Yielding": "Deformation", "Yielded": "Deformed", "YieldedScene": "DeformedScene"}
_RENAMED |= {"yielded": "deformed", "yielded_force": "deformed_force", "yielded_scene": "deformed_scene"}


def __getattr__(name: str) -> object:
    if name in _RENAMED:  # yield is plastic flow
        raise AttributeError(f"nanotouch.reference.{name} is called nanotouch.reference.{_RENAMED[name]}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
