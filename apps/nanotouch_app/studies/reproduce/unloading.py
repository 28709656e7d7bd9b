# SPDX-License-Identifier: BSD-3-Clause
"""A tip on a cantilever whose base moves slowly: which equilibria it meets (paper, Eq. 4-5, for any law).

The stage at a displacement Delta, a spring k_c and a force F(delta) are in equilibrium where
Delta = delta + F cos(alpha)/k_c. Where this falls with delta the spring is too soft to hold the tip, which jumps to the
next delta that is reached at this Delta: what is met is the running extreme of Delta.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Literal, NamedTuple

import numpy as np
from nanotouch.contact import Contact, Model, evaluate
from nanotouch.errors import InvalidValue

from nanotouch_app.studies.reproduce.paper import CANTILEVER, TILT
from nanotouch_app.studies.reproduce.statement import Floats

SAMPLES = 40_001


class Path(NamedTuple):
    """What the tip meets, in the order of rising stage displacement; arrays of one shape."""

    displacement: Floats
    """Delta, + towards the sample, 0 at first touch of the undeformed bodies [m]"""
    indentation: Floats
    """delta [m]"""
    force: Floats
    """[N], + repulsive"""
    radius: Floats
    """of the contact [m]"""

    def at(self, displacement: Floats | float) -> Path:
        """The same at other displacements [m]."""
        wanted = np.asarray(displacement, dtype=float)
        if not (self.displacement[0] <= wanted.min() and wanted.max() <= self.displacement[-1]):
            raise InvalidValue(f"displacement: valid is {self.displacement[0]:g} .. {self.displacement[-1]:g} m")
        return Path(wanted, *(np.interp(wanted, self.displacement, column) for column in self[1:]))

    def displacement_at(self, force: float) -> float:
        """Where an adhesive contact carries a load [N]: from the strongest attraction inwards the force rises."""
        start = int(np.argmin(self.force))
        return float(np.interp(force, self.force[start:], self.displacement[start:]))

    @property
    def pull_off(self) -> float:
        """The strongest attraction, a positive magnitude [N]."""
        return -float(np.min(self.force))

    @property
    def let_go(self) -> float:
        """Stage displacement at which nothing is felt any more on unloading [m]."""
        return float(self.displacement[np.flatnonzero(self.force != 0.0)[0]])


def follow(
    indentation: Floats,
    force: Floats,
    radius: Floats,
    direction: Literal["load", "unload"],
    spring_constant: float = CANTILEVER.value,
) -> Path:
    """The equilibria met among those at rising indentations [m], on the way in or on the way out."""
    displacement = indentation + force * math.cos(TILT.value) / spring_constant
    onward, sign = (slice(None), 1.0) if direction == "load" else (slice(None, None, -1), -1.0)
    reached = np.maximum.accumulate(sign * displacement[onward])
    met = np.concatenate([[True], np.diff(reached) > 0.0])[onward]
    return Path(displacement[met], indentation[met], force[met], radius[met])


def unload(model: Model, body: Contact, start: float, stop: float, spring_constant: float = CANTILEVER.value) -> Path:
    """Retraction from one stage displacement [m] to another at which the tip has let go."""

    def excess(indentation: Floats) -> Floats:
        load = np.asarray(evaluate(model, indentation, body).F)
        return indentation + load * math.cos(TILT.value) / spring_constant - start

    deepest = max(float(bisect(excess, 0.0, 2.0 * start)), 0.0)
    indentation = np.linspace(stop, deepest, SAMPLES)
    law = evaluate(model, indentation, body)
    return follow(indentation, law.F, law.a, "unload", spring_constant)


def bisect(function: Callable[[Floats], Floats], low: Floats | float, high: Floats | float) -> Floats:
    """Where a function changes from - at `low` to + at `high`, element by element, to rounding."""
    below, above = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    for _ in range(100):
        middle = 0.5 * (below + above)
        positive = function(middle) > 0.0
        below, above = np.where(positive, below, middle), np.where(positive, middle, above)
    return np.asarray(0.5 * (below + above))
