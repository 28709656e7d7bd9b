# SPDX-License-Identifier: BSD-3-Clause
"""Starts the window that watches a session. It is a program beside this library, and runs in a process of its own."""

from __future__ import annotations

import atexit
import importlib.util
import itertools
import os
import subprocess
import sys
from typing import Any, Protocol

import numpy as np

from nanotouch.errors import Error, missing
from nanotouch.scratch import Scratch

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


def watch(session: Watched) -> subprocess.Popen[str]:
    """Open a window that watches this session, in a process of its own; the session never waits for it.

    Returns that process once its first picture is drawn; :class:`~nanotouch.errors.Error` where it cannot be. Not while
    the session runs in its own thread.
    """
    if importlib.util.find_spec("vtkmodules") is None:
        raise missing("vtk", "view")
    if not session._name:  # a second window watches beside the first one
        session.publish(f"session-{os.getpid()}-{next(_numbers)}")
    name = session._name
    folder = Scratch()
    atexit.register(folder.close)
    surface = folder.path / "surface.npz"
    heights, pixel_size = _surface_of(session)
    np.savez(surface, heights=heights, pixel_size=np.asarray(pixel_size))
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    said = folder.path / "said.txt"
    with open(said, "wb") as errors:
        window = subprocess.Popen(
            [sys.executable, "-m", WINDOW, str(surface), "--watch", name], stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, stderr=errors, env=environment, text=True,
        )  # fmt: skip
    assert window.stdout is not None
    if not window.stdout.readline():  # it has ended
        window.wait()
        for wire in (window.stdin, window.stdout):
            if wire is not None:
                wire.close()
        last = said.read_text(errors="replace").strip().splitlines() or ["it said nothing"]
        raise Error(f"the window could not be opened: {last[-1]}")
    return window


def _surface_of(session: Watched) -> tuple[Any, tuple[float, float]]:
    """Heights and pixel size of its surface; a flat around the path without one."""
    if session.surface is not None:
        return session.surface.topography.heights, session.surface.topography.pixel_size
    side = 2.0 * max(1e-6, *(abs(part) for point in session.path for part in point))
    return np.zeros((16, 16)), (side / 16, side / 16)
