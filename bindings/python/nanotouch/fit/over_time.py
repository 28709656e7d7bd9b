# SPDX-License-Identifier: BSD-3-Clause
"""The models of a viscoelastic sample, which are fitted to a whole curve over time: one row for each kernel and tip."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple

from nanotouch.rheology import Rheology

from .models import Model, Parameter

Kernel = Literal["power_law", "standard_linear_solid", "prony"]
ARMS = 2  # of ting_prony

MODULUS = Parameter("effective_modulus", "Pa", 1e-3, 1e13)
_ARM = Parameter("arm_modulus", "Pa", 1e-3, 1e13)
_TIME = Parameter("relaxation_time", "s", 1e-7, 1e7)


class Row(NamedTuple):
    """A kernel: what is fitted, and in words."""

    kernel: Kernel
    arms: int
    own: tuple[Parameter, ...]
    """in the order of the C library"""
    title: str
    law: str


class TipRow(NamedTuple):
    """A tip: its shape's kind, and the words."""

    ending: str
    shape: Literal["paraboloid", "sphere", "cone", "punch"]
    sides: int | None
    exponent: float
    words: str
    scaling: str


def _numbered(parameter: Parameter, number: int) -> Parameter:
    return Parameter(f"{parameter.name}_{number}", parameter.unit, parameter.minimum, parameter.maximum)


_PRONY = tuple(_numbered(one, k + 1) for k in range(ARMS) for one in (_ARM, _TIME))
ROWS = {
    "ting_power": Row(
        "power_law", 0, (MODULUS, Parameter("exponent", "", 0.0, 0.85)), "power law",
        "E(t) = E_1 (t/1 s)^-beta: effective_modulus is E* at 1 s, exponent is beta",
    ),
    "ting_sls": Row(
        "standard_linear_solid", 1, (MODULUS, _ARM, _TIME), "standard linear solid",
        "E(t) = E_inf + E_1 exp(-t/tau): effective_modulus is E* at rest, arm_modulus E_1, relaxation_time tau",
    ),
    "ting_prony": Row(
        "prony", ARMS, (MODULUS, *_PRONY), "Prony series of two arms",
        "E(t) = E_inf + Sum E_k exp(-t/tau_k): effective_modulus is E* at rest",
    ),
}  # fmt: skip
_ROUND, _SHARP = "E* goes as 1/sqrt(R)", "E* goes as 1/tan(half angle)"
TIPS = (
    TipRow("", "paraboloid", None, 1.5, "a paraboloid (a/R up to 0.5), on a half-space or a layer", _ROUND),
    TipRow("_sphere", "sphere", None, 1.5, "a sphere on a half-space", "E* goes about as 1/sqrt(R)"),
    TipRow("_cone", "cone", 0, 2.0, "a cone on a half-space or a layer", _SHARP),
    TipRow("_pyramid", "cone", 4, 2.0, "a pyramid of four faces on a half-space", _SHARP),
    TipRow("_punch", "punch", None, 1.0, "a flat punch on a half-space", "E* goes as 1/R"),
)


def _model(name: str, row: Row, tip: TipRow) -> Model:
    return Model(
        name + tip.ending,
        parameters=row.own,
        title=f"Ting's law, {row.title}{' (' + tip.ending[1:] + ')' if tip.ending else ''}",
        valid=f"a linear viscoelastic sample without adhesion, small strains; {tip.words}",
        tip=tip.shape,
        sides=tip.sides,
        scaling=tip.scaling,
        law=row.law,
        exponent=tip.exponent,
        kernel=name,
    )


OVER_TIME = {model.name: model for name, row in ROWS.items() for tip in TIPS for model in [_model(name, row, tip)]}


def rheology_of(name: str, values: Mapping[str, float]) -> Rheology:
    """The kernel of a fitted model."""
    row = ROWS[OVER_TIME[name].kernel]
    modulus = values["effective_modulus"]
    factor = values["youngs_modulus"] / modulus if "youngs_modulus" in values else 1.0
    if row.kernel == "power_law":
        return Rheology.power_law(factor * modulus, values["exponent"])
    arms = [factor * value for key, value in values.items() if key.startswith("arm_modulus")]
    times = [value for key, value in values.items() if key.startswith("relaxation_time")]
    return Rheology(row.kernel, equilibrium_modulus=factor * modulus, arm_moduli=arms, relaxation_times=times)
