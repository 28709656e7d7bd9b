# SPDX-License-Identifier: BSD-3-Clause
"""All that look at one session: each is given the newest update when it has taken the last one. What a slow one has
missed is summed up, never kept. No reader is waited for, and the session does not know of them."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import nanotouch as nt
from nanotouch.errors import Error

from nanotouch_app.browser.update import Summary, message_text
from nanotouch_app.live.reel import measured

Message = dict[str, Any]
SIMULATED = "simulated, wall pace, seen over a socket"
KEPT = ("sliders", "world", "guide", "dents", "task", "particles")  # sent again to a page that joins later


class Reader:
    """One page: how to send to it, and what it has not seen yet."""

    def __init__(self, send: Callable[[bytes | str], Awaitable[None] | None], operates: bool) -> None:
        self.send, self.operates = send, operates
        self.summary = Summary()
        self.free = True  # the last update was taken
        self.refusal: asyncio.Task[None] | None = None  # the last one, until it is sent
        self.updates = self.bytes = self.dropped = 0


class Readers:
    """The readers of a session; for one thread, as the observer is."""

    def __init__(self) -> None:
        self.all: list[Reader] = []
        self.kept: dict[str, Message] = {}
        self.surface = b""
        self.corner = (0.0, 0.0)  # of the surface in the frame of the tip [m]
        self.observer: nt.frames.Observer | None = None
        self.name = ""
        self.touched = False
        self.changes = 0

    # --- what the session shows ---

    def attach(self, name: str) -> None:
        """Look at the frames of that session from now on."""
        if name == self.name:
            return
        self.close()
        self.observer, self.name = nt.frames.attach(name), name

    def look(self) -> list[tuple[Reader, bytes]]:
        """The updates that are due now."""
        if self.observer is None:
            return []
        frames = measured(self.observer.read(), self.kept.get("world", {}))
        if not len(frames):
            return []
        if any(self.corner):  # a page counts from the corner
            frames = frames.copy()
            frames["tip_position"][:, :2] -= self.corner
        part = Summary.of(frames, self.touched)
        self.touched = bool(frames[-1]["contact_radius"] > 0.0)
        due = []
        for reader in self.all:
            reader.summary.add(part)
            if not reader.free:
                reader.dropped += 1
                continue
            reader.free = False
            update = reader.summary.take(self.changes)
            reader.updates, reader.bytes = reader.updates + 1, reader.bytes + len(update)
            due.append((reader, update))
        return due

    # --- what the host tells ---

    def hear(self, message: Message, surface: bytes = b"") -> list[tuple[Reader, bytes | str]]:
        """What is to be sent to whom; ``surface``: of a message that another sample is laid."""
        kind = message["tell"]
        if kind == "laid":
            self.surface = surface
            for name in ("dents", "sliders"):  # of what lay there before
                self.kept.pop(name, None)
            return [(reader, surface) for reader in self.all]
        if kind == "properties":
            return []
        if kind == "world":
            self.changes += 1
            try:
                self.attach(message["name"])
            except Error:
                self.observer = None
            message = {"source": SIMULATED, **message}
        if kind in KEPT:
            self.kept[kind] = message
        text = message_text(message)
        return [(reader, text) for reader in self.all if self._wants(reader, kind)]

    @staticmethod
    def _wants(reader: Reader, kind: str) -> bool:
        """A slow reader is not told the time; refusals and notes are for the hand that asked."""
        if kind == "clock":
            return reader.free
        return reader.operates or kind not in ("refused", "note")

    def greeting(self) -> list[bytes | str]:
        """What one who comes now is told."""
        return [*([self.surface] if self.surface else []), *(message_text(message) for message in self.kept.values())]

    def close(self) -> None:
        """Look no more."""
        if self.observer is not None:
            self.observer.close()
        self.observer, self.name = None, ""
