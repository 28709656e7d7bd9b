# SPDX-License-Identifier: BSD-3-Clause
"""Contact sheets: a small picture of every fit, to be looked through."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .._io.drawing import VERMILION, new_figure, plain, saved
from ..units import engineering

ACROSS, DOWN = 5, 6
_WIDE, _HIGH = 3.0, 2.4  # of a picture with its labels [inch]
_LEFT, _RIGHT, _BELOW, _ABOVE = 0.5, 0.1, 0.35, 0.4  # for the labels [inch]
_NAME = 36  # characters that fit over a picture


def draw(
    pictures: Sequence[Mapping[str, Any]], folder: str | os.PathLike[str], name: str = "sheet", most: int = 20
) -> list[Path]:
    """Write ``name-01.png``, ... with 30 fits each; red are those whose status is not ok.

    Parameters
    ----------
    pictures : sequence
        ``Summary.pictures``.
    most : int
        Sheets; further fits are left out.
    """
    each = ACROSS * DOWN
    written = []
    for number in range(min(most, -(-len(pictures) // each))):
        path = Path(folder) / f"{name}-{number + 1:02d}.png"
        _sheet(pictures[number * each : (number + 1) * each], path)
        written.append(path)
    return written


def _sheet(pictures: Sequence[Mapping[str, Any]], path: Path) -> None:
    down = -(-len(pictures) // ACROSS)
    wide, high = _WIDE * ACROSS, _HIGH * down
    figure = new_figure(wide, high)
    figure.set_layout_engine(None)  # all pictures are alike; finding their margins took three quarters of the time
    panels = figure.subplots(down, ACROSS, squeeze=False).ravel()
    across, up = _WIDE - _LEFT - _RIGHT, _HIGH - _BELOW - _ABOVE
    figure.subplots_adjust(
        left=_LEFT / wide, right=1.0 - _RIGHT / wide, bottom=_BELOW / high, top=1.0 - _ABOVE / high,
        wspace=(_LEFT + _RIGHT) / across, hspace=(_BELOW + _ABOVE) / up,
    )  # fmt: skip
    for panel, picture in zip(panels, pictures, strict=False):
        _curve(panel, picture)
    for panel in panels[len(pictures) :]:
        panel.set_axis_off()
    saved(figure, path, dpi=100)


def _curve(panel: Any, picture: Mapping[str, Any]) -> None:
    z, force, fitted = (np.array(picture[key]) for key in ("z", "force", "fitted"))
    wide, scale_z = engineering("m", z - z.min())
    strong, scale_f = engineering("N", force)
    colour = "black" if picture["good"] else VERMILION
    panel.plot((z - z.min()) * scale_z, force * scale_f, ".", ms=2.5, color="0.55")
    panel.plot((z - z.min()) * scale_z, fitted * scale_f, lw=1.0, color=colour)
    panel.axhline(0.0, color="0.8", lw=0.6, zorder=0)
    text = picture["text"].replace("+-", "±")
    panel.set_title(f"{plain(_short(picture['name']))}\n{text}", fontsize=6.5, color=colour)
    panel.tick_params(labelsize=6, pad=2)
    panel.locator_params(nbins=4)
    panel.set_xlabel(wide, fontsize=6, labelpad=1)
    panel.set_ylabel(strong, fontsize=6, labelpad=1)


def _short(name: str) -> str:
    return name if len(name) <= _NAME else f"…{name[-_NAME + 1 :]}"
