# SPDX-License-Identifier: BSD-3-Clause
"""Two charts: force against gap with the law behind it, and the force at the hand over the last ten seconds."""

from __future__ import annotations

import math

import numpy as np

from nanotouch_app.live.axes import Axes
from nanotouch_app.live.look import SMALL, Palette, digits, step_up
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.seen import HISTORY, Seen

Frame = tuple[float, float, float, float]
HELD = 3.0  # an axis becomes narrower no earlier than after this [s]


class Follower:
    """The end of an axis that follows in steps: at once outwards, late inwards, so that it never wobbles."""

    def __init__(self) -> None:
        self.end, self.since = 0.0, 0.0

    def of(self, wanted: float, now: float) -> float:
        """The end that holds a wanted size."""
        step = step_up(max(wanted, 1e-15))
        if step >= self.end:
            self.end, self.since = step, now
        elif step > 0.45 * self.end:
            self.since = now
        elif now - self.since > HELD:
            self.end, self.since = step, now
        return self.end


class ForceGap:
    """The law: stable branches solid, unstable ones dashed; the lever's line; the point that is now."""

    def __init__(self) -> None:
        self.up, self.down, self.out = Follower(), Follower(), Follower()

    def draw(self, painter: Painter, palette: Palette, frame: Frame, seen: Seen) -> None:
        """Into x, y, width, height."""
        painter.box(frame, palette.panel, palette.line)
        if seen.frame is None or not seen.world:
            return
        now = float(seen.frame["time"])
        pull = seen.plan.pull_off_force
        recent = [force for _, _, force in seen.tail] or [0.0]
        top = self.up.of(max(1.3 * pull, 1.15 * max(recent), 0.02 * seen.load), now)
        gap = 0.0 if seen.is_blind else float(seen.frame["gap"])
        reach = self.out.of(max(seen.reach, 1.1 * min(gap, 3.9 * seen.reach)), now)
        deep = np.interp(top, seen.curve.attached[::-1, 1], -seen.curve.attached[::-1, 0]) if len(
            seen.curve.attached) else 0.0  # fmt: skip
        inner = -max(0.25 * reach, 1.2 * min(float(deep), 1.5 * seen.depth), -1.1 * gap)
        low = -self.down.of(max(1.3 * pull, -1.15 * min(recent), 0.1 * top), now)
        axes = Axes(frame, (inner, reach), (low, top))
        axes.draw(painter, palette, ("gap", "force on the tip"), ("m", "N"))
        self._measured(painter, palette, axes, seen)
        self._law(painter, palette, axes, seen)
        if seen.is_blind:  # somewhere on this level
            painter.line(axes.at(axes.x, (seen.force, seen.force)), palette.repulsion, 1.5)
        else:
            self._lever(painter, palette, axes, seen)
            self._now(painter, palette, axes, seen)
        x, y = frame[0] + frame[2] - 14, frame[1] + frame[3] - 16
        words = f"pull-off {digits(pull, 'N')}" if pull > 1e-3 * seen.load else "nothing pulls"
        painter.text(x, y, words, palette.ink, SMALL, "right")
        left = frame[0] + 58
        names = ("approach", "retraction")
        if float(seen.world.get("slow", 1.0)) < 1.0:
            names = ("no force", "at once, and in the end (dashed)")
        for name, colour in zip(names, (palette.accent, palette.ink), strict=True):
            painter.text(left, frame[1] + 14, name, colour, SMALL)
            left += painter.width_of(name, SMALL) + 12

    @staticmethod
    def _law(painter: Painter, palette: Palette, axes: Axes, seen: Seen) -> None:
        painter.line(_mapped(axes, seen.curve.unstable), palette.quiet, 1.5, dashed=True)
        slow = float(seen.world.get("slow", 1.0))
        if slow < 1.0:  # a sample that relaxes: between the law at once and that in the end
            painter.line(_mapped(axes, seen.curve.attached * (1.0, slow)), palette.ink, 1.5, dashed=True)
        painter.line(_mapped(axes, seen.curve.attached), palette.ink, 2.0)
        painter.line(_mapped(axes, seen.curve.apart), palette.accent, 2.0)

    @staticmethod
    def _measured(painter: Painter, palette: Palette, axes: Axes, seen: Seen) -> None:
        """The curve that was fitted: its points, and the fit along them."""
        rows = np.array(seen.world.get("measured", ())).reshape(-1, 3)
        painter.line(_mapped(axes, rows[:, [0, 2]]), palette.quiet, 1.2)
        for gap, force, _ in rows[axes.holds(rows)]:
            x, y = axes.at(gap, force)
            painter.dot(float(x), float(y), 3.0, palette.quiet, palette.panel)

    @staticmethod
    def _lever(painter: Painter, palette: Palette, axes: Axes, seen: Seen) -> None:
        """F = K (h - h_proxy): the spring that holds the tip, through the point that is now."""
        spring = float(seen.world["stiffness"])
        gap, force = float(seen.frame["gap"]), float(seen.frame["tip_force"][2])
        ends = np.array([axes.x[0], axes.x[1]])
        line = np.stack([ends, force + spring * (ends - gap)], axis=1)
        if not (line[:, 1].max() > axes.y[0] and line[:, 1].min() < axes.y[1]):
            return
        low, high = sorted((gap + (axes.y[0] - force) / spring, gap + (axes.y[1] - force) / spring))
        ends = np.clip(ends, low, high)
        line = np.stack([ends, force + spring * (ends - gap)], axis=1)
        painter.line(axes.at(line[:, 0], line[:, 1]), palette.hold, 1.2)
        (x, y), (right, up) = (map(float, axes.at(*end)) for end in line)
        steep = (up - y) / max(right - x, 1e-9)
        aside = 4.0 if steep < 0.2 else 4.0 + 19.0 / steep  # above a flat line, beside a steep one
        painter.text(x + aside, y + 12, "spring", palette.hold, SMALL)

    @staticmethod
    def _now(painter: Painter, palette: Palette, axes: Axes, seen: Seen) -> None:
        colour = palette.repulsion if seen.force >= 0.0 else palette.attraction
        tail = np.array([(gap, force) for _, gap, force in seen.tail]).reshape(-1, 2)
        sides = np.flatnonzero(np.diff(tail[:, 1] >= 0.0)) + 1
        for part in np.split(np.arange(len(tail)), sides):
            rows = tail[part[0] : part[-1] + 2] if len(part) else tail[:0]  # up to the first of the other side
            pushed = len(rows) > 0 and rows[0, 1] >= 0.0
            painter.line(axes.at(rows[:, 0], rows[:, 1]), palette.repulsion if pushed else palette.attraction, 2.5)
        x, y = axes.at(float(seen.frame["gap"]), float(seen.frame["tip_force"][2]))
        painter.dot(float(x), float(y), 5.0, colour, palette.panel)


