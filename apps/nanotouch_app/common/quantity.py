# SPDX-License-Identifier: BSD-3-Clause
"""Quantities on the command line: every length, force, ... carries its unit; and numbers that have none."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable

from nanotouch.errors import InvalidValue
from nanotouch.units import engineering, parse_quantity

__all__ = ["digits", "number", "parse_point", "parse_points", "parse_quantity", "whole_number"]


def number(minimum: float, maximum: float) -> Callable[[str], float]:
    """What reads the value of an option: a number without a unit, within this range."""

    def read(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not minimum <= value <= maximum:
            raise argparse.ArgumentTypeError(f"{text!r}: valid is a number, {minimum:g} .. {maximum:g}")
        return value

    return read


def whole_number(minimum: int, maximum: int, written: str = "") -> Callable[[str], int]:
    """The same for a whole number; ``written`` is how the maximum is told."""

    def read(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = minimum - 1
        if not minimum <= value <= maximum:
            raise argparse.ArgumentTypeError(f"{text!r}: valid is a whole number, {minimum} .. {written or maximum}")
        return value

    return read


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


def digits(value: float, unit_name: str, count: int = 3) -> str:
    """A number of three digits with its unit, "-" where it is not known; never wider because a digit has come."""
    if not math.isfinite(value):
        return "-"
    prefixed, factor = engineering(unit_name, [value]) if unit_name else ("", 1.0)
    scaled = value * factor
    if abs(scaled) < 1e-3:
        return f"0 {unit_name}".strip()
    decimals = max(0, count - 1 - math.floor(math.log10(abs(scaled))))
    return f"{scaled:.{min(decimals, count)}f} {prefixed}".strip()
