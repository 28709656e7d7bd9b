# SPDX-License-Identifier: BSD-3-Clause
"""Panels of the reproduced figures, in the manner of nanotouch.plots."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from nanotouch.plots import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION, new_figure, saved

#: colour and dashes of the curves, in order
LOOKS: tuple[tuple[str, Any], ...] = (
    (BLUE, "-"), (VERMILION, "--"), (GREEN, "-."), (PURPLE, ":"), (ORANGE, (0, (5, 1, 1, 1))), (SKY, (0, (8, 2))),
)  # fmt: skip
GREY = "0.4"


def save(draw: Callable[[Any], None], path: Path) -> None:
    """Draw on a new figure and write it, whole or not at all."""
    figure = new_figure(11.0, 5.0)
    draw(figure)
    saved(figure, path)


def dress(panel: Any, title: str, across: str, up: str, legend: str | None = "best") -> None:
    """Title, axes with quantity and unit, grid; a legend where one is wanted."""
    panel.set_title(title, loc="left", fontsize="medium")
    panel.set_xlabel(across)
    panel.set_ylabel(up)
    panel.grid(alpha=0.3)
    if legend:
        panel.legend(loc=legend, frameon=True, framealpha=0.85, edgecolor="none", fontsize="small")


def zero(panel: Any) -> None:
    """The line of no force."""
    panel.axhline(0.0, color=GREY, lw=0.8)
