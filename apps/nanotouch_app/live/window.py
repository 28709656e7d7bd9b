# SPDX-License-Identifier: BSD-3-Clause
"""The process that owns the window: ``python -m nanotouch_app.live.window SURFACE``. It is told of the session by lines
of JSON on its input, and asks by lines on its output; frames come through shared memory."""

from __future__ import annotations

import argparse
import json
import queue
import sys
import threading
import time
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import guard, record
from nanotouch.errors import DeviceError, Error

from nanotouch_app.live import board, cards, hands, parts
from nanotouch_app.live.entry import Entry
from nanotouch_app.live.held import Held
from nanotouch_app.live.keys import Keys
from nanotouch_app.live.look import fitting
from nanotouch_app.live.picture import MARGIN, Picture, save
from nanotouch_app.live.reel import Reel, world_of
from nanotouch_app.live.remote import Remote

FASTEST = 1.0 / 60.0  # between two pictures [s]
SHARE = 0.5  # of one processor at most that drawing takes
FINE, TURN = 0.1, 0.4  # with shift; degrees per pixel


class Window:
    """VTK's window with mouse and keys."""

    def __init__(
        self, surface: str, dark: bool = False, recording: str | None = None, watched: str | None = None,
        hand: str = "none", leads: bool = False, sideways: bool = False,
    ) -> None:  # fmt: skip
        self.vtk = parts.load()
        with np.load(surface) as stored:
            heights, pixel_size, origin = stored["heights"], stored["pixel_size"], stored.get("origin")
        self.window = self.vtk.vtkRenderWindow()
        self.window.SetMultiSamples(0)
        self.window.SetSize(*fitting(*self.window.GetScreenSize()))
        self.window.SetWindowName("nanotouch live")
        self.picture = Picture(self.vtk, self.window, heights, pixel_size)
        self.picture.stage.origin = np.zeros(2) if origin is None else origin
        if dark:
            self.picture.turn_light()
        self.reel = None if recording is None else Reel(record.read(recording, untrusted=guard.is_there()))
        self.keys, self.device = Keys(self), "wheel"
        self.interactor = self.vtk.vtkRenderWindowInteractor()
        self.interactor.SetRenderWindow(self.window)
        style = self.vtk.vtkInteractorStyleUser()
        style.AddObserver("CharEvent", lambda *_: None)  # or E leaves, as the E of a typed 1e-9, and 3 draws in stereo
        self.interactor.SetInteractorStyle(style)
        for event, answer in (
            ("LeftButtonPressEvent", self.left), ("LeftButtonReleaseEvent", self.let_go),
            ("RightButtonPressEvent", self.right), ("RightButtonReleaseEvent", self.let_go),
            ("MiddleButtonPressEvent", self.middle), ("MiddleButtonReleaseEvent", self.let_go),
            ("MouseMoveEvent", self.move), ("MouseWheelForwardEvent", lambda *_: self.wheel(-1.0)),
            ("MouseWheelBackwardEvent", lambda *_: self.wheel(1.0)), ("KeyPressEvent", self.keys.down),
            ("KeyReleaseEvent", self.keys.up), ("ExitEvent", lambda *_: self.leave()),
        ):  # fmt: skip
            self.interactor.AddObserver(event, answer)
        self.interactor.AddObserver("DropFilesEvent", self._dropper())
        self.told: queue.Queue[dict[str, Any]] = queue.Queue()
        self.observer: nt.frames.Observer | Reel | None = self.reel
        self.name = ""
        if self.reel is not None and recording is not None:
            self.picture.hear(world_of(self.reel.recording.metadata, Path(recording).name, "recording"))
            self.picture.reel = self.reel
        self.leads = recording is None and watched is None
        self.remote: Remote | None = None
        if watched is not None:
            self.watch(watched, leads, sideways)
        self.held, self.moved_at = Held(hands.opened(hand) if self.leads or leads else []), time.monotonic()
        self.dragging, self.at = "", np.zeros(2)
        self.open = True

    def _dropper(self) -> Any:
        """What VTK calls with the names of files that are dropped on the window: the first one is opened."""

        def dropped(_: Any, __: str, names: Any) -> None:
            if names.GetNumberOfValues():
                self.picture.hear({"tell": "note", "text": f"opening {names.GetValue(0)} ..."})
                self.ask("open", path=names.GetValue(0))

        dropped.CallDataType = self.vtk.VTK_OBJECT  # type: ignore[attr-defined]
        return dropped

    # --- the loop ---

    def run(self) -> None:
        """Until the person leaves or the host has gone."""
        threading.Thread(target=self._listen, daemon=True).start()
        self.interactor.Initialize()
        self.picture.render()
        if sys.platform == "linux" and not str(self.window.GetClassName()).startswith("vtkX"):
            raise Error("the display lets no window be opened: is this user allowed to (xauth list)?")
        self.ask("ready")
        due = 0.0
        while self.open:
            self.interactor.ProcessEvents()
            self._take()
            begun = time.monotonic()
            self.held.move(begun - self.moved_at, self.picture.stage.unit, self._ask_by_pad)
            self.moved_at = begun
            self.keys.turn(begun)
            if begun < due:
                time.sleep(min(due - begun, 0.004))
                continue
            if self.reel is not None:
                for message in self.reel.told():
                    self.picture.hear(message)
            if self.observer is not None:
                self.picture.seen.look(self.observer)
            self._hear_remote()
            self.held.feel(self.picture.seen.feel())
            self.picture.render()
            took = time.monotonic() - begun
            due = begun + max(FASTEST, took / SHARE)
        self.held.close()
        self.ask("leave")

    def _listen(self) -> None:
        for line in sys.stdin:
            self.told.put(json.loads(line))
        self.told.put({"tell": "gone"})

    def _take(self) -> None:
        while not self.told.empty():
            message = self.told.get()
            if message["tell"] == "gone":
                self.open = False
                return
            if message["tell"] == "picture":
                self.picture.render()
                save(self.vtk, self.window, message["path"])
                self.ask("saved", path=message["path"])
                continue
            if message["tell"] == "world" and message.get("name", "") != self.name:
                self._attach(message["name"])
            self.picture.hear(message)

    def watch(self, name: str, leads: bool = False, sideways: bool = False) -> None:
        """Look at the session of another program; ``leads``: with a hand, ``sideways``: in x and y alone."""
        self.observer, self.name = nt.frames.attach(name), name
        self.remote = Remote(name, self.observer, leads, sideways)
        self._hear_remote()

    def _hear_remote(self) -> None:
        """What became of what was asked of a watched session, and what it says of itself."""
        for message in [] if self.remote is None else self.remote.turn(self.picture.seen.frame):
            self.picture.hear(message)

    def _attach(self, name: str) -> None:
        try:
            self.observer, self.name = nt.frames.attach(name), name
        except DeviceError as error:
            self.picture.hear({"tell": "refused", "why": str(error)})

    def ask(self, what: str | dict[str, Any], **more: Any) -> None:
        """Ask the host for something."""
        message = {"do": what, **more} if isinstance(what, str) else what
        self.picture.seen.asks(message["do"])
        if self.reel is not None:
            self.reel.answer(message)
        if self.remote is not None and message["do"] not in ("ready", "leave"):
            try:
                self.remote.ask(message, self.picture.seen.frame)
            except Error as error:
                self.picture.hear({"tell": "refused", "why": str(error), "field": message.get("field")})
            return
        if not self.leads and message["do"] != "ready":
            return  # nobody listens
        try:
            print(json.dumps(message), flush=True)
        except BrokenPipeError:
            self.open = False

    def _ask_by_pad(self, what: str | dict[str, Any], **more: Any) -> None:
        self.by("pad")
        self.ask(what, **more)

    def by(self, device: str) -> None:
        """What the hand is moved with: hints follow it."""
        if device != self.device and self.leads:
            self.device = device
            self.ask("device", name=device)

    def leave(self) -> None:
        """The window is closed."""
        self.open = False

    # --- the mouse ---

    def _pointer(self) -> Any:
        return np.array(self.interactor.GetEventPosition(), dtype=float)

    @staticmethod
    def _in(frame: tuple[float, float, float, float], at: Any) -> bool:
        x, y, width, height = frame
        return bool(x <= at[0] <= x + width and y <= at[1] <= y + height)

    def _scrub(self) -> None:
        """The recording goes to where the pointer is on its time line."""
        if self.reel is not None:
            x, _, width, _ = self.picture.layout.controls
            self.reel.jump(self.reel.length * (self.at[0] - x - MARGIN) / (width - 2.0 * MARGIN))
            self.picture.seen.forget()

    def left(self, *_: Any) -> None:
        """Take the tip, or a slider."""
        self.at = self._pointer()
        slider = self.picture.sliders.at(*self.at)
        if self.picture.board and self.on_board(board.at(self.picture.board, *self.picture.corner, self.at)):
            return
        if self.picture.cards:
            name, self.picture.cards = cards.at(self.picture.layout.cards, *self.at), False
            if name:
                self.ask("preset", name=name)
        elif self.reel is not None and self._in(self.picture.layout.controls, self.at):
            self.dragging = "time"
            self._scrub()
        elif slider is not None and self.picture.sliders.value_at(*self.at) is not None:
            self.picture.entry = Entry(slider)
        elif slider is not None:
            self.dragging = "slider"
            self.picture.sliders.held = slider
            self.picture.sliders.drag(self.at[0])
        elif self._in(self.picture.layout.view, self.at):
            self.dragging = "camera" if self.interactor.GetControlKey() else "tip"

    def on_board(self, number: int | None) -> bool:
        """One of the choices of the board."""
        if number is None or number >= len(self.picture.board["choices"]):
            return False
        if self.picture.menu:
            self.picture.menu = False
            self.ask("task", name=list(board.MENU)[number], lay=True)
        else:
            self.ask("choose", number=number)
        return True

    def right(self, *_: Any) -> None:
        """Take the height."""
        self.at, self.dragging = self._pointer(), "height"

    def middle(self, *_: Any) -> None:
        """Take the camera."""
        self.at, self.dragging = self._pointer(), "camera"

    def let_go(self, *_: Any) -> None:
        """A slider that is let go asks for its value."""
        if self.dragging == "slider":
            request = self.picture.sliders.drop()
            if request is not None:
                self.picture.seen.waiting.add(request["field"])
                self.ask(request)
        self.dragging = ""

    def move(self, *_: Any) -> None:
        """What is held follows the pointer."""
        at = self._pointer()
        way, self.at = at - self.at, at
        self.picture.sliders.hovered = self.picture.sliders.at(*at)
        fine = self.fine
        if self.dragging == "slider":
            self.picture.sliders.drag(at[0])
        elif self.dragging == "time":
            self._scrub()
        elif self.dragging == "tip":
            self.drag(fine * way)
        elif self.dragging == "height":
            self.ask("wheel", steps=-fine * way[1] / 4.0)
        elif self.dragging == "camera":
            self.picture.stage.turn(*(TURN * way))

    def drag(self, pixels: Any) -> None:
        """The tip, by a way on the screen."""
        seen = self.picture.seen
        if seen.frame is not None and seen.world:
            x, y = self.picture.stage.dragged(self.picture.stage.apex(seen), pixels)
            self.ask("move", way=(x, y, 0.0))

    @property
    def fine(self) -> float:
        """With shift ten times finer."""
        return FINE if self.interactor.GetShiftKey() else 1.0

    def wheel(self, steps: float) -> None:
        """Down and up; nearer and farther with control, and where the height is not led from here."""
        if self.interactor.GetControlKey() or "z" not in self.picture.seen.world.get("leads", "xyz"):
            self.picture.magnify(-steps * self.fine)
        else:
            self.step(steps, "wheel")

    def step(self, steps: float, device: str) -> None:
        """Down and up, by what the hand is moved with."""
        self.by(device)
        self.ask("wheel", steps=steps * self.fine)


def main(arguments: list[str]) -> int:
    """Run the window over a surface, of a session or of a recording."""
    parser = argparse.ArgumentParser()
    parser.add_argument("surface")
    parser.add_argument("--dark", action="store_true")
    parser.add_argument("--recording")
    parser.add_argument("--watch")
    parser.add_argument("--lead", action="store_true")
    parser.add_argument("--sideways", action="store_true")
    parser.add_argument("--hand", default="none")
    args = parser.parse_args(arguments)
    try:
        Window(args.surface, args.dark, args.recording, args.watch, args.hand, args.lead, args.sideways).run()
    except Error as error:
        print(error, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
