# SPDX-License-Identifier: BSD-3-Clause
"""What each place of a surface has of its own."""

from __future__ import annotations

from typing import Any

import nanotouch as nt

from nanotouch_app.live.look import PROPERTY_NAMES


def here(surface: nt.Surface | None, frame: Any) -> dict[str, float]:
    """Under the tip: effective radius [m], and properties where they are given."""
    if surface is None or frame is None:
        return {}
    x, y = (float(part) for part in frame["tip_position"][:2])
    found = surface.properties(x, y)._asdict()
    if surface.tip_radius is not None:
        found["radius"] = surface.radius_map.radius(x, y).radius
    return {name: float(value) for name, value in found.items() if value is not None}


def properties(surface: nt.Surface | None) -> dict[str, Any]:
    """Of all places; empty where the scene alone says them."""
    given = {} if surface is None else {name: getattr(surface, name) for name in PROPERTY_NAMES}
    return {name: values for name, values in given.items() if values is not None}
