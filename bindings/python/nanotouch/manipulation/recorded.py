# SPDX-License-Identifier: BSD-3-Clause
"""The particles of a recording, or its rod: what they are like, where each was laid, and the way of the tip. Led along
that way again, they go where they went."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch._arrays import Floats
from nanotouch.errors import InvalidValue

from .particle import Particle, ParticleContact
from .particles import Particles
from .rod import Rod

APART = 1e-9  # points of the way are no nearer: half of a step of the tip [m]
NEEDED = ("x", "y", "gap", "surface_height")


class Recording(Protocol):
    """A :class:`nanotouch.Recording`, as far as it is asked."""

    columns: dict[str, NDArray[Any]]
    metadata: dict[str, Any]

    def __contains__(self, name: object) -> bool: ...


class Recorded:
    """Where the particles of a recording, or its rod, were.

    Parameters
    ----------
    recording : Recording
        Of a session with particles or a rod, from its first tick on, without rewinds
        (:func:`nanotouch.touch.replay.without_rewinds`).

    Attributes
    ----------
    radius, length : float
        Of each [m]; the length of spheres is 0.
    laid : list
        Row, number and pose of each that was laid: x, y [m] and a rod's angle [rad], which is 0 of spheres.
    """

    def __init__(self, recording: Recording) -> None:
        kind = "rod" if "rod" in recording.metadata else "particles"
        missing = [name for name in NEEDED if name not in recording]
        if kind not in recording.metadata or missing:
            raise InvalidValue(f"the recording holds no particles: it lacks {', '.join(missing) or 'what they are'}")
        try:
            of = recording.metadata[kind]
            pushed = Rod(**of) if kind == "rod" else _described(of)
            side = float(recording.metadata["rig"]["probe"].get("lateral_stiffness", 0.0))
            rate = float(recording.metadata["loop_rate"])
            ticks = np.rint(recording.columns["time"] * rate)
            self.laid = [
                (int(np.searchsorted(ticks, tick)), *_posed(name, [float(number) for number in numbers]))
                for tick, name, numbers in recording.metadata["events"]
                if name in ("lay", "lay_rod")
            ]
        except (TypeError, ValueError, LookupError, AttributeError) as error:
            raise InvalidValue(f"the recording's metadata cannot be read: {error}") from error
        self.radius = pushed.radius if isinstance(pushed, Rod) else pushed.particle.radius
        self.length = pushed.length if isinstance(pushed, Rod) else 0.0
        columns = recording.columns
        height = np.maximum(columns["gap"] + columns["surface_height"], 0.0)  # as the simulated slave does
        self._way = np.column_stack([columns["x"], columns["y"], height]).astype(np.float64)
        self._core = _core.Pushed(pushed._core, side)
        self._state: Any = None
        self._rows: list[int] = []  # that are known, in their order ...
        self._places: list[Floats] = []  # ... and where all were then
        self._done = 0  # rows
        self._next = 0  # of `laid`

    def at(self, row: int) -> Floats:
        """x, y, z of their centres [m]; one row of the answer for each that has been laid by then."""
        return self.poses(row)[:, :3]

    def poses(self, row: int) -> Floats:
        """The same, and the angle of a rod's axis from x [rad], 0 of spheres."""
        if not 0 <= row < len(self._way):
            raise InvalidValue(f"row {row}: valid is 0 .. {len(self._way) - 1}")
        while self._done <= row:
            self._go_on(row + 1)
        known = bisect_right(self._rows, row)
        return self._places[known - 1] if known else np.empty((0, 4))

    def _go_on(self, end: int) -> None:
        """Up to a row, or to where the next one is laid."""
        while self._next < len(self.laid) and self.laid[self._next][0] <= self._done:
            _, number, pose = self.laid[self._next]
            begun = self._core.begin(tuple(self._way[self._done])) if self._state is None else self._state
            self._state = self._core.lay(begun, number, pose)
            self._keep(self._done, np.asarray(self._state.read()))
            self._next += 1
        if self._next < len(self.laid):
            end = min(end, self.laid[self._next][0])
        rows = self._thinned(self._done, end)
        self._done = end
        if self._state is None or not len(rows):
            return
        self._state, found = self._core.run(self._state, self._way[rows])
        for row, values in zip(rows, found, strict=True):
            self._keep(int(row), values)

    def _keep(self, row: int, values: Floats) -> None:
        self._rows.append(row)
        self._places.append(values.reshape(-1, 4))

    def _thinned(self, begin: int, end: int) -> NDArray[np.int64]:
        """Rows in which the tip has gone on, and the last one: what stands still costs nothing."""
        way = self._way[begin:end]
        good = np.flatnonzero(np.isfinite(way).all(axis=1))
        if not len(good):
            return good
        gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(way[good], axis=0), axis=1))])
        places = np.unique(np.floor(gone / APART), return_index=True)[1]
        return np.asarray(begin + np.union1d(good[places], good[-1:]))


def _described(of: Mapping[str, Any]) -> Particles:
    """What a session wrote down of its set."""
    one, between = of["particle"], of.get("between")
    substrate, tip = (ParticleContact(**one[side]) for side in ("substrate", "tip"))
    particle = Particle(**{**one, "substrate": substrate, "tip": tip})
    return Particles(particle, None if between is None else ParticleContact(**between))


def _posed(name: str, numbers: list[float]) -> tuple[int, tuple[float, float, float]]:
    """Number, and x, y, angle."""
    if name == "lay_rod":
        x, y, angle = numbers
        return 0, (x, y, angle)
    number, x, y = numbers
    return int(number), (x, y, 0.0)
