# SPDX-License-Identifier: BSD-3-Clause
"""What goes to a reader: updates of 128 bytes (page_update of apps/page/page.h), a surface, messages in JSON."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np

from nanotouch_app.live.look import PROPERTY_NAMES

VERSION, LAID = 1, 2  # first byte of a binary message
SNAP, TEAR = 1, 2
LAYOUT = struct.Struct("<BBBBIIIQd3ddd2f2f2f3ff3fI")
SURFACE = struct.Struct("<B3xIIIdd")
assert LAYOUT.size == 128
assert SURFACE.size == 32


class Summary:
    """All frames since the last update: the newest, least and largest force, snaps and tears. One per reader."""

    def __init__(self) -> None:
        self.newest: Any = None
        self.least, self.largest, self.ticks, self.events = math.inf, -math.inf, 0, 0

    def add(self, part: Summary) -> None:
        """What has come since."""
        self.newest = part.newest
        self.least, self.largest = min(self.least, part.least), max(self.largest, part.largest)
        self.ticks += part.ticks
        self.events |= part.events

    @classmethod
    def of(cls, frames: Any, touched: bool) -> Summary:
        """Of an array of frames; ``touched`` before them."""
        made = cls()
        made.newest, made.ticks = frames[-1], len(frames)
        force = frames["tip_force"][:, 2]
        force = force[np.isfinite(force)]
        if len(force):
            made.least, made.largest = float(force.min()), float(force.max())
        steps = np.diff(np.concatenate([[touched], frames["contact_radius"] > 0.0]).astype(int))
        made.events = SNAP * bool((steps > 0).any()) | TEAR * bool((steps < 0).any())
        return made

    def take(self, changes: int) -> bytes:
        """As bytes; the next one begins."""
        frame = self.newest
        made = LAYOUT.pack(
            VERSION, int(frame["state"]), int(frame["phase"]), self.events, int(frame["reasons"]), changes, self.ticks,
            int(frame["sequence"]), float(frame["time"]), *frame["tip_position"], float(frame["gap"]),
            float(frame["tip_force"][2]), *frame["tip_force"][:2], self.least, self.largest, frame["base_height"],
            frame["deflection"], frame["contact_radius"], frame["cohesive_radius"], frame["neck_radius"],
            frame["motor_force"][2], *frame["master_position"], 0,
        )  # fmt: skip
        self.least, self.largest, self.ticks, self.events = math.inf, -math.inf, 0, 0
        return made


def surface_bytes(heights: Any, pixel_size: Any, properties: Mapping[str, Any] | None = None) -> bytes:
    """A surface, its rows upwards; then what else is known of each place, of the names in PROPERTY_NAMES."""
    rows, columns = heights.shape
    held = [(bit, properties[name]) for bit, name in enumerate(PROPERTY_NAMES) if properties and name in properties]
    mask = sum(1 << bit for bit, _ in held)
    head = SURFACE.pack(LAID, rows, columns, mask, float(pixel_size[1]), float(pixel_size[0]))
    return head + b"".join(np.asarray(part, dtype="<f4").tobytes() for part in (heights, *(part for _, part in held)))


def stored_surface(path: str) -> bytes:
    """The same of the file that a host has written of what was laid."""
    with np.load(path) as stored:
        return surface_bytes(stored["heights"], stored["pixel_size"], stored)


def finite(value: Any) -> Any:
    """What JSON can say: null for NaN and infinite numbers."""
    if isinstance(value, dict):
        return {str(key): finite(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [finite(one) for one in value]
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return int(value) if isinstance(value, np.integer) else value


def message_text(message: dict[str, Any]) -> str:
    """A message as JSON."""
    return json.dumps(finite(message), separators=(",", ":"), allow_nan=False)
