# SPDX-License-Identifier: BSD-3-Clause
"""The particles of a recording. It holds what they are like, where each was laid, and the way of the tip: led along
that way again, they go where they went."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from nanotouch._arrays import Floats
from nanotouch.errors import InvalidValue

from .lever import core_of
from .particle import OF_EACH, OF_TIP, Particle, ParticleContact
from .particles import polystyrene

APART = 1e-9  # points of the way are no nearer: half of a step of the tip [m]
NEEDED = ("x", "y", "gap", "surface_height")


class Recording(Protocol):
    """A :class:`nanotouch.Recording`, as far as it is asked."""

    columns: dict[str, NDArray[Any]]
    metadata: dict[str, Any]

    def __contains__(self, name: object) -> bool: ...


class Recorded:
    """Where the particles of a recording were.

    Parameters
    ----------
    recording : Recording
        Of a session with particles, from its first tick on, without rewinds
        (:func:`nanotouch.touch.replay.without_rewinds`).

    Attributes
    ----------
    radius : float
        Of each [m].
    laid : list
        Row, number and place [m] of each particle that was laid.
    """

    def __init__(self, recording: Recording) -> None:
        missing = [name for name in NEEDED if name not in recording]
        if "particles" not in recording.metadata or missing:
            raise InvalidValue(f"the recording holds no particles: it lacks {', '.join(missing) or 'what they are'}")
        try:
            particle, between = _described(recording.metadata["particles"])
            side = float(recording.metadata["rig"]["probe"].get("lateral_stiffness", 0.0))
            rate = float(recording.metadata["loop_rate"])
            ticks = np.rint(recording.columns["time"] * rate)
            self.laid = [
                (int(np.searchsorted(ticks, tick)), int(numbers[0]), (float(numbers[1]), float(numbers[2])))
                for tick, name, numbers in recording.metadata["events"]
                if name == "lay"
            ]
        except (TypeError, ValueError, LookupError, AttributeError) as error:
            raise InvalidValue(f"the recording's metadata cannot be read: {error}") from error
        self.radius = particle.radius
        columns = recording.columns
        height = np.maximum(columns["gap"] + columns["surface_height"], 0.0)  # as the simulated slave does
        self._way = np.column_stack([columns["x"], columns["y"], height]).astype(np.float64)
        self._core = core_of(particle, between, (side, side, 0.0))
        self._state: Any = None
        self._rows: list[int] = []  # that are known, in their order ...
        self._places: list[Floats] = []  # ... and where all were then
        self._done = 0  # rows
        self._next = 0  # of `laid`

    def at(self, row: int) -> Floats:
        """x, y, z of their centres [m]; one row of the answer for each that has been laid by then."""
        if not 0 <= row < len(self._way):
            raise InvalidValue(f"row {row}: valid is 0 .. {len(self._way) - 1}")
        while self._done <= row:
            self._go_on(row + 1)
        known = bisect_right(self._rows, row)
        return self._places[known - 1] if known else np.empty((0, 3))

    def _go_on(self, end: int) -> None:
        """Up to a row, or to where the next one is laid."""
        while self._next < len(self.laid) and self.laid[self._next][0] <= self._done:
            _, number, place = self.laid[self._next]
            begun = self._core.begin(tuple(self._way[self._done])) if self._state is None else self._state
            self._state = self._core.lay(begun, number, place)
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
        self._places.append(values[OF_TIP:].reshape(-1, OF_EACH)[:, :3])

    def _thinned(self, begin: int, end: int) -> NDArray[np.int64]:
        """Rows in which the tip has gone on, and the last one: what stands still costs nothing."""
        way = self._way[begin:end]
        good = np.flatnonzero(np.isfinite(way).all(axis=1))
        if not len(good):
            return good
        gone = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(way[good], axis=0), axis=1))])
        places = np.unique(np.floor(gone / APART), return_index=True)[1]
        return np.asarray(begin + np.union1d(good[places], good[-1:]))


def _described(of: Mapping[str, Any]) -> tuple[Particle, ParticleContact]:
    """What a session wrote down of its set."""
    one, between = of["particle"], of.get("between")
    substrate, tip = (ParticleContact(**one[side]) for side in ("substrate", "tip"))
    return Particle(**{**one, "substrate": substrate, "tip": tip}), (
        polystyrene() if between is None else ParticleContact(**between)
    )
