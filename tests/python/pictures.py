# SPDX-License-Identifier: BSD-3-Clause
"""Whether all that a figure plots can be seen. ``conftest.py`` asks this of every figure that a test saves."""

from __future__ import annotations

from typing import Any

import numpy as np

EDGE = 0.5
"""a point that lies on the frame is seen [pixels]"""


def hidden(figure: Any, drawn: bool = False) -> list[str]:
    """The series, areas and images of which nothing lies within the limits of their axes, in words. What has been
    drawn since its last change has its limits and its layout."""
    if not drawn:
        figure.draw_without_rendering()
    found = []
    for panel in figure.axes:
        if not panel.get_visible() or panel.get_label() == "<colorbar>":
            continue
        title = panel.get_title(loc="left") or panel.get_title() or panel.get_ylabel()
        for artist in (*panel.lines, *panel.collections, *panel.images, *panel.patches):
            if artist.get_visible() and not _is_seen(artist, panel):
                found.append(f"{type(artist).__name__} {artist.get_label()!r} in {title!r}")
    return found


def _is_seen(artist: Any, panel: Any) -> bool:
    frame = panel.get_window_extent()
    low, high = np.array([frame.x0, frame.y0]) - EDGE, np.array([frame.x1, frame.y1]) + EDGE
    for points, joined in _drawn(artist):
        points = np.asarray(np.ma.filled(points, np.nan), dtype=float).reshape(-1, 2)
        points = points[np.isfinite(points).all(axis=1)]
        if np.any((points >= low).all(axis=1) & (points <= high).all(axis=1)):
            return True
        if joined and len(points) > 1:  # an area or a line may cross what none of its corners lies in
            ends = [np.minimum(points[:-1], points[1:]), np.maximum(points[:-1], points[1:])]
            if joined == "area":
                ends = [points.min(axis=0, keepdims=True), points.max(axis=0, keepdims=True)]
            if np.any((ends[0] <= high).all(axis=1) & (ends[1] >= low).all(axis=1)):
                return True
    return False


def _drawn(artist: Any) -> list[tuple[Any, str]]:
    """Points in pixels, and how they are joined."""
    if hasattr(artist, "get_xydata"):
        joined = "line" if artist.get_linestyle() not in ("None", "none", "", " ") else ""
        with np.errstate(all="ignore"):
            return [(artist.get_transform().transform(artist.get_xydata()), joined)]
    if hasattr(artist, "get_offsets") and hasattr(artist, "get_sizes") and len(artist.get_sizes()):
        return [(artist.get_offset_transform().transform(artist.get_offsets()), "")]
    if hasattr(artist, "get_coordinates"):  # a mesh
        return [(artist.get_transform().transform(artist.get_coordinates().reshape(-1, 2)), "area")]
    if hasattr(artist, "get_paths"):
        return [(artist.get_transform().transform(path.vertices), "area") for path in artist.get_paths()]
    if hasattr(artist, "get_path"):
        return [(artist.get_transform().transform(artist.get_path().vertices), "area")]
    extent = artist.get_window_extent()
    return [([[extent.x0, extent.y0], [extent.x1, extent.y1]], "area")]
