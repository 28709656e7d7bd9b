# SPDX-License-Identifier: BSD-3-Clause
"""Sound: the pitch follows the force over two octaves; a snap and a tear click. Rendered by numpy, played by SDL."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from nanotouch.errors import DeviceError
from numpy.typing import NDArray

from nanotouch_app.live.hands.device import Feel
from nanotouch_app.live.hands.sdl import load

RATE = 44_100  # [Hz]
LOWEST, OCTAVES = 220.0, 2.0  # pitch at no force [Hz], and how far it rises
LOUDNESS, CLICK = 0.25, 0.6  # of full scale
CLICK_TIME = 0.03  # [s]
CLICKS = {"snap": 2500.0, "tear": 900.0}  # pitch [Hz]
AHEAD = 0.08  # so much is rendered before it is heard [s]
SLOPE = 400.0  # loudness changes by no more than this per second, so that it does not crackle [1/s]


class Synth:
    """Makes samples; a tone that goes on without a step, and clicks over it."""

    def __init__(self) -> None:
        self.phase = self.loudness = 0.0
        self.click: NDArray[np.float64] = np.zeros(0)

    def render(self, count: int, feel: Feel) -> NDArray[np.int16]:
        """So many samples of what is felt now; silence at level 0, but for what still clicks."""
        level = min(max(feel.level, 0.0), 1.0)
        pitch = LOWEST * 2.0 ** (OCTAVES * level)
        phases = self.phase + 2.0 * math.pi * pitch / RATE * np.arange(1, count + 1)
        wanted = LOUDNESS * math.sqrt(level)
        steps = np.clip(wanted - self.loudness, -SLOPE / RATE * np.arange(1, count + 1),
                        SLOPE / RATE * np.arange(1, count + 1))  # fmt: skip
        loudness = self.loudness + steps
        if count:
            self.phase, self.loudness = float(phases[-1] % (2.0 * math.pi)), float(loudness[-1])
        if feel.event:
            self.click = self._clicked(CLICKS[feel.event])
        samples = loudness * np.sin(phases)
        part = self.click[:count]
        samples[: len(part)] += part
        self.click = self.click[len(part) :]
        return np.asarray(np.round(32767.0 * np.clip(samples, -1.0, 1.0)), dtype=np.int16)

    @staticmethod
    def _clicked(pitch: float) -> NDArray[np.float64]:
        time = np.arange(round(CLICK_TIME * RATE)) / RATE
        return CLICK * np.exp(-time / (0.2 * CLICK_TIME)) * np.sin(2.0 * math.pi * pitch * time)


class Sound:
    """The default loudspeaker."""

    def __init__(self) -> None:
        self.sdl: Any = load()
        if self.sdl.SDL_InitSubSystem(self.sdl.SDL_INIT_AUDIO) != 0:
            raise DeviceError(f"no sound: {self.sdl.SDL_GetError().decode()}")
        wanted = self.sdl.SDL_AudioSpec(RATE, self.sdl.AUDIO_S16SYS, 1, 1024)
        self.device = self.sdl.SDL_OpenAudioDevice(None, 0, wanted, None, 0)
        if not self.device:
            raise DeviceError(f"no sound: {self.sdl.SDL_GetError().decode()}")
        self.sdl.SDL_PauseAudioDevice(self.device, 0)
        self.synth = Synth()

    def feel(self, feel: Feel) -> None:
        """Fill up what will be heard next."""
        waiting = self.sdl.SDL_GetQueuedAudioSize(self.device) // 2
        samples = self.synth.render(max(0, round(AHEAD * RATE) - waiting), feel)
        if len(samples):
            data = samples.tobytes()
            self.sdl.SDL_QueueAudio(self.device, data, len(data))

    def close(self) -> None:
        """Silence."""
        self.sdl.SDL_CloseAudioDevice(self.device)
