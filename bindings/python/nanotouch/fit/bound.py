# SPDX-License-Identifier: BSD-3-Clause
"""The 95 % bounds of a parameter that a curve does not determine."""

from __future__ import annotations

import numpy as np

from .solving import Solution
from .uncertainties import Uncertainties

_GAUSSIAN = 1.959963984540054
_POWER_OF_RADIUS = {"effective_modulus": 0.5, "work_of_adhesion": 1.0}  # E* goes as 1/sqrt(R), w as 1/R


def bounds_of(name: str, solution: Solution, uncertainties: Uncertainties) -> tuple[float, float]:
    """Least and most that a positive parameter can be (95 %), SI; 0 and infinity where the curve sets no bound.

    Those of the fit; what spring constant and radius are not known to is added.
    """
    low, high = solution.bounds(name)
    spread = np.hypot(uncertainties.spring_constant, _POWER_OF_RADIUS.get(name, 0.0) * uncertainties.radius)
    factor = float(np.exp(_GAUSSIAN * spread))
    return low / factor, high * factor
