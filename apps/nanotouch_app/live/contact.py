# SPDX-License-Identifier: BSD-3-Clause
"""The contact, magnified: a section through tip and sample as they are deformed, at one scale in both directions."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from nanotouch.scene.view import Section
from numpy.typing import NDArray

from nanotouch_app.live.look import SMALL, Palette, digits, step_up
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.seen import Seen

Floats = NDArray[np.float64]
Frame = tuple[float, float, float, float]
POINTS = 120  # from the axis to the edge
HEADING = 30.0  # [pixels]


class ContactPanel:
    """Zooms by factors of two, smoothly."""

    def __init__(self) -> None:
        self.half_width = 0.0  # of what is shown [m]

    def draw(self, painter: Painter, palette: Palette, frame: Frame, seen: Seen) -> None:
        """Into x, y, width, height."""
        painter.box(frame, palette.panel, palette.line)
        if seen.frame is None or not seen.world:
            return
        self._zoom(seen, frame)
        edge = np.linspace(0.0, 1.0, POINTS) ** 1.5 * self.half_width
        section = seen.section(edge)
        if section is None:
            return
        view = _View(frame, self.half_width)
        self._bodies(painter, palette, view, section)
        self._between(painter, palette, view, section, seen)
        self._words(painter, palette, view, section, seen)

    def _zoom(self, seen: Seen, frame: Frame) -> None:
        """The zone of action fills a third of the panel; the gap is seen, too."""
        gap = float(seen.frame["gap"])
        probe = seen.section(np.zeros(1))
        zone = max(probe.contact_radius, probe.cohesive_radius) if probe is not None else 0.0
        aspect = frame[2] / (frame[3] - HEADING)
        radius = float(seen.facts["radius"])
        least = 1.5 * math.sqrt(radius * max(seen.depth, 0.3e-9))
        wanted = max(3.0 * zone, 1.1 * aspect * max(gap, 0.0), least)
        target = least * 2.0 ** math.ceil(math.log2(wanted / least) - 0.2)
        if self.half_width == 0.0:
            self.half_width = target
        self.half_width *= (target / self.half_width) ** 0.15

    @staticmethod
    def _bodies(painter: Painter, palette: Palette, view: _View, section: Section) -> None:
        low, high = view.low, view.high
        sample = np.concatenate([section.sample[::-1], section.sample])
        r = np.concatenate([-section.r[::-1], section.r])
        tip = np.concatenate([section.tip[::-1], section.tip])
        x, ground = view.x(r), view.y(np.clip(sample, low, high))
        painter.area(np.stack([x, np.full_like(x, view.bottom), ground], axis=1), palette.sample)
        edge = view.y(np.clip(tip, low, high))
        painter.area(np.stack([x, edge, np.full_like(x, view.top)], axis=1), palette.tip)
        rigid = np.concatenate([section.rigid_tip[::-1], section.rigid_tip])
        shown = (rigid > low) & (rigid < high)
        painter.line(np.stack([x, ground], axis=1), palette.ink, 1.5)
        visible = tip < high
        painter.line(np.stack([x[visible], edge[visible]], axis=1), palette.ink, 1.5)
        flat = view.y(0.0)
        painter.line([[view.left, flat], [view.right, flat]], palette.quiet, 1.0, dashed=True)
        if np.abs(tip[shown] - rigid[shown]).max(initial=0.0) * view.scale > 2.0:  # seen beside the deformed one
            painter.line(np.stack([x[shown], view.y(rigid[shown])], axis=1), palette.panel, 1.0, dashed=True)

    @staticmethod
    def _between(painter: Painter, palette: Palette, view: _View, section: Section, seen: Seen) -> None:
        """What is between the bodies: water films and neck, the zone that pulls, brush or ions."""
        a, c = section.contact_radius, section.cohesive_radius
        brush = float(seen.world["scene"]["medium"]["brush_thickness"])
        if brush > 0.0:
            _haze(painter, palette, view, section, brush)
        if not c > a:
            return
        zone = (section.r >= a) & (section.r <= c)
        for sign in (-1.0, 1.0):
            x = view.x(sign * section.r[zone])
            rows = np.stack([x, view.y(np.clip(section.sample[zone], view.low, view.high)),
                             view.y(np.clip(section.tip[zone], view.low, view.high))], axis=1)  # fmt: skip
            if seen.meniscus:
                painter.area(rows, palette.water)
                if len(rows):
                    _bow(painter, palette, view, rows[-1], sign)
            else:
                for row in rows[:: max(1, len(rows) // 10)]:
                    painter.line([[row[0], row[1]], [row[0] + 4 * sign, row[2]]], palette.attraction, 1.0)

    @staticmethod
    def _words(painter: Painter, palette: Palette, view: _View, section: Section, seen: Seen) -> None:
        x, y, width, height = view.frame
        painter.text(x + 12, y + height - 16, "The contact, magnified", palette.ink, bold=True)
        length = step_up(0.25 * 2.0 * view.half_width / 2.0)
        pixels = length * view.scale
        right, level = x + width - 16, y + height - 16
        painter.line([[right - pixels, level], [right, level]], palette.ink, 2.0)
        for end in (right - pixels, right):
            painter.line([[end, level - 4], [end, level + 4]], palette.ink, 2.0)
        painter.text(right - pixels - 8, level, digits(length, "m", 1), palette.ink, SMALL, "right")
        a = section.contact_radius
        if a > 0.0:
            level = view.y(view.low) + 34
            for sign in (-1.0, 1.0):
                end = view.x(sign * a)
                painter.line([[end, level - 5], [end, level + 5]], palette.ink, 1.5)
            painter.line([[view.x(-a), level], [view.x(a), level]], palette.ink, 1.5)
            painter.text(view.x(0.0), level - 14, f"2a = {digits(2 * a, 'm')}", palette.ink, SMALL, "centre")
        painter.text(x + 12, y + 12, _like(seen), palette.ink, SMALL)
        painter.text(x + width - 14, y + 12, _state(section, seen), palette.ink, SMALL, "right")


def _state(section: Section, seen: Seen) -> str:
    if section.contact_radius > 0.0:
        brush = float(seen.world["scene"]["medium"]["brush_thickness"]) > 0.0
        return "pressed, the brush between" if brush else "touching"
    if section.attached:
        return "held by its neck" if seen.meniscus else "held"
    return f"gap {digits(float(seen.frame['gap']), 'm')}"


class _View:
    """Metres to pixels, the undeformed sample a third up."""

    def __init__(self, frame: Frame, half_width: float) -> None:
        x, y, width, height = frame
        self.frame, self.half_width = frame, half_width
        self.scale = 0.5 * (width - 2.0) / half_width
        self.left, self.right = x + 1.0, x + width - 1.0
        self.bottom, self.top = y + 1.0, y + height - HEADING
        self.middle = x + 0.5 * width
        self.level = self.bottom + 0.42 * (self.top - self.bottom)
        self.low = (self.bottom - self.level) / self.scale
        self.high = (self.top - self.level) / self.scale

    def x(self, r: Any) -> Any:
        """Of a distance from the axis."""
        return self.middle + self.scale * r

    def y(self, z: Any) -> Any:
        """Of a height."""
        return self.level + self.scale * z


def _bow(painter: Painter, palette: Palette, view: _View, row: Floats, sign: float) -> None:
    """The meniscus ends in an arc that is hollow to the outside: what is not water there is painted over."""
    end, low, high = (float(part) for part in row)
    radius, middle = 0.5 * (high - low), 0.5 * (low + high)
    if radius < 2.0:
        return
    along = np.sin(np.linspace(0.0, 0.5 * np.pi, 12))
    reach = 0.97 * radius * np.sqrt(1.0 - along**2)
    painter.area(np.stack([end + sign - sign * radius * along, middle - reach, middle + reach], axis=1), palette.panel)


def _haze(painter: Painter, palette: Palette, view: _View, section: Section, thickness: float) -> None:
    """Fur: denser where it is pressed together."""
    x = view.x(np.concatenate([-section.r[::-1], section.r]))
    sample = np.concatenate([section.sample[::-1], section.sample])
    tip = np.concatenate([section.tip[::-1], section.tip])
    top = np.minimum(sample + thickness, tip)
    for share in np.linspace(0.1, 1.0, 10):
        height = sample + share * (top - sample)
        rows = np.stack([x, view.y(np.clip(sample, view.low, view.high)), view.y(np.clip(height, view.low, view.high))],
                        axis=1)  # fmt: skip
        painter.area(rows, palette.water, 26)


def _like(seen: Seen) -> str:
    """Which law it is like: Maugis' lambda in words."""
    if seen.dented is not None:
        return seen.dented.words
    number = seen.plan.maugis_lambda
    if not math.isfinite(number) or seen.plan.pull_off_force < 1e-3 * seen.load:
        return "no adhesion: like Hertz"
    kind = "DMT" if number < 0.1 else "JKR" if number > 5.0 else "between DMT and JKR"
    return f"{'like ' if number < 0.1 or number > 5.0 else ''}{kind}, lambda {digits(number, '', 2)}"
