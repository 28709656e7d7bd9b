# SPDX-License-Identifier: BSD-3-Clause
"""What a tip leaves in a sample that keeps dents while a person touches it: told to the picture, and taken back."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import nanotouch as nt
from nanotouch.plasticity import Dent, dents_of

LOOKED = 0.1  # for new dents so often [s]
Message = dict[str, Any]


def keeps(scene: nt.Scene) -> bool:
    """Whether the sample does."""
    return bool(scene.sample.dents == "yes")


class Left:
    """The dents of one session."""

    def __init__(self, session: nt.Session, tell: Callable[[Message], None]) -> None:
        self.session, self.tell = session, tell
        self.dents: tuple[Dent, ...] = ()
        self.looked = 0.0

    def look(self, now: float | None = None) -> bool:
        """Whether there are others than before. Of a session that keeps its events."""
        now = time.monotonic() if now is None else now
        if not keeps(self.session.scene) or now - self.looked < LOOKED:
            return False
        self.looked = now
        dents = dents_of(self.session.metadata()["events"])
        if dents == self.dents:
            return False
        self.dents = dents
        self.report()
        return True

    def undo(self) -> None:
        """Take the last one back, while the tip touches nothing."""
        self.session.undent()
        self.looked = 0.0
        self.look()

    def report(self) -> None:
        """Tell the picture, which knows the world already."""
        if not keeps(self.session.scene):
            return
        rows = [[*dent.imprint, dent.load, -1 if dent.before is None else dent.before] for dent in self.dents]
        self.tell({"tell": "dents", "dents": rows})
