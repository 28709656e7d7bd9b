# SPDX-License-Identifier: BSD-3-Clause
"""What is promised to the hand that holds the master: docs/safety.md."""

from __future__ import annotations

from typing import NamedTuple

from nanotouch import _core
from nanotouch.scene import Rig, Settings


class MotorBound(NamedTuple):
    """What the motor may do to the hand, whatever happens. After any event that uncouples hand and tip its force never
    rises above its value before, is never turned round, and is gone soon."""

    force: float
    """on the hand, all axes together, at most [N]; 0 without a motor"""
    speed: float
    """of the hand that is counted: ``master.max_speed``, and what a released handle of 0.1 kg gains meanwhile [m/s]"""
    fade_time: float
    """in which that force is gone after an event [s]"""
    delay: float
    """after which a command acts: the force stays so long [s]"""
    energy: float
    """that the motor gives the hand after an event, at most [J]"""

    def __str__(self) -> str:
        if self.force == 0.0:
            return "force on the hand: none, the master has no motor"
        return (
            f"force on the hand at most {self.force:.4g} N; after any event it never rises, ends within "
            f"{(self.fade_time + self.delay) * 1e3:.3g} ms, gives at most {self.energy * 1e3:.3g} mJ"
        )


def motor_bound(rig: Rig, settings: Settings) -> MotorBound:
    """Of a rig and its settings, before anything moves. A smaller force fades within min(50 ms, 2 mJ/(force speed))."""
    return MotorBound(**_core.motor_bound(rig.core, settings.core))
