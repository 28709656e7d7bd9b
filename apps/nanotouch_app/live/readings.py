# SPDX-License-Identifier: BSD-3-Clause
"""What stands around the pictures: the line at the top, the bars of force, the status line, the help."""

from __future__ import annotations

import math
import time

from nanotouch.touch import host
from nanotouch.touch.columns import STATES
from nanotouch.touch.supervisor import REASONS

from nanotouch_app.live.look import SMALL, TITLE, Colour, Palette, digits
from nanotouch_app.live.painter import Painter
from nanotouch_app.live.seen import DOTS, Seen

Frame = tuple[float, float, float, float]
NOTED = 9.0  # a note stays for so long [s]
LONGEST = 300.0  # one of what is being done till the next [s]
AGE, HELP_HEAD, HELP_LINE = 190.0, 70.0, 25.0  # for the age of a frame; of the help [pixels]
LARGE = 20  # letters of what to do next [pixels]
TIP_STEP = 3.0  # forces at the tip are told apart from so many RMS noises of the lever on
HAND_STEPS = (0.06, 0.01)  # just noticeable difference of a force at the hand: this share, at least this [N]
HELP = (
    ("drag", "move the tip over the surface"),
    ("wheel, right drag", "down and up; shift: ten times finer"),
    ("space held", "press with a steady force; release lifts"),
    ("arrows, page up, down", "the same by steps"),
    ("R", "retract"),
    ("Escape, Enter", "emergency stop; go on after one"),
    ("P, .", "pause, one step of a millisecond"),
    ("[ ]", "slower, faster"),
    ("backspace", "rewind by 5 s"),
    ("Z, shift Z", "undo, redo a change"),
    ("1 .. 5, 0", "views; drag with control turns"),
    ("V, shift V", "magnify, back; or control and wheel"),
    ("D", "more: all sliders, charts and facts; less"),
    ("C, T", "other samples; tasks and the lesson"),
    ("F1 .. F7, N", "the choices of a task; type its number"),
    ("click on a number", "type it with its unit"),
    ("L, M", "light and dark; sound"),
    ("+ -", "draw heights higher, lower"),
    ("K", "colour by height, modulus, adhesion"),
    ("S", "save a picture"),
    ("H", "this help"),
    ("Q", "leave"),
)


def guide(painter: Painter, palette: Palette, frame: Frame, seen: Seen) -> None:
    """What to do next, in a sentence."""
    words = seen.world.get("hint", "") if seen.guide is None else seen.guide
    painter.text(frame[0] + 4, frame[1] + 0.5 * frame[3], painter.fitted(str(words), frame[2] - 8, LARGE), palette.ink,
                 LARGE, bold=True)  # fmt: skip


def top(painter: Painter, palette: Palette, frame: Frame, seen: Seen, full: bool) -> None:
    """Title at the left; clock and history at the right."""
    x, y, width, height = frame
    middle = y + 0.5 * height
    clock = seen.clock
    parts = [f"{clock['speed']:g}x"] if full or clock["speed"] != 1.0 else []
    if clock["slowdown"] > 1.05 and not clock["paused"]:
        parts.append(f"machine slow: {clock['slowdown']:.1f} times")
    if clock["paused"]:
        parts.insert(0, "PAUSED")
    if clock["recorded"] and seen.frame is not None:
        parts.insert(0, f"rec {int(seen.frame['time']) // 60:02d}:{int(seen.frame['time']) % 60:02d}")
    if seen.world.get("undo"):
        parts.append(f"Z: undo ({seen.world['undo']})")
    parts.append("H: help" if "source" in seen.world else f"C: samples   {'T: tasks   ' * full}H: help")
    parts.append("D: less" if full else "D: more")
    clocks, title = "   ".join(parts), str(seen.world.get("title", ""))
    painter.text(x + width - 4, middle, clocks, palette.ink, align="right")
    room = width - painter.width_of(clocks) - 24
    painter.text(x + 4, middle, painter.fitted(title, room, TITLE), palette.ink, TITLE, bold=True)
    start = 28 + painter.width_of(title, TITLE, bold=True)
    words = [seen.world.get("source", "simulated, wall pace"), seen.world.get("felt", "")] if full else []
    told = painter.fitted("  ·  ".join(filter(None, words)), room - start, SMALL)
    painter.text(x + start, middle, told, palette.quiet, SMALL)


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


