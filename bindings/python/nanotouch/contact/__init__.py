# SPDX-License-Identifier: BSD-3-Clause
"""Contact mechanics: the force between an elastic tip and a half-space at a given indentation.

Models: ``"hertz"``, ``"dmt"``, ``"jkr"``, ``"maugis"`` (Maugis-Dugdale, every case between DMT and JKR). Adhesive
models have branches. ``"stable"`` is what retraction from contact meets under grips. ``"approach"`` is what approach
from far away meets. ``"unstable"`` is the equilibrium between the folds that no grip can hold (NaN where there is
none).

``tier`` trades accuracy for speed: ``"exact"`` (rounding), ``"polished"`` (rounding, away from the folds), ``"table"``
(error below 1.5e-6 of the larger of force and pull-off force, about 1 ns). Hertz, DMT and the unstable branch are exact
in every tier. Every law is a numpy ufunc as well: :mod:`nanotouch.ufuncs`.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, get_args

from numpy.typing import ArrayLike

from nanotouch import _core, ufuncs
from nanotouch._arrays import LawValue, as_floats, as_law, as_operand, check_between, law_over, plain, value_over
from nanotouch.errors import InvalidValue

Model = Literal["hertz", "dmt", "jkr", "maugis"]
Branch = Literal["stable", "approach", "unstable"]
MODELS: tuple[Model, ...] = get_args(Model)
BRANCHES: tuple[Branch, ...] = get_args(Branch)
Tier = Literal["table", "polished", "exact"]
TIERS: tuple[Tier, ...] = get_args(Tier)


@dataclass(frozen=True)
class Contact:
    """A sphere on a half-space.

    Parameters
    ----------
    radius : float
        R of the tip [m].
    effective_modulus : float
        E* [Pa], see :func:`effective_modulus`.
    work_of_adhesion : float
        w [J/m^2]; 0 makes every model Hertz.
    cohesive_stress : float, optional
        sigma0 of the Dugdale zone [Pa]; needed by ``"maugis"`` where w > 0.
    cohesive_range : float, optional
        h0 = w/sigma0 [m], instead of the cohesive stress.
    """

    radius: float
    effective_modulus: float
    work_of_adhesion: float = 0.0
    cohesive_stress: float | None = None
    cohesive_range: float | None = None

    def __post_init__(self) -> None:
        if self.cohesive_stress is not None and self.cohesive_range is not None:
            raise InvalidValue(
                "give cohesive_stress [Pa] or cohesive_range [m], not both: the range is w over cohesive stress"
            )
        if self.cohesive_range is not None:
            check_between("cohesive_range", self.cohesive_range, "m", above=0.0)
        self.law("jkr")  # the C library checks the values

    def law(self, model: Model, branch: Branch = "stable", tier: Tier = "exact") -> _core.ContactLaw:
        """The prepared law of a model: ``law.force(indentation)``, the quickest call for one number after another."""
        laws = self.__dict__.setdefault("_laws", {})
        law: _core.ContactLaw | None = laws.get((model, branch, tier))
        if law is None:
            if model not in MODELS:
                raise InvalidValue(f"model {model!r}: valid are {', '.join(MODELS)}")
            which, level = branch_index(branch), tier_index(tier)
            law = _core.ContactLaw(MODELS.index(model), *self._numbers(model), which, level)
            laws[model, branch, tier] = law
        return law

    def __getstate__(self) -> dict[str, Any]:
        """Prepared laws are made again where they are needed."""
        return {name: value for name, value in self.__dict__.items() if name != "_laws"}

    def _numbers(self, model: Model) -> tuple[float, float, float, float]:
        return self.radius, self.effective_modulus, self.work_of_adhesion, self._stress(model)

    def _operands(self, model: Model) -> tuple[float, ...]:
        """The parameters that the ufunc of a model takes."""
        return self._numbers(model)[: {"hertz": 2, "maugis": 4}.get(model, 3)]

    def _stress(self, model: Model) -> float:
        if self.cohesive_range is not None:
            return self.work_of_adhesion / self.cohesive_range
        if self.cohesive_stress is not None:
            return self.cohesive_stress
        if model == "maugis" and self.work_of_adhesion > 0.0:
            raise InvalidValue("the model 'maugis' needs cohesive_stress [Pa] or cohesive_range [m] of the adhesion")
        return 1.0  # read by no other model

    @property
    def maugis_lambda(self) -> float:
        """Maugis' transition parameter lambda (1.157 times Tabor's mu)."""
        return self.law("maugis").maugis_lambda


def branch_index(branch: Branch) -> int:
    """The number of a branch in the C library."""
    if branch not in BRANCHES:
        raise InvalidValue(f"branch {branch!r}: valid are {', '.join(BRANCHES)}")
    return BRANCHES.index(branch)


def tier_index(tier: Tier) -> int:
    """The number of a tier in the C library."""
    if tier not in TIERS:
        raise InvalidValue(f"tier {tier!r}: valid are {', '.join(TIERS)}")
    return TIERS.index(tier)


def evaluate(
    model: Model, indentation: ArrayLike, contact: Contact, branch: Branch = "stable", *, tier: Tier = "exact"
) -> LawValue:
    """Energy [J], force [N], stiffness [N/m] and contact radius [m] at an indentation [m], broadcast over arrays."""
    law = contact.law(model, branch, tier)
    if type(indentation) is float:
        return LawValue(*law.evaluate(indentation))
    operands = (as_operand(indentation, "indentation"), *contact._operands(model))
    return law_over(lambda value: ufuncs.contact_ufunc(model, value, branch, tier), operands)


def force(
    model: Model,
    indentation: ArrayLike,
    contact: Contact,
    branch: Branch = "stable",
    *,
    tier: Tier = "exact",
    out: Any = None,
    where: Any = True,
) -> Any:
    """Force on the tip [N] at an indentation [m], + repulsive.

    Parameters
    ----------
    model, branch, tier : str
        See the module.
    indentation : array_like
        [m]; arrays of xarray, dask or pandas come back as such.
    contact : Contact
        The tip and the sample.
    out : numpy.ndarray, optional
        Where to write the result.
    where : array_like of bool, optional
        Where to compute; elsewhere ``out`` stays as it is, or the result is NaN.
    """
    law = contact.law(model, branch, tier)
    if type(indentation) is float and out is None and where is True:
        return law.force(indentation)
    operands = (as_operand(indentation, "indentation"), *contact._operands(model))
    return value_over(ufuncs.contact_ufunc(model, "force", branch, tier), operands, out, where)


class Gradient(NamedTuple):
    """How the force changes with each of what it depends on; each an array of the input's shape, or a float."""

    indentation: Any
    """the stiffness [N/m]"""
    radius: Any
    """[N/m]"""
    effective_modulus: Any
    """[N/Pa]"""
    work_of_adhesion: Any
    """[N m^2/J]; 0 of Hertz"""
    cohesive_stress: Any
    """[N/Pa]; 0 of all but Maugis-Dugdale"""


