# SPDX-License-Identifier: BSD-3-Clause
"""What a plan is made of: the laws it chose, and what its bound does not cover."""

from __future__ import annotations

from typing import NamedTuple


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

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.text}: {self.value:.3g}{unit}, limit {self.limit:.3g}{unit}"
