# SPDX-License-Identifier: BSD-3-Clause
"""Colours, sizes and words of the live view: two greys, one accent, two colours for forces, light and dark."""

from __future__ import annotations

import configparser
import math
import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from nanotouch_app.common.quantity import digits as digits

Colour = tuple[int, int, int]

WIDTH, HEIGHT = 1440, 900  # of the window [pixels]
EDGES = 16, 64  # of a desktop around a window [pixels]
LEAST = 640, 480  # [pixels]
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


# of properties: matplotlib's viridis and magma, whose lightness rises evenly; the same in light and dark
PROPERTY_COLOURS: dict[str, tuple[Colour, ...]] = {
    "youngs_modulus": ((68, 1, 84), (72, 40, 120), (62, 74, 137), (49, 104, 142), (38, 130, 142), (31, 158, 137),
                       (53, 183, 121), (109, 205, 89), (180, 222, 44), (253, 231, 37)),
    "work_of_adhesion": ((0, 0, 4), (28, 16, 68), (79, 18, 123), (129, 37, 129), (181, 54, 122), (229, 80, 100),
                         (251, 135, 97), (254, 194, 135), (252, 253, 191)),
}  # fmt: skip
PROPERTY_NAMES = {"youngs_modulus": ("modulus", "Pa"), "work_of_adhesion": ("work of adhesion", "J/m²")}


def fitting(screen_width: int, screen_height: int) -> tuple[int, int]:
    """The size of a window that is seen as a whole on a screen: as designed, or what the screen has without the edges
    and bars of a desktop. Screens that do not say their size get it as designed."""
    if min(screen_width, screen_height) <= 0:
        return WIDTH, HEIGHT
    width = WIDTH if screen_width >= WIDTH else screen_width - EDGES[0]
    height = HEIGHT if screen_height >= HEIGHT else screen_height - EDGES[1]
    return max(width, LEAST[0]), max(height, LEAST[1])


def is_still() -> bool:
    """Whether the desktop asks for reduced motion: GTK's settings, which GNOME, KDE and Xfce write."""
    home = Path(os.environ.get("XDG_CONFIG_HOME") or Path.home() / ".config")
    for name in ("gtk-4.0", "gtk-3.0"):
        settings = configparser.ConfigParser(interpolation=None, strict=False)
        with suppress(OSError, configparser.Error, UnicodeDecodeError):
            settings.read(home / name / "settings.ini", encoding="utf-8")
        if settings.get("Settings", "gtk-enable-animations", fallback="true").lower() in ("false", "0"):
            return True
    return False


def unit(colour: Colour) -> tuple[float, float, float]:
    """The colour as three numbers from 0 to 1."""
    return colour[0] / 255.0, colour[1] / 255.0, colour[2] / 255.0


def step_up(value: float) -> float:
    """The next of 1, 2, 5 times a power of ten that is not below a value above 0."""
    power = 10.0 ** math.floor(math.log10(value))
    return float(next(step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= value * (1.0 - 1e-9)))
