# SPDX-License-Identifier: BSD-3-Clause
"""What stands around the pictures: the line at the top, the bars of force, the status line, the help."""

from __future__ import annotations

import math
import time

from nanotouch.columns import STATES
from nanotouch.supervisor import REASONS

from nanotouch_app.live.look import SMALL, TITLE, Palette, digits
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.seen import Seen

Frame = tuple[float, float, float, float]
NOTED = 6.0  # a note stays for so long [s]
TIP_STEP = 3.0  # forces at the tip are told apart from so many RMS noises of the lever on
HAND_STEPS = (0.06, 0.01)  # just noticeable difference of a force at the hand: this share, at least this [N]
HELP = (
    ("drag", "move the tip over the surface"),
    ("wheel, right drag", "down and up; shift: ten times finer"),
    ("space held", "press with a steady force; release lifts"),
    ("arrows, page up, down", "the same by steps"),
    ("R", "retract"),
    ("Enter", "go on after a stop"),
    ("P, .", "pause, one step of a millisecond"),
    ("[ ]", "slower, faster"),
    ("backspace", "rewind by 5 s"),
    ("Z, shift Z", "undo, redo a change"),
    ("1 .. 5, 0", "views; drag with the middle button turns"),
    ("C", "other samples"),
    ("L", "light and dark"),
    ("S", "save a picture"),
    ("H", "this help"),
    ("Q", "leave"),
)


def top(painter: Painter, palette: Palette, frame: Frame, seen: Seen) -> None:
    """Title at the left; clock and history at the right."""
    x, y, width, height = frame
    middle = y + 0.5 * height
    painter.text(x + 4, middle, f"{seen.world.get('title', '')}", palette.ink, TITLE, bold=True)
    start = x + 28 + 1.1 * painter.width_of(str(seen.world.get("title", "")), TITLE)
    words = [seen.world.get("source", "simulated, wall pace"), seen.world.get("felt", "")]
    painter.text(start, middle, "  ·  ".join(filter(None, words)), palette.quiet, SMALL)
    clock = seen.clock
    parts = [f"{clock['speed']:g}x"]
    if clock["slowdown"] > 1.05 and not clock["paused"]:
        parts.append(f"machine slow: {clock['slowdown']:.1f} times")
    if clock["paused"]:
        parts.insert(0, "PAUSED")
    if clock["recorded"] and seen.frame is not None:
        parts.insert(0, f"rec {int(seen.frame['time']) // 60:02d}:{int(seen.frame['time']) % 60:02d}")
    if seen.world.get("undo"):
        parts.append(f"Z: undo ({seen.world['undo']})")
    parts.append("C: samples   H: help")
    painter.text(x + width - 4, middle, "   ".join(parts), palette.ink, align="right")


def bars(painter: Painter, palette: Palette, frame: Frame, seen: Seen) -> None:
    """Force at the tip and at the hand, signed, with ticks at what can just be told apart."""
    if seen.frame is None or not seen.world:
        return
    x, y, width, height = frame
    painter.box(frame, palette.panel, palette.line)
    probe = seen.world["rig"]["probe"]
    noise = probe["spring_constant"] * probe["sensitivity"] * probe["noise"] / 6.0
    scale = float(seen.world["settings"]["gains"]["alpha_f"])
    full = max(seen.load, 1.2 * seen.plan.pull_off_force)
    told = float(seen.reading["tip_force"][2]) if seen.reading is not None and not seen.stale else 0.0
    for number, (name, factor, step) in enumerate(
        (("at the tip", 1.0, TIP_STEP * noise), ("at the hand", scale, HAND_STEPS[1]))
    ):
        top_y = y + height - 20 - 58 * number
        painter.text(x + 12, top_y, name, palette.quiet, SMALL)
        shown = digits(told * factor, "N") if abs(told * factor) > 0.01 * step else "0 N"
        painter.text(x + width - 12, top_y, shown, palette.ink, align="right", bold=True)
        left, right, middle = x + 12, x + width - 12, x + 0.5 * width
        level = top_y - 20
        painter.line([[left, level], [right, level]], palette.line, 10.0)
        share = _squeezed(seen.force / full)
        colour = palette.repulsion if share >= 0.0 else palette.attraction
        painter.line([[middle, level], [middle + 0.5 * (right - left) * share, level]], colour, 10.0)
        painter.line([[middle, level - 8], [middle, level + 8]], palette.ink, 1.5)
        for sign in (-1.0, 1.0):
            at = middle + sign * 0.5 * (right - left) * _squeezed(min(step / factor / full, 1.0))
            painter.line([[at, level - 7], [at, level + 7]], palette.quiet, 1.0)


