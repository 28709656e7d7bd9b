# SPDX-License-Identifier: BSD-3-Clause
"""Sliders made from the field tables: name, unit, range and one sentence each; logarithmic over two decades and more.

A slider asks; it shows the new value when the session has taken it, and springs back when it was refused."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import nanotouch as nt

from nanotouch_app.live.look import SMALL, Palette, digits
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.seen import Seen

Frame = tuple[float, float, float, float]
KINDS: dict[str, Any] = {"scene": nt.Scene, "settings": nt.Settings, "rig": nt.Rig}
# what, field, name, and where the slider ends, as factors of the value that it begins with; 0: the field's own ends
OFFERED = (
    ("scene", "medium.relative_humidity", "humidity", 0.0, 0.95),
    ("scene", "sample.youngs_modulus", "sample modulus", 0.02, 20.0),
    ("scene", "adhesion.work_of_adhesion", "work of adhesion", 0.1, 4.0),
    ("scene", "adhesion.sample_surface_energy", "surface energy", 0.1, 4.0),
    ("scene", "tip.radius", "tip radius", 0.5, 4.0),
    ("rig", "probe.spring_constant", "spring constant", 0.1, 10.0),
    ("settings", "gains.coupling_stiffness", "hand's spring", 0.1, 4.0),
    ("settings", "gains.alpha_f", "force scaling", 0.1, 10.0),
    ("scene", "medium.ionic_strength", "salt", 0.05, 20.0),
    ("scene", "medium.brush_thickness", "fur", 0.3, 2.0),
)  # fmt: skip
# what is read of the adhesion, by adhesion.given
GIVEN = {
    "adhesion.work_of_adhesion": "work_of_adhesion",
    "adhesion.sample_surface_energy": "surface_energies",
    "adhesion.tip_surface_energy": "surface_energies",
}
MOST, ROW, HEAD, INSET = 8, 52.0, 8.0, 14.0
WIDE, COLUMNS = 660.0, (3, 4)  # from this width on four to a row [pixels]


@dataclass
class Slider:
    """One field of one description."""

    what: str
    field: str
    name: str
    low: float
    high: float
    value: float

    @property
    def logarithmic(self) -> bool:
        """Over two decades or more."""
        return self.low > 0.0 and self.high / self.low >= 99.0

    @property
    def place(self) -> float:
        """Of the value, 0 .. 1."""
        if self.logarithmic:
            share = math.log(max(self.value, self.low) / self.low) / math.log(self.high / self.low)
        else:
            share = (self.value - self.low) / (self.high - self.low)
        return min(max(share, 0.0), 1.0)

    def at(self, place: float) -> float:
        """The value at a place, rounded to three digits."""
        place = min(max(place, 0.0), 1.0)
        if self.logarithmic:
            value = self.low * (self.high / self.low) ** place
        else:
            value = self.low + place * (self.high - self.low)
        return float(f"{value:.3g}")

    def told(self, value: float) -> str:
        """The value in words, with its unit."""
        if self.field.endswith("humidity"):
            return f"{100.0 * value:.0f} %"
        if self.about.unit == "N/N":
            return f"{value / 1e9:.3g} billion" if value >= 1e9 else f"{value / 1e6:.3g} million"
        return digits(value, self.about.unit).replace("^2", "²").replace("^3", "³")

    @property
    def about(self) -> nt.scene.description.Field:
        """Unit, valid range and meaning."""
        field: nt.scene.description.Field = KINDS[self.what].fields[self.field]
        return field


def offered(world: dict[str, Any]) -> list[Slider]:
    """The sliders that mean something in this world: what is 0 and no humidity stays away."""
    made = []
    given = world["scene"]["adhesion"]["given"]
    for what, name, words, least, largest in OFFERED:
        section, key = name.split(".")
        value = float(world[what][section][key])
        field = KINDS[what].fields[name]
        if name == "medium.relative_humidity":
            if world["scene"]["medium"]["kind"] != "air" or world["scene"]["medium"]["surface_tension"] == 0.0:
                continue
            made.append(Slider(what, name, words, 0.0, largest, value))
        elif value > 0.0 and GIVEN.get(name, given) == given:
            low, high = max(least * value, field.minimum), min(largest * value, field.maximum)
            made.append(Slider(what, name, words, low, high, value))
    return made[:MOST]


def columns_of(width: float) -> int:
    """How many lie side by side."""
    return COLUMNS[width >= WIDE]


def height_of(width: float) -> float:
    """Of the panel of all [pixels]."""
    return 2.0 * HEAD + ROW * -(-MOST // columns_of(width)) + 2.0


class Sliders:
    """Rows of sliders."""

    def __init__(self) -> None:
        self.sliders: list[Slider] = []
        self.held: Slider | None = None
        self.wish = 0.0
        self.hovered: Slider | None = None
        self.frame: Frame = (0.0, 0.0, 1.0, 1.0)

    def take(self, world: dict[str, Any]) -> None:
        """The values as they are now; the ends stay where they were."""
        if not self.sliders:
            self.sliders = offered(world)
        for slider in self.sliders:
            section, key = slider.field.split(".")
            slider.value = float(world[slider.what][section][key])

    def _box(self, number: int) -> Frame:
        x, y, width, height = self.frame
        row, column = divmod(number, columns_of(width))
        across = width / columns_of(width)
        return x + column * across + 0.5 * INSET, y + height - HEAD - (row + 1) * ROW, across - INSET, ROW

    def at(self, x: float, y: float) -> Slider | None:
        """The slider under a place of the window."""
        for number, slider in enumerate(self.sliders):
            left, bottom, width, height = self._box(number)
            if left - 8 <= x <= left + width + 8 and bottom <= y <= bottom + height:
                return slider
        return None

    def value_at(self, x: float, y: float) -> Slider | None:
        """The slider whose number lies there: a click on it lets one be typed."""
        slider = self.at(x, y)
        if slider is None:
            return None
        left, bottom, width, _ = self._box(self.sliders.index(slider))
        return slider if x > left + 0.5 * width and y > bottom + 26 else None

    def drag(self, x: float) -> None:
        """The held slider's wish follows the pointer."""
        if self.held is not None:
            left, _, width, _ = self._box(self.sliders.index(self.held))
            self.wish = self.held.at((x - left) / width)

    def drop(self) -> dict[str, Any] | None:
        """Let go: what is asked of the session."""
        slider, self.held = self.held, None
        if slider is None or self.wish == slider.value:
            return None
        return {"do": "change", "what": slider.what, "field": slider.field, "value": self.wish}

    def draw(self, painter: Painter, palette: Palette, seen: Seen) -> None:
        """Into the frame."""
        painter.box(self.frame, palette.panel, palette.line)
        for number, slider in enumerate(self.sliders):
            left, bottom, width, _ = self._box(number)
            held = slider is self.held
            value = self.wish if held else slider.value
            shown = Slider(slider.what, slider.field, slider.name, slider.low, slider.high, value)
            track = bottom + 14
            knob = left + width * shown.place
            waits = slider.field in seen.waiting
            words = ("… " if waits else "") + slider.told(value)
            room = width - painter.width_of(words, SMALL) - 4.0
            painter.text(left, bottom + 37, painter.fitted(slider.name, room, SMALL), palette.ink, SMALL)
            painter.text(left + width, bottom + 37, words, palette.accent if held or waits else palette.ink, SMALL,
                         "right")  # fmt: skip
            painter.line([[left, track], [left + width, track]], palette.line, 4.0)
            painter.line([[left, track], [knob, track]], palette.accent, 4.0)
            painter.dot(knob, track, 8.0 if held else 7.0, palette.hold if waits else palette.accent, palette.panel)
