# SPDX-License-Identifier: BSD-3-Clause
"""The quantities of a map as channels of an image, for programs that show images."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import InvalidValue
from ..images.channel import Plane
from .dataset import determined
from .touched import pixel_size_of

_STATES = ("status", "flags")


def planes(data: Any) -> list[Plane]:
    """Every quantity of a map; NaN, and so masked, where a curve does not determine it."""
    try:
        size = pixel_size_of(data)
    except InvalidValue:
        size = None
    found = []
    for name, variable in data.data_vars.items():
        if variable.dims != ("y", "x") or variable.dtype.kind != "f" or name in _STATES:
            continue
        plain = "_sigma" in name
        values = np.where(np.isfinite(variable.values), variable.values, np.nan)
        values = values if plain else np.where(determined(data, name), values, np.nan)
        if np.isfinite(values).any():
            unit = variable.attrs.get("units", "1")
            found.append(Plane(str(name), values, "" if unit == "1" else unit, size, "nanotouch map"))
    return found
