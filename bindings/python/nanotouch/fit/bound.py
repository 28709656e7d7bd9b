# SPDX-License-Identifier: BSD-3-Clause
"""The 95 % bounds of a parameter that a curve does not determine: how far it can go before the fit gets worse."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np

from nanotouch.errors import Error

from .points import Points
from .solving import Setup, Solution, let_vary
from .uncertainties import Uncertainties

_EXCESS = 3.841458820694124  # of chi^2 at 95 %, one parameter
_HALVINGS = 8  # of a decade: to 1 %
_GAUSSIAN = 1.959963984540054
_POWER_OF_RADIUS = {"effective_modulus": 0.5, "work_of_adhesion": 1.0}  # E* goes as 1/sqrt(R), w as 1/R


def bounds_of(
    name: str, extension: ModuleType, setup: Setup, points: Points, solution: Solution, uncertainties: Uncertainties
) -> tuple[float, float]:
    """Least and most that a positive parameter can be (95 %), SI; 0 and infinity where the curve sets no bound.

    The profile of chi^2: at each value all others are fitted again, sensitivity and baseline within what is known of
    them. What spring constant and radius are not known to is added.
    """
    place = next(i for i, p in enumerate(solution.options.parameters) if p is not None and p[0] == name)
    limits = solution.options.parameters[place][2:]
    profile = _Profile(name, place, extension, setup, points, solution, uncertainties)
    best = float(np.clip(solution.found["value"][place], *limits))
    profile(best)
    for decade in range(-2, 3):  # where the parameter hardly matters the best is anywhere
        profile(float(np.clip(best * 10.0**decade, *limits)))
    best = profile.best
    low = _end(profile, best, limits[0], 0.1, 0.0)
    high = _end(profile, best, limits[1], 10.0, np.inf)
    spread = np.hypot(uncertainties.spring_constant, _POWER_OF_RADIUS.get(name, 0.0) * uncertainties.radius)
    factor = float(np.exp(_GAUSSIAN * spread))
    return low / factor, high * factor


class _Profile:
    """chi^2 over one parameter, the others fitted; remembers the best."""

    def __init__(
        self, name: str, place: int, extension: ModuleType, setup: Setup, points: Points, solution: Solution,
        uncertainties: Uncertainties,
    ) -> None:  # fmt: skip
        self.name, self.place, self.extension, self.points = name, place, extension, points
        self._given = setup, solution, uncertainties
        self.known: dict[float, float] = {}

    def __call__(self, value: float) -> float:
        if value not in self.known:
            self.known[value] = self._found(value)
        return self.known[value]

    @property
    def best(self) -> float:
        """The value of the smallest chi^2 so far."""
        return min(self.known, key=self.known.__getitem__)

    def _found(self, value: float) -> float:
        setup, solution, uncertainties = self._given
        options = setup.options(self.extension)
        noise = solution.options.force_noise
        if noise <= 0.0:
            return np.inf
        let_vary(options, setup, self.points, uncertainties, noise)
        options.tear_sigma = solution.options.tear_sigma
        options.hold(self.name, value)
        try:
            found = self.extension.run(options, -self.points.z, self.points.force)
        except Error:
            return np.inf
        return self._chi2(found["value"], options, uncertainties)

    def _chi2(self, values: Any, options: Any, uncertainties: Uncertainties) -> float:
        points = self.points
        fitted = self.extension.evaluate(options, values, -points.z)[0]
        total = float(np.sum(((points.force - fitted) / options.force_noise) ** 2))
        data = {"sensitivity": (1.0, uncertainties.sensitivity), "force_offset": (0.0, points.level_sigma),
                "force_tilt": (0.0, points.tilt_sigma)}  # fmt: skip
        for place, parameter in enumerate(options.parameters):
            expected, sigma = data.get("" if parameter is None else parameter[0], (0.0, 0.0))
            if sigma > 0.0 and options.is_free(parameter[0]):
                total += float((values[place] - expected) / sigma) ** 2
        if options.tear_sigma > 0.0:
            off = self.extension.tear_position(options, values) - options.tear_position
            total += (off / options.tear_sigma) ** 2
        return total


def _end(profile: Callable[[float], float], best: float, limit: float, step: float, beyond: float) -> float:
    """Where chi^2 has risen by what 95 % allow; `beyond` where it does not up to the limit."""
    most = profile(best) + _EXCESS
    inside = best
    while (inside * step - limit) * (step - 1.0) < 0.0:
        if profile(inside * step) > most:
            break
        inside *= step
    else:
        return beyond
    outside = inside * step
    for _ in range(_HALVINGS):
        middle = float(np.sqrt(inside * outside))
        if profile(middle) > most:
            outside = middle
        else:
            inside = middle
    return outside
