# SPDX-License-Identifier: BSD-3-Clause
"""The device on the desk, for the mocks of the makers' libraries: a handle with mass, weight and friction, a hand that
holds it, and a motor. It lies in a file that processes share, so that it goes on, with the last force, when the program
that has it open is killed; and so that a test is the hand.

Everything is in the device's own axes and in SI units.
"""

from __future__ import annotations

import math
import mmap
import os
import struct
import time
from pathlib import Path

NAMES = (
    "x", "y", "z", "vx", "vy", "vz",
    "fx", "fy", "fz", "forced",  # the motor's force, and when it was set
    "stepped",
    "tx", "ty", "tz", "stiffness", "damping",  # the hand
    "mass", "gx", "gy", "gz", "friction",  # the handle: its weight as a force
    "px", "py", "pz",  # what the device pushes by itself
    "watchdog",  # the firmware lets go without a new force for so long; 0: it has none
    "buttons", "present", "garbage", "stall", "opened", "moved",
    "gain", "autocenter",  # of a wheel's driver
)  # fmt: skip
FORMAT = f"{len(NAMES)}d"
TARGET, HELD, MASS, GRAVITY, FRICTION, OWN = map(NAMES.index, ("tx", "stiffness", "mass", "gx", "friction", "px"))
STEP, LONGEST = 1e-3, 0.02  # of the motion, and what is made up for at most [s]


class Desk:
    """What lies in the file; each name is an attribute."""

    def __init__(self, path: str | os.PathLike[str] | None = None) -> None:
        path = Path(path or os.environ["NANOTOUCH_DESK"])
        if not path.exists():
            path.write_bytes(bytes(8 * len(NAMES)))
        with open(path, "r+b") as file:
            object.__setattr__(self, "memory", mmap.mmap(file.fileno(), 8 * len(NAMES)))

    @classmethod
    def new(cls, path: str | os.PathLike[str], **values: float) -> Desk:
        """A device that is plugged in, held loosely in the middle."""
        desk = cls(path)
        usual = {"present": 1.0, "mass": 0.2, "stiffness": 300.0, "damping": 6.0, "gain": 1.0}
        usual["stepped"] = time.monotonic()
        for name, value in (usual | values).items():
            setattr(desk, name, value)
        return desk

    def __getattr__(self, name: str) -> float:
        return float(struct.unpack_from("d", self.memory, 8 * NAMES.index(name))[0])

    def __setattr__(self, name: str, value: float) -> None:
        struct.pack_into("d", self.memory, 8 * NAMES.index(name), value)

    def motor(self) -> tuple[float, float, float]:
        """What the motor does now."""
        if self.watchdog and time.monotonic() - self.forced > self.watchdog:
            return 0.0, 0.0, 0.0
        return self.fx, self.fy, self.fz

    def force(self, x: float, y: float, z: float) -> None:
        """Set the motor."""
        self.fx, self.fy, self.fz, self.forced = x, y, z, time.monotonic()

    def move(self) -> None:
        """Let the handle go on until now."""
        now = time.monotonic()
        left = min(now - self.stepped, LONGEST)
        values = list(struct.unpack_from(FORMAT, self.memory))
        motor = self.motor()
        while left > 0.0:
            step = min(left, STEP)
            left -= step
            for axis in range(3):
                _step(values, axis, motor[axis], step)
        struct.pack_into("6d", self.memory, 0, *values[:6])  # the rest belongs to others
        self.stepped = now
        self.moved += 1.0


def _step(values: list[float], axis: int, motor: float, step: float) -> None:
    place, speed = values[axis], values[3 + axis]
    force = motor + values[GRAVITY + axis] + values[OWN + axis]
    force += values[HELD] * (values[TARGET + axis] - place) - values[HELD + 1] * speed
    impulse, most = force * step + values[MASS] * speed, values[FRICTION] * step
    speed = 0.0 if abs(impulse) <= most else (impulse - math.copysign(most, impulse)) / values[MASS]
    values[axis], values[3 + axis] = place + speed * step, speed