def status(painter: Painter, palette: Palette, frame: Frame, seen: Seen, about: str, full: bool) -> None:
    """State and why; what touches; how accurate, how far from the limit, what is guaranteed."""
    x, y, width, height = frame
    painter.box(frame, palette.panel, palette.line)
    if seen.reading is None or not seen.world:
        painter.text(x + 12, y + 0.5 * height, "the session starts ...", palette.quiet)
        return
    state = int(seen.frame["state"])
    colour = (palette.good, palette.hold, palette.bad, palette.bad)[state]
    upper, room = y + height - 17, width - 44 - AGE
    words, tint = _lower(palette, seen, about)
    first, rest = _split(painter, words, width - 122, room)
    painter.dot(x + 18, upper, 6.0, colour)
    painter.text(x + 32, upper, STATES[state], colour, bold=True)
    if seen.stale:
        painter.text(x + 110, upper, f"no frame for {seen.age:.1f} s: nothing is felt", palette.bad)
    elif state:
        painter.text(x + 110, upper, _stopped(state, int(seen.frame["reasons"])), colour)
    elif first:
        painter.text(x + 110, upper, first, tint, SMALL)
    elif full:
        painter.text(x + 110, upper, painter.fitted(_facts(seen), width - 122), palette.ink)
    lower = y + 16
    skipped = f", {seen.missed} ticks not drawn" if seen.missed else ""
    age = f"frame {1e3 * min(seen.age, 9.999):.0f} ms old{skipped}"
    if full:
        painter.text(x + width - 12, lower, age, palette.quiet, SMALL, "right")
    left = rest if first and not (seen.stale or state) else words
    painter.text(x + 32, lower, painter.fitted(left, room, SMALL), tint, SMALL)


def _split(painter: Painter, words: str, upper: float, lower: float) -> tuple[str, str]:
    """What is too long for the lower line begins on the upper one; what goes there, and what remains."""
    if painter.width_of(words, SMALL) <= lower:
        return "", words
    parts = words.split(" ")
    most = next((n for n in range(len(parts), 0, -1) if painter.width_of(" ".join(parts[:n]), SMALL) <= upper), 1)
    return " ".join(parts[:most]), " ".join(parts[most:])


def _lower(palette: Palette, seen: Seen, about: str) -> tuple[str, Colour]:
    """The second line: the effect of a slider, or the last message."""
    if about:
        return about, palette.accent
    if seen.notes:
        at, words, is_bad = seen.notes[-1]
        age = time.monotonic() - at
        if words.endswith(DOTS) and 0.0 <= age < LONGEST:  # a caption of a film is from the future
            return f"{words} {age:.0f} s", palette.hold
        if age < NOTED:
            return words, palette.bad if is_bad else palette.hold
    return "", palette.quiet


def known(value: float | None) -> float:
    """JSON has no infinite number."""
    return math.inf if value is None else float(value)


def _facts(seen: Seen) -> str:
    world = seen.world
    bounds = (known(world["bound"]), known(world["margin"]), float(world["force"]), float(world.get("hand", 0.0)))
    return host.facts(seen.reading, *bounds)


def _stopped(state: int, bits: int) -> str:
    names = [words for number, words in enumerate(REASONS) if bits >> number & 1]
    waits = STATES[state] == "HOLD" and "loop unstable" not in names
    return f"{', '.join(names) or 'stopped'}. {'It goes on when that has ended' if waits else 'Enter: go on'}"


def help_panel(painter: Painter, palette: Palette, frame: Frame) -> None:
    """All keys."""
    painter.box(frame, palette.panel, palette.accent)
    x, y, _, height = frame
    pitch = (height - HELP_HEAD) / len(HELP)
    painter.text(x + 24, y + height - 28, "Mouse and keys", palette.ink, TITLE, bold=True)
    for number, (key, does) in enumerate(HELP):
        level = y + height - 62 - pitch * number
        painter.text(x + 24, level, key, palette.accent)
        painter.text(x + 210, level, does, palette.ink)
