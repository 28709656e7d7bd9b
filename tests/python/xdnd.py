# SPDX-License-Identifier: BSD-3-Clause
"""Drops a file on a window by the protocol of X11's desktops (XDND 5): ``python xdnd.py WINDOW FILE``. Status 0 when
the window has said that it has taken it."""

from __future__ import annotations

import ctypes as c
import sys
import time
from pathlib import Path
from typing import Any

PATIENCE = 60.0  # of a loaded machine [s]
SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE, LONG, VERSION = 30, 31, 33, 32, 5
_HEAD: list[Any] = [("type", c.c_int), ("serial", c.c_ulong), ("sent", c.c_int), ("display", c.c_void_p)]


class Message(c.Structure):
    """XClientMessageEvent."""

    _fields_ = [*_HEAD, ("window", c.c_ulong), ("kind", c.c_ulong), ("format", c.c_int), ("data", c.c_long * 5)]


class Request(c.Structure):
    """XSelectionRequestEvent."""

    _fields_ = [*_HEAD, ("owner", c.c_ulong), ("requestor", c.c_ulong), ("selection", c.c_ulong),
                ("target", c.c_ulong), ("property", c.c_ulong), ("time", c.c_ulong)]  # fmt: skip


class Notice(c.Structure):
    """XSelectionEvent."""

    _fields_ = [*_HEAD, ("requestor", c.c_ulong), ("selection", c.c_ulong), ("target", c.c_ulong),
                ("property", c.c_ulong), ("time", c.c_ulong)]  # fmt: skip


class Event(c.Union):
    """XEvent."""

    _fields_ = [
        ("type", c.c_int),
        ("message", Message),
        ("request", Request),
        ("notice", Notice),
        ("pad", c.c_long * 24),
    ]


class Source:
    """What is dragged, on its own window."""

    def __init__(self, window: int, file: Path) -> None:
        self.x: Any = c.CDLL("libX11.so.6")
        for name in ("XOpenDisplay", "XInternAtom", "XDefaultRootWindow", "XCreateSimpleWindow"):
            getattr(self.x, name).restype = c.c_void_p if name == "XOpenDisplay" else c.c_ulong
        self.display = c.c_void_p(self.x.XOpenDisplay(None))
        root = c.c_ulong(self.x.XDefaultRootWindow(self.display))
        self.window, self.data = c.c_ulong(window), f"{file.absolute().as_uri()}\r\n".encode()
        self.own = c.c_ulong(self.x.XCreateSimpleWindow(self.display, root, 0, 0, 1, 1, 0, c.c_ulong(0), c.c_ulong(0)))
        self.x.XSetSelectionOwner(self.display, self.atom("XdndSelection"), self.own, c.c_ulong(0))

    def atom(self, name: str) -> Any:
        """Its number."""
        return c.c_ulong(self.x.XInternAtom(self.display, name.encode(), 0))

    def send(self, to: Any, event: Event) -> None:
        """To another window."""
        self.x.XSendEvent(self.display, to, 0, c.c_long(0), c.byref(event))
        self.x.XFlush(self.display)

    def say(self, kind: str, *data: int) -> None:
        """One step of the protocol."""
        event = Event(message=Message(type=CLIENT_MESSAGE, window=self.window, kind=self.atom(kind), format=LONG))
        event.message.data[:] = [self.own.value, *data, *[0] * (4 - len(data))]
        self.send(self.window, event)

    def give(self, asked: Request) -> None:
        """The name of the file, to who has asked."""
        requestor, where, target = c.c_ulong(asked.requestor), c.c_ulong(asked.property), c.c_ulong(asked.target)
        self.x.XChangeProperty(self.display, requestor, where, target, 8, 0, self.data, len(self.data))
        notice = Notice(type=SELECTION_NOTIFY, requestor=asked.requestor, selection=asked.selection,
                        target=asked.target, property=asked.property, time=asked.time)  # fmt: skip
        self.send(requestor, Event(notice=notice))

    def drop(self) -> bool:
        """Enter, move, let go, until it is taken."""
        status, finished = self.atom("XdndStatus").value, self.atom("XdndFinished").value
        self.say("XdndEnter", VERSION << 24, self.atom("text/uri-list").value)
        self.say("XdndPosition", 0, 300 << 16 | 300, 0, self.atom("XdndActionCopy").value)
        event, end, dropped = Event(), time.monotonic() + PATIENCE, False
        while time.monotonic() < end:
            if not self.x.XPending(self.display):
                time.sleep(0.01)
                continue
            self.x.XNextEvent(self.display, c.byref(event))
            if event.type == SELECTION_REQUEST:
                self.give(event.request)
            elif event.type == CLIENT_MESSAGE and event.message.kind == status and not dropped:
                dropped = True
                self.say("XdndDrop", 0, 0)
            elif event.type == CLIENT_MESSAGE and event.message.kind == finished:
                return bool(event.message.data[1] & 1)
        return False


if __name__ == "__main__":
    sys.exit(not Source(int(sys.argv[1]), Path(sys.argv[2])).drop())
