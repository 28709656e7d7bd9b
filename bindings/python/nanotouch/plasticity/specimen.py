# SPDX-License-Identifier: BSD-3-Clause
"""A height field that yields: dents and grooves edit it, each as an event that is replayed or undone. All SI."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from nanotouch import _core
from nanotouch._arrays import Floats, as_floats
from nanotouch.errors import InvalidValue

from .indentation import Indentation
from .scratch import Scratching

if TYPE_CHECKING:
    from .dents import Dent


@dataclass(frozen=True)
class Displacement:
    """Where the material goes that a tip displaces, as shares of its volume; the rest is densified below the dent.

    Parameters
    ----------
    piled_up : float
        In a ridge around the dent, 0 .. 1.
    debris : float
        Leaves the surface, 0 .. 1.
    ridge_width : float
        Of the ridge, over the radius of the dent.
    """

    piled_up: float = 0.8
    debris: float = 0.0
    ridge_width: float = 1.0

    def __post_init__(self) -> None:
        _ = self._core

    @cached_property
    def _core(self) -> _core.Displacement:
        return _core.Displacement(self.piled_up, self.debris, self.ridge_width)


class Imprint(NamedTuple):
    """A paraboloid swept along a straight line; a dent ends where it begins."""

    start_x: float
    """[m]"""
    start_y: float
    """[m]"""
    end_x: float
    """[m]"""
    end_y: float
    """[m]"""
    radius: float
    """a, half of the width [m]"""
    depth: float
    """[m]"""

    @property
    def volume(self) -> float:
        """pi a^2 depth/2 + 4/3 a depth length [m^3]."""
        return _core.Displacement.volume(self)


@dataclass(frozen=True)
class Event:
    """What happened to a specimen: all that it takes to do it again, and what it did."""

    kind: Literal["indent", "scratch"]
    load: float
    """[N]"""
    before: Imprint | None
    """the dent that has grown; None: a new one"""
    after: Imprint
    displacement: Displacement
    lateral_force: float
    """of a scratch, ploughing and shearing; 0 for a dent [N]"""
    removed: float
    """volume below what was there: piled_up + densified + debris, as sums over the pixels [m^3]"""
    piled_up: float
    """[m^3]"""
    densified: float
    """[m^3]"""
    debris: float
    """[m^3]"""
    rows: tuple[int, int]
    """first row that may have changed, and the one after the last"""
    columns: tuple[int, int]
    """the same of the columns"""

    @property
    def changed(self) -> tuple[slice, slice]:
        """The part of the heights that may have changed: ``heights[event.changed]``."""
        return slice(*self.rows), slice(*self.columns)

    def as_dict(self) -> dict[str, Any]:
        """Plain numbers and lists, for JSON."""
        return asdict(self)

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Self:
        """What :meth:`as_dict` gave, also after JSON. `InvalidValue` where a key is missing or unknown."""
        known = {field.name for field in fields(cls)}
        if wrong := sorted(known ^ values.keys()):
            raise InvalidValue(f"event: {', '.join(wrong)} missing or unknown; valid are {', '.join(sorted(known))}")
        pairs = {name: tuple(values[name]) for name in ("rows", "columns")}
        before = None if values["before"] is None else Imprint(*values["before"])
        parts = {"before": before, "after": Imprint(*values["after"]), **pairs}
        return cls(**{**values, **parts, "displacement": Displacement(**values["displacement"])})


class Specimen:
    """Heights that a tip dents and scratches.

    The sample is taken as flat where it is pressed: its own relief does not change radius or pressure. A load inside a
    dent goes on with that dent, which takes up to its own load again without yielding; so does a stroke along a groove.

    Parameters
    ----------
    heights : array_like (ny, nx)
        [m], row 0 at y = 0; copied.
    pixel_size : float or (float, float)
        [m]: one length, or (dy, dx).
    indentation : Indentation, optional
        Tip and sample, for :meth:`indent`.
    scratching : Scratching, optional
        Tip and sample, for :meth:`scratch`.
    displacement : Displacement
        Where the displaced material goes.
    """

    def __init__(
        self,
        heights: ArrayLike,
        pixel_size: float | tuple[float, float],
        *,
        indentation: Indentation | None = None,
        scratching: Scratching | None = None,
        displacement: Displacement | None = None,
    ) -> None:
        self._heights = np.array(as_floats(heights, "heights"), order="C")
        if self._heights.ndim != 2:
            raise InvalidValue(f"heights has {self._heights.ndim} dimensions: valid is 2, (ny, nx)")
        self.pixel_size = _pair("pixel_size", (pixel_size, pixel_size) if np.ndim(pixel_size) == 0 else pixel_size)
        """(dy, dx) [m]"""
        _core.Displacement.check_map(self._heights, *self.pixel_size)
        self.indentation = indentation
        self.scratching = scratching
        self.displacement = Displacement() if displacement is None else displacement
        self._events: list[Event] = []
        self._patches: list[Floats] = []

    @property
    def heights(self) -> Floats:
        """As they are now [m], (ny, nx); a view that cannot be written."""
        view = self._heights.view()
        view.flags.writeable = False
        return view

    @property
    def events(self) -> tuple[Event, ...]:
        """All that has happened and was not undone, the oldest first."""
        return tuple(self._events)

    def indent(self, x: float, y: float, load: float) -> Event | None:
        """Press at (x, y) [m] with a load [N] and let go. None: it stays elastic, nothing changes."""
        if self.indentation is None:
            raise InvalidValue("indentation is missing: Specimen(..., indentation=Indentation(...))")
        x, y = _pair("place", (x, y))
        load = float(load)
        made = self.indentation.at_load(load)
        dent = self._dent_at(x, y)
        if (dent is not None and load <= dent.load) or not made.dissipated > 0.0:
            return None
        if dent is not None:
            x, y = dent.after[:2]
        imprint = Imprint(x, y, x, y, made.contact_radius, made.residual_depth)
        return self._make("indent", load, None if dent is None else dent.after, imprint, 0.0)

    def scratch(self, start: tuple[float, float], end: tuple[float, float], load: float) -> Event | None:
        """Plough from start to end, (x, y) [m], under a load [N]. None: a groove is there that carries this load."""
        if self.scratching is None:
            raise InvalidValue("scratching is missing: Specimen(..., scratching=Scratching(...))")
        start, end, load = _pair("start", start), _pair("end", end), float(load)
        if start == end:
            raise InvalidValue("start and end are one place: to press there is indent")
        groove = self.scratching.groove(load)
        known = self._groove_along(start, end)
        if (known is not None and load <= known.load) or load == 0.0:
            return None
        imprint = Imprint(*start, *end, 0.5 * groove.width, groove.depth)
        if known is not None:
            imprint = Imprint(*known.after[:4], *imprint[4:])
        return self._make("scratch", load, None if known is None else known.after, imprint, groove.lateral_force)

    def take(self, dent: Dent) -> Event:
        """Draw what a session has left (``Session.dents``, ``Recording.dents``), in their order.

        The number of a dent counts from the first that was taken.
        """
        taken = len(self._events)
        if dent.before is not None and dent.before >= taken:
            raise InvalidValue(f"dent {dent.before} is to grow, of {taken} that were taken: take all of them")
        before = None if dent.before is None else self._events[dent.before].after
        is_groove = dent.imprint[:2] != dent.imprint[2:4]
        return self._make("scratch" if is_groove else "indent", dent.load, before, dent.imprint, 0.0)

    def apply(self, event: Event) -> Event:
        """Do a recorded event again: on the same heights, after the same events, it gives the same bits."""
        return self._make(event.kind, event.load, event.before, event.after, event.lateral_force, event.displacement)

    def undo(self) -> Event:
        """Take the last event back, bit by bit, and return it."""
        if not self._events:
            raise InvalidValue("nothing has happened that could be undone")
        event = self._events.pop()
        self._heights[event.changed] = self._patches.pop()
        return event

    def _make(
        self,
        kind: Literal["indent", "scratch"],
        load: float,
        before: Imprint | None,
        after: Imprint,
        lateral_force: float,
        displacement: Displacement | None = None,
    ) -> Event:
        how = self.displacement if displacement is None else displacement
        boxes = [
            how._core.extent(self._heights, *self.pixel_size, one)[:4] for one in (before, after) if one is not None
        ]
        rows = min(box[0] for box in boxes), max(box[0] + box[1] for box in boxes)
        columns = min(box[2] for box in boxes), max(box[2] + box[3] for box in boxes)
        kept = self._heights[slice(*rows), slice(*columns)].copy()
        edit = how._core.edit(self._heights, *self.pixel_size, before, after)
        event = Event(kind, load, before, after, how, lateral_force, *edit[4:], rows, columns)
        self._events.append(event)
        self._patches.append(kept)
        return event

    def _standing(self, kind: str) -> list[Event]:
        """The last event of each dent or groove, the newest first."""
        grown = {event.before for event in self._events if event.before is not None}
        return [event for event in reversed(self._events) if event.kind == kind and event.after not in grown]

    def _dent_at(self, x: float, y: float) -> Event | None:
        """Of the dents that hold this place, the one whose middle is nearest."""
        away = {math.hypot(x - e.after.start_x, y - e.after.start_y): e for e in self._standing("indent")}
        near = {distance: e for distance, e in away.items() if distance < e.after.radius}
        return near[min(near)] if near else None

    def _groove_along(self, start: tuple[float, float], end: tuple[float, float]) -> Event | None:
        for event in self._standing("scratch"):
            if event.after[:4] in ((*start, *end), (*end, *start)):
                return event
        return None


def _pair(name: str, values: Any) -> tuple[float, float]:
    """Two lengths that are numbers."""
    pair = as_floats(values, name)
    if pair.shape != (2,) or not np.isfinite(pair).all():
        raise InvalidValue(f"{name} = {values!r}: valid are two lengths in m")
    return float(pair[0]), float(pair[1])
