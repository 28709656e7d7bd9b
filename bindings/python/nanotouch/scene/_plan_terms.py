# SPDX-License-Identifier: BSD-3-Clause
"""What a plan is made of: the laws that there are, those it chose, and what its bound does not cover."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from nanotouch import _core
from nanotouch.units import in_words


class Form(NamedTuple):
    """One way to compute a law."""

    name: str
    cost: float
    """of one evaluation in contact, in Hertz evaluations"""
    words: str
    latency: float
    """the same where each evaluation waits for the last"""


class Row(NamedTuple):
    """What the library says of one of its laws."""

    name: str
    title: str
    doc: str
    tail: str | None
    """the field of the scene that scales it, where what it pulls in contact is a part of the work of adhesion"""
    forms: tuple[Form, ...]
    has_pressure: bool


class Pressure(NamedTuple):
    """Two flats under a law."""

    energy: Any
    """0 at infinite gap [J/m^2]"""
    pressure: Any
    """+ repulsive [Pa]"""
    slope: Any
    """of the pressure over the gap [Pa/m]"""


#: every law, contact first, in the order of a plan's terms
ROWS = tuple(Row(*row[:4], tuple(Form(*form) for form in row[4]), row[5]) for row in _core.term_rows())


class Term(NamedTuple):
    """One law of a plan."""

    name: str
    form: str
    """how it is computed: ``"table"``, ``"sphere"``, ...; ``"off"``"""
    force: float
    """the largest it is in the range of the scene, for contact the largest load [N]"""
    bound: float
    """of what this form errs by, over max(\\|quantity\\|, scale)"""
    cost: float
    """of one evaluation, in Hertz evaluations"""
    title: str
    """what it is called in sentences: ``"van der Waals"``"""
    words: str
    """how it is computed, in words"""
    latency: float
    """as the cost, where each evaluation waits for the last"""

    @property
    def included(self) -> bool:
        """Whether it is computed."""
        return self.form != "off"


class Warning(NamedTuple):
    """Something that the bound does not cover."""

    text: str
    unit: str
    value: float
    limit: float
    """NaN where it is not a matter of size"""

    def __str__(self) -> str:
        value, limit = (in_words(number, self.unit, 3) for number in (self.value, self.limit))
        return f"{self.text}: {value}" + ("" if math.isnan(self.limit) else f", limit {limit}")
