# SPDX-License-Identifier: BSD-3-Clause
"""Images as HDF5: a picture any HDF5 program shows, and attributes from which it is read back without being told.

``/height`` holds the picture as pictures are stored, its first row at the top. The axes ``/y`` and ``/x`` (of the
pixels' centres, y upwards) are attached as dimension scales, with ``units`` on each. ``/mask`` is 1 where a height
was filled in. The root says ``format = "nanotouch image"``, ``version``, ``title``, ``name``, ``source``,
``pixel_size`` (dy, dx) [m] and ``offset`` (y, x) [m] of the lower left corner. Values carry check sums.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ReadError, require
from ..formats import HDF5
from .channel import Channel, Plane
from .checks import check_shape
from .topography import Topography

NAME = "nanotouch/hdf5"
FORMAT = "nanotouch image"
VERSION = 1
_STORAGE: dict[str, Any] = {"compression": "gzip", "shuffle": True, "fletcher32": True}


def recognises(file: Path, head: bytes) -> bool:
    """Whether :func:`write` made this file."""
    if not head.startswith(HDF5):
        return False
    h5py = require("h5py", "images")
    try:
        with h5py.File(file, "r") as opened:
            return _text(opened, "format") == FORMAT
    except OSError:  # damaged; the reader that takes it says so
        return False


def channels(file: Path) -> list[Channel]:
    """The one channel there is."""
    with _opened(file) as (opened, heights):
        dy, dx = _pair(opened, "pixel_size", file)
        ny, nx = heights.shape
        return [Channel(_text(opened, "title"), (ny, nx), (ny * dy, nx * dx), "m", "height", True)]


def read(file: Path, channel: str | None) -> Plane:
    """The heights and the mask."""
    with _opened(file) as (opened, heights):
        title = _text(opened, "title")
        if channel is not None and channel.casefold() != title.casefold():
            raise ReadError(f"{file}: no channel {channel!r}; it holds {title}")
        dy, dx = _pair(opened, "pixel_size", file)
        for axis, count, pitch in (("y", heights.shape[0], -dy), ("x", heights.shape[1], dx)):
            centres = np.asarray(opened[axis][...], np.float64)
            if centres.shape != (count,) or not np.allclose(np.diff(centres), pitch, rtol=1e-6, atol=0.0):
                raise ReadError(f"{file}: its header contradicts itself: {axis} does not go in steps of {pitch:g} m")
        values = np.array(heights[...][::-1], np.float64)
        mask = np.asarray(opened["mask"][...], bool)[::-1]
        if mask.shape != values.shape:
            raise ReadError(f"{file}: a mask of {mask.shape} for {values.shape} pixels")
        return Plane(title, values, _text(heights, "units") or None, (dy, dx), NAME, mask=mask)


def write(file: Path, topography: Topography, title: str, offset: tuple[float, float] | None) -> None:
    """Write `topography` to `file`; without `offset` its lower left corner is the origin."""
    h5py = require("h5py", "images")
    (ny, nx), (dy, dx) = topography.shape, topography.pixel_size
    corner = (0.0, 0.0) if offset is None else offset
    with h5py.File(file, "w") as opened:
        facts = {"format": FORMAT, "title": title, "name": topography.name, "source": topography.source}
        for key, text in facts.items():
            _set_text(opened, key, text)
        opened.attrs.update({"version": VERSION, "pixel_size": topography.pixel_size, "offset": corner})
        heights = opened.create_dataset("height", data=topography.heights[::-1], **_STORAGE)
        _set_text(heights, "units", "m")
        _set_text(heights, "long_name", title)
        opened.create_dataset("mask", data=topography.mask[::-1].astype(np.uint8), **_STORAGE)
        axes = {"y": corner[0] + (np.arange(ny)[::-1] + 0.5) * dy, "x": corner[1] + (np.arange(nx) + 0.5) * dx}
        for number, (axis, centres) in enumerate(axes.items()):
            scale = opened.create_dataset(axis, data=centres)
            _set_text(scale, "units", "m")
            scale.make_scale(axis)
            for picture in (heights, opened["mask"]):
                picture.dims[number].attach_scale(scale)


@contextmanager
def _opened(file: Path) -> Iterator[tuple[Any, Any]]:
    h5py = require("h5py", "images")
    with h5py.File(file, "r") as opened:
        version = opened.attrs.get("version")
        if version != VERSION:
            raise ReadError(f"{file}: version {version} of {FORMAT!r}; version {VERSION} is read")
        heights = opened.get("height")
        if not isinstance(heights, h5py.Dataset) or heights.dtype.kind != "f":
            raise ReadError(f"{file}: holds no height")
        check_shape(file, heights.shape)
        yield opened, heights


def _set_text(node: Any, key: str, text: str) -> None:
    """With a fixed length: on a damaged heap, where others lie, the HDF5 library may loop for ever."""
    raw = text.encode()
    node.attrs.create(key, raw, dtype=require("h5py", "images").string_dtype("utf-8", max(1, len(raw))))


def _text(node: Any, key: str) -> str:
    """A text of fixed length; empty where there is none."""
    if key not in node.attrs or node.attrs.get_id(key).dtype.kind != "S":
        return ""
    return bytes(np.asarray(node.attrs[key]).item()).decode("utf-8", "replace")


def _pair(opened: Any, key: str, file: Path) -> tuple[float, float]:
    values = np.ravel(np.asarray(opened.attrs[key], np.float64))
    if values.size != 2:
        raise ReadError(f"{file}: {key} has {values.size} numbers, expected two")
    return float(values[0]), float(values[1])
