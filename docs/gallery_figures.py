# SPDX-License-Identifier: BSD-3-Clause
"""Pictures of the gallery that nanotouch draws: its figures are none of pyplot's, whose own sphinx-gallery finds."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests" / "python"))
import pictures


def drawn_figures(block: Any, variables: dict[str, Any], settings: dict[str, Any]) -> str:
    """Save what an example calls `figure`, once; called after each of its blocks, before the scraper of pyplot."""
    from matplotlib import pyplot
    from sphinx_gallery.scrapers import figure_rst

    own = [pyplot.figure(number) for number in pyplot.get_fignums()]
    figure = variables["example_globals"].get("figure")
    for drawn in (*own, *([figure] if hasattr(figure, "savefig") else [])):
        if unseen := pictures.hidden(drawn):
            raise ValueError(f"hidden by the limits of its axes: {', '.join(unseen)}")
    if not hasattr(figure, "savefig") or getattr(figure, "is_in_gallery", False):
        return ""
    figure.is_in_gallery = True
    if any(figure is one for one in own):
        return ""
    path = next(variables["image_path_iterator"])
    figure.savefig(path)
    return str(figure_rst([path], settings["src_dir"]))
