# SPDX-License-Identifier: BSD-3-Clause
"""What a session leaves in a sample that keeps dents: read from it or from its recording, and drawn into heights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple, Self

from nanotouch.errors import InvalidValue

from .specimen import Imprint


class Dent(NamedTuple):
    """A dent or a groove of a session, as :meth:`nanotouch.plasticity.Specimen.take` draws it."""

    imprint: Imprint
    load: float
    """that makes it at rest [N]"""
    before: int | None
    """number of the dent that it has grown from, in the order of the session; None: a new one"""

    @classmethod
    def from_numbers(cls, numbers: Sequence[float]) -> Self:
        """Of start, end, radius, depth, load and the dent before, -1 for none."""
        imprint, load, before = Imprint(*numbers[:6]), float(numbers[6]), int(numbers[7])
        return cls(imprint, load, None if before < 0 else before)


def dents_of(events: Sequence[Sequence[Any]]) -> tuple[Dent, ...]:
    """Those that a session's events leave, the oldest first.

    ``undent`` takes one back, ``rewind`` all that came since.
    """
    moments: list[tuple[Dent, ...]] = [()]  # after so many events
    begun: Sequence[float] | None = None
    for _, name, numbers in events:
        found = moments[-1]
        if name == "dent":
            begun = numbers
        elif name == "dent_size":
            if begun is None:
                raise InvalidValue("events: a dent_size without its dent")
            dent, begun = Dent.from_numbers([*begun, *numbers]), None
            if dent.before is not None and dent.before == len(found) - 1:  # the last one has grown in its place
                dent, found = dent._replace(before=found[-1].before), found[:-1]
            found = (*found, dent)
        elif name == "undent":
            found = found[:-1]
        elif name == "rewind":
            kept = int(numbers[1])
            found = moments[kept] if 0 <= kept < len(moments) else ()
        moments.append(found)
    return moments[-1]
