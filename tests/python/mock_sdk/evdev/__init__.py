# SPDX-License-Identifier: BSD-3-Clause
"""A mock of python-evdev, after its documentation and the kernel's: what a bridge calls of it, over a device on the
desk, whose x is the rim of the wheel."""

import math
import os
from typing import NamedTuple

from desk import Desk

from . import ecodes as ecodes
from . import ff as ff

TUNED = [ecodes.FF_GAIN, ecodes.FF_AUTOCENTER]  # not every driver has them
PATH, SCALE = "/dev/input/event7", 65535 / (0.14 * math.radians(900.0))


class AbsInfo(NamedTuple):
    value: int
    min: int
    max: int
    fuzz: int
    flat: int
    resolution: int


def list_devices(input_device_dir="/dev/input", writable=True):
    return [PATH] if Desk().present == 1.0 else []


class InputDevice:
    def __init__(self, dev):
        self.desk = Desk()
        if os.environ.get("NANOTOUCH_MOCK") == "denied":
            raise PermissionError(13, "Permission denied")
        if self.desk.present != 1.0:
            raise FileNotFoundError(2, "No such file or directory")
        self.effects = {}

    def capabilities(self, verbose=False, absinfo=True):
        return {
            ecodes.EV_ABS: [ecodes.ABS_X],
            ecodes.EV_FF: [ecodes.FF_CONSTANT, *TUNED],
            ecodes.EV_KEY: [ecodes.BTN_JOYSTICK],
        }

    def _check(self):
        if self.desk.present != 1.0:
            raise OSError(19, "No such device")

    def absinfo(self, axis_num):
        self._check()
        if self.desk.stall != 1.0:
            self.desk.px = -100.0 * self.desk.autocenter * self.desk.x
            self.desk.move()
        return AbsInfo(round(32767.5 + SCALE * self.desk.x), 0, 65535, 0, 0, 0)

    def active_keys(self, verbose=False):
        return [ecodes.BTN_JOYSTICK] if self.desk.buttons else []

    def upload_effect(self, effect, writeback_id=True):
        self._check()
        assert effect.type == ecodes.FF_CONSTANT
        number = effect.id if effect.id >= 0 else len(self.effects)
        self.effects[number] = effect
        return number

    def write(self, etype, code, value):
        """An effect pulls to where its direction says, and ends by itself."""
        self._check()
        if code in TUNED:
            setattr(self.desk, "gain" if code == ecodes.FF_GAIN else "autocenter", value / 0xFFFF)
            return
        effect = self.effects[code]
        level = effect.u.ff_constant_effect.level / 0x7FFF
        to = {0x4000: -1.0, 0xC000: 1.0}[effect.direction]
        self.desk.watchdog = effect.ff_replay.length * 1e-3  # the kernel's timer
        self.desk.force(to * level * self.desk.gain * value * 2.0 / 0.14, 0.0, 0.0)

    def erase_effect(self, ff_id):
        self._check()
        self.effects.pop(ff_id)
        self.desk.force(0.0, 0.0, 0.0)

    def close(self):
        pass
