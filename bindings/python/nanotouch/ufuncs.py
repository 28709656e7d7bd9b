# SPDX-License-Identifier: BSD-3-Clause
"""Every law as a numpy ufunc: it broadcasts over all of its arguments and takes ``out=``, ``where=`` and ``dtype=``.

A ufunc goes wherever numpy's own do: xarray, dask and pandas hand their arrays to it. Arguments and results are SI and
float64. A value out of its range raises :class:`~nanotouch.errors.InvalidValue`; NaN in the argument gives NaN, and so
does a branch that does not exist there.

===================== ==============================================================================================
``hertz``             (indentation, radius, effective_modulus)
``dmt``, ``jkr``      (indentation, radius, effective_modulus, work_of_adhesion)
``maugis``            (indentation, radius, effective_modulus, work_of_adhesion, cohesive_stress)
``reduced``           (lam, d): Maugis-Dugdale in the units of :mod:`nanotouch.contact.reduced`
``vdw``, ``steric``.. (gap, ...): the laws of :mod:`nanotouch.forces`, with their parameters in the order given there
===================== ==============================================================================================

A name alone returns energy, force, stiffness and contact radius; ``_energy``, ``_force``, ``_stiffness`` or ``_radius``
after it return one of them. Contact laws take a branch (``_approach``, ``_unstable``; stable without) and a tier
(``_table``, ``_polished``; exact without) behind that: ``maugis_force_approach_table``. ``hertz_gradient``,
``dmt_gradient``, ``jkr_gradient``, ``maugis_gradient`` (and a branch) return the derivatives of the force by each of
their arguments.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np

from nanotouch import _core

VALUES = ("energy", "force", "stiffness", "radius")
_CONTACTS = ("hertz", "dmt", "jkr", "maugis", "reduced")
_BRANCHES = ("", "_approach", "_unstable")
_TIERS = ("_table", "_polished", "")
_FORCES = (
    "vdw",
    "vdw_derjaguin",
    "vdw_tip",
    "capillary",
    "electrostatic",
    "electrostatic_plate",
    "electrostatic_tip",
    "electrostatic_lever",
    "point_charge",
    "lennard_jones",
    "double_layer_potential",
    "double_layer_charge",
    "hydration",
    "steric",
    "steric_exponential",
)
_VALUE_NUMBERS = {"": -1} | {f"_{value}": number for number, value in enumerate(VALUES)}

#: (model, branch) of the derivatives of the force
_GRADIENTS: dict[str, tuple[int, int]] = {
    f"{law}_gradient{branch}": (model, number)
    for (model, law), (number, branch) in itertools.product(enumerate(_CONTACTS[:-1]), enumerate(_BRANCHES))
}
#: the numbers by which the C library knows a ufunc: (model, branch, tier, value), or (law, value)
_NAMES: dict[str, tuple[Any, ...]] = {
    f"{law}{value}{branch}{tier}": (model, _BRANCHES.index(branch), _TIERS.index(tier), number)
    for (model, law), (value, number), branch, tier in itertools.product(
        enumerate(_CONTACTS), _VALUE_NUMBERS.items(), _BRANCHES, _TIERS
    )
} | {f"{law}{value}": (law, number) for law, (value, number) in itertools.product(_FORCES, _VALUE_NUMBERS.items())}


def _is_of_use(name: str) -> bool:
    """Hertz and DMT have one branch and one tier, the unstable branch has no table, forces of a gap have no radius."""
    numbers = _NAMES[name]
    if len(numbers) == 2:
        return bool(numbers[1] != VALUES.index("radius"))
    model, branch, tier, _ = numbers
    is_exact, is_stable = _TIERS[tier] == "", _BRANCHES[branch] == ""
    if _CONTACTS[model] in ("hertz", "dmt"):
        return is_exact and is_stable
    return is_exact or _BRANCHES[branch] != "_unstable"


__all__ = ["VALUES", *filter(_is_of_use, _NAMES), *_GRADIENTS]


def __getattr__(name: str) -> np.ufunc:
    doc = f"See {__name__}."
    if name in _GRADIENTS:
        made = _core.gradient_ufunc(*_GRADIENTS[name], name, doc)
    elif name in _NAMES:
        *first, value = _NAMES[name]
        make: Any = _core.contact_ufunc if len(first) > 1 else getattr(_core, f"{first.pop()}_ufunc")
        made = make(*first, value, name, doc)
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = made  # also where pickle looks for it
    return made


def __dir__() -> list[str]:
    return sorted(__all__)


def contact_ufunc(model: str, value: str, branch: str, tier: str) -> np.ufunc:
    """The ufunc of a model; ``value`` is one of ``VALUES``, or "" for all four."""
    parts = (model, value, "" if branch == "stable" else branch, "" if tier == "exact" else tier)
    return _named("_".join(filter(None, parts)))


def gradient_ufunc(model: str, branch: str) -> np.ufunc:
    """The derivatives of the force of a model by its arguments."""
    return _named("_".join((model, "gradient", *([] if branch == "stable" else [branch]))))


def _named(name: str) -> np.ufunc:
    return globals().get(name) or __getattr__(name)
