# SPDX-License-Identifier: BSD-3-Clause
"""Processor time of this process, the least of several runs: what disturbs a run only ever adds to it."""

from __future__ import annotations

import time
from collections.abc import Callable


def least(work: Callable[[], object], runs: int = 5) -> float:
    """Least time of one call [s]."""
    times = []
    for _ in range(runs):
        start = time.process_time()
        work()
        times.append(time.process_time() - start)
    return min(times)
