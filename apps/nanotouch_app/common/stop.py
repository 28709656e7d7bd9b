# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C, SIGTERM and SIGHUP end a command in order: one line, and the exit status 128 + the signal's number."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

NUMBERS = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


class Stopped(KeyboardInterrupt):
    """A signal has asked the command to end; `kept` says what is left of its work."""

    def __init__(self, number: int, kept: str = "") -> None:
        super().__init__(f"stopped by {signal.Signals(number).name}" + (f"; {kept}" if kept else ""))
        self.number = number


@contextmanager
def on_signals() -> Iterator[None]:
    """Raise :class:`Stopped` when a signal comes."""

    def stop(number: int, _: FrameType | None) -> None:
        raise Stopped(number)

    with _handled(stop):
        yield


@contextmanager
def keeping(what: str, place: object) -> Iterator[None]:
    """Say where what is done already is kept, if a signal ends what follows."""
    try:
        yield
    except Stopped as stopped:
        raise Stopped(stopped.number, f"{what} in {place}") from None


@contextmanager
def asked() -> Iterator[list[int]]:
    """The signals that came, for what ends by itself and keeps what it has. A second one does not wait."""
    came: list[int] = []

    def note(number: int, _: FrameType | None) -> None:
        came.append(number)
        if len(came) > 1:
            raise Stopped(number)

    with _handled(note):
        yield came


@contextmanager
def between_blocks() -> Iterator[Callable[[], None]]:
    """Hold a signal back until the function is called that this yields, so that no block is lost half-way."""
    with asked() as came:

        def check() -> None:
            if came:
                raise Stopped(came[0])

        yield check
        check()


@contextmanager
def _handled(handler: Callable[[int, FrameType | None], None]) -> Iterator[None]:
    """Handle the signals by this, and as before after it. What is ignored (nohup) stays so; threads get none."""
    before: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():
        before = {n: signal.getsignal(n) for n in NUMBERS if signal.getsignal(n) is not signal.SIG_IGN}
    try:
        for number in before:
            signal.signal(number, handler)
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)
