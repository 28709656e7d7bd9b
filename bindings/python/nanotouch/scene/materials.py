# SPDX-License-Identifier: BSD-3-Clause
"""Constants of common materials of tips and samples, and what follows for a pair of them.

The table, with its sources and how far they differ, is libnanotouch/core/materials.c. It is a start, for want of one's
own measurement: surface energies are of clean surfaces, moduli of crystals are of one direction.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from nanotouch import _core
from nanotouch.errors import InvalidValue


@dataclass(frozen=True)
class Material:
    """What a material is known by; NaN where the table has no value that could be vouched for."""

    name: str
    symbol: str
    youngs_modulus: float
    """E [Pa]"""
    poisson_ratio: float
    surface_energy: float
    """gamma [J/m^2]"""
    hamaker_constant: float
    """H of the material against itself across vacuum [J]"""
    yield_strength: float = math.nan
    """Y [Pa]"""


_TABLE = tuple(Material(*row) for row in _core.materials())


def names() -> tuple[str, ...]:
    """The names of all materials in the table."""
    return tuple(material.name for material in _TABLE)


def find(name: str) -> Material:
    """The material of a name ("silicon") or symbol ("Si")."""
    for material in _TABLE:
        if name and name in (material.name, material.symbol):
            return material
    raise InvalidValue(f"material {name!r}: known are {', '.join(names())}")


def hamaker_constant(tip: Material | str, sample: Material | str, medium: Material | str | None = None) -> float:
    """H [J] of two materials across a third, or vacuum: (sqrt(H1) - sqrt(H3)) (sqrt(H2) - sqrt(H3)); < 0: repulsion.

    An estimate; across water, where the static part counts, a poor one.
    """
    third = 0.0 if medium is None else _known(medium, "hamaker_constant")
    return _core.hamaker_combine(_known(tip, "hamaker_constant"), _known(sample, "hamaker_constant"), third)


def work_of_adhesion(tip: Material | str, sample: Material | str) -> float:
    """w = 2 sqrt(gamma1 gamma2) [J/m^2] of two clean surfaces."""
    return _core.work_of_adhesion(_known(tip, "surface_energy"), _known(sample, "surface_energy"))


def effective_modulus(tip: Material | str, sample: Material | str) -> float:
    """E* [Pa] of two materials: 1/E* = Sum (1 - nu^2)/E."""
    return _core.effective_modulus(
        _known(tip, "youngs_modulus"),
        _known(tip, "poisson_ratio"),
        _known(sample, "youngs_modulus"),
        _known(sample, "poisson_ratio"),
    )


def _known(material: Material | str, quantity: str) -> float:
    """One quantity of a material, which must be known."""
    entry = find(material) if isinstance(material, str) else material
    value: float = getattr(entry, quantity)
    if math.isnan(value):
        raise InvalidValue(f"the {quantity} of {entry.name} is not in the table; make a Material with your own")
    return value
