# SPDX-License-Identifier: BSD-3-Clause
"""Force Dimension's devices (omega, delta, sigma, lambda) by forcedimension-core, which loads the maker's SDK.

Its axes: x towards the person, y to the right, z up. Where the device has a watchdog it is set, so that its own
firmware lets go when forces stay away: of a bridge that was killed, or stopped.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from nanotouch.errors import DeviceError
from nanotouch.touch.hal import Capabilities

from nanotouch_app.devices import hand

if TYPE_CHECKING:
    from nanotouch_app.devices.bridge import Box

PERIOD = 1e-3  # [s]
REACH = 0.25  # along an axis, of the largest one [m]
STRONGEST = 8.0  # along an axis; less than each model has [N]
WATCHDOG = 160  # without a force the firmware lets go: 20 ms, in its steps of 125 us
LINK = "https://www.forcedimension.com/software/sdk"


def capabilities() -> Capabilities:
    """Three axes with motors."""
    return hand.capabilities(3, PERIOD, REACH, STRONGEST)


class ForceDimension:
    """One open device; ``option`` is its number, "": the first one."""

    def __init__(self, option: str) -> None:
        self.dhd = _dhd()
        self.id = self.dhd.open() if option == "" else self.dhd.openID(_number(option))
        if self.id == -1:
            raise DeviceError(f"no Force Dimension device opens: {self.dhd.errorGetLastStr()}")
        self.place = [0.0, 0.0, 0.0]
        self.dhd.expert.enableExpertMode()
        self.has_watchdog = self.dhd.expert.setWatchdog(WATCHDOG, ID=self.id) == 0
        if self.dhd.enableForce(True, ID=self.id) == -1:
            self.close()
            raise self._lost("its motors do not go on")

    def _lost(self, what: str) -> DeviceError:
        return DeviceError(f"Force Dimension: {what}: {self.dhd.errorGetLastStr()}")

    def read(self) -> hand.State | None:
        """Its place and buttons."""
        if self.dhd.getPosition(self.place, ID=self.id) == -1:
            raise self._lost("it gives no position")
        x, y, z = self.place
        if not all(math.isfinite(value) and abs(value) <= REACH for value in self.place):
            return None
        return hand.State((y, -x, -z), self.dhd.getButtonMask(ID=self.id))

    def push(self, force: Sequence[float]) -> None:
        """Set the force."""
        right, away, down = force
        if self.dhd.setForce((-away, right, -down), ID=self.id) == -1:
            raise self._lost("it takes no force")

    def close(self) -> None:
        """Stop it: no force, brakes on."""
        self.dhd.setForce((0.0, 0.0, 0.0), ID=self.id)
        self.dhd.stop(ID=self.id)
        self.dhd.close(ID=self.id)


def _number(option: str) -> int:
    if not option.isdecimal():
        raise DeviceError(f"Force Dimension: {option!r} is no number of a device: 0 is the first one")
    return int(option)


def _dhd() -> Any:
    try:
        from forcedimension_core import dhd
    except ImportError as error:  # the package is there: nanotouch_app.devices.bridge has looked
        raise DeviceError(f"the Force Dimension SDK is not found ({error})") from error
    return dhd


def serve(box: Box, option: str, stopped: threading.Event) -> None:
    """For nanotouch_app.devices.bridge."""
    hand.serve(box, lambda: ForceDimension(option), PERIOD, stopped)
