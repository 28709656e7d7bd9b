# SPDX-License-Identifier: BSD-3-Clause
"""Quantities on the command line: every length, force, ... carries its unit."""

from __future__ import annotations

from nanotouch.errors import InvalidValue
from nanotouch.units import parse_quantity

__all__ = ["parse_point", "parse_points", "parse_quantity"]


def parse_points(text: str, count: int) -> list[tuple[float, float]]:
    """``"0um,2um,6um,2um"`` to ``count`` points (x, y) [m]."""
    parts = text.split(",")
    if len(parts) != 2 * count:
        example = "2.5um,3um" if count == 1 else "0um,2um,6um,2um"
        raise InvalidValue(f"{text!r} has {len(parts)} lengths instead of {2 * count}; write it like {example}")
    lengths = [parse_quantity(part, "m") for part in parts]
    return list(zip(lengths[0::2], lengths[1::2], strict=True))


def parse_point(text: str) -> tuple[float, float]:
    """``"2.5um,3um"`` to (x, y) [m]."""
    return parse_points(text, 1)[0]
