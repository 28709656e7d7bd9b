# SPDX-License-Identifier: BSD-3-Clause
"""Sliders of the C library (host.h), drawn.

A slider asks; it shows the new value when the session has taken it, and springs back when it was refused."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import nanotouch as nt
from nanotouch.touch import host

from nanotouch_app.live.look import SMALL, Palette
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.seen import Seen

Frame = tuple[float, float, float, float]
MOST, ROW, HEAD, INSET = 8, 52.0, 8.0, 14.0
WIDE, COLUMNS = 660.0, (3, 4)  # from this width on four to a row [pixels]


@dataclass
class Slider:
    """One field of one description, as C has it, with its value."""

    row: Any
    value: float

    @property
    def name(self) -> str:
        """Its title."""
        return str(self.row.title)


def offered(world: dict[str, Any]) -> list[Slider]:
    """The sliders that mean something in this world."""
    described = nt.Scene(**world["scene"]), nt.Rig(**world["rig"]), nt.Settings(**world["settings"])
    return [Slider(row, _value(world, row)) for row in host.sliders(*(one.core for one in described))]


def _value(world: dict[str, Any], row: Any) -> float:
    section, key = row.field.split(".")
    return float(world[row.what][section][key])


def columns_of(width: float) -> int:
    """How many lie side by side."""
    return COLUMNS[width >= WIDE]


def height_of(width: float, full: bool) -> float:
    """Of the panel of all, or of the first one [pixels]."""
    return 2.0 * HEAD + ROW * (-(-MOST // columns_of(width)) if full else 1) + 2.0


class Sliders:
    """Rows of sliders."""

    def __init__(self) -> None:
        self.sliders: list[Slider] = []
        self.held: Slider | None = None
        self.wish = 0.0
        self.hovered: Slider | None = None
        self.frame: Frame = (0.0, 0.0, 1.0, 1.0)
        self.full = False  # all of them, or the first one alone

    @property
    def shown(self) -> list[Slider]:
        """Those that are drawn."""
        return self.sliders if self.full else self.sliders[:1]

    def take(self, world: dict[str, Any]) -> None:
        """The values as they are now; the ends stay where they were."""
        if not self.sliders:
            self.sliders = offered(world)
        for slider in self.sliders:
            slider.value = _value(world, slider.row)

    def _box(self, number: int) -> Frame:
        x, y, width, height = self.frame
        columns = columns_of(width) if self.full else 1
        row, column = divmod(number, columns)
        across = width / columns
        return x + column * across + 0.5 * INSET, y + height - HEAD - (row + 1) * ROW, across - INSET, ROW

    def at(self, x: float, y: float) -> Slider | None:
        """The slider under a place of the window."""
        for number, slider in enumerate(self.shown):
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
            self.wish = self.held.row.at((x - left) / width)

    def drop(self) -> dict[str, Any] | None:
        """Let go: what is asked of the session."""
        slider, self.held = self.held, None
        if slider is None or self.wish == slider.value:
            return None
        return {"do": "change", "what": slider.row.what, "field": slider.row.field, "value": self.wish}

    def draw(self, painter: Painter, palette: Palette, seen: Seen) -> None:
        """Into the frame."""
        painter.box(self.frame, palette.panel, palette.line)
        for number, slider in enumerate(self.shown):
            left, bottom, width, _ = self._box(number)
            held = slider is self.held
            value = self.wish if held else slider.value
            track = bottom + 14
            knob = left + width * slider.row.place(value)
            waits = slider.row.field in seen.waiting
            words = ("… " if waits else "") + slider.row.told(value)
            room = width - painter.width_of(words, SMALL) - 4.0
            painter.text(left, bottom + 37, painter.fitted(slider.name, room, SMALL), palette.ink, SMALL)
            painter.text(left + width, bottom + 37, words, palette.accent if held or waits else palette.ink, SMALL,
                         "right")  # fmt: skip
            painter.line([[left, track], [left + width, track]], palette.line, 4.0)
            painter.line([[left, track], [knob, track]], palette.accent, 4.0)
            painter.dot(knob, track, 8.0 if held else 7.0, palette.hold if waits else palette.accent, palette.panel)
