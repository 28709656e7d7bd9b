# SPDX-License-Identifier: BSD-3-Clause
"""Gamepad, SpaceMouse and sound through their real adapters: SDL's virtual joystick, hidapi's reports, a buffer."""

from __future__ import annotations

import ctypes
import struct
import sys
from collections.abc import Iterator
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.errors import DeviceError, InvalidValue, MissingExtra
from nanotouch_app.live import hands
from nanotouch_app.live.hands import Feel, sound
from nanotouch_app.live.hands.device import DEAD, curved
from nanotouch_app.live.hands.gamepad import Gamepad
from nanotouch_app.live.hands.sdl import load
from nanotouch_app.live.hands.spacemouse import SpaceMouse


def loaded() -> Any:
    try:
        return load()
    except MissingExtra as missing:
        pytest.skip(str(missing))


class Virtual:
    """A gamepad that SDL simulates; what it is told to rumble."""

    def __init__(self, sdl: Any) -> None:
        self.sdl = sdl
        self.rumbled: list[tuple[int, int]] = []

        def rumble(_: Any, low: int, high: int) -> int:
            self.rumbled.append((low, high))
            return 0

        description = sdl.SDL_VirtualJoystickDesc()
        description.version = sdl.SDL_VIRTUAL_JOYSTICK_DESC_VERSION
        description.type, description.naxes, description.nbuttons = sdl.SDL_JOYSTICK_TYPE_GAMECONTROLLER, 6, 15
        kind = dict(sdl.SDL_VirtualJoystickDesc._fields_)["Rumble"]
        self.kept = kind(rumble)
        description.Rumble = self.kept
        self.index = sdl.SDL_JoystickAttachVirtualEx(ctypes.byref(description))
        assert self.index >= 0, sdl.SDL_GetError()

    def set(self, pad: Gamepad, axes: dict[int, int], buttons: dict[int, int]) -> None:
        stick = self.sdl.SDL_GameControllerGetJoystick(pad.pad)
        for axis, value in axes.items():
            self.sdl.SDL_JoystickSetVirtualAxis(stick, axis, value)
        for button, value in buttons.items():
            self.sdl.SDL_JoystickSetVirtualButton(stick, button, value)


@pytest.fixture
def virtual(monkeypatch: pytest.MonkeyPatch) -> Iterator[Virtual]:
    sdl = loaded()
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    sdl.SDL_InitSubSystem(sdl.SDL_INIT_GAMECONTROLLER)
    made = Virtual(sdl)
    yield made
    sdl.SDL_JoystickDetachVirtual(made.index)
    sdl.SDL_QuitSubSystem(sdl.SDL_INIT_GAMECONTROLLER)


def test_a_gamepad_moves_presses_and_rumbles(virtual: Virtual) -> None:
    pad = hands.opened("gamepad")[0]
    assert isinstance(pad, Gamepad)
    virtual.set(pad, {0: 32767, 1: -32768, 3: 16384}, {0: 1})
    moved = pad.poll()
    assert (moved.x, moved.y) == (pytest.approx(1.0), pytest.approx(1.0))
    assert 0.0 < moved.down < 0.5
    assert moved.pressed == ["press"]
    assert pad.poll().pressed == []
    virtual.set(pad, {0: 1000, 1: 0, 3: 0}, {0: 0})
    still = pad.poll()
    assert (still.x, still.released) == (0.0, ["press"])
    pad.feel(Feel(0.5))
    assert virtual.rumbled[-1][0] == pytest.approx(0x8000, abs=1)
    pad.feel(Feel(0.5, "snap"))
    assert virtual.rumbled[-1][1] == 0xFFFF
    pad.pulse_until = 0
    pad.feel(Feel(0.0))
    assert virtual.rumbled[-1] == (0, 0)
    pad.close()


class Reports:
    """hidapi's device, from memory."""

    def __init__(self, *reports: bytes) -> None:
        self.reports = list(reports)
        self.closed = False

    def set_nonblocking(self, on: bool) -> None:
        assert on

    def read(self, size: int) -> list[int]:
        if self.closed:
            raise OSError("read error")
        return list(self.reports.pop(0)[:size]) if self.reports else []

    def close(self) -> None:
        self.closed = True


