# SPDX-License-Identifier: BSD-3-Clause
"""What a tip leaves while a person touches: dents in a sample that keeps them, told to the picture, and particles where
they were pushed to; both can be taken back."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from typing import Any

import nanotouch as nt
from nanotouch.errors import Error
from nanotouch.plasticity import Dent, dents_of

LOOKED = 0.1  # for new dents so often [s]
MOST = 128  # dents that a session keeps (NT_DENTS)
APART = 0.3  # for so long, until the next contact is another touch [s]
Message = dict[str, Any]


def keeps(scene: nt.Scene) -> bool:
    """Whether the sample does."""
    return bool(scene.sample.dents == "yes")


def told_of(dents: Sequence[Dent]) -> Message:
    """As a picture hears them."""
    rows = [[*dent.imprint, dent.load, -1 if dent.before is None else dent.before] for dent in dents]
    return {"tell": "dents", "dents": rows}


class Left:
    """The dents of one session."""

    def __init__(self, session: nt.Session, tell: Callable[[Message], None]) -> None:
        self.session, self.tell = session, tell
        self.dents: tuple[Dent, ...] = ()
        self.looked = 0.0
        self.began: list[int] = []  # how many there were at each touch
        self.touched_at = self.newest = -math.inf  # of the session [s]

    def follow(self, frame: Any) -> None:
        """The newest frame: whether the tip touches."""
        self.newest = float(frame["time"])
        if keeps(self.session.scene) and frame["contact_radius"] > 0.0:
            self._touches()

    def _touches(self) -> None:
        if not self.touched_at <= self.newest < self.touched_at + APART:
            self.began.append(len(self.dents))
        self.touched_at = self.newest

    def look(self, now: float | None = None) -> bool:
        """Whether there are others than before. Of a session that keeps its events."""
        now = time.monotonic() if now is None else now
        if not keeps(self.session.scene) or now - self.looked < LOOKED:
            return False
        self.looked = now
        dents = dents_of(self.session.metadata()["events"])
        if dents == self.dents:
            return False
        if len(dents) > len(self.dents):  # a tap may be over already
            self._touches()
        self.dents = dents
        self.report()
        if len(dents) == MOST:
            text = f"{MOST} dents are kept, no more: take some back (Z), or lay the sample anew (C)"
            self.tell({"tell": "note", "text": text})
        return True

    def undo(self) -> None:
        """Take back all that the last touch has left, while the tip touches nothing."""
        earlier = [count for count in self.began if count < len(self.dents)]
        before = earlier[-1] if earlier else len(self.dents) - 1
        try:
            for _ in self.dents[before:]:
                self.session.undent()
        except Error as error:
            raise Error("the tip presses: lift it first, then take the dent back") from error
        self.began = [count for count in self.began if count < before]
        self.looked = 0.0
        self.look()

    def report(self) -> None:
        """Tell the picture, which knows the world already."""
        if not keeps(self.session.scene):
            return
        self.tell(told_of(self.dents))


class Pushes:
    """Of the particles of one session that keeps its events."""

    def __init__(self, session: nt.Session) -> None:
        self.session = session
        self.done: list[tuple[int, int, tuple[float, ...]]] = []  # tick, number, where it lay before, a rod's angle
        self.seen = 0

    def look(self) -> None:
        """At what has happened since."""
        events = self.session.metadata()["events"]
        for tick, name, numbers in events[self.seen :]:
            if name == "pushed":
                self.done.append((tick, numbers[0], (numbers[1], numbers[2])))
            elif name == "turned" and self.done:
                self.done[-1] = (*self.done[-1][:2], (*self.done[-1][2], numbers[0]))
            elif name == "rewind":
                self.done = [one for one in self.done if one[0] < numbers[0]]
        self.seen = len(events)

    def forget(self) -> None:
        """They have been laid anew."""
        self.look()
        self.done.clear()

    def undo(self) -> None:
        """The last push: all that it has moved goes back, while the tip touches none of them."""
        last = [one for one in self.done if one[0] == self.done[-1][0]]
        try:
            for _, number, place in last:
                if len(place) == 3:
                    self.session.lay_rod((place[0], place[1], place[2]))
                else:
                    self.session.lay(number, (place[0], place[1]))
        except Error as error:
            raise Error("the tip touches a particle, or is where it lay: take it away first") from error
        self.done = self.done[: -len(last)]
