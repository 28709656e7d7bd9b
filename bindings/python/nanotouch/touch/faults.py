# SPDX-License-Identifier: BSD-3-Clause
"""Faults of the simulated rig, by name, channel and time: what fails, where, when. What has to happen then is the table
of docs/safety.md."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple, Self

from nanotouch import _arrays, _core
from nanotouch.errors import InvalidValue

CHANNELS: tuple[str, ...] = _core.fault_channels


class FaultKind(NamedTuple):
    """One kind of fault."""

    name: str
    unit: str
    """of the value; empty if it has none, or that of the channel"""
    doc: str
    value: float
    """if none is given"""
    minimum: float
    """of the value"""
    maximum: float
    row: int
    """of the fault table in docs/safety.md"""
    channels: tuple[str, ...]
    """where it may be; a fault of the whole rig has the channel ``"rig"``"""


def _kind(entry: tuple[str, str, str, float, float, float, int, int]) -> FaultKind:
    name, unit, doc, value, minimum, maximum, row, mask = entry
    channels = tuple(c for n, c in enumerate(CHANNELS) if mask >> n & 1)
    return FaultKind(name, unit, doc, value, minimum, maximum, row, channels)


#: every kind by its name
KINDS: dict[str, FaultKind] = {entry[0]: _kind(entry) for entry in _core.fault_kinds}
_NUMBERS = {name: number for number, name in enumerate(KINDS)}


class Fault(NamedTuple):
    """One fault. ``at`` counts from the session's first tick [s]; None is from switching on, before the preflight."""

    name: str
    channel: str
    at: float | None
    duration: float
    value: float

    @property
    def core(self) -> tuple[int, int, float, float, float]:
        """As the C library takes it."""
        start = 0.0 if self.at is None else self.at
        return _NUMBERS[self.name], CHANNELS.index(self.channel), start, self.duration, self.value

    def __str__(self) -> str:
        where = f" on {self.channel}" if len(KINDS[self.name].channels) > 1 else ""
        when = " from switching on" if self.at is None else f" at {self.at:g} s"
        lasts = f" for {self.duration:g} s" if math.isfinite(self.duration) else ""
        return f"{self.name}{where}{when}{lasts}"


class Faults:
    """A schedule of faults for ``Session(faults=...)`` or :meth:`nanotouch.Session.inject`.

    >>> Faults().add("nan", "deflection", at=0.5, duration=1e-4).add("emergency-stop", at=1.0)
    Faults(nan on deflection at 0.5 s for 0.0001 s, emergency-stop at 1 s)
    """

    def __init__(self) -> None:
        self._list: list[Fault] = []

    def add(
        self,
        name: str,
        channel: str | None = None,
        *,
        at: float | None = 0.0,
        duration: float = math.inf,
        value: float | None = None,
    ) -> Self:
        """Add one; returns the schedule.

        Parameters
        ----------
        name : str
            One of :data:`KINDS`.
        channel : str, optional
            One of the kind's channels; needed where it has several.
        at : float, optional
            When it begins, after the session's first tick [s]; None: from switching on, before the preflight.
        duration : float
            How long it lasts [s]; one period is one sample. A shorter one takes the sample nearest to `at`.
        value : float, optional
            See the kind; by default its own.
        """
        if name not in KINDS:
            raise InvalidValue(f"fault {name!r}: valid are {', '.join(KINDS)}")
        kind = KINDS[name]
        if channel is None and len(kind.channels) == 1:
            channel = kind.channels[0]
        if channel not in kind.channels:
            raise InvalidValue(f"fault {name!r} on channel {channel!r}: valid are {', '.join(kind.channels)}")
        if at is not None and not 0.0 <= _arrays.as_number(f"fault {name!r}: at", at, "s") < math.inf:
            raise InvalidValue(f"fault {name!r}: at = {at} s: it must be a time of 0 s or more, or None")
        if not _arrays.as_number(f"fault {name!r}: duration", duration, "s") > 0.0:
            raise InvalidValue(f"fault {name!r}: duration = {duration} s: it must be above 0 s")
        value = kind.value if value is None else value
        if not kind.minimum <= _arrays.as_number(f"fault {name!r}: value", value, kind.unit) <= kind.maximum:
            raise InvalidValue(
                f"fault {name!r}: value = {value:g} {kind.unit}: valid is {kind.minimum:g} .. {kind.maximum:g}"
            )
        if len(self._list) == _core.faults_max:
            raise InvalidValue(f"fault {name!r}: a schedule holds {_core.faults_max} faults")
        self._list.append(Fault(name, channel, at, duration, value))
        return self

    def __iter__(self) -> Iterator[Fault]:
        return iter(self._list)

    def __len__(self) -> int:
        return len(self._list)

    def __repr__(self) -> str:
        return f"Faults({', '.join(map(str, self._list))})"