def _mapped(axes: Axes, rows: np.ndarray) -> np.ndarray:
    kept = axes.inside(rows)
    return axes.at(kept[:, 0], kept[:, 1])


def _alike(values: list[float]) -> list[float]:
    """Parts of a sum, each to the third digit of the largest; 0 without a sign."""
    largest = max(map(abs, values))
    decimals = 2 - math.floor(math.log10(largest)) if largest > 0.0 else 0
    return [round(value, decimals) + 0.0 for value in values]


def _energies(seen: Seen) -> str:
    """Where the work of the hand has gone in this touch; "" where the hand is not known."""
    if "energies" not in seen.clock:
        return ""
    hand, stored, tip, heat = seen.clock["energies"]
    if seen.dented is not None:  # what has yielded gives nothing back
        elastic = seen.dented.stored(float(seen.frame["contact_radius"]))
        tip, heat = elastic, heat + tip - elastic
    unit, factor = ("fJ", 1e15) if max(abs(hand), abs(stored)) > 1e-15 else ("aJ", 1e18)
    hand, stored, tip, heat = _alike([factor * value for value in (hand, stored, tip, heat)])
    told = [f"{name} {value:.3g}" for name, value in (("spring", stored), ("tip", tip), ("heat", heat))]
    about = "about " if seen.clock.get("missed") else ""  # ticks that were not drawn are bridged by straight lines
    return f"work of the hand {about}{hand:.3g} {unit} = {' + '.join(told)}".replace("-0 ", "0 ").replace("+ -", "- ")


TITLED, UNTITLED = 210.0, 130.0  # what the names of the axes take of the upper and the lower line [pixels]


class History:
    """The last ten seconds: least and largest force of each slice, so that no spike is lost."""

    def __init__(self) -> None:
        self.high, self.low = Follower(), Follower()

    def draw(self, painter: Painter, palette: Palette, frame: Frame, seen: Seen) -> None:
        """Into x, y, width, height."""
        painter.box(frame, palette.panel, palette.line)
        if not seen.slices or not seen.world:
            return
        scale = float(seen.world["settings"]["gains"]["alpha_f"])
        rows = np.array(seen.slices)
        now = float(rows[-1, 0])
        rows = rows[rows[:, 0] > now - HISTORY]
        most = max(float(rows[:, 2].max()), 0.05 * seen.load, 0.3 * seen.plan.pull_off_force)
        high = self.high.of(1.1 * most * scale, now)
        low = self.low.of(1.1 * max(-float(rows[:, 1].min()), 0.05 * high / scale) * scale, now)
        axes = Axes(frame, (-HISTORY, 0.0), (-low, high))
        axes.draw(painter, palette, ("time", "force at the hand"), ("s", "N"))
        self._balance(painter, palette, frame, _energies(seen))
        for sign, colour in ((1.0, palette.repulsion), (-1.0, palette.attraction)):
            least, largest = (np.clip(sign * rows[:, column], 0.0, None) * sign * scale for column in (1, 2))
            when = rows[:, 0] - now
            lower, upper = axes.at(when, np.minimum(least, largest)), axes.at(when, np.maximum(least, largest))
            zero = axes.at(when, np.zeros(len(rows)))[:, 1]
            painter.area(np.stack([lower[:, 0], zero, 0.5 * (lower[:, 1] + upper[:, 1])], axis=1), colour, 60)
            painter.area(np.stack([lower[:, 0], lower[:, 1] - 0.8, upper[:, 1] + 0.8], axis=1), colour)

    @staticmethod
    def _balance(painter: Painter, palette: Palette, frame: Frame, words: str) -> None:
        """Beside the upper title; below the chart where there is no room."""
        x, y, width, height = frame
        if painter.width_of(words, SMALL) <= width - TITLED:
            painter.text(x + width - 14, y + height - 16, words, palette.ink, SMALL, "right")
            return
        room = width - UNTITLED
        short = words if painter.width_of(words, SMALL) <= room else words.replace("work of the hand", "work")
        painter.text(x + 14, y + 14, painter.fitted(short, room, SMALL), palette.ink, SMALL)
