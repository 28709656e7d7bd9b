# SPDX-License-Identifier: BSD-3-Clause
"""The ways to get a contact force, in Maugis' units (R = K = pi w = 1): every model, and Maugis-Dugdale in its tiers.

A new way is one more row of ``SOLVERS``; errors, timings, pictures and the page follow from the rows.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from nanotouch import contact
from nanotouch.contact import reduced
from numpy.typing import NDArray

Floats = NDArray[np.float64]
FloatsOf = Callable[[float, Floats], Floats]
Call = Callable[[], Floats]

JKR_LAMBDA = 1e15
"""the largest valid lambda, at which Maugis-Dugdale is JKR"""


class Solver(NamedTuple):
    """One way to get force and radius at a lambda."""

    name: str
    force: FloatsOf
    """of lambda and indentations, on the stable branch"""
    indentation: FloatsOf
    """of lambda and loads; NaN where the model has no contact"""
    radius: FloatsOf
    """of lambda and loads, under load control; NaN where the model has no contact"""
    prepare: Callable[[float, Floats], Call]
    """of lambda and indentations: a call that computes the forces, what is timed"""


@functools.lru_cache(maxsize=16)
def unit(lam: float) -> contact.Contact:
    """The contact whose SI numbers are Maugis' units: R = K = pi w = 1."""
    return contact.Contact(1.0, 0.75, 1.0 / math.pi, cohesive_stress=lam / 2.0)


def _model(name: str, model: contact.Model, prepare: Callable[[float, Floats], Call] | None = None) -> Solver:
    """A model as ``nanotouch.contact`` solves it."""

    def force(lam: float, d: Floats) -> Floats:
        return np.asarray(contact.force(model, d, unit(lam)))

    def indentation(lam: float, P: Floats) -> Floats:
        return np.asarray(contact.indentation(model, P, unit(lam)))

    def radius(lam: float, P: Floats) -> Floats:
        d = indentation(lam, P)
        return np.where(np.isnan(d), np.nan, contact.evaluate(model, np.nan_to_num(d), unit(lam)).a)

    return Solver(name, force, indentation, radius, prepare or (lambda lam, d: lambda: force(lam, d)))


def _tier(name: str, tier: contact.Tier, fixed: float | None = None) -> Solver:
    """A tier of Maugis-Dugdale, at a fixed lambda if one is given. At given loads every tier is the exact solver; its
    radius is that at the exact indentation."""

    def at(lam: float) -> float:
        return lam if fixed is None else fixed

    def indentation(lam: float, P: Floats) -> Floats:
        return np.asarray(reduced.indentation(at(lam), P))

    def prepare(lam: float, d: Floats) -> Call:
        out = np.empty_like(d)
        return lambda: np.asarray(reduced.force(at(lam), d, tier=tier, out=out))

    return Solver(
        name,
        lambda lam, d: np.asarray(reduced.force(at(lam), d, tier=tier)),
        indentation,
        lambda lam, P: np.asarray(reduced.radius(at(lam), indentation(lam, P), tier=tier)),
        prepare,
    )


def _closed(pull: float) -> Callable[[float, Floats], Call]:
    """Hertz or DMT in numpy: the force alone, without new memory, is the yardstick for other forces alone."""

    def prepare(lam: float, d: Floats) -> Call:
        out, root, touching = np.empty_like(d), np.empty_like(d), np.empty(d.shape, bool)

        def call() -> Floats:
            np.maximum(d, 0.0, out=out)
            np.sqrt(out, out=root)
            np.multiply(out, root, out=out)
            if pull:
                np.greater_equal(d, 0.0, out=touching)
                np.subtract(out, pull, out=out, where=touching)
            return out

        return call

    return prepare


HERTZ = _model("Hertz", "hertz", _closed(0.0))
DMT = _model("DMT", "dmt", _closed(2.0))
JKR = _model("JKR", "jkr")
JKR_TABLE = _tier("JKR table", "table", JKR_LAMBDA)
TABLE = _tier("MD table", "table")
POLISHED = _tier("MD polished", "polished")
EXACT = _tier("MD exact", "exact")

SOLVERS = (HERTZ, DMT, JKR_TABLE, JKR, TABLE, POLISHED, EXACT)
MAPPED = (HERTZ, DMT, JKR, TABLE)
"""those whose errors are mapped over lambda and load"""


def pull_off(lam: float) -> float:
    """Pull-off force of Maugis-Dugdale under load control [pi w R], positive."""
    return contact.pull_off_force("maugis", unit(lam))
