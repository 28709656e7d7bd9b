# SPDX-License-Identifier: BSD-3-Clause
"""What every hand does."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Self

DEAD = 0.12  # of a stick's full way: nothing


@dataclass
class Motion:
    """How the hand moves now, each axis -1 .. 1; and the buttons that have been pressed or let go since."""

    x: float = 0.0
    """to the right"""
    y: float = 0.0
    """away from the person"""
    down: float = 0.0
    pressed: list[str] = field(default_factory=list)
    """requests of the keyboard's table: press, retract, arm, stop"""
    released: list[str] = field(default_factory=list)


@dataclass
class Feel:
    """What is to be felt."""

    level: float = 0.0
    """|force| over the largest planned one, 0 .. 1; 0 where nothing may be felt"""
    event: str = ""
    """snap or tear, once"""


class Device:
    """Opened by :meth:`first`."""

    name = ""

    @classmethod
    def first(cls) -> Self:
        """The first one that is connected; :class:`DeviceError` where there is none."""
        raise NotImplementedError

    def poll(self) -> Motion:
        """How it moves now."""
        raise NotImplementedError

    def feel(self, feel: Feel) -> None:
        """Let it be felt; nothing where it cannot."""

    def close(self) -> None:
        """Let go of it."""


def curved(value: float) -> float:
    """A stick's place, -1 .. 1: nothing near the middle, fine beside it, all at the end."""
    size = min(abs(value), 1.0)
    if size < DEAD:
        return 0.0
    return float((size - DEAD) / (1.0 - DEAD)) ** 2 * (1.0 if value > 0.0 else -1.0)
