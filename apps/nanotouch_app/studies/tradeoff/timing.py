# SPDX-License-Identifier: BSD-3-Clause
"""What calls cost in processor time: the least of repeated runs, as whatever else a machine does only adds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from time import process_time_ns
from typing import Any

ELEMENTS = 65536
"""of an array: so many that the Python call and a new table are below a nanosecond each, and still in cache"""


def nanoseconds(
    calls: Mapping[str, Callable[[], Any]], runs: int, progress: Callable[[float], None] | None = None
) -> dict[str, float]:
    """Nanoseconds per element of each call on an array of ``ELEMENTS``.

    The calls take turns, so that a spell of a busy machine or another clock rate meets them all; ratios are worth more
    than figures. Everything a user pays for is in them: the Python call, folds and table of a contact, the results.
    """
    least = dict.fromkeys(calls, float("inf"))
    for call in calls.values():
        call()
    for run in range(runs):
        for name, call in calls.items():
            start = process_time_ns()
            call()
            least[name] = min(least[name], (process_time_ns() - start) / ELEMENTS)
        if progress:
            progress((run + 1) / runs)
    return least
