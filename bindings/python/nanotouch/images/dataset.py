# SPDX-License-Identifier: BSD-3-Clause
"""What a dataset of HDF5 or netCDF says of itself, by the conventions of CF: the unit of its values, a scale and an
offset of packed numbers, the value of what is missing, and its axes. Readers of bare arrays know none of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._io.text import decoded
from ..errors import ReadError, require
from .checks import LENGTHS

EVEN = 1e-3
"""of the mean step of an axis; what is less even is no raster"""
_SPELLED = {"meter": "m", "metre": "m", "millimeter": "mm", "micrometer": "um", "micron": "um", "nanometer": "nm",
            "angstrom": "Å", "picometer": "pm"}  # fmt: skip


class Facts(NamedTuple):
    """Of one dataset."""

    unit: str | None = None
    scale: float = 1.0
    offset: float = 0.0
    missing: tuple[float, ...] = ()
    pixel_size: tuple[float, float] | None = None
    """(dy, dx) [m], where both axes are there with a unit of length"""
    turned: tuple[bool, bool] = (False, False)
    """y rises with the rows, so that the first is the lowest; x falls with the columns"""

    def of(self, picture: NDArray[np.float64]) -> NDArray[np.float64]:
        """The values, row 0 at the bottom, of what was read as a picture: unpacked, NaN where nothing was measured."""
        values = picture[:: -1 if self.turned[0] else 1, :: -1 if self.turned[1] else 1]
        for value in self.missing:
            values = np.where(values == value, np.nan, values)
        return np.array(values * self.scale + self.offset, order="C")


def facts_of(file: Path, name: str) -> Facts:
    """Those of the dataset `name`; none of a file that is no HDF5, or where it is not found."""
    h5py = require("h5py", "images")
    try:
        opened = h5py.File(file, "r")
    except OSError:
        return Facts()
    with opened:
        node = opened.get(name)
        if not isinstance(node, h5py.Dataset):
            return Facts()
        if node.dtype.kind not in "fiu":
            raise ReadError(f"{file}: {node.name} holds {node.dtype}, expected real numbers")
        missing = [_number(node, key, file) for key in ("_FillValue", "missing_value") if key in node.attrs]
        scale, offset = (_number(node, key, file) if key in node.attrs else usual
                         for key, usual in (("scale_factor", 1.0), ("add_offset", 0.0)))  # fmt: skip
        steps = [_step(node, axis, file) for axis in (0, 1)]
        sides = None if steps[0] is None or steps[1] is None else (abs(steps[0]), abs(steps[1]))
        turned = (steps[0] or 0.0) > 0.0, (steps[1] or 0.0) < 0.0
        return Facts(_unit(node), scale, offset, tuple(missing), sides, turned)


def _number(node: Any, key: str, file: Path) -> float:
    try:
        values = np.asarray(node.attrs[key]).reshape(-1)
        if values.size > 1:
            raise ReadError(f"{file}: {node.name}: {key} is {str(values)[:40]}, {values.size} numbers, expected one")
        return float(values[0])
    except (TypeError, ValueError, IndexError):
        raise ReadError(f"{file}: {node.name}: {key} is {str(node.attrs[key])[:40]!r}, no number") from None


def _unit(node: Any) -> str | None:
    for key in ("units", "unit"):
        stated = node.attrs.get(key)
        raw = stated if isinstance(stated, bytes) else str(stated).encode("utf-8", "surrogateescape")
        text = decoded(raw).strip()
        if stated is not None and text:
            return _SPELLED.get(text.casefold().removesuffix("s"), text)
    return None


def _step(node: Any, axis: int, file: Path) -> float | None:
    """From pixel to pixel [m], negative where the axis falls; None where no axis is attached, or without a length."""
    attached = list(node.dims[axis].values())
    unit = LENGTHS.get(_unit(attached[0]) or "") if attached else None
    if unit is None or attached[0].shape != (node.shape[axis],) or node.shape[axis] < 2:
        return None
    steps = np.diff(np.asarray(attached[0][...], np.float64)) * unit
    mean = float(np.mean(steps))
    if mean == 0.0 or not np.all(np.abs(steps - mean) <= EVEN * abs(mean)):
        raise ReadError(f"{file}: {node.name}: the axis {attached[0].name} does not go in even steps")
    return mean
