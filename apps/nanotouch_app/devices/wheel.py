# SPDX-License-Identifier: BSD-3-Clause
"""A steering wheel with force feedback, by Linux' evdev: turned clockwise the tip goes down, and the force is felt at
the rim. A pad or joystick with constant forces on its first axis works as well.

The kernel plays a force for LENGTH and then lets go; it lets go, too, when the program that has sent it is gone.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from nanotouch.errors import DeviceError, require
from nanotouch.touch.hal import Capabilities

from nanotouch_app.devices import hand

if TYPE_CHECKING:
    from nanotouch_app.devices.bridge import Box

PERIOD = 8e-3  # of its reports and forces [s]
RIM = 0.14  # radius of the wheel [m]
TURN = math.radians(900.0)  # from stop to stop
TORQUE = 2.0  # of a full force; makers state 2 to 8 [N m]
REACH = 0.6 * RIM * TURN  # [m]
STRONGEST = TORQUE / RIM  # at the rim [N]
LENGTH = 60  # that the kernel plays a force for [ms]
FULL, WHOLE = 0x7FFF, 0xFFFF  # of a force; of the gain
LEFT, RIGHT = 0x4000, 0xC000  # where Linux lets a force pull to


def capabilities() -> Capabilities:
    """z alone, with a motor."""
    return hand.capabilities(1, PERIOD, REACH, STRONGEST)


class Wheel:
    """One open device; ``option`` is its file, "": the first one with constant forces."""

    def __init__(self, option: str) -> None:
        self.evdev = require("evdev", "wheel")
        self.device = self._opened(option)
        self.codes = self.evdev.ecodes
        info = self.device.absinfo(self.codes.ABS_X)
        self.middle, self.scale = 0.5 * (info.max + info.min), RIM * TURN / max(1, info.max - info.min)
        self.effect = -1
        self._alone()

    def _alone(self) -> None:
        """No spring of its driver pulls it to its middle, and a force is played whole."""
        offered = self.device.capabilities(absinfo=False)[self.codes.EV_FF]
        for code, value in ((self.codes.FF_AUTOCENTER, 0), (self.codes.FF_GAIN, WHOLE)):
            if code in offered:
                self.device.write(self.codes.EV_FF, code, value)

    def _opened(self, option: str) -> Any:
        codes, denied = self.evdev.ecodes, []
        for path in [option] if option else self.evdev.list_devices(writable=False):
            try:
                device = self.evdev.InputDevice(path)
            except OSError as error:
                denied.append(f"{path}: {error.strerror or error}")
                continue
            has = device.capabilities(absinfo=False)
            if codes.FF_CONSTANT in has.get(codes.EV_FF, []) and codes.ABS_X in has.get(codes.EV_ABS, []):
                return device
            device.close()
        why = f"; {denied[0]}: is it yours to read and write (group input, or a udev rule)?" if denied else ""
        raise DeviceError(f"no wheel, pad or joystick with constant forces is connected{why}")

    def read(self) -> hand.State | None:
        """How far it is turned."""
        try:
            value = self.device.absinfo(self.codes.ABS_X).value
            keys = self.device.active_keys()
        except OSError as error:
            raise DeviceError(f"the wheel is lost: {error.strerror or error}") from error
        buttons = sum(1 << (key - self.codes.BTN_JOYSTICK) for key in keys if 0 <= key - self.codes.BTN_JOYSTICK < 16)
        return hand.State((math.nan, math.nan, self.scale * (value - self.middle)), buttons)

    def push(self, force: Sequence[float]) -> None:
        """The force at the rim, played anew."""
        share = max(-1.0, min(1.0, force[2] / STRONGEST))
        ff = self.evdev.ff
        constant = ff.EffectType(ff_constant_effect=ff.Constant(round(FULL * abs(share)), ff.Envelope(0, 0, 0, 0)))
        effect = ff.Effect(self.codes.FF_CONSTANT, self.effect, RIGHT if share > 0.0 else LEFT,
                           ff.Trigger(0, 0), ff.Replay(LENGTH, 0), constant)  # fmt: skip
        try:
            self.effect = self.device.upload_effect(effect)
            self.device.write(self.codes.EV_FF, self.effect, 1)
        except OSError as error:
            raise DeviceError(f"the wheel takes no force: {error.strerror or error}") from error

    def close(self) -> None:
        """No force."""
        try:
            if self.effect >= 0:
                self.device.erase_effect(self.effect)
            self.device.close()
        except OSError as error:
            raise DeviceError(f"the wheel is lost: {error.strerror or error}") from error


def serve(box: Box, option: str, stopped: threading.Event) -> None:
    """For nanotouch_app.devices.bridge."""
    hand.serve(box, lambda: Wheel(option), PERIOD, stopped)
