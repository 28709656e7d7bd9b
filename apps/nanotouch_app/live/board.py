# SPDX-License-Identifier: BSD-3-Clause
"""The board over the scene: a task with its words, how it stands, and its choices; or the list of all tasks."""

from __future__ import annotations

import textwrap
from typing import Any

from nanotouch.touch import host

from nanotouch_app.live.look import SMALL, TITLE, Palette
from nanotouch_app.live.painter import Painter

Frame = tuple[float, float, float, float]
WIDTH, LETTERS, LINE, BUTTON, PAD = 470.0, 66, 18.0, 28.0, 14.0  # [pixels]; letters of a line
TASKS = {task["name"]: task for task in host.tasks()}
PAGES = sum(task["is_page"] for task in TASKS.values())
MENU = {**{name: task["title"] for name, task in TASKS.items() if not task["is_page"]},
        "": "No task"}  # fmt: skip

KEYS = (*(f"F{number}" for number in range(1, 13)), "0")


def menu() -> dict[str, Any]:
    """The list of all tasks, as a task is told."""
    return {"title": "What to learn", "words": f"Tasks with a score, and a lesson of {PAGES} pages.", "now": "",
            "choices": list(MENU.values())}  # fmt: skip


def _lines(task: dict[str, Any]) -> list[tuple[str, str]]:
    """Lines with their kind: words, or how it stands."""
    rows = [(line, "words") for line in textwrap.wrap(task["words"], LETTERS)]
    rows += [(line, "now") for line in textwrap.wrap(task["now"], LETTERS)]
    if task.get("scored"):
        rows.insert(0, (f"{'passed' if task['passed'] else 'not passed'}, {task['score']:.0f} of 100", "score"))
    if task.get("saved"):
        rows.append((task["saved"].rsplit("/", 1)[-1], "words"))
    return rows


def size(task: dict[str, Any], typed: bool = False) -> float:
    """Height [pixels]."""
    return 2 * PAD + 24.0 + LINE * len(_lines(task)) + (BUTTON + 4.0) * len(task["choices"]) + (BUTTON + 4.0) * typed


def buttons(task: dict[str, Any], left: float, top: float) -> list[Frame]:
    """Where each choice lies, below the upper left corner of the board."""
    start = top - PAD - 24.0 - LINE * len(_lines(task))
    return [(left + PAD, start - (number + 1) * (BUTTON + 4.0), WIDTH - 2 * PAD, BUTTON)
            for number in range(len(task["choices"]))]  # fmt: skip


def at(task: dict[str, Any], left: float, top: float, place: Any) -> int | None:
    """The choice that lies at a place of the window."""
    for number, (x, y, width, height) in enumerate(buttons(task, left, top)):
        if x <= place[0] <= x + width and y <= place[1] <= y + height:
            return number
    return None


def draw(
    painter: Painter, palette: Palette, task: dict[str, Any], corner: tuple[float, float], typed: str = ""
) -> None:
    """With its upper left corner there."""
    left, top = corner
    height = size(task, bool(typed))
    painter.box((left, top - height, WIDTH, height), palette.panel, palette.accent)
    painter.text(left + PAD, top - PAD - 8.0, task["title"], palette.ink, TITLE, bold=True)
    colours = {"words": palette.ink, "now": palette.accent,
               "score": palette.good if task.get("passed") else palette.hold}  # fmt: skip
    for number, (line, kind) in enumerate(_lines(task)):
        painter.text(left + PAD, top - PAD - 32.0 - LINE * number, line, colours[kind], SMALL, bold=kind == "score")
    for number, (box, words) in enumerate(zip(buttons(task, left, top), task["choices"], strict=True)):
        painter.box(box, palette.paper, palette.line)
        painter.text(box[0] + 10, box[1] + 0.5 * BUTTON, KEYS[number], palette.quiet, SMALL)
        painter.text(box[0] + 44, box[1] + 0.5 * BUTTON, words, palette.ink)
    if typed:
        painter.text(left + PAD, top - height + PAD + 6.0, typed, palette.accent, bold=True)
