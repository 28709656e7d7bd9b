# SPDX-License-Identifier: BSD-3-Clause
"""What real rigs this machine could drive: the lines of its GPIO chips."""

from __future__ import annotations

from typing import NamedTuple

from nanotouch import _core
from nanotouch.errors import DeviceError


class GpioLine(NamedTuple):
    """One line of a GPIO chip."""

    chip: str
    offset: int
    name: str
    """empty if the line has none"""
    consumer: str
    """who holds it; empty if it is free"""


def gpio_lines() -> list[GpioLine]:
    """The lines of all chips that may be opened; :class:`~nanotouch.errors.DeviceError` if built without libgpiod."""
    if not hasattr(_core, "gpio_lines"):
        raise DeviceError("built without libgpiod: install libgpiod 2.1 or newer, then install nanotouch again")
    return [GpioLine(*line) for line in _core.gpio_lines()]
