# SPDX-License-Identifier: BSD-3-Clause
"""The contact, magnified: a section through tip and sample as they are deformed, at one scale in both directions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from nanotouch.scene.view import Section
from numpy.typing import NDArray

from nanotouch_app.live.look import SMALL, Colour, Palette, digits, step_up
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.seen import Seen

Floats = NDArray[np.float64]
Frame = tuple[float, float, float, float]
POINTS = 120  # from the axis to the edge
HEADING = 30.0  # [pixels]


class Contact:
    """Zooms by factors of two, smoothly; in a panel and in the lens."""

    def __init__(self, shown: float = 3.0) -> None:
        self.shown = shown  # times the zone of action
        self.half_width = 0.0  # of what is shown [m]

    def draw(self, painter: Painter, palette: Palette, frame: Frame, seen: Seen, *, still: bool = False,
             round_: bool = False) -> tuple[View, Section] | None:  # fmt: skip
        """Into x, y, width, height, or the circle in it; where things lie. None: nothing is known."""
        if seen.frame is None or not seen.world or seen.is_blind:
            return None
        self._zoom(seen, frame, still)
        section = seen.section(np.linspace(0.0, 1.0, POINTS) ** 1.5 * self.half_width)
        if section is None:
            return None
        view = View(frame, self.half_width, round_)
        self._between(painter, palette, view, section, seen)
        self._bodies(painter, palette, view, section)
        return view, section

    def _zoom(self, seen: Seen, frame: Frame, still: bool) -> None:
        """The zone of action fills its part of the frame; the gap is seen, too."""
        gap = float(seen.frame["gap"])
        probe = seen.section(np.zeros(1))
        zone = max(probe.contact_radius, probe.cohesive_radius) if probe is not None else 0.0
        radius = float(seen.facts["radius"])
        least = 1.5 * math.sqrt(radius * max(seen.depth, 0.3e-9))
        wanted = max(self.shown * zone, 1.1 * frame[2] / frame[3] * max(gap, 0.0), least)
        target = least * 2.0 ** math.ceil(math.log2(wanted / least) - 0.2)
        if self.half_width == 0.0 or still:
            self.half_width = target
        self.half_width *= (target / self.half_width) ** 0.15

    @staticmethod
    def _bodies(painter: Painter, palette: Palette, view: View, section: Section) -> None:
        r, sample, tip, rigid = (
            np.concatenate([sign * rows[::-1], rows])
            for sign, rows in ((-1, section.r), (1, section.sample), (1, section.tip), (1, section.rigid_tip))
        )
        x = view.x(r)
        view.strip(painter, x, view.bottom, view.y(sample), palette.sample)
        view.strip(painter, x, view.y(tip), view.top, palette.tip)
        view.path(painter, x, view.y(sample), palette.ink)
        view.path(painter, x, view.y(tip), palette.ink)
        view.path(painter, x, np.full_like(x, view.y(0.0)), palette.quiet, 1.0, dashed=True)
        there = np.isfinite(tip) & np.isfinite(rigid)  # beyond the radius of a ball there is none
        if np.abs(tip[there] - rigid[there]).max(initial=0.0) * view.scale > 2.0:  # seen beside the deformed one
            view.path(painter, x, view.y(rigid), palette.panel, 1.0, dashed=True)

    @staticmethod
    def _between(painter: Painter, palette: Palette, view: View, section: Section, seen: Seen) -> None:
        """What is between the bodies, below them: water films and neck, the zone that pulls, brush or ions."""
        a, c = section.contact_radius, section.cohesive_radius
        brush = float(seen.world["scene"]["medium"]["brush_thickness"])
        if brush > 0.0:
            _haze(painter, palette, view, section, brush)
        if not c > a:
            return
        zone = (section.r >= a) & (section.r <= c)
        for sign in (-1.0, 1.0):
            x, low, high = view.x(sign * section.r[zone]), view.y(section.sample[zone]), view.y(section.tip[zone])
            if seen.meniscus:
                view.strip(painter, x, low, high, palette.water)
                if len(x):
                    _bow(painter, palette, view, (x[-1], low[-1], high[-1]), sign)
                continue
            for row in range(0, len(x), max(1, len(x) // 10)):
                view.path(painter, x[row] + np.array([0.0, 4.0 * sign]), np.array([low[row], high[row]]),
                          palette.attraction, 1.0)  # fmt: skip


class ContactPanel:
    """With a scale, and what the contact is like."""

    def __init__(self) -> None:
        self.contact = Contact()

    def draw(self, painter: Painter, palette: Palette, frame: Frame, seen: Seen) -> None:
        """Into x, y, width, height."""
        painter.box(frame, palette.panel, palette.line)
        x, y, width, height = frame
        drawn = self.contact.draw(painter, palette, (x + 1.0, y + 1.0, width - 2.0, height - HEADING - 1.0), seen)
        if drawn is not None:
            self._words(painter, palette, frame, drawn, seen)

    def _words(self, painter: Painter, palette: Palette, frame: Frame, drawn: tuple[View, Section], seen: Seen) -> None:
        view, section = drawn
        x, y, width, height = frame
        level = y + height - 16
        painter.text(x + 12, level, "The contact, magnified", palette.ink, bold=True)
        length = step_up(0.25 * self.contact.half_width)
        right = x + width - 16
        painter.scale(right - length * view.scale, right, level, palette.ink)
        painter.text(right - length * view.scale - 8, level, digits(length, "m", 1), palette.ink, SMALL, "right")
        a = section.contact_radius
        if a > 0.0:
            level = view.bottom + 34
            painter.scale(view.x(-a), view.x(a), level, palette.ink)
            painter.text(view.x(0.0), level - 14, f"2a = {digits(2 * a, 'm')}", palette.ink, SMALL, "centre")
        painter.text(x + 12, y + 12, _like(seen), palette.ink, SMALL)
        painter.text(x + width - 14, y + 12, state_of(section, seen), palette.ink, SMALL, "right")


def state_of(section: Section, seen: Seen) -> str:
    if section.contact_radius > 0.0:
        brush = float(seen.world["scene"]["medium"]["brush_thickness"]) > 0.0
        return "pressed, the brush between" if brush else "touching"
    if section.attached:
        return "held by its neck" if seen.meniscus else "held"
    return f"gap {digits(float(seen.frame['gap']), 'm')}"


class View:
    """Metres to pixels, the undeformed sample below the middle; of a frame, or of the circle in it."""

    def __init__(self, frame: Frame, half_width: float, round_: bool) -> None:
        x, y, width, height = frame
        self.half_width, self.scale = half_width, 0.5 * width / half_width
        self.bottom, self.top = y, y + height
        self.middle, self.radius = x + 0.5 * width, 0.5 * width if round_ else math.inf
        self.level = self.bottom + 0.42 * height

    def x(self, r: Any) -> Any:
        """Of a distance from the axis."""
        return self.middle + self.scale * r

    def y(self, z: Any) -> Any:
        """Of a height."""
        return self.level + self.scale * z

    def _within(self, x: Any) -> tuple[Any, Any]:
        """What of the frame is seen there, from below to above."""
        if math.isinf(self.radius):
            return np.full_like(x, self.bottom), np.full_like(x, self.top)
        half = np.sqrt(np.maximum(self.radius**2 - (x - self.middle) ** 2, 0.0))
        centre = 0.5 * (self.bottom + self.top)
        return centre - half, centre + half

    def strip(self, painter: Painter, x: Any, lower: Any, upper: Any, fill: Colour, opacity: int = 255) -> None:
        """A filled strip, as far as it is seen."""
        low, high = self._within(x)
        rows = [x, np.clip(lower + 0.0 * x, low, high), np.clip(upper + 0.0 * x, low, high)]
        painter.area(np.stack(rows, axis=1), fill, opacity)

    def path(self, painter: Painter, x: Any, y: Any, colour: Colour, width: float = 1.5, dashed: bool = False) -> None:
        """A line, as far as it is seen."""
        low, high = self._within(x)
        seen = (y >= low) & (y <= high)
        painter.line(np.stack([x[seen], y[seen]], axis=1), colour, width, dashed)


def _bow(painter: Painter, palette: Palette, view: View, row: tuple[float, float, float], sign: float) -> None:
    """The meniscus ends in an arc that is hollow to the outside: what is not water there is painted over."""
    end, low, high = row
    radius, middle = 0.5 * (high - low), 0.5 * (low + high)
    if radius < 2.0:
        return
    along = np.sin(np.linspace(0.0, 0.5 * np.pi, 12))
    reach = 0.97 * radius * np.sqrt(1.0 - along**2)
    view.strip(painter, end + sign - sign * radius * along, middle - reach, middle + reach, palette.panel)


def _haze(painter: Painter, palette: Palette, view: View, section: Section, thickness: float) -> None:
    """A brush: denser where it is pressed together."""
    x = view.x(np.concatenate([-section.r[::-1], section.r]))
    sample = np.concatenate([section.sample[::-1], section.sample])
    tip = np.concatenate([section.tip[::-1], section.tip])
    top = np.minimum(sample + thickness, tip)
    for share in np.linspace(0.1, 1.0, 10):
        view.strip(painter, x, view.y(sample), view.y(sample + share * (top - sample)), palette.water, 26)


def _like(seen: Seen) -> str:
    """Which law it is like: Maugis' lambda in words."""
    if seen.dented is not None:
        return seen.dented.words
    number = seen.plan.maugis_lambda
    if not math.isfinite(number) or seen.plan.pull_off_force < 1e-3 * seen.load:
        return "no adhesion: like Hertz"
    kind = "DMT" if number < 0.1 else "JKR" if number > 5.0 else "between DMT and JKR"
    return f"{'like ' if number < 0.1 or number > 5.0 else ''}{kind}, lambda {digits(number, '', 2)}"
