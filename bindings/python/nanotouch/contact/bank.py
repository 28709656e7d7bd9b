# SPDX-License-Identifier: BSD-3-Clause
"""Maugis-Dugdale for many contacts at once, each with its own radius, modulus, adhesion and indentation.

Where every contact has its own lambda (grains of many sizes, a tip on a curved surface) a table for each would cost
more than it saves; a bank of tables over lambda serves all. Its energy is one function of indentation and radius;
force, stiffness and dU/dR are its exact derivatives.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, as_floats, plain
from nanotouch.contact import Branch, branch_index


class Pairs(NamedTuple):
    """What :meth:`Bank.evaluate` returns; each an array of the broadcast shape, or a float."""

    U: Any
    """energy [J]"""
    F: Any
    """force on the tip [N], + repulsive"""
    k: Any
    """stiffness [N/m]"""
    a: Any
    """contact radius [m]"""
    dU_dR: Any
    """slope of the energy with the radius, at constant indentation [J/m]"""


class Bank:
    """Tables over a range of lambda, made once (some ten milliseconds); may be shared by threads.

    Outside the range, within 1 % of lambda = 0.9379 and beyond the largest indentation the exact solver answers; the
    energy goes over into its smoothly.

    Parameters
    ----------
    lambda_range : tuple of float
        Range of Maugis' lambda that is tabulated.
    largest_indentation : float
        In Maugis' units, (pi^2 w^2 R/K^2)^(1/3).
    panels_per_octave, cells_per_octave : int
        1, 2, 4, .. 64: over lambda and over indentation. Each doubling of both divides the error by some ten.
    """

    def __init__(
        self,
        lambda_range: tuple[float, float] = (0.01, 100.0),
        largest_indentation: float = 100.0,
        *,
        panels_per_octave: int = 4,
        cells_per_octave: int = 4,
    ) -> None:
        self.core = _core.Bank(*lambda_range, largest_indentation, panels_per_octave, cells_per_octave)

    @property
    def force_error(self) -> float:
        """Measured error of the force, of the larger of it and the pull-off force."""
        return self.core.force_error

    def evaluate(
        self,
        indentation: ArrayLike,
        radius: ArrayLike,
        effective_modulus: ArrayLike,
        work_of_adhesion: ArrayLike,
        cohesive_stress: ArrayLike,
        branch: Branch = "stable",
    ) -> Pairs:
        """All contacts at their indentations; NaN where a contact is none or a branch does not exist.

        Parameters
        ----------
        indentation, radius : array_like
            [m], broadcast with the rest.
        effective_modulus, work_of_adhesion, cohesive_stress : array_like
            E* [Pa], w [J/m^2] (0 is Hertz), sigma0 [Pa].
        branch : str
            As in :mod:`nanotouch.contact`.
        """
        which = branch_index(branch)
        contacts, shape = _contacts(indentation, radius, effective_modulus, work_of_adhesion, cohesive_stress)
        depths = np.broadcast_to(as_floats(indentation, "indentation"), shape).reshape(-1)
        columns = self.core.eval(contacts, depths, which).reshape((5, *shape))
        return Pairs(*(plain(column) for column in columns))

    def grip_indentation(
        self,
        radius: ArrayLike,
        effective_modulus: ArrayLike,
        work_of_adhesion: ArrayLike,
        *,
        cohesive_stress: ArrayLike,
    ) -> Any:
        """Where the stable branch ends under grips [m]."""
        contacts, shape = _contacts(0.0, radius, effective_modulus, work_of_adhesion, cohesive_stress)
        return plain(np.broadcast_to(self.core.grip_indentation(contacts), int(np.prod(shape))).reshape(shape).copy())


def _contacts(
    indentation: ArrayLike,
    radius: ArrayLike,
    effective_modulus: ArrayLike,
    work_of_adhesion: ArrayLike,
    cohesive_stress: ArrayLike,
) -> tuple[Floats, tuple[int, ...]]:
    """Rows (R, E*, w, sigma0), a single one where all are scalars, and the broadcast shape."""
    columns = (
        as_floats(radius, "radius"),
        as_floats(effective_modulus, "effective_modulus"),
        as_floats(work_of_adhesion, "work_of_adhesion"),
        as_floats(cohesive_stress, "cohesive_stress"),
    )
    own = np.broadcast_shapes(*(column.shape for column in columns))
    shape = np.broadcast_shapes(own, as_floats(indentation, "indentation").shape)
    rows = own if np.prod(own) == 1 else shape
    return np.stack([np.broadcast_to(column, rows).reshape(-1) for column in columns], axis=-1), shape
