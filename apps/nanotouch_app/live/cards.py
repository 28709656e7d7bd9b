# SPDX-License-Identifier: BSD-3-Clause
"""The presets as cards: a title, what is felt, what to try. A click on one opens it."""

from __future__ import annotations

import textwrap

from nanotouch_app.common.scenes import ROWS as PRESETS
from nanotouch_app.common.scenes import felt
from nanotouch_app.live.look import SMALL, TITLE, Palette
from nanotouch_app.live.painter import Painter

Frame = tuple[float, float, float, float]
COLUMNS, GAP, HEAD = 2, 12.0, 44.0  # [pixels]
LETTER = 6.1  # width of one [pixels]


def boxes(frame: Frame) -> dict[str, Frame]:
    """Where each card lies."""
    x, y, width, height = frame
    rows = -(-len(PRESETS) // COLUMNS)
    across, up = (width - GAP * (COLUMNS + 1)) / COLUMNS, (height - HEAD - GAP * rows) / rows
    places = {}
    for number, name in enumerate(PRESETS):
        row, column = divmod(number, COLUMNS)
        places[name] = (x + GAP + column * (across + GAP), y + height - HEAD - (row + 1) * up - row * GAP, across, up)
    return places


def at(frame: Frame, x: float, y: float) -> str:
    """The preset whose card lies there, "" for none."""
    for name, (left, bottom, width, height) in boxes(frame).items():
        if left <= x <= left + width and bottom <= y <= bottom + height:
            return name
    return ""


def draw(painter: Painter, palette: Palette, frame: Frame, opened: str) -> None:
    """All cards; the one that is open with a coloured edge."""
    painter.box(frame, palette.panel, palette.accent)
    x, y, width, height = frame
    painter.text(x + GAP, y + height - 22, "What to touch", palette.ink, TITLE, bold=True)
    painter.text(x + width - GAP, y + height - 22, "click one; C: back", palette.quiet, SMALL, "right")
    for name, box in boxes(frame).items():
        preset = PRESETS[name]
        painter.box(box, palette.paper, palette.accent if preset["title"] == opened else palette.line)
        left, top = box[0] + 12, box[1] + box[3]
        letters = max(10, int((box[2] - 24) / LETTER))
        painter.text(left, top - 17, preset["title"], palette.ink, bold=True)
        lines = [(line, palette.accent) for line in textwrap.wrap(preset["hint"], letters)]
        lines += [(line, palette.quiet) for line in textwrap.wrap(felt(name), letters)]
        fits = int((box[3] - 44.0) / 16.0) + 1
        if len(lines) > fits:
            lines[fits - 1] = (f"{lines[fits - 1][0]} ...", lines[fits - 1][1])
        for number, (line, colour) in enumerate(lines[:fits]):
            painter.text(left, top - 38 - 16 * number, line, colour, SMALL)
