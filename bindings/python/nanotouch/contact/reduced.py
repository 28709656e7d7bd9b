# SPDX-License-Identifier: BSD-3-Clause
"""Maugis-Dugdale contact in Maugis' units: one parameter, ``lam``, from DMT (0) to JKR (infinity).

Loads are counted in pi w R, radii in (pi w R^2/K)^(1/3), indentations in (pi^2 w^2 R/K^2)^(1/3), with K = 4/3 E*;
stiffness and energy in the units that follow. ``lam`` is Maugis' lambda (1.157 times Tabor's mu), 1e-15 .. 1e15.

Every function broadcasts its arguments; scalars give floats. NaN gives NaN, and so does a branch that does not exist
there.

``branch="stable"`` is what retraction from contact meets under grips: the contact branch while it is stable, then the
attracted non-contact branch down to its fold, then zero. ``"approach"`` is what approach from far away meets,
``"unstable"`` the equilibrium that no grip holds.

``tier`` trades accuracy for speed: ``"table"`` (error below 1.5e-6 of the larger of force and pull-off force, about 1
ns), ``"polished"`` (rounding, away from the folds), ``"exact"`` (rounding). No tier is ever worse than that, and none
depends on how many points there are. A table is made for each ``lam`` (some 30 us): it pays from some hundred points
on. The exact solver takes each point's own ``lam`` (0.1 us), whatever their order. Where no table exists (the unstable
branch, given loads and radii, folds), it answers in every tier.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nanotouch import _core, ufuncs
from nanotouch._arrays import Floats, as_floats, as_operand, is_foreign, plain, value_over
from nanotouch.contact import TIERS as TIERS
from nanotouch.contact import Branch, Tier, branch_index, tier_index
from nanotouch.errors import InvalidValue


class State(NamedTuple):
    """One equilibrium, or an array of them; reduced."""

    indentation: Any
    energy: Any
    load: Any
    stiffness: Any
    radius: Any


class Folds(NamedTuple):
    """Where the branches end or turn; reduced."""

    pull_off_load: Any
    """lowest load: where a dead weight falls off"""
    pull_off_radius: Any
    pull_off_indentation: Any
    grip_kind: Any
    """``"contact"`` or ``"non-contact"``: the branch on which grips let go"""
    grip_indentation: Any
    grip_load: Any
    zero_load_radius: Any
    zero_load_indentation: Any


class _Arguments:
    """Two arguments broadcast against each other, flat, with equal lambdas side by side where that is of use."""

    def __init__(self, lam: ArrayLike, other: ArrayLike, name: str, *, sort: bool = True) -> None:
        lambdas, values = as_lambda(lam), as_floats(other, name)
        self.shape = np.broadcast_shapes(lambdas.shape, values.shape)
        self.order: NDArray[np.intp] | None = None
        if lambdas.size == 1:
            self.lam, self.values = lambdas.reshape(1), values.reshape(-1)
            return
        lam_flat = np.broadcast_to(lambdas, self.shape).reshape(-1)
        if not sort:
            self.lam, self.values = lam_flat, np.broadcast_to(values, self.shape).reshape(-1)
            return
        self.order = np.argsort(lam_flat, kind="stable")
        self.lam = lam_flat[self.order]
        self.values = np.broadcast_to(values, self.shape).reshape(-1)[self.order]

    def back(self, column: Floats) -> Any:
        """A result in the order and shape of the arguments."""
        if self.order is not None:
            restored = np.empty_like(column)
            restored[self.order] = column
            column = restored
        return plain(column.reshape(self.shape))


def as_lambda(lam: ArrayLike) -> Floats:
    """Checked values of lambda; NaN passes."""
    lambdas = as_floats(lam, "lam")
    wrong = lambdas[(lambdas < _core.lambda_min) | (lambdas > _core.lambda_max)]
    if wrong.size:
        raise InvalidValue(f"lam = {wrong.flat[0]:g}: valid is {_core.lambda_min:g} .. {_core.lambda_max:g}")
    return lambdas


def _ufunc(value: str, branch: Branch, tier: Tier) -> np.ufunc:
    branch_index(branch)  # checked
    tier_index(tier)
    return ufuncs.contact_ufunc("reduced", value, branch, tier)


def force(
    lam: ArrayLike, d: ArrayLike, branch: Branch = "stable", *, tier: Tier = "exact", out: Any = None, where: Any = True
) -> Any:
    """Load P at an indentation.

    Parameters
    ----------
    lam, d : array_like
        Maugis' lambda; reduced indentation. Arrays of xarray, dask or pandas come back as such.
    branch, tier : str
        See the module.
    out : numpy.ndarray, optional
        Where to write the result.
    where : array_like of bool, optional
        Where to compute; elsewhere ``out`` stays as it is, or the result is NaN.

    Returns
    -------
    float or numpy.ndarray
        Reduced load, + repulsive.
    """
    ufunc = _ufunc("force", branch, tier)
    operands = as_operand(lam, "lam"), as_operand(d, "d")
    is_plain = out is None and where is True and not any(map(is_foreign, operands))
    if tier == "exact" or not is_plain or np.size(lam) == 1:
        return value_over(ufunc, operands, out, where)
    given = _Arguments(lam, d, "d")
    return given.back(ufunc(given.lam, given.values))


def evaluate(lam: ArrayLike, d: ArrayLike, branch: Branch = "stable", *, tier: Tier = "exact") -> State:
    """Energy, load, stiffness and radius at an indentation."""
    ufunc = _ufunc("", branch, tier)
    given = _Arguments(lam, d, "d", sort=tier != "exact")
    energy, load, stiffness_, radius_ = (given.back(column) for column in ufunc(given.lam, given.values))
    indentation_ = plain(np.broadcast_to(as_floats(d, "d"), given.shape).copy())
    return State(indentation_, energy, load, stiffness_, radius_)


def radius(lam: ArrayLike, d: ArrayLike, branch: Branch = "stable", *, tier: Tier = "exact") -> Any:
    """Contact radius at an indentation; 0 where the surfaces do not touch."""
    return evaluate(lam, d, branch, tier=tier).radius


def stiffness(lam: ArrayLike, d: ArrayLike, branch: Branch = "stable", *, tier: Tier = "exact") -> Any:
    """dP/dd at an indentation."""
    return evaluate(lam, d, branch, tier=tier).stiffness


def at_load(lam: ArrayLike, P: ArrayLike, branch: Branch = "stable", *, tier: Tier = "exact") -> State:
    """The equilibrium at a load; ``"stable"`` is the branch above the load fold, ``"unstable"`` the one below it."""
    tier_index(tier)
    given = _Arguments(lam, P, "P")
    return State(
        *(given.back(column) for column in _core.reduced_at_load(given.lam, given.values, branch_index(branch)))
    )


def indentation(lam: ArrayLike, P: ArrayLike, branch: Branch = "stable", *, tier: Tier = "exact") -> Any:
    """Indentation d at a load; NaN below the pull-off load."""
    return at_load(lam, P, branch, tier=tier).indentation


def at_radius(lam: ArrayLike, a: ArrayLike, *, tier: Tier = "exact") -> State:
    """The equilibrium at a contact radius >= 0: each occurs once on the contact branch."""
    tier_index(tier)
    given = _Arguments(lam, a, "a")
    return State(*(given.back(column) for column in _core.reduced_at_radius(given.lam, given.values)))


def folds(lam: ArrayLike, *, tier: Tier = "exact") -> Folds:
    """Folds and the point of zero load."""
    tier_index(tier)
    lambdas = as_lambda(lam)
    columns = np.moveaxis(_core.reduced_folds(lambdas.reshape(-1)), -1, 0).reshape((8, *lambdas.shape))
    kinds = np.where(columns[3] == 1.0, "contact", np.where(columns[3] == 0.0, "non-contact", ""))
    values = [plain(column.copy()) for column in columns]
    values[3] = kinds if kinds.ndim else str(kinds)
    return Folds(*values)
