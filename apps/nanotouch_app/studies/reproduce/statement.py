# SPDX-License-Identifier: BSD-3-Clause
"""What a reproduced figure consists of: parameters with their source, columns, statements, and how it is drawn."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal, NamedTuple

import numpy as np
from nanotouch.plots import engineering
from numpy.typing import NDArray

Floats = NDArray[np.float64]
TOLERANCE = 0.1
"""of a formula that is said to hold"""
Verdict = Literal["holds", "does not hold", "cannot be compared"]


class Parameter(NamedTuple):
    """A number that a figure is computed with."""

    name: str
    value: float
    unit: str
    source: str
    """section of the paper, or why this value"""


@dataclass(frozen=True)
class Statement:
    """A statement of the paper and what became of it."""

    statement: str
    section: str
    verdict: Verdict
    quantity: str
    """what `number` is"""
    number: float
    unit: str
    """SI; empty for a ratio"""
    why: str

    def __str__(self) -> str:
        return (
            f"{self.verdict.upper()}: {self.statement} (Sec. {self.section})\n"
            f"  {self.quantity}: {quantity(self.number, self.unit)}. {self.why}"
        )


@dataclass(frozen=True)
class Reproduction:
    """One figure of the paper, computed."""

    number: int
    title: str
    parameters: tuple[Parameter, ...]
    columns: Mapping[str, Floats]
    """header with its unit -> values, all of one length"""
    statements: tuple[Statement, ...]
    draw: Callable[[Any], None]
    """fills an empty matplotlib figure"""

    def as_dict(self) -> dict[str, Any]:
        """JSON-able, without the columns."""
        return {
            "title": self.title,
            "parameters": [parameter._asdict() for parameter in self.parameters],
            "statements": [asdict(statement) for statement in self.statements],
        }


def quantity(value: float, unit: str) -> str:
    """Three digits with an SI prefix: ``quantity(1.8e-8, "N")`` is ``"18 nN"``."""
    if unit not in ("m", "N"):  # ratios and compound units are small numbers
        return f"{value:.3g} {unit}".rstrip()
    label, scale = engineering(unit, [value])
    return f"{value * scale:.3g} {label}"


def holds(condition: bool) -> Verdict:
    """The verdict on what could be compared."""
    return "holds" if condition else "does not hold"


def near(ratio: float) -> bool:
    """Whether a formula is right within TOLERANCE."""
    return abs(ratio - 1.0) <= TOLERANCE
