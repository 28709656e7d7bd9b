# SPDX-License-Identifier: BSD-3-Clause
"""The hands of a window beside its mouse: their motion becomes requests, and what is felt goes back to them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nanotouch.errors import Error

from nanotouch_app.live.hands import Device, Feel
from nanotouch_app.live.hands.sound import Sound

SIDEWAYS = 0.25  # of the surface's width per second at full deflection
DOWN = 40.0  # steps of the wheel per second at full deflection
LONGEST = 0.1  # a window that has been away moves no further than this [s]
Ask = Callable[..., None]


class Held:
    """All hands that are connected, and the sound."""

    def __init__(self, devices: list[Device]) -> None:
        self.devices = devices
        self.sound: Sound | None = None

    @property
    def names(self) -> str:
        """Of what is connected."""
        return ", ".join(device.name for device in self.devices)

    def turn_sound(self) -> None:
        """On and off; an error in words where there is none."""
        if self.sound is None:
            self.sound = Sound()
        else:
            self.sound.close()
            self.sound = None

    def move(self, elapsed: float, width: float, ask: Ask) -> None:
        """What the hands do in a time [s] over a surface of a width [m]."""
        elapsed = min(elapsed, LONGEST)
        for device in self.devices:
            motion = device.poll()
            if motion.x or motion.y:
                reach = SIDEWAYS * width * elapsed
                ask("move", way=(reach * motion.x, reach * motion.y, 0.0))
            if motion.down:
                ask("wheel", steps=DOWN * elapsed * motion.down)
            for name in motion.pressed:
                self._press(name, ask)
            if "press" in motion.released:
                ask("press", on=False)

    @staticmethod
    def _press(name: str, ask: Ask) -> None:
        more: dict[str, Any] = {"on": True} if name == "press" else {}
        ask(name, **more)

    def _all(self) -> list[Device | Sound]:
        return [*self.devices, *([] if self.sound is None else [self.sound])]

    def feel(self, feel: Feel) -> None:
        """Rumble and sound."""
        for one in self._all():
            try:
                one.feel(feel)
            except Error:  # it was pulled out
                continue

    def close(self) -> None:
        """Let go of all."""
        for one in self._all():
            one.close()
