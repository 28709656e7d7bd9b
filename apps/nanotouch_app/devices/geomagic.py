# SPDX-License-Identifier: BSD-3-Clause
"""3D Systems' Touch (Geomagic Touch, Phantom Omni) by pyopenhaptics, which loads OpenHaptics' libHD.

The maker's scheduler calls us a thousand times a second in a thread of its own; force and place are handed over to it.
A force that is older than FRESH is none. Its axes: x to the right, y up, z towards the person, in millimetres.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from nanotouch.errors import DeviceError
from nanotouch.touch.hal import Capabilities

from nanotouch_app.devices import hand

if TYPE_CHECKING:
    from nanotouch_app.devices.bridge import Box

PERIOD = 1e-3  # [s]
REACH = 0.3  # along an axis [m]
STRONGEST = 3.3  # the maker's maximum, near the middle [N]
FRESH = 0.02  # [s]
SILENT = 0.5  # without a call of the scheduler the device is lost [s]
MILLIMETRE = 1e-3  # [m]


def capabilities() -> Capabilities:
    """Three axes with motors."""
    return hand.capabilities(3, PERIOD, REACH, STRONGEST)


class Touch:
    """One open device; ``option`` is its name in the maker's setup."""

    def __init__(self, option: str) -> None:
        self.hd, decorator, schedule = _openhaptics()
        self.id = self.hd.init_device(option or "Default Device")
        if self.id is None:
            raise DeviceError(f"no Touch opens under the name {option or 'Default Device'!r}")
        self.force = (0.0, 0.0, 0.0)
        self.asked = self.called = time.monotonic()
        self.place: tuple[float, float, float] | None = None
        self.buttons = self.calls = self.seen = 0
        self.callback = decorator(self._turn)  # kept: the maker's thread calls it
        self.hd.enable_force()
        self.hd.start_scheduler()
        schedule(self.callback)

    def _turn(self) -> None:
        """In the maker's thread."""
        now = time.monotonic()
        transform = self.hd.get_transform()
        self.place = tuple(MILLIMETRE * float(transform[3][axis]) for axis in range(3))  # type: ignore[assignment]
        self.buttons = int(self.hd.get_buttons())
        right, away, down = self.force if now - self.asked < FRESH else (0.0, 0.0, 0.0)
        self.hd.set_force([right, -down, -away])
        self.called, self.calls = now, self.calls + 1

    def read(self) -> hand.State | None:
        """What the scheduler's last call has left; None if there was none since."""
        if time.monotonic() - self.called > SILENT:
            raise DeviceError("Touch: its scheduler has stopped")
        place, calls = self.place, self.calls
        if place is None or calls == self.seen:
            return None
        self.seen = calls
        x, y, z = place
        if not all(math.isfinite(value) and abs(value) <= REACH for value in place):
            return None
        return hand.State((x, -z, -y), self.buttons)

    def push(self, force: Sequence[float]) -> None:
        """For the scheduler's next calls."""
        right, away, down = force
        self.force, self.asked = (right, away, down), time.monotonic()

    def close(self) -> None:
        """No force; the scheduler ends."""
        self.force = (0.0, 0.0, 0.0)
        calls, end = self.calls, time.monotonic() + FRESH
        while self.calls < calls + 2 and time.monotonic() < end:  # it has said so to the device
            time.sleep(PERIOD)
        self.hd.stop_scheduler()
        self.hd.close_device(self.id)


def _openhaptics() -> tuple[Any, Any, Any]:
    try:
        from pyOpenHaptics import hd
        from pyOpenHaptics.hd_callback import hd_callback, hdAsyncSheduler
    except (ImportError, OSError) as error:  # the package loads libHD.so
        raise DeviceError(f"OpenHaptics is not found ({error})") from error
    return hd, hd_callback, hdAsyncSheduler


def serve(box: Box, option: str, stopped: threading.Event) -> None:
    """For nanotouch_app.devices.bridge."""
    hand.serve(box, lambda: Touch(option), PERIOD, stopped)
