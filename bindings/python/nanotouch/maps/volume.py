# SPDX-License-Identifier: BSD-3-Clause
"""Force volumes: where the curves of a map come from, a block at a time."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats, as_floats, refuse_dressed
from .._io.digest import file_digest
from .._io.words import printable
from ..curves import ForceCurve, Segment, Stream, read, stream
from ..errors import InvalidValue

_HASHED = 1 << 24  # byte at a time


class Sliced(Protocol):
    """Numbers that are had by slicing: a numpy array or memmap, an h5py or zarr data set, a Dask array."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Length along each axis."""

    def __getitem__(self, key: Any) -> Any: ...


@dataclass(frozen=True, eq=False)
class Block:
    """Some curves, one after the other: all that is sent to where they are fitted.

    Attributes
    ----------
    z, force : ndarray, shape (m,)
        Height of the base [m] and force [N] of all segments in turn; where z has fewer elements, it is that of every
        curve.
    edges : ndarray, shape (2 n + 1,)
        Where segments begin: curve i approaches from ``edges[2 * i]`` and retracts from ``edges[2 * i + 1]`` on.
    spring_constant : ndarray, shape (n,)
        [N/m].
    """

    z: Floats
    force: Floats
    edges: NDArray[np.int64]
    spring_constant: Floats

    def __len__(self) -> int:
        return int(self.spring_constant.size)


