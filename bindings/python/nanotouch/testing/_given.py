# SPDX-License-Identifier: BSD-3-Clause
"""What a check is given must be something that can be checked: nothing passes because there was nothing to see."""

from __future__ import annotations

from typing import SupportsFloat

from nanotouch._io.words import told
from nanotouch.errors import InvalidValue
from nanotouch.touch.record import Recording

TIME = ".9g"  # a period shows, also after hours


def rows_of(recording: Recording, name: str = "recording") -> Recording:
    """`recording`, which has rows."""
    if not len(recording_of(recording, name)):
        raise InvalidValue(f"{name} has no rows, so it shows nothing; a session with recorded=False keeps none")
    return recording


def recording_of(value: object, name: str = "recording") -> Recording:
    if not isinstance(value, Recording):
        raise InvalidValue(
            f"{name}: a {type(value).__name__} is no Recording; nanotouch.Recording(columns, session.metadata()) makes "
            f"one of columns"
        )
    return value


def number(name: str, value: object, unit: str) -> float:
    if isinstance(value, bool | str) or not isinstance(value, SupportsFloat):
        raise InvalidValue(f"{name} = {told(value)}: it must be a number{f' [{unit}]' * bool(unit)}")
    return float(value)
