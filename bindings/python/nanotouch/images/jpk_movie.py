# SPDX-License-Identifier: BSD-3-Clause
"""JPK movies, ``.h5-jpk``: HDF5 with one column per frame.

``Measurement_N/Channel_M`` holds integers of shape (pixels, frames), its first pixel the lower left one. Its
attributes are name, direction, and with ``net-encoder.scaling`` what brings them to the unit of its default
calibration. The grid stands in the attributes of the measurement. Each frame is a channel: ``"Height (measured) trace
frame 2"``.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ReadError, require
from ..formats import HDF5
from .channel import Channel, Plane, chosen, si_unit, with_default
from .checks import check_shape

NAME = "nanotouch/jpk-movie"
_FORMAT = "JPK SCAN"


@dataclass(frozen=True)
class _Movie:
    """One channel of one measurement."""

    name: str
    kind: str
    node: Any  # dataset (pixels, frames)
    shape: tuple[int, int]
    size: tuple[float, float]
    scale: tuple[float, float]  # multiplier and offset
    unit: str


def recognises(file: Path, head: bytes) -> bool:
    """Whether it is a JPK movie."""
    if not head.startswith(HDF5):
        return False
    h5py = require("h5py", "images")
    try:
        with h5py.File(file, "r") as opened:
            return _text(opened, "file-format-info") == _FORMAT
    except OSError:  # damaged; the reader that takes it says so
        return False


def channels(file: Path) -> list[Channel]:
    """Every frame of every channel."""
    with _opened(file) as movies:
        return _listed(movies)


def read(file: Path, channel: str | None) -> Plane:
    """One frame; the first of the heights if none is named."""
    with _opened(file) as movies:
        listed = _listed(movies)
        number = chosen(listed, channel, file)
        for movie in movies:
            if number < movie.node.shape[1]:
                break
            number -= movie.node.shape[1]
        check_shape(file, movie.shape)
        multiplier, offset = movie.scale
        values = np.asarray(movie.node[:, number], np.float64).reshape(movie.shape) * multiplier + offset
        pixel_size = (movie.size[0] / movie.shape[0], movie.size[1] / movie.shape[1])
        name, frames = f"{movie.name} frame {number + 1}", movie.node.shape[1]
        notes = () if channel is not None or frames == 1 else (f"frame 1 of {frames}; name another as the channel",)
        return Plane(name, values, movie.unit, pixel_size, NAME, notes=notes)


def _listed(movies: list[_Movie]) -> list[Channel]:
    return with_default(
        [
            Channel(f"{movie.name} frame {n + 1}", movie.shape, movie.size, movie.unit, movie.kind, False)
            for movie in movies
            for n in range(movie.node.shape[1])
        ]
    )


@contextmanager
def _opened(file: Path) -> Iterator[list[_Movie]]:
    h5py = require("h5py", "images")
    with h5py.File(file, "r") as opened:
        found = [
            movie
            for measurement in opened.values()
            if isinstance(measurement, h5py.Group)
            for channel in measurement.values()
            if isinstance(channel, h5py.Group) and "channel.name" in channel.attrs
            for movie in _movies(file, measurement, channel)
        ]
        if not found:
            raise ReadError(f"{file}: holds no channel")
        yield [replace(movie, name=_numbered(found[:n], movie.name)) for n, movie in enumerate(found)]


def _numbered(before: list[_Movie], name: str) -> str:
    """The name, with its number where others bear it: ``"Height trace#2"``."""
    same = sum(movie.name == name for movie in before)
    return f"{name}#{same + 1}" if same else name


def _movies(file: Path, measurement: Any, channel: Any) -> Iterator[_Movie]:
    if "position-pattern.grid.ilength" not in measurement.attrs:
        return  # no grid: no picture
    nx, ny = (int(_number(file, measurement, f"position-pattern.grid.{key}")) for key in ("ilength", "jlength"))
    lx, ly = (_number(file, measurement, f"position-pattern.grid.{key}") for key in ("ulength", "vlength"))
    for key, node in channel.items():
        if key == "thumbnail" or getattr(node, "ndim", 0) != 2 or node.shape[0] != nx * ny:
            continue
        scale = (
            _number(file, channel, "net-encoder.scaling.multiplier", 1.0),
            _number(file, channel, "net-encoder.scaling.offset", 0.0),
        )
        direction = "retrace" if _text(channel, "retrace").casefold() in ("true", "1") else "trace"
        name = f"{_text(channel, 'channel.fancy-name') or _text(channel, 'channel.name')} {direction}"
        kind = "height" if "height" in _text(channel, "channel.name").casefold() else key.casefold()
        unit = si_unit(_text(channel, "net-encoder.scaling.unit.unit"))
        yield _Movie(name, kind, node, (ny, nx), (ly, lx), scale, unit)


def _number(file: Path, node: Any, key: str, otherwise: float | None = None) -> float:
    if key not in node.attrs and otherwise is not None:
        return otherwise
    try:
        return float(_attribute(node, key))
    except (KeyError, IndexError, TypeError, ValueError):
        raise ReadError(f"{file}: {node.name} states no number {key!r}") from None


def _text(node: Any, key: str) -> str:
    value = _attribute(node, key) if key in node.attrs else b""
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _attribute(node: Any, key: str) -> Any:
    """Of an array of one, what it holds."""
    return np.ravel(node.attrs[key])[0]
