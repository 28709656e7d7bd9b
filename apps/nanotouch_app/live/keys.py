# SPDX-License-Identifier: BSD-3-Clause
"""The keyboard of the window: the table of the help."""

from __future__ import annotations

import math
import time
from datetime import datetime
from typing import TYPE_CHECKING, Any

import numpy as np
from nanotouch.errors import Error, InvalidValue

from nanotouch_app.live.entry import Entry
from nanotouch_app.live.picture import save

if TYPE_CHECKING:
    from nanotouch_app.live.window import Window

PLAIN = {
    "r": "retract", "p": "pause", "pause": "pause", "period": "step", "bracketleft": "slower",
    "bracketright": "faster", "backspace": "rewind", "return": "arm", "kp_enter": "arm", "escape": "stop",
}  # fmt: skip
ARROWS = {"left": (-1.0, 0.0), "right": (1.0, 0.0), "up": (0.0, 1.0), "down": (0.0, -1.0)}
ARROW_PIXELS, KEY_STEPS = 4.0, 3.0
FUNCTION_KEYS = (*(f"f{number}" for number in range(1, 13)), "0")  # of choices, as board.KEYS shows them
HEIGHTS = {"plus": True, "kp_add": True, "minus": False, "kp_subtract": False}
SHOWN = {"c": "cards", "d": "full", "h": "help", "t": "menu"}  # what is seen of the picture, or not
REPEAT = 0.08  # a key that is let go for less than this [s] is held: X11 repeats it so


class Keys:
    """Of one window."""

    def __init__(self, window: Window) -> None:
        self.window, self.picture = window, window.picture
        self.pressing, self.lift_at = False, math.inf
        self.others = {
            "l": self.picture.turn_light, "n": self._answer, "k": lambda: self.picture.stage.colour_by_next(),
            "m": self._turn_sound, "s": self._save, "q": window.leave,
        }  # fmt: skip

    def turn(self, now: float) -> None:
        """The space bar was let go, and does not only repeat: the hand lifts."""
        if now > self.lift_at:
            self.lift_at, self.pressing = math.inf, False
            self.window.ask("press", on=False)

    def down(self, *_: Any) -> None:
        """A key is pressed."""
        name, shift = str(self.window.interactor.GetKeySym()).lower(), self.window.interactor.GetShiftKey()
        if self.picture.entry is not None:
            self._type(name)
        elif name in PLAIN:
            self.window.ask(PLAIN[name])
        elif name in ARROWS:
            self.window.drag(ARROW_PIXELS * self.window.fine * np.array(ARROWS[name]))
        elif name in ("next", "prior"):
            self.window.step(1.0 if name == "next" else -1.0, "keys")
        elif name == "space":
            self.lift_at = math.inf
            if not self.pressing:
                self.pressing = True
                self.window.ask("press", on=True)
        elif name == "v":
            self.picture.magnify(-KEY_STEPS if shift else KEY_STEPS)
        elif name == "z":
            self.window.ask("redo" if shift else "undo")
        elif name == FUNCTION_KEYS[-1] and self.picture.menu:
            self.window.on_board(len(FUNCTION_KEYS) - 1)
        elif name in "012345" and len(name) == 1:
            seen = self.picture.seen
            self.picture.stage.camera(name, self.picture.stage.apex(seen) if seen.world else None)
        else:
            self._own(name)

    def up(self, *_: Any) -> None:
        """A key is let go."""
        if str(self.window.interactor.GetKeySym()).lower() == "space":
            self.lift_at = time.monotonic() + REPEAT

    def _own(self, name: str) -> None:
        """What the session does not need to know."""
        if name in SHOWN:
            setattr(self.picture, SHOWN[name], not getattr(self.picture, SHOWN[name]))
        elif name in FUNCTION_KEYS and self.picture.board:
            self.window.on_board(FUNCTION_KEYS.index(name))
        elif name in HEIGHTS:
            self.picture.stage.raise_heights(HEIGHTS[name])
        elif name in self.others:
            self.others[name]()

    def _type(self, name: str) -> None:
        """While a number is typed."""
        entry = self.picture.entry
        assert entry is not None
        state = entry.key(name, str(self.window.interactor.GetKeyCode()))
        if state:
            self.picture.entry = None
        if state == "done":
            try:
                self.window.ask(entry.request())
            except InvalidValue as error:
                self.picture.hear({"tell": "refused", "why": str(error)})

    def _answer(self) -> None:
        if self.picture.seen.task.get("asked"):
            self.picture.entry = Entry(None, "your answer")

    def _save(self) -> None:
        path = f"nanotouch-{datetime.now():%Y-%m-%dT%H-%M-%S}.png"
        save(self.window.vtk, self.window.window, path)
        self.picture.hear({"tell": "note", "text": f"saved {path}"})

    def _turn_sound(self) -> None:
        try:
            self.window.held.turn_sound()
        except Error as error:
            self.picture.hear({"tell": "refused", "why": str(error)})
