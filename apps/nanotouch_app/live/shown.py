# SPDX-License-Identifier: BSD-3-Clause
"""What shows a session of which hand or slave is a device: a window, or pages in browsers. Either is a process of its
own that watches the session, and leads what no device leads."""

from __future__ import annotations

import argparse
import json
from subprocess import Popen, TimeoutExpired
from typing import Any, Literal

import nanotouch as nt
from nanotouch.errors import Error, InvalidValue, require
from nanotouch.touch import _live

from nanotouch_app.browser import page

PAGES = "nanotouch_app.browser.watch"
USELESS = ("task", "film", "dark")
ENDS = 5.0  # a view whose input has ended [s]
Leads = bool | Literal["sideways"]


def check(args: argparse.Namespace, what: str, *more: str) -> None:
    """Refuse options that would do nothing for such a session, and pages that cannot be served."""
    names = (*USELESS, *more, *(() if args.browser else ("port", "page")))
    useless = [f"--{name.replace('_', '-')}" for name in names if getattr(args, name) not in (None, False)]
    if useless:
        raise InvalidValue(f"{what}: {' and '.join(useless)} cannot be used with it")
    if args.browser:
        require("aiohttp", "browser")
        page(args.page)


def leads_of(session: nt.Session, by_device: bool) -> Leads:
    """What a view leads: the whole hand, or x and y beside a device of one axis that leads z."""
    if not by_device:
        return True
    return "sideways" if session.rig.master.axes == 1.0 and session.rig.stage.axes == 3.0 else False


class Shown:
    """A view of a session."""

    def __init__(self, session: nt.Session, args: argparse.Namespace, leads: Leads) -> None:
        self.leads, self.words = leads, ""
        """to say: where pages find it"""
        self.leave = "Ctrl-C ends the session" if args.browser else "Q in the window leaves, Escape stops"
        if not args.browser:
            self.process: Popen[Any] = session.live(hand=leads)
            return
        options = ["--sideways"] if leads == "sideways" else ["--lead"] * leads
        options += ["--recorded"] * (args.record is not None) + ["--port", str(args.port or 0)]
        options += [] if args.page is None else ["--page", str(args.page)]
        self.process, first = _live.viewed(session, PAGES, options)
        self.words = str(json.loads(first)["words"])

    def is_open(self) -> bool:
        """Until the person has left; :class:`~nanotouch.errors.Error` where it has died."""
        status = self.process.poll()
        if status:
            raise Error("the view has died; the session has ended in order")
        return status is None

    def close(self) -> None:
        """It leaves when its input ends."""
        if self.process.stdin is not None:
            self.process.stdin.close()
        try:
            self.process.wait(ENDS)
        except TimeoutExpired:
            self.process.kill()
            self.process.wait()
        if self.process.stdout is not None:
            self.process.stdout.close()