def _squeezed(share: float) -> float:
    """Small forces are seen beside large ones: the root."""
    return math.copysign(math.sqrt(min(abs(share), 1.0)), share)


def status(painter: Painter, palette: Palette, frame: Frame, seen: Seen, about: str = "") -> None:
    """State and why; what touches; how accurate, how far from the limit, what is guaranteed."""
    x, y, width, height = frame
    painter.box(frame, palette.panel, palette.line)
    if seen.reading is None or not seen.world:
        painter.text(x + 12, y + 0.5 * height, "the session starts ...", palette.quiet)
        return
    state = int(seen.frame["state"])
    colour = (palette.good, palette.hold, palette.bad, palette.bad)[state]
    upper = y + height - 17
    painter.dot(x + 18, upper, 6.0, colour)
    painter.text(x + 32, upper, STATES[state], colour, bold=True)
    if seen.stale:
        painter.text(x + 110, upper, f"no frame for {seen.age:.1f} s: nothing is felt", palette.bad)
    elif state:
        painter.text(x + 110, upper, f"{_reasons(int(seen.frame['reasons']))}. Enter: go on", colour)
    else:
        painter.text(x + 110, upper, _facts(seen), palette.ink)
    note = next((entry for entry in reversed(seen.notes) if time.monotonic() - entry[0] < NOTED), None)
    lower = y + 16
    if about:
        painter.text(x + 32, lower, about, palette.accent, SMALL)
    elif note is not None:
        painter.text(x + 32, lower, _cut(note[1]), palette.bad if note[2] else palette.hold, SMALL)
    else:
        painter.text(x + 32, lower, f"{seen.world.get('hint', '')}", palette.quiet, SMALL)
    painter.text(x + width - 12, lower, f"frame {1e3 * min(seen.age, 9.999):.0f} ms old, missed {seen.missed}",
                 palette.quiet, SMALL, "right")  # fmt: skip


def _facts(seen: Seen) -> str:
    radius = float(seen.reading["contact_radius"])
    gap = float(seen.reading["gap"])
    touch = f"contact of {digits(radius, 'm')} radius" if radius > 0.0 else (
        f"apart by {digits(gap, 'm')}" if gap > 0.0 else f"pressed in by {digits(-gap, 'm')}")  # fmt: skip
    bound = max(100.0 * float(seen.world["bound"]), 0.01)
    margin = float(seen.world["margin"])
    told = "no loop closes through this hand" if not math.isfinite(margin) else f"margin {margin:.3g}"
    return (
        f"{touch}  ·  within {bound:.2g} % (plan)  ·  {told}  ·  never above {digits(float(seen.world['force']), 'N')}"
    )


def _reasons(bits: int) -> str:
    names = [words for number, words in enumerate(REASONS) if bits >> number & 1]
    return ", ".join(names) or "stopped"


def _cut(words: str, most: int = 170) -> str:
    return words if len(words) <= most else words[: most - 4] + " ..."


def help_panel(painter: Painter, palette: Palette, frame: Frame) -> None:
    """All keys."""
    painter.box(frame, palette.panel, palette.accent)
    x, y, _, height = frame
    painter.text(x + 24, y + height - 28, "Mouse and keys", palette.ink, TITLE, bold=True)
    for number, (key, does) in enumerate(HELP):
        level = y + height - 62 - 25 * number
        painter.text(x + 24, level, key, palette.accent)
        painter.text(x + 210, level, does, palette.ink)
