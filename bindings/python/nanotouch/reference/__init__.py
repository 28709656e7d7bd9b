# SPDX-License-Identifier: BSD-3-Clause
"""What the models are measured against: slower and truer than anything that runs in a loop.

- :func:`force`: a scene with every term on, Maugis-Dugdale exact, composed here from the laws one by one; plans are
  measured against it.
- :func:`lennard_jones`: a sphere on an elastic half-space under the Lennard-Jones law, self-consistent;
  :func:`model_error` says what Hertz, DMT, JKR and Maugis-Dugdale are worth beside it;
- :class:`Yielding`: a paraboloid before and on an elastic half-space or layer under any pressure of the gap,
  self-consistent; what plans say of soft samples is measured against it.
"""

from nanotouch.reference._adhesive_scene import YieldedScene, yielded_scene
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
from nanotouch.reference._soft_scene import yielded, yielded_force
from nanotouch.reference._yielding import Yielded, Yielding

__all__ = [
    "LAMBDA_PER_MU",
    "PEAK_STRESS",
    "Layer",
    "LennardJones",
    "Pressure",
    "SceneForces",
    "TableError",
    "Yielded",
    "YieldedScene",
    "Yielding",
    "brush",
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
    "yielded",
    "yielded_force",
    "yielded_scene",
]
