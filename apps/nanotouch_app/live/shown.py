# SPDX-License-Identifier: BSD-3-Clause
"""What shows a session of which hand or slave is a device: a window, or pages in browsers. Either is a process of its
own that watches the session, and leads what no device leads."""

from __future__ import annotations

import argparse
import json
from subprocess import TimeoutExpired
from typing import Literal

import nanotouch as nt
from nanotouch.errors import Error, InvalidValue, require
from nanotouch.touch import views

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
            self.view = views.window(session, leads)
            return
        options = ["--sideways"] if leads == "sideways" else ["--lead"] * leads
        options += ["--recorded"] * (args.record is not None) + ["--port", str(args.port or 0)]
        options += [] if args.page is None else ["--page", str(args.page)]
        self.view = views.viewed(session, PAGES, options)
        self.words = str(json.loads(self.view.first)["words"])

    def is_open(self) -> bool:
        """Until the person has left; :class:`~nanotouch.errors.Error` where it has died."""
        status = self.view.process.poll()
        if status:
            raise Error(f"the view has died ({self.view.last_words}); the session has ended in order")
        return status is None

    def close(self) -> None:
        """It leaves when its input ends."""
        process = self.view.process
        if process.stdin is not None:
            process.stdin.close()
        try:
            process.wait(ENDS)
        except TimeoutExpired:
            process.kill()
            process.wait()
        if process.stdout is not None:
            process.stdout.close()
