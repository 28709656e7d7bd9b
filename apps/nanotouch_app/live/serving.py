# SPDX-License-Identifier: BSD-3-Clause
"""The loop of the process that holds the session, the same for a window and for pages."""

from __future__ import annotations

import queue
import time
from typing import Any, Protocol

from nanotouch_app.live.host import Host

TURN = 0.005  # of the loop [s]
CLOCK = 0.2  # between two reports of the clock [s]


class FrontEnd(Protocol):
    """What shows a session and asks of it."""

    asked: queue.Queue[dict[str, Any]]

    def tell(self, message: dict[str, Any]) -> None:
        """Never waits."""


def serve(front: FrontEnd, host: Host, first: dict[str, Any] | None = None, until: float | None = None) -> None:
    """What is asked, what happens by itself, the clock: until the person leaves, or a time of the monotonic clock.
    ``first`` is asked at once."""
    if first is not None:
        host.answer(first)
    due = 0.0
    while until is None or time.monotonic() < until:
        try:
            message = front.asked.get(timeout=TURN)
            while True:
                if not host.answer(message):
                    return
                message = front.asked.get_nowait()
        except queue.Empty:
            pass
        host.tick()
        if time.monotonic() > due:
            due = time.monotonic() + CLOCK
            front.tell(host.clock())
