# SPDX-License-Identifier: BSD-3-Clause
"""What a plan is made of: the laws it chose, and what its bound does not cover."""

from __future__ import annotations

import math
from typing import NamedTuple

from nanotouch.units import in_words


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
