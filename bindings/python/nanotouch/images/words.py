# SPDX-License-Identifier: BSD-3-Clause
"""Lengths of images in words: nanometres up to 1 µm, then µm, mm and m."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..units import engineering

_LEAST = 1e-9  # [m]: heights below it stay decimals of a nanometre, as the field writes them


def length(metres: float, digits: int = 4) -> str:
    """``length(3.495e-5)`` is ``"34.95 µm"``, ``length(1.36e-10)`` is ``"0.136 nm"``."""
    return lengths([metres], digits, "")


def lengths(metres: Iterable[float], digits: int = 4, between: str = " x ") -> str:
    """Several with one unit, that of the largest: ``lengths([0.03, 0.06])`` is ``"30 x 60 mm"``."""
    values = [float(f"{value:.{digits}g}") for value in metres]  # before the unit is chosen: 999.99 nm are 1 µm
    unit, factor = engineering("m", [_LEAST, *values])
    return between.join(f"{value * factor + 0.0:.{digits}g}" for value in values) + f" {unit}"


def prefixed(metres: Iterable[float]) -> tuple[str, float]:
    """Unit and factor of a column of lengths, by the largest."""
    return engineering("m", [_LEAST, *np.asarray(list(metres), dtype=float)])
