# SPDX-License-Identifier: BSD-3-Clause
"""A SpaceMouse by hidapi: its cap is pushed over the surface and pressed down. It has no motor."""

from __future__ import annotations

import struct
from typing import Any, Self

from nanotouch.errors import DeviceError, require

from nanotouch_app.live.hands.device import Device, Motion, curved

VENDORS = (0x256F, 0x046D)  # 3Dconnexion, and Logitech before it
AXES = (0x01, 0x08)  # usage page and usage of a multi-axis controller
FULL = 350.0  # of each axis
TRANSLATION, BUTTON_REPORT = 1, 3
BUTTONS = ("press", "retract")
MOST = 64  # reports that are read at a time


class SpaceMouse(Device):
    """Any that hidapi finds; ``device`` is an open ``hid.device``."""

    name = "spacemouse"

    def __init__(self, device: Any) -> None:
        self.device = device
        self.device.set_nonblocking(True)
        self.motion = Motion()
        self.buttons = 0

    @classmethod
    def first(cls) -> Self:
        """The first one; a reason in words where it may not be opened."""
        hid = require("hid", "hands")
        for found in hid.enumerate():
            if found["vendor_id"] in VENDORS and (found["usage_page"], found["usage"]) == AXES:
                device = hid.device()
                try:
                    device.open_path(found["path"])
                except OSError as error:
                    raise DeviceError(f"the SpaceMouse {found['path']!r} does not open: {error}; is it yours to read "
                                      "(udev rules)?") from error  # fmt: skip
                return cls(device)
        raise DeviceError("no SpaceMouse is connected")

    def poll(self) -> Motion:
        """The newest report of each kind; a device that has gone stands still."""
        pressed: list[str] = []
        released: list[str] = []
        for _ in range(MOST):
            try:
                report = bytes(self.device.read(64))
            except (OSError, ValueError):
                self.motion = Motion()
                break
            if not report:
                break
            if report[0] == TRANSLATION and len(report) >= 7:
                x, y, z = struct.unpack_from("<3h", report, 1)
                # its axes: x to the right, y towards the person, z down
                self.motion = Motion(curved(x / FULL), -curved(y / FULL), curved(z / FULL))
            elif report[0] == BUTTON_REPORT and len(report) >= 2:
                for number, name in enumerate(BUTTONS):
                    was, now = self.buttons >> number & 1, report[1] >> number & 1
                    (pressed if now > was else released if was > now else []).append(name)
                self.buttons = report[1]
        return Motion(self.motion.x, self.motion.y, self.motion.down, pressed, released)

    def close(self) -> None:
        """Let go of it."""
        self.device.close()
