# SPDX-License-Identifier: BSD-3-Clause
"""Starts a view that watches a session. It is a program beside this library, and runs in a process of its own."""

from __future__ import annotations

import atexit
import importlib.util
import itertools
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Literal, NamedTuple, Protocol

import numpy as np

from nanotouch.errors import Error, missing
from nanotouch.touch.scratch import Scratch

WINDOW = "nanotouch_app.live.window"
_numbers = itertools.count(1)


class Watched(Protocol):
    """What is needed of a session."""

    surface: Any
    _name: str

    @property
    def path(self) -> Any:
        """Where the tip goes [m]."""

    def publish(self, name: str = "") -> None:
        """Show every tick under a name."""


class View(NamedTuple):
    """One that shows something."""

    process: subprocess.Popen[str]
    first: str
    """what it has said then"""
    said: Path
    """what it says of what goes wrong"""

    @property
    def last_words(self) -> str:
        """The last line of that."""
        return (self.said.read_text(errors="replace").strip().splitlines() or ["it said nothing"])[-1]


def watch(session: Watched, hand: bool | Literal["sideways"] = False) -> subprocess.Popen[str]:
    """Open a window that watches this session, in a process of its own; the session never waits for it. With ``hand``
    its mouse, keys and other devices move the simulated hand, too, while no other program holds the lease; "sideways":
    in x and y alone, where a device of one axis leads z.

    Returns that process once its first picture is drawn; :class:`~nanotouch.errors.Error` where it cannot be. Not while
    the session runs in its own thread.
    """
    return window(session, hand).process


def window(session: Watched, hand: bool | Literal["sideways"]) -> View:
    """That of :func:`watch`, with what it says."""
    if importlib.util.find_spec("vtkmodules") is None:
        raise missing("vtk", "view")
    options = ["--sideways"] if hand == "sideways" else ["--lead", "--hand", "auto"] if hand else []
    return viewed(session, WINDOW, options)


def viewed(session: Watched, view: str, options: list[str]) -> View:
    """A view, once it shows something; :class:`~nanotouch.errors.Error` with its last words where it cannot."""
    if not session._name:  # a second view watches beside the first one
        session.publish(f"session-{os.getpid()}-{next(_numbers)}")
    name = session._name
    folder = Scratch()
    atexit.register(folder.close)
    surface = folder.path / "surface.npz"
    heights, pixel_size, origin = _surface_of(session)
    np.savez(surface, heights=heights, pixel_size=np.asarray(pixel_size), origin=np.asarray(origin))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    said = folder.path / "said.txt"
    with open(said, "wb") as errors:
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", view, str(surface), "--watch", name, *options], stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=errors, env=environment, text=True,
        )  # fmt: skip
    assert process.stdout is not None
    made = View(
        process, next((line for line in process.stdout if line.startswith("{")), ""), said
    )  # others are a library's own
    if not made.first:  # it has ended
        process.wait()
        for wire in (process.stdin, process.stdout):
            if wire is not None:
                wire.close()
        raise Error(f"the view could not be opened: {made.last_words}")
    return made


def _surface_of(session: Watched) -> tuple[Any, tuple[float, float], tuple[float, float]]:
    """Heights, pixel size and lower left corner of its surface; a flat around the path without one."""
    if session.surface is not None:
        return session.surface.topography.heights, session.surface.topography.pixel_size, (0.0, 0.0)
    points = np.asarray(session.path, dtype=float).reshape(-1, 2)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    side = max(2e-6, 1.5 * float(np.ptp(points, axis=0).max()))
    corner = middle - 0.5 * side
    return np.zeros((16, 16)), (side / 16, side / 16), (float(corner[0]), float(corner[1]))