@dataclass(frozen=True, eq=False)
class ArrayVolume:
    """Curves in one array, sliced by rows when they are needed; row 0 is y = 0.

    Attributes
    ----------
    values : array-like, shape (ny, nx, n)
        Force [N], or deflection [m] if `deflection`.
    z : ndarray, shape (n,), or array-like, shape (ny, nx, n)
        Height of the base, away from the sample [m]; it falls to its lowest and rises again, or does one of both.
    spring_constant : float
        k_c [N/m].
    """

    values: Sliced
    z: Any
    spring_constant: float
    deflection: bool = False
    name: str = "array"
    coordinates: dict[str, Floats] = field(default_factory=dict)
    tip_radii: frozenset[float] = frozenset()

    def __post_init__(self) -> None:
        for values, name in ((self.values, "the map"), (self.z, "z")):
            refuse_dressed(values, name)
        if len(self.values.shape) != 3:
            raise InvalidValue(f"the array of a map has shape (y, x, points), not {self.values.shape}")
        valid = (self.values.shape[2:], self.values.shape)
        if tuple(self.z.shape) not in valid:
            raise InvalidValue(f"z has shape {self.z.shape}, expected {valid[0]} or {valid[1]}")
        if not 0.0 < self.spring_constant < np.inf:
            raise InvalidValue(f"spring_constant: {self.spring_constant!r} N/m, expected a positive number")

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of curves."""
        return int(self.values.shape[0]), int(self.values.shape[1])

    def block(self, start: int, stop: int) -> Block:
        """The curves start .. stop - 1, counted along the rows."""
        count, points = stop - start, int(self.values.shape[2])
        force = self._rows(self.values, start, stop)
        if self.deflection:
            force = force * self.spring_constant
        shared = len(self.z.shape) == 1
        z = as_floats(self.z, "z") if shared else self._rows(self.z, start, stop)
        turns = np.full(count, _turn(z)) if shared else np.array([_turn(one) for one in z.reshape(count, points)])
        first = points * np.arange(count)
        edges = np.append(np.stack([first, first + turns], axis=1).ravel(), points * count)
        return Block(z.ravel(), force.ravel(), edges, np.full(count, float(self.spring_constant)))

    def _rows(self, values: Any, start: int, stop: int) -> Floats:
        """The curves start .. stop - 1 of an array that can be sliced by rows."""
        nx = self.shape[1]
        top = start // nx
        found = values[top : -(-stop // nx)]
        found = found.compute() if hasattr(found, "compute") else found  # of Dask, whose chunks may be masked
        rows = as_floats(found, "the map").reshape(-1, values.shape[2])
        return np.ascontiguousarray(rows[start - top * nx : stop - top * nx])

    def digest(self) -> str:
        """SHA-256 of all that :meth:`block` can return."""
        found = hashlib.sha256(repr((self.values.shape, self.spring_constant, self.deflection)).encode())
        for values in (self.values, self.z):
            rows = max(1, _HASHED // (8 * int(np.prod(values.shape[1:], dtype=int))))
            for row in range(0, int(values.shape[0]), rows):
                found.update(np.ascontiguousarray(values[row : row + rows]).tobytes())
        return found.hexdigest()


def _turn(z: Floats) -> int:
    """How many points are the approach: up to the lowest; none or all where the base goes one way only."""
    if not np.isfinite(z).all():
        return int(z.size) // 2
    lowest = int(np.argmin(z))
    return 0 if lowest == 0 else lowest + 1


class _Lazy(Mapping[int, ForceCurve]):
    """Curves that are read when a block needs them."""

    def __init__(self, curves: Any, order: Mapping[int, int]) -> None:
        self._curves, self._order = curves, order

    def __getitem__(self, place: int) -> ForceCurve:
        curve: ForceCurve = self._curves[self._order[place]]
        return curve

    def __len__(self) -> int:
        return len(self._order)

    def __iter__(self) -> Iterator[int]:
        return iter(self._order)


_NOWHERE = np.empty(0)


@dataclass(frozen=True, eq=False)
class CurveVolume:
    """Curves of a file, at the places that it gives them; without such, in one row.

    Attributes
    ----------
    places : mapping
        Curves by their number along the rows; a place without a curve is one that fails.
    shape : (int, int)
        Rows, columns.
    file : path or None
        Where they come from.
    numbers : mapping
        For each place the number of its curve in the file.
    tip_radii : frozenset of float
        All that the curves state [m].
    """

    places: Mapping[int, ForceCurve]
    shape: tuple[int, int]
    name: str
    file: Path | None = None
    coordinates: dict[str, Floats] = field(default_factory=dict)
    numbers: Mapping[int, int] = field(default_factory=dict)
    tip_radii: frozenset[float] = frozenset()

    @classmethod
    def of(cls, curves: Sequence[ForceCurve] | Stream, name: str, file: Path | None = None) -> CurveVolume:
        """Find the grid."""
        if not len(curves):
            raise InvalidValue(f"{name}: a map without curves")
        streamed = isinstance(curves, Stream)
        metas = [curves.place(k) if isinstance(curves, Stream) else curves[k].meta for k in range(len(curves))]
        meta, shape = metas[0], (1, len(curves))
        order = {k: k for k in range(len(curves))}
        gridded = "grid shape x" in meta and all("grid index x" in m and "grid index y" in m for m in metas)
        if gridded:
            shape = int(meta["grid shape y"]), int(meta["grid shape x"])
            order = _order(metas, shape, name)
        places = _Lazy(curves, order) if streamed else {place: curves[k] for place, k in order.items()}
        radii = frozenset(float(m["tip radius"]) for m in metas if m.get("tip radius") is not None)
        return cls(places, shape, name, file, _coordinates(meta, *shape) if gridded else {}, order, radii)

    def block(self, start: int, stop: int) -> Block:
        """The curves start .. stop - 1, counted along the rows."""
        z, force, lengths, stiffness = [], [], [], []
        for number in range(start, stop):
            curve = self.places.get(number)
            for segment in (curve.approach, curve.retract) if curve else (None, None):
                values = _values(segment)
                z.append(values[0])
                force.append(values[1])
                lengths.append(values[0].size)
            stiffness.append(np.nan if curve is None or curve.spring_constant is None else curve.spring_constant)
        edges = np.concatenate([[0], np.cumsum(lengths)]).astype(np.int64)
        return Block(np.concatenate(z), np.concatenate(force), edges, np.array(stiffness))

    def digest(self) -> str:
        """SHA-256 of the file, or of all that :meth:`block` can return."""
        if self.file is not None:
            return file_digest(self.file)
        found = hashlib.sha256(repr(self.shape).encode())
        for number, curve in sorted(self.places.items()):
            found.update(repr((number, curve.spring_constant)).encode())
            for segment in (curve.approach, curve.retract):
                for values in _values(segment):
                    found.update(values.tobytes())
        return found.hexdigest()


def _order(metas: Sequence[Mapping[str, Any]], shape: tuple[int, int], name: str) -> dict[int, int]:
    """Which curve is at each place, counted along the rows."""
    (ny, nx), order = shape, dict[int, int]()
    for number, meta in enumerate(metas):
        y, x = int(meta["grid index y"]), int(meta["grid index x"])
        if not (0 <= y < ny and 0 <= x < nx):
            raise InvalidValue(f"{name}: a curve at row {y}, column {x} of a grid of {ny} x {nx}")
        if (other := order.setdefault(y * nx + x, number)) != number:
            raise InvalidValue(f"{name}: curves {other} and {number} both lie at row {y}, column {x} of a grid of "
                               f"{ny} x {nx}: grid and positions do not belong together")  # fmt: skip
    return order


def _values(segment: Segment | None) -> tuple[Floats, Floats]:
    if segment is None or segment.force is None:
        return _NOWHERE, _NOWHERE
    return segment.z, segment.force


def _coordinates(meta: Any, ny: int, nx: int) -> dict[str, Floats]:
    """Centres of the pixels [m], where the file says how large the grid is."""
    try:
        size = {"y": (float(meta["grid size y"]), ny), "x": (float(meta["grid size x"]), nx)}
    except KeyError:
        return {}
    return {axis: np.asarray((np.arange(count) + 0.5) * (length / count)) for axis, (length, count) in size.items()}


Volume = ArrayVolume | CurveVolume


def volume_of(source: Any, z: Any, deflection: bool, reading: Mapping[str, Any]) -> Volume:
    """What :func:`nanotouch.maps.fit` was given, as a volume."""
    if isinstance(source, ArrayVolume | CurveVolume):
        return source
    if isinstance(source, str | os.PathLike):
        path = Path(source)
        found = stream(path, **reading)
        return CurveVolume.of(read(path, **reading) if found is None else found, printable(path.name), path)
    if isinstance(source, Sequence) and source and isinstance(source[0], ForceCurve):
        return CurveVolume.of(source, source[0].name)
    if not hasattr(source, "shape"):
        raise InvalidValue(f"a map is a file, an array of shape (y, x, points) or a list of curves, not {source!r:.60}")
    spring_constant = reading["spring_constant"]
    if z is None or spring_constant is None:
        raise InvalidValue("a map from an array needs z [m] and spring_constant [N/m]")
    return ArrayVolume(source, z if hasattr(z, "shape") else as_floats(z, "z"), spring_constant, deflection)


def blocks_of(volume: Volume, size: int) -> Iterator[tuple[int, int, int]]:
    """(number, start, stop) of each block of `size` curves."""
    total = volume.shape[0] * volume.shape[1]
    for number, start in enumerate(range(0, total, size)):
        yield number, start, min(total, start + size)
