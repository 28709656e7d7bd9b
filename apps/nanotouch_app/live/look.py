# SPDX-License-Identifier: BSD-3-Clause
"""Colours, sizes and words of the live view: two greys, one accent, two colours for forces, light and dark."""

from __future__ import annotations

import math
from dataclasses import dataclass

from nanotouch.units import engineering

Colour = tuple[int, int, int]

WIDTH, HEIGHT = 1440, 900  # of the window [pixels]
TEXT, SMALL, TITLE = 14, 12, 16  # [pixels]


@dataclass(frozen=True)
class Palette:
    """One of the two looks."""

    paper: Colour
    panel: Colour
    ink: Colour
    quiet: Colour
    """text of less weight; at least 4.5 to 1 on the panel"""
    line: Colour
    accent: Colour
    attraction: Colour
    repulsion: Colour
    tip: Colour
    sample: Colour
    water: Colour
    good: Colour
    hold: Colour
    bad: Colour
    heights: tuple[Colour, ...]
    """from low to high; a map whose lightness rises evenly"""


LIGHT = Palette(
    paper=(236, 238, 241), panel=(252, 252, 253), ink=(28, 31, 36), quiet=(92, 98, 107), line=(205, 209, 215),
    accent=(0, 105, 148), attraction=(0, 110, 200), repulsion=(138, 20, 150), tip=(108, 118, 132),
    sample=(214, 190, 150), water=(110, 180, 225), good=(20, 120, 60), hold=(166, 92, 0), bad=(190, 20, 30),
    heights=((62, 38, 26), (112, 70, 36), (166, 116, 60), (212, 172, 112), (246, 230, 192)),
)  # fmt: skip
DARK = Palette(
    paper=(18, 20, 24), panel=(29, 32, 38), ink=(232, 235, 239), quiet=(160, 167, 177), line=(66, 72, 82),
    accent=(86, 190, 230), attraction=(90, 175, 255), repulsion=(224, 120, 235), tip=(150, 160, 175),
    sample=(150, 122, 82), water=(70, 135, 185), good=(90, 200, 130), hold=(240, 170, 60), bad=(255, 105, 100),
    heights=((46, 30, 22), (98, 62, 34), (152, 106, 56), (202, 162, 104), (240, 224, 186)),
)  # fmt: skip


def unit(colour: Colour) -> tuple[float, float, float]:
    """The colour as three numbers from 0 to 1."""
    return colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0


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


def step_up(value: float) -> float:
    """The next of 1, 2, 5 times a power of ten that is not below a value above 0."""
    power = 10.0 ** math.floor(math.log10(value))
    return float(next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= value * (1.0 - 1e-9)))
