# SPDX-License-Identifier: BSD-3-Clause
"""A script, block by block: as fast as it goes, or by the clock where a device is real."""

from __future__ import annotations

import time
from collections.abc import Generator, Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from nanotouch.touch.operator import Hold, Input

BLOCK_TICKS = 500
"""rows that a killed process may lose"""
NAP = 2e-3
"""between two looks at a ring that is empty [s]"""

Columns = dict[str, NDArray[Any]]


class Played(Protocol):
    """What is needed of a session."""

    rate: float

    @property
    def pace(self) -> Any: ...
    @property
    def progress(self) -> Any: ...
    def start(self, pace: Any, duration: float | None) -> None: ...
    def halt(self) -> None: ...
    def aim(self, input: Input | Hold) -> None: ...
    def advance(self, duration: float) -> Columns: ...
    def read(self, rows: int) -> Columns: ...


def joined(blocks: Sequence[Columns], axis: int = 0) -> Columns:
    """One block; ``axis`` is that of the rows."""
    return {name: np.concatenate([block[name] for block in blocks], axis) for name in blocks[0]}


def played(session: Played, script: Sequence[Input | Hold]) -> Generator[tuple[Columns, float]]:
    """Each block as it comes, with the share of the script that is done. A real half moves by the clock, in a thread
    that ends with the script, or when this is closed."""
    ticks = [round(step.duration * session.rate) for step in script]
    is_real, done = session.pace != "free", 0
    if is_real:
        session.start(None, max(sum(ticks), 1) / session.rate)
    try:
        for step, left in zip(script, ticks, strict=True):
            session.aim(step)
            for start in range(0, left, BLOCK_TICKS):
                length = min(BLOCK_TICKS, left - start)
                done += length
                block = _awaited(session, length) if is_real else session.advance(length / session.rate)
                yield block, done / sum(ticks)
    finally:
        if is_real:
            session.halt()


def _awaited(session: Played, rows: int) -> Columns:
    """So many rows of what runs; fewer where it has ended."""
    blocks = [session.read(rows)]
    while (left := rows - sum(len(block["time"]) for block in blocks)) > 0:
        runs = session.progress.runs  # before the look: what was written until its end is there
        block = session.read(left)
        blocks.append(block)
        if not len(block["time"]):
            if not runs:
                break
            time.sleep(NAP)
    return joined(blocks)
