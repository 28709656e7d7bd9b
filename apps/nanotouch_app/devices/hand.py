# SPDX-License-Identifier: BSD-3-Clause
"""A haptic device that is asked for its place and given its force, once a period: what its module has to write, and
the loop of its bridge. A device that is pulled out is opened again once it is back; meanwhile its last reading grows
old."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, NamedTuple, Protocol

from nanotouch.errors import DeviceError
from nanotouch.touch.hal import Capabilities, Channel, Reading

if TYPE_CHECKING:
    from nanotouch_app.devices.bridge import Box

NOTHING = (0.0, 0.0, 0.0)
"""no force [N]"""
PAUSE = 0.5
"""before a lost device is tried again [s]"""
BEAT = 0.02
"""between two signs of life without a device [s]"""


class State(NamedTuple):
    """Where the hand is."""

    position: tuple[float, float, float]
    """to the right, away from the person, and down, towards the sample; NaN where it has no such axis [m]"""
    buttons: int = 0


class Hand(Protocol):
    """An open device."""

    def read(self) -> State | None:
        """Where it is now; None: nothing new. :class:`DeviceError` where it is lost."""

    def push(self, force: Sequence[float]) -> None:
        """The force on the hand, in the same axes [N]. :class:`DeviceError` where it is lost."""

    def close(self) -> None:
        """No force, and everything given back; it may be lost."""


def capabilities(axes: int, period: float, reach: float, force: float) -> Capabilities:
    """Of a device with motors and no force sensor: places within +- ``reach`` [m], twice that once a calibration has
    moved its middle; forces within +- ``force`` [N]."""
    numbers = range(3) if axes == 3 else (2,)
    reads = [Channel("position", "m", axis=axis, minimum=-2.0 * reach, maximum=2.0 * reach) for axis in numbers]
    drives = [
        Channel("motor force", "N", driven=True, axis=axis, minimum=-force, maximum=force, safe=0.0) for axis in numbers
    ]
    return Capabilities(axes=axes, period=period, pushes=True, channels=[*reads, *drives])


def serve(box: Box, opens: Callable[[], Hand], period: float, stopped: threading.Event) -> None:
    """Between a device and the mailbox, until it is stopped. A device that is not there at first is an error."""
    hand: Hand | None = opens()
    while hand is not None:
        try:
            _poll(hand, box, period, stopped)
        except DeviceError as lost:
            print(f"{lost}: waiting for it", file=sys.stderr, flush=True)
            box.trouble = str(lost)
        finally:
            with suppress(DeviceError):
                hand.close()
        hand = _found_again(box, opens, stopped)


def _poll(hand: Hand, box: Box, period: float, stopped: threading.Event) -> None:
    due = time.monotonic()
    while not stopped.is_set():
        state = hand.read()
        if state is None:
            box.beat()
        else:
            box.publish(Reading(position=state.position, buttons=state.buttons))
        hand.push(NOTHING if state is None else box.ask().target)
        due = max(due + period, time.monotonic())  # what is late is not made up for
        time.sleep(max(0.0, due - time.monotonic()))


def _found_again(box: Box, opens: Callable[[], Hand], stopped: threading.Event) -> Hand | None:
    due = time.monotonic() + PAUSE
    while not stopped.wait(BEAT):
        box.beat()
        if time.monotonic() > due:
            due = time.monotonic() + PAUSE
            with suppress(DeviceError):
                return opens()
    return None
