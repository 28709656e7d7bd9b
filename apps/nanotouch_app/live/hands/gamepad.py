# SPDX-License-Identifier: BSD-3-Clause
"""A gamepad by SDL: left stick over the surface, right stick up and down; it rumbles with the force."""

from __future__ import annotations

import ctypes
from typing import Any, Self

from nanotouch.errors import DeviceError

from nanotouch_app.live.hands.device import Device, Feel, Motion, curved
from nanotouch_app.live.hands.sdl import load

FULL = 32767.0
RUMBLE = 100  # a rumble ends by itself after this [ms], so that a window that hangs lets go
PULSE = 60  # of a snap or a tear [ms]
BUTTONS = ("press", "retract", "stop", "arm")  # SDL's A, B, X, Y


class Gamepad(Device):
    """One controller that SDL knows."""

    name = "gamepad"

    def __init__(self, index: int) -> None:
        self.sdl: Any = load()
        self.pad = self.sdl.SDL_GameControllerOpen(index)
        if not self.pad:
            raise DeviceError(f"the gamepad does not open: {self.sdl.SDL_GetError().decode()}")
        self.down = [False] * len(BUTTONS)
        self.pulse_until = 0
        self.level = 0

    @classmethod
    def first(cls) -> Self:
        """SDL without its video part, also while another window has the focus."""
        sdl = load()
        sdl.SDL_SetHint(sdl.SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, b"1")
        if sdl.SDL_InitSubSystem(sdl.SDL_INIT_GAMECONTROLLER) != 0:
            raise DeviceError(f"no gamepad: {sdl.SDL_GetError().decode()}")
        sdl.SDL_GameControllerUpdate()
        for index in range(sdl.SDL_NumJoysticks()):
            if sdl.SDL_IsGameController(index):
                return cls(index)
        raise DeviceError("no gamepad is connected")

    def poll(self) -> Motion:
        """Sticks and buttons as they are now."""
        sdl = self.sdl
        sdl.SDL_GameControllerUpdate()
        axis = [curved(sdl.SDL_GameControllerGetAxis(self.pad, one) / FULL)
                for one in (sdl.SDL_CONTROLLER_AXIS_LEFTX, sdl.SDL_CONTROLLER_AXIS_LEFTY,
                            sdl.SDL_CONTROLLER_AXIS_RIGHTY)]  # fmt: skip
        motion = Motion(axis[0], -axis[1], axis[2])
        for number, name in enumerate(BUTTONS):
            now = bool(sdl.SDL_GameControllerGetButton(self.pad, number))
            if now and not self.down[number]:
                motion.pressed.append(name)
            if self.down[number] and not now:
                motion.released.append(name)
            self.down[number] = now
        return motion

    def feel(self, feel: Feel) -> None:
        """The slow motor by the level, the quick one for a snap or a tear. Each call takes the place of the last."""
        now = self.sdl.SDL_GetTicks()
        if feel.event:
            self.pulse_until = now + PULSE
        level = round(0xFFFF * min(max(feel.level, 0.0), 1.0))
        pulse = 0xFFFF if now < self.pulse_until else 0
        if level or pulse or self.level:
            length = RUMBLE if level or pulse else 0
            self.sdl.SDL_GameControllerRumble(self.pad, ctypes.c_uint16(level), ctypes.c_uint16(pulse), length)
        self.level = level or pulse

    def close(self) -> None:
        """It stops rumbling."""
        self.sdl.SDL_GameControllerRumble(self.pad, 0, 0, 0)
        self.sdl.SDL_GameControllerClose(self.pad)
