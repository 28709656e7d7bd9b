# SPDX-License-Identifier: BSD-3-Clause
"""What stopped a touch, in words: of an open session, and of what was recorded."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch.touch.columns import STATES

REASONS: tuple[str, ...] = _core.reasons
RUN = STATES.index("RUN")


def reasons_of(bits: int) -> tuple[str, ...]:
    """Of ``reasons``, in words."""
    return tuple(name for bit, name in enumerate(REASONS) if bits >> bit & 1)


def in_words(state: int, since: float, bits: int) -> str:
    """ "RUN", or "LATCHED at 0.09 s: sensor stuck"."""
    if state == RUN:
        return STATES[state]
    return f"{STATES[state]} at {since:.9g} s: {', '.join(reasons_of(bits)) or 'no reason is known'}"


def of_columns(columns: Mapping[str, NDArray[Any]]) -> str:
    """How it ended: its last state, since when, and why. "" where that was not recorded."""
    if "state" not in columns or not len(columns["state"]):
        return ""
    state = columns["state"]
    other = np.flatnonzero(state != state[-1])
    since = int(other[-1]) + 1 if len(other) else 0
    bits = int(columns["reasons"][-1]) if "reasons" in columns else 0
    return in_words(int(state[-1]), float(columns["time"][since]), bits)


def warn(columns: Mapping[str, NDArray[Any]], ended: str) -> None:
    """Of a run that did not end in RUN, or never was in it: what was measured is not what was asked for."""
    never = "state" in columns and len(columns["state"]) and not np.any(columns["state"] == RUN)
    if never:
        warnings.warn(f"the session never ran: {ended}; nothing of this is a measurement", stacklevel=3)
    elif ended and ended != STATES[RUN]:
        warnings.warn(f"the session was stopped: {ended}; nothing after that is a measurement", stacklevel=3)
