# SPDX-License-Identifier: BSD-3-Clause
"""How much a test draws. ``make test`` takes a sample, ``make heavy`` all of it: the same tests with
NANOTOUCH_ALL_DRAWS=1."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import TypeVar

ALL = bool(os.environ.get("NANOTOUCH_ALL_DRAWS"))
T = TypeVar("T")


def count(sample: int, full: int) -> int:
    """Draws of a loop."""
    return full if ALL else sample


def some(cases: Sequence[T], sample: int) -> Sequence[T]:
    """The first cases, or all."""
    return cases if ALL else cases[:sample]
