# SPDX-License-Identifier: BSD-3-Clause
"""Expert functions."""

from desk import Desk

_is_enabled = False


def enableExpertMode() -> int:
    global _is_enabled
    _is_enabled = True
    return 0


def setWatchdog(duration: int, ID: int = -1) -> int:
    """In multiples of 125 us; 0 disables it. A duration fits a C char."""
    if not _is_enabled or not 0 <= duration < 256:
        return -1
    Desk().watchdog = duration * 125e-6
    return 0
