# SPDX-License-Identifier: BSD-3-Clause
"""The process that shows the session of another program in browsers: ``python -m nanotouch_app.browser.watch SURFACE
--watch NAME``, as ``nanotouch_app.live.window`` does in a window. It says its links in one line of JSON, and ends when
its input does; the session does not know of it."""

from __future__ import annotations

import argparse
import json
import signal
import sys
import threading
from collections.abc import Callable
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch.errors import Error
from nanotouch.touch import host

from nanotouch_app.browser import page
from nanotouch_app.browser.desk import BrowserDesk
from nanotouch_app.live.reel import measured
from nanotouch_app.live.remote import Remote

STOPS = 201  # of a slider (NT_HOST_STOPS)
TOUCHES, CHANGES = "touch it", "change and stop it"  # what the first link is for
Message = dict[str, Any]


class Watcher:
    """What a host is to its pages, of a session that another program has opened."""

    def __init__(
        self, name: str, tell: Callable[[Message], None], leads: bool = False, sideways: bool = False,
        recorded: bool = False,
    ) -> None:  # fmt: skip
        self.name, self.tell, self.recorded = name, tell, recorded
        self.observer = nt.frames.attach(name)
        self.remote = Remote(name, self.observer, leads, sideways)
        self.offered: list[str] = []  # fields that have a slider

    @property
    def frame(self) -> Any:
        """The newest; None before the first."""
        newest = self.observer.newest()
        return None if newest is None else measured(np.array([newest]), self.remote.world)[0]

    def properties(self) -> dict[str, Any]:
        """None that is known of each place."""
        return {}

    def report(self) -> None:
        """Tell the world as it is now."""
        self.tick()

    def tick(self) -> None:
        """What became of what was asked, and what the session says of itself."""
        for message in self.remote.turn(self.frame):
            for told in self._for_pages(message):
                self.tell(told)

    def _for_pages(self, message: Message) -> list[Message]:
        """With what each slider shows: a page knows no fields."""
        if message["tell"] != "world":
            return [message]
        described = nt.Scene(**message["scene"]), nt.Rig(**message["rig"]), nt.Settings(**message["settings"])
        rows = host.sliders(*(one.core for one in described))
        shown = {row.field: row.told(_value(message, row)) for row in rows}
        world = {**message, "name": self.name, "preset": "", "shown": shown}
        told = [world, {"tell": "guide", "text": message["hint"]}]
        if self.offered != list(shown):
            self.offered = list(shown)
            told.insert(0, {"tell": "sliders", "sliders": [_slider(row) for row in rows]})
        return told

    def answer(self, message: Message) -> bool:
        """Pass on what a page asks; a refusal goes back to it. False: the program has ended."""
        if message["do"] == "leave":
            return False
        if message["do"] == "device" or (message == {"do": "press", "on": False} and not self.remote.leads):
            return True  # a page says these by itself
        try:
            self.remote.ask(message, self.frame)
        except Error as error:
            self.tell({"tell": "refused", "why": str(error), "field": message.get("field")})
        return True

    def clock(self) -> Message:
        """How the session goes."""
        return {"tell": "clock", "speed": 1.0, "paused": False, "slowdown": 1.0, "recorded": self.recorded,
                "undo": 0, "facts": self._facts(), "here": {}}  # fmt: skip

    def _facts(self) -> str:
        frame, world = self.frame, self.remote.world
        if frame is None or not world:
            return ""
        bounds = [float(world.get(key, 0.0)) for key in ("bound", "margin", "force", "hand")]
        return host.facts(frame, *bounds)

    def close(self) -> None:
        """Look no more."""
        self.remote.close()
        self.observer.close()


def _value(world: Message, row: Any) -> float:
    section, key = row.field.split(".")
    return float(world[row.what][section][key])


def _slider(row: Any) -> Message:
    """As the host of a session tells it (docs/host.md)."""
    values = [row.at(stop / (STOPS - 1)) for stop in range(STOPS)]
    return {**{name: getattr(row, name) for name in ("what", "field", "title", "unit", "doc")},
            "stops": [[value, row.told(value)] for value in values]}  # fmt: skip


def _listen(desk: BrowserDesk) -> None:
    """Until the program that watches its session here has closed our input."""
    sys.stdin.read()
    desk.asked.put({"do": "leave"})


def main(arguments: list[str]) -> int:
    """Serve a session until our input ends."""
    parser = argparse.ArgumentParser()
    parser.add_argument("surface")
    parser.add_argument("--watch", required=True)
    parser.add_argument("--lead", action="store_true")
    parser.add_argument("--sideways", action="store_true")
    parser.add_argument("--recorded", action="store_true")
    parser.add_argument("--port", type=int, default=0)
    parser.add_argument("--page")
    args = parser.parse_args(arguments)
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the program that has the session, which ends us
    try:
        with np.load(args.surface) as stored:
            topography = nt.Topography(stored["heights"], tuple(stored["pixel_size"]), name="surface")
            x, y = map(float, stored["origin"])
        desk = BrowserDesk(topography, page(args.page), args.port, (x, y))
        watcher = Watcher(args.watch, desk.tell, args.lead, args.sideways, args.recorded)
        threading.Thread(target=_listen, args=(desk,), daemon=True).start()
        words = desk.links(TOUCHES if watcher.remote.leads else CHANGES)
        print(json.dumps({"do": "ready", "words": words}), flush=True)
        desk.serve(watcher)
        watcher.close()
        desk.close()
    except Error as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
