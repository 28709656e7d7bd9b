# SPDX-License-Identifier: BSD-3-Clause
"""The page in a notebook. Updates go through the widget's own channel, so that the kernel may be anywhere.

::

    from nanotouch_app.browser.widget import Touch
    touch = Touch("silicon_in_air")     # a session of its own, at the pace of a clock
    touch                               # shows it
    touch.close()                       # ends it
"""

from __future__ import annotations

import queue
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

from nanotouch.errors import Error
from nanotouch.errors import missing as missing_extra

from nanotouch_app.browser import page as page_of
from nanotouch_app.browser.access import checked
from nanotouch_app.browser.readers import Reader, Readers
from nanotouch_app.browser.update import finite, stored_surface, surface_bytes
from nanotouch_app.live.host import Host
from nanotouch_app.live.subject import Subject, of_preset

try:
    import anywidget
    import traitlets
except ImportError as missing:
    raise missing_extra("anywidget", "notebook") from missing

TURN, SHOWN, CLOCK = 0.005, 1.0 / 30.0, 0.2  # of the thread; between two updates; between two reports of the clock [s]
ESM = Path(__file__).with_name("widget.js")


class Touch(anywidget.AnyWidget):
    """A session on a preset (or a :class:`~nanotouch_app.live.subject.Subject`), in a cell."""

    _esm = ESM
    page = traitlets.Unicode().tag(sync=True)
    height = traitlets.Int(720).tag(sync=True)
    _thread: threading.Thread | None = None  # none where the page could not be had

    def __init__(self, what: str | Subject = "silicon_in_air", page: str | Path | None = None, **options: Any) -> None:
        super().__init__(page=page_of(page).decode("utf-8"), **options)
        subject = of_preset(what) if isinstance(what, str) else what
        self._asked: queue.Queue[Any] = queue.Queue()
        self._readers = Readers()
        self._reader = Reader(lambda data: None, True)
        self._readers.all.append(self._reader)
        self._ends = threading.Event()
        self._host = Host(subject, self._tell)
        topography = subject.topography
        self._readers.surface = surface_bytes(topography.heights, topography.pixel_size, self._host.properties())
        self.on_msg(self._heard)
        self._thread = threading.Thread(target=self._run, name="nanotouch-widget", daemon=True)
        self._thread.start()

    # --- to the page ---

    def _tell(self, message: dict[str, Any]) -> None:
        surface = stored_surface(message["path"]) if message["tell"] == "laid" else b""
        if self._readers.hear(message, surface):
            self._show(message, surface)

    def _show(self, message: dict[str, Any], surface: bytes) -> None:
        if surface:
            self.send({}, [surface])
        else:
            self.send({"message": finite(message)})

    def _greet(self) -> None:
        """A frame has opened: what it must know."""
        self._reader.free = True
        self.send({}, [self._readers.surface])
        for message in self._readers.kept.values():
            self.send({"message": finite(message)})

    # --- from the page ---

    def _heard(self, _: Any, content: Any, buffers: Any) -> None:
        self._asked.put(content)

    def _answer(self, content: Any) -> None:
        if content == {}:  # the last update was taken
            self._reader.free = True
        elif isinstance(content, dict) and content.get("do") == "hello":
            self._greet()
        else:
            try:
                self._host.answer(checked(content))
            except Error as error:
                self._tell({"tell": "refused", "why": str(error), "field": None})

    # --- the thread ---

    def _run(self) -> None:
        self._host.report()
        shown = told = 0.0
        while not self._ends.is_set():
            with suppress(queue.Empty):
                self._answer(self._asked.get(timeout=TURN))
            self._host.tick()
            now = time.monotonic()
            if now - shown > SHOWN:
                shown = now
                for _, update in self._readers.look():
                    self.send({}, [update])
            if now - told > CLOCK:
                told = now
                self._tell(self._host.clock())

    def close(self) -> None:
        """End the session."""
        if self._thread is not None and not self._ends.is_set():
            self._ends.set()
            self._thread.join()
            self._readers.close()
            self._host.close()
        super().close()