def gradient(model: Model, indentation: ArrayLike, contact: Contact, branch: Branch = "stable") -> Gradient:
    """Derivatives of the force by the indentation and by each parameter of the contact, for fits and uncertainty.

    In closed form. At a fold, where the force has no slope, they are large and of no use; NaN where the branch does not
    exist. A ``cohesive_range`` h0 is w over the cohesive stress: with it given, w changes the stress, too.
    """
    contact.law(model, branch)  # checked
    columns = ufuncs.gradient_ufunc(model, branch)(as_operand(indentation, "indentation"), *contact._operands(model))
    nothing = (0.0 * columns[0],) * (len(Gradient._fields) - len(columns))
    return Gradient(*map(plain, (*columns, *nothing)))


def indentation(model: Model, force: ArrayLike, contact: Contact, branch: Branch = "stable") -> Any:
    """Indentation [m] at a force [N]; NaN where the branch does not reach it (below minus the pull-off force)."""
    return plain(contact.law(model, branch).indentation(as_floats(force, "force")))


def pull_off_force(model: Model, contact: Contact) -> float:
    """Pull-off force under load control, a positive magnitude [N]."""
    return contact.law(model).pull_off_force


def effective_modulus(
    tip_youngs_modulus: float, tip_poisson_ratio: float, sample_youngs_modulus: float, sample_poisson_ratio: float
) -> float:
    """E* [Pa] of two bodies: 1/E* = (1 - nu_t^2)/E_t + (1 - nu_s^2)/E_s. An infinite modulus is a rigid body."""
    check_between("tip_youngs_modulus", tip_youngs_modulus, "Pa", above=0.0)
    check_between("sample_youngs_modulus", sample_youngs_modulus, "Pa", above=0.0)
    check_between("tip_poisson_ratio", tip_poisson_ratio, "", above=-1.0, up_to=0.5)
    check_between("sample_poisson_ratio", sample_poisson_ratio, "", above=-1.0, up_to=0.5)
    return _core.effective_modulus(tip_youngs_modulus, tip_poisson_ratio, sample_youngs_modulus, sample_poisson_ratio)


def cohesive_stress_atomic(work_of_adhesion: float, equilibrium_distance: float) -> float:
    """sigma0 [Pa] of atoms against atoms: 16 w/(9 sqrt(3) z0) (the paper's 1.03 w/a0)."""
    check_between("equilibrium_distance", equilibrium_distance, "m", above=0.0)
    return _core.cohesive_stress_atomic(work_of_adhesion, equilibrium_distance)


def cone(indentation: ArrayLike, effective_modulus: float, half_angle: float) -> LawValue:
    """Sneddon's cone of half-angle psi [rad] at an indentation [m]: F = 2/pi E* tan(psi) delta^2."""
    check_between("effective_modulus", effective_modulus, "Pa", above=0.0)
    check_between("half_angle", half_angle, "rad", above=0.0, up_to=1.57)
    return as_law(_core.cone_eval(effective_modulus, half_angle, as_floats(indentation, "indentation")))


def punch(indentation: ArrayLike, effective_modulus: float, radius: float) -> LawValue:
    """Flat punch of a radius [m] at an indentation [m]: F = 2 E* a delta."""
    check_between("effective_modulus", effective_modulus, "Pa", above=0.0)
    check_between("radius", radius, "m", above=0.0)
    return as_law(_core.punch_eval(effective_modulus, radius, as_floats(indentation, "indentation")))


if TYPE_CHECKING:
    from nanotouch.contact import bank as bank
    from nanotouch.contact import reduced as reduced
else:

    def __getattr__(name: str) -> Any:
        if name in ("bank", "reduced"):
            return importlib.import_module(f"nanotouch.contact.{name}")
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
