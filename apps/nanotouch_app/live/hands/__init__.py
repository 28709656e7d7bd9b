# SPDX-License-Identifier: BSD-3-Clause
"""Hands beside mouse and keys: a gamepad that rumbles, a SpaceMouse, and sound. Each says how it moves; each is told
what is to be felt, and falls silent where nothing may be felt."""

from __future__ import annotations

from nanotouch.errors import DeviceError, InvalidValue, MissingExtra

from nanotouch_app.live.hands.device import Device as Device
from nanotouch_app.live.hands.device import Feel as Feel
from nanotouch_app.live.hands.device import Motion as Motion
from nanotouch_app.live.hands.gamepad import Gamepad
from nanotouch_app.live.hands.spacemouse import SpaceMouse

KINDS: dict[str, type[Device]] = {"gamepad": Gamepad, "spacemouse": SpaceMouse}


def check_named(name: str) -> None:
    """Refuse a hand that there is none of."""
    if name not in ("auto", "none", *KINDS):
        raise InvalidValue(f"--hand {name}: valid are auto, none, {', '.join(KINDS)}")


def opened(name: str) -> list[Device]:
    """The hand of that name, or an error in words; "auto": those that are there, "none": none."""
    if name == "none":
        return []
    check_named(name)
    if name != "auto":
        return [KINDS[name].first()]
    found = []
    for kind in KINDS.values():
        try:
            found.append(kind.first())
        except (MissingExtra, DeviceError):  # it is not there
            continue
    return found
