# SPDX-License-Identifier: BSD-3-Clause
"""Images as TopoStats stores them, ``.topostats``: HDF5 with heights in nanometres, their first row at the top.

``image`` is the flattened picture, ``image_original`` the one before; ``pixel_to_nm_scaling`` the side of a pixel [nm].
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ReadError, require
from ..formats import HDF5
from .channel import Channel, Plane, chosen, with_default
from .checks import check_shape

NAME = "nanotouch/topostats"
_SCALE = "pixel_to_nm_scaling"
_PICTURES = ("image", "image_original")


def recognises(file: Path, head: bytes) -> bool:
    """Whether it is one of TopoStats' files."""
    if not head.startswith(HDF5):
        return False
    h5py = require("h5py", "images")
    try:
        with h5py.File(file, "r") as opened:
            return _SCALE in opened and "image" in opened
    except OSError:  # damaged; the reader that takes it says so
        return False


def channels(file: Path) -> list[Channel]:
    """The pictures before and after flattening."""
    with _opened(file) as (found, side):
        return _listed(found, side)


def read(file: Path, channel: str | None) -> Plane:
    """One picture; the flattened one if none is named."""
    with _opened(file) as (found, side):
        name = list(found)[chosen(_listed(found, side), channel, file)]
        check_shape(file, found[name].shape)
        values = np.array(found[name][...][::-1], np.float64)
        notes = ("flattened by TopoStats; the picture before is the channel 'image_original'",)
        return Plane(name, values, "nm", (side, side), NAME, notes=notes if name == "image" and len(found) > 1 else ())


def _listed(found: dict[str, Any], side: float) -> list[Channel]:
    return with_default(
        [
            Channel(name, node.shape, (node.shape[0] * side, node.shape[1] * side), "nm", "height", False)
            for name, node in found.items()
        ]
    )


@contextmanager
def _opened(file: Path) -> Iterator[tuple[dict[str, Any], float]]:
    h5py = require("h5py", "images")
    with h5py.File(file, "r") as opened:
        found = {
            name: opened[name]
            for name in _PICTURES
            if isinstance(opened.get(name), h5py.Dataset) and opened[name].ndim == 2
        }
        side = float(np.asarray(opened[_SCALE][()], np.float64)) * 1e-9
        if not found or not 0.0 < side < np.inf:
            raise ReadError(f"{file}: holds no picture, or pixels of {side:g} m")
        yield found, side
