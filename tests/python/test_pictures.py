# SPDX-License-Identifier: BSD-3-Clause
"""Every series of every figure that is saved lies within its axes (``conftest.py`` asks it of all that tests save)."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pictures
import pytest
from nanotouch.plots import new_figure, saved

pytest.importorskip("matplotlib")

ROOT = Path(__file__).resolve().parents[2]


def test_a_series_outside_of_the_axes_is_found(tmp_path: Path) -> None:
    """The fault that was there: limits of 8 to 250 around costs of 1.8 to 16."""
    figure = new_figure(3.0, 3.0)
    panel = figure.subplots()
    panel.semilogy([1, 2], [1.8, 2.4], "o", label="cheap")
    panel.semilogy([1, 2], [8.5, 16.0], "o", label="dear")
    assert pictures.hidden(figure) == []
    panel.set_ylim(8.0, 250.0)
    assert pictures.hidden(figure) == ["Line2D 'cheap' in ''"]
    with pytest.raises(AssertionError, match="cheap"):
        saved(figure, tmp_path / "hidden.png")


@pytest.mark.parametrize("kind", ["nothing", "nan", "scatter", "area", "mesh", "image", "bar"])
def test_what_is_hidden_of_any_kind(kind: str) -> None:
    figure = new_figure(3.0, 3.0)
    panel = figure.subplots()
    x = np.array([1.0, 2.0])
    match kind:
        case "nothing":
            panel.plot([], [])
        case "nan":
            panel.plot(x, [np.nan, np.nan])
        case "scatter":
            panel.scatter(x, x)
        case "area":
            panel.fill_between(x, x, 2.0 * x)
        case "mesh":
            panel.pcolormesh(x, x, np.ones((2, 2)))
        case "image":
            panel.imshow(np.ones((2, 2)), extent=(1.0, 2.0, 1.0, 2.0))
        case "bar":
            panel.bar(x, x)
    assert bool(pictures.hidden(figure)) == (kind in ("nothing", "nan"))
    panel.set(xlim=(10.0, 11.0), ylim=(10.0, 11.0))
    assert pictures.hidden(figure)


def test_a_line_that_only_crosses_is_seen() -> None:
    figure = new_figure(3.0, 3.0)
    panel = figure.subplots()
    panel.plot([-5.0, 5.0], [-5.0, 5.0])
    panel.axhline(0.5)
    panel.set(xlim=(0.0, 1.0), ylim=(0.0, 1.0))
    assert pictures.hidden(figure) == []


def test_every_figure_is_a_watched_one() -> None:
    """Whoever saves a figure makes it by ``new_figure``: no other is looked at. A film's frames and what a notebook
    shows are not saved."""
    own = {"_io/drawing.py", "workflow/film.py", "data/review_window.py"}
    for folder in ("apps", "bindings/python/nanotouch"):
        for file in sorted((ROOT / folder).rglob("*.py")):
            if "/".join(file.parts[-2:]) not in own:
                makes = re.search(r"Figure\(|from matplotlib\.figure|pyplot", file.read_text(encoding="utf-8"))
                assert not makes, file
