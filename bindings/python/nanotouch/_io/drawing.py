# SPDX-License-Identifier: BSD-3-Clause
"""What all pictures share: colours, and figures of matplotlib's object interface (no global state, no display)."""

from __future__ import annotations

import functools
import io
import os
import warnings
from pathlib import Path
from typing import Any

from nanotouch._io.writing import replacing
from nanotouch.errors import require

StrPath = str | os.PathLike[str]

# Okabe and Ito's palette: told apart with any colour vision, and by lightness in print.
BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY = "#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7", "#56B4E9"


def new_figure(width: float, height: float) -> Any:
    """An empty ``matplotlib.figure.Figure`` of this size [inch]; a notebook shows it without a magic line."""
    return _shown(require("matplotlib.figure", "app").Figure)(figsize=(width, height), layout="constrained")


@functools.cache
def _shown(figure: Any) -> Any:
    return type("Figure", (figure,), {"_repr_png_": _as_png, "__reduce__": _reduced, "__module__": __name__})


def _as_png(figure: Any) -> bytes:
    with io.BytesIO() as file:
        figure.savefig(file, format="png", dpi=100)
        return file.getvalue()


def _reduced(figure: Any) -> Any:
    """Pickled by its state: the class is made when it is needed."""
    return _empty, (), figure.__getstate__()


def _empty() -> Any:
    made = _shown(require("matplotlib.figure", "app").Figure)
    return made.__new__(made)


def plain(text: str) -> str:
    """A user's text, in which dollar signs make no formula."""
    return text.replace("$", r"\$")


def saved(figure: Any, save: StrPath | None, dpi: int = 150) -> Any:
    """The figure, also written where a path is given, whole or not at all; its ending names the format."""
    if save is not None:
        with replacing(save) as part, warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Glyph", UserWarning)  # of a name that the font lacks: a box is drawn
            figure.savefig(part, format=Path(save).suffix.lstrip(".") or "png", dpi=dpi)
    return figure