def test_a_spacemouse_is_read() -> None:
    device = Reports(
        b"\x01" + struct.pack("<3h", 350, -350, 175), b"\x02" + bytes(6), b"\x03\x01\x00", b"\x03\x02\x00", b"\x01\x00"
    )
    mouse = SpaceMouse(device)
    moved = mouse.poll()
    assert (moved.x, moved.y) == (pytest.approx(1.0), pytest.approx(1.0))
    assert 0.0 < moved.down < 0.5
    assert (moved.pressed, moved.released) == (["press", "retract"], ["press"])
    assert mouse.poll().x == pytest.approx(1.0)  # it reports changes only
    device.closed = True
    assert mouse.poll().x == 0.0  # pulled out


def test_a_spacemouse_that_may_not_be_opened_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    hid = pytest.importorskip("hid")
    found = {"vendor_id": 0x256F, "usage_page": 1, "usage": 8, "path": b"/dev/hidraw99"}
    monkeypatch.setattr(hid, "enumerate", lambda: [found])
    with pytest.raises(DeviceError, match="udev"):
        hands.opened("spacemouse")
    monkeypatch.setattr(hid, "enumerate", list)
    with pytest.raises(DeviceError, match="no SpaceMouse is connected"):
        hands.opened("spacemouse")


@pytest.mark.parametrize(("name", "module"), [("gamepad", "sdl2"), ("spacemouse", "hid")])
def test_a_missing_extra_is_named(name: str, module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtra, match="extra hands"):
        hands.opened(name)
    assert all(device.name != name for device in hands.opened("auto"))
    with pytest.raises(InvalidValue, match="valid are auto, none, gamepad, spacemouse"):
        hands.opened("foot")
    assert hands.opened("none") == []


def test_a_stick_is_still_in_the_middle_and_fine_beside_it() -> None:
    assert curved(0.5 * DEAD) == 0.0
    assert curved(1.0) == pytest.approx(1.0)
    assert curved(-0.5) == pytest.approx(-curved(0.5))
    assert curved(0.3) < 0.3


def pitch(samples: Any) -> float:
    spectrum = np.abs(np.fft.rfft(samples * np.hanning(len(samples))))
    return float(np.argmax(spectrum) * sound.RATE / len(samples))


def test_pitch_follows_the_force_over_two_octaves() -> None:
    synth = sound.Synth()
    for level, wanted in ((0.25, 311.1), (0.5, 440.0), (1.0, 880.0)):
        synth.render(4410, Feel(level))
        samples = synth.render(44_100, Feel(level))
        assert pitch(samples.astype(float)) == pytest.approx(wanted, abs=1.5)
        assert np.abs(samples).max() == pytest.approx(32767 * sound.LOUDNESS * level**0.5, rel=0.02)


def test_what_may_not_be_felt_is_silent_and_clicks_are_heard() -> None:
    synth = sound.Synth()
    assert not synth.render(1000, Feel(0.0)).any()
    synth.render(4410, Feel(0.8))
    assert not synth.render(8820, Feel(0.0))[-4410:].any()  # it ends
    for event in ("snap", "tear"):
        click = synth.render(4410, Feel(0.0, event)).astype(float)
        assert np.abs(click).max() > 0.3 * 32767
        assert not click[-1000:].any()
        assert pitch(click) == pytest.approx(sound.CLICKS[event], rel=0.1)


def test_the_tone_has_no_step_between_two_pieces() -> None:
    synth = sound.Synth()
    pieces = [synth.render(441, Feel(0.5)) for _ in range(20)]
    joined = np.concatenate(pieces).astype(float)
    assert np.abs(np.diff(joined)).max() < 1.1 * 2 * np.pi * 440 / sound.RATE * 32767 * sound.LOUDNESS


def test_a_loudspeaker_is_kept_filled(monkeypatch: pytest.MonkeyPatch) -> None:
    sdl = loaded()
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    speaker = sound.Sound()
    speaker.feel(Feel(0.5))
    waiting = sdl.SDL_GetQueuedAudioSize(speaker.device)
    assert 0 < waiting <= 2 * round(sound.AHEAD * sound.RATE)
    speaker.close()
    sdl.SDL_QuitSubSystem(sdl.SDL_INIT_AUDIO)
    assert issubclass(nt.errors.MissingExtra, nt.Error)
