# SPDX-License-Identifier: BSD-3-Clause
"""The haptic devices that ``--hand`` knows: a row for each, and a file of its name with what it does.

A new device is one row here and one module with two functions: ``capabilities()`` and ``serve(box, option, stopped)``,
which publishes readings to the mailbox ``box`` and sends its forces to the device until the event ``stopped`` is set.
nanotouch_app.devices.bridge makes a program of it.
"""

from __future__ import annotations

from typing import NamedTuple

from nanotouch.errors import InvalidValue
from nanotouch.scene import Rig
from nanotouch.touch.session import settings_for_path


class Device(NamedTuple):
    """One row."""

    name: str
    """for ``--hand``; its module has this name, too"""
    title: str
    module: str
    """of Python, that its module imports"""
    extra: str
    """of nanotouch, that brings this module"""
    needs: str
    """what beside this extra has to be there, and where to get it"""
    force: float
    """on the hand that a session asks for, at most [N]"""
    period: float
    """between two readings [s]"""
    axes: int
    """1: it leads z alone"""
    travel: float
    """how far from where it begins the hand may go [m]"""

    def lead(self, rig: Rig) -> dict[str, float]:
        """Make it the master of a rig: without a gauge, with its axes, rate, travel and force. The gains with which a
        hand goes as far as with the master of the rig as it was; its own travel is far more than a hand uses."""
        alpha_p = float(settings_for_path(rig).gains.alpha_p)
        rig["master.gauge"], rig["master.axes"] = "no", self.axes
        rig["master.rate"], rig["master.max_force"] = 1.0 / self.period, self.force
        rig["master.travel"] = self.travel
        return {"alpha_p": alpha_p}


ROWS = (
    Device(
        "inverse3", "Haply Inverse3", "aiohttp", "browser",
        "Haply's Inverse Service must run: install it from Haply's download page (develop.haply.co), start it, connect "
        "the device and calibrate it there", 3.0, 1e-3, 3, 0.4,
    ),
    Device(
        "forcedimension", "Force Dimension", "forcedimension_core", "forcedimension",
        "The maker's SDK 3.16 or newer must be there (www.forcedimension.com/software/sdk; the environment variable "
        "FDSDK names its folder), the device connected and switched on, and yours to open (on Linux a udev rule)",
        5.0, 1e-3, 3, 0.5,
    ),
    Device(
        "geomagic", "3D Systems Touch", "pyOpenHaptics", "geomagic",
        "OpenHaptics and the Touch Device Driver must be there (3D Systems' support pages), and the device set up by "
        "the maker's Touch Setup under this name", 2.0, 1e-3, 3, 0.6,
    ),
    Device(
        "wheel", "wheel with force feedback", "evdev", "wheel",
        "Linux shows such a device as /dev/input/event*: connect it, and be allowed to write to it (group input)",
        5.0, 8e-3, 1, 2.6,
    ),
)  # fmt: skip
DEVICES = {row.name: row for row in ROWS}


def named(name: str) -> Device:
    """The row of a device."""
    if name not in DEVICES:
        raise InvalidValue(f"device {name!r}: valid are {', '.join(DEVICES)}")
    return DEVICES[name]
