# SPDX-License-Identifier: BSD-3-Clause
"""The lens: the contact, magnified, over the scene and beside the tip. It grows while something snaps or tears; then
its rim lights up, and one large number says how hard."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np

from nanotouch_app.live.contact import Contact, View, state_of
from nanotouch_app.live.look import SMALL, Palette, digits, step_up
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.seen import Seen

Frame = tuple[float, float, float, float]
LITTLE, LARGE = 0.17, 0.27  # its radius, of the view's shorter side; while something happens
SHOWN, GROWS, FLASH = 4.0, 0.18, 0.5  # an event; its lens; its light [s]
AWAY, LOW = 2.1, 0.55  # of its middle from the tip, in radii; from below, of the view
SIDES = 0.45, 0.62  # where the tip is when the lens changes its side, of the view
LETTERS = 34  # of the number [pixels]
DARK = (10, 11, 13)  # words on the sample, in light and dark


class Lens:
    """Of one picture."""

    def __init__(self, still: bool = False) -> None:
        self.still = still  # nothing shall move by itself
        self.contact, self.side = Contact(1.8), 1.0

    def draw(self, painter: Painter, palette: Palette, view: Frame, tip: Any, seen: Seen) -> None:
        """Beside the tip [pixels], within the view."""
        at, words, kind = seen.event
        age = time.monotonic() - at if words else math.inf
        grown = self._grown(age)
        radius = min(view[2], view[3]) * (LITTLE + (LARGE - LITTLE) * grown)
        x, y = middle = self._place(view, float(tip[0]), radius)
        self._leads(painter, palette, np.asarray(tip, dtype=float), np.array(middle), radius)
        painter.dot(x, y, radius, palette.panel)
        frame = (x - radius, y - radius, 2.0 * radius, 2.0 * radius)
        drawn = self.contact.draw(painter, palette, frame, seen, still=self.still, round_=True)
        if drawn is not None:
            self._words(painter, drawn, seen)
        if grown > 0.0:
            self._light(painter, palette, (tip, middle), radius, age)
        painter.ring(x, y, radius, palette.accent if grown > 0.0 else palette.quiet, 5.0 if grown > 0.0 else 2.0)
        if grown > 0.0:
            self._number(painter, palette, view, words, kind)

    def _grown(self, age: float) -> float:
        """0 before and long after an event, 1 while it is shown; at once where nothing shall move."""
        if not 0.0 <= age < SHOWN:
            return 0.0
        return 1.0 if self.still else min(age / GROWS, (SHOWN - age) / GROWS, 1.0)

    def _place(self, view: Frame, tip: float, radius: float) -> tuple[float, float]:
        """Beside the tip, on the side where there is room; not back and forth."""
        left, bottom, width, height = view
        if tip > left + SIDES[1] * width:
            self.side = -1.0
        elif tip < left + SIDES[0] * width:
            self.side = 1.0
        edge = radius + 8.0
        x = min(max(tip + self.side * AWAY * radius, left + edge), left + width - edge)
        return x, bottom + min(LOW * height, height - edge)

    @staticmethod
    def _leads(painter: Painter, palette: Palette, tip: Any, middle: Any, radius: float) -> None:
        away = tip - middle
        far = float(np.hypot(*away))
        if far <= radius:
            return
        turn, back = math.acos(radius / far), math.atan2(away[1], away[0])
        for sign in (-1.0, 1.0):
            end = middle + radius * np.array([math.cos(back + sign * turn), math.sin(back + sign * turn)])
            painter.line([tip, end], palette.quiet, 1.0)

    def _light(self, painter: Painter, palette: Palette, places: Any, radius: float, age: float) -> None:
        """Around tip and lens; where nothing shall move it stands still as long as the number."""
        strength = 0.5 if self.still else max(1.0 - age / FLASH, 0.0)
        for place, size in zip(places, (0.2 * radius, radius), strict=True):
            for part in range(1, 5):
                opacity = int(200.0 * strength * (1.0 - part / 5.0))
                painter.ring(float(place[0]), float(place[1]), size + 6.0 * part, palette.accent, 7.0, opacity)

    def _words(self, painter: Painter, drawn: Any, seen: Seen) -> None:
        view: View = drawn[0]
        section, radius = drawn[1], view.radius
        length = step_up(0.3 * self.contact.half_width)
        half = 0.5 * length * view.scale
        a = section.contact_radius
        words = f"{digits(2.0 * a, 'm')} wide" if a > 0.0 else state_of(section, seen)
        painter.text(view.middle, view.bottom + 0.5 * radius, words, DARK, SMALL, "centre", bold=True)
        painter.text(view.middle, view.bottom + 0.32 * radius, digits(length, "m", 1), DARK, SMALL, "centre")
        painter.scale(view.middle - half, view.middle + half, view.bottom + 0.2 * radius, DARK)

    @staticmethod
    def _number(painter: Painter, palette: Palette, view: Frame, words: str, kind: str) -> None:
        x, y, width, height = view
        room, middle, level = painter.width_of(words, LETTERS, bold=True) + 32, x + 0.5 * width, y + height - 56
        painter.box((middle - 0.5 * room, level - 0.8 * LETTERS, room, 2.15 * LETTERS), palette.panel, palette.line)
        painter.text(middle, level + 0.85 * LETTERS, kind, palette.quiet, align="centre")
        painter.text(middle, level, words, palette.accent, LETTERS, "centre", bold=True)
