# SPDX-License-Identifier: BSD-3-Clause
"""Host and window together: the window in a process of its own, which may come, go or die; the session stays here."""

from __future__ import annotations

import importlib.util
import json
import os
import queue
import signal
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

import numpy as np
from nanotouch.errors import Error, missing
from nanotouch.images import Topography
from nanotouch.touch.scratch import Scratch

from nanotouch_app.live.serving import serve

START_TIME = 60.0  # until VTK has drawn its first picture on a loaded machine [s]


class Desk:
    """A window and the wires to it."""

    def __init__(
        self, topography: Topography, dark: bool = False, recording: Path | None = None, hand: str = "none",
        corner: tuple[float, float] = (0.0, 0.0),
    ) -> None:  # fmt: skip
        if importlib.util.find_spec("vtkmodules") is None:
            raise missing("vtk", "view")
        self.folder = Scratch()
        surface = self.folder.path / "surface.npz"
        np.savez(
            surface, heights=topography.heights, pixel_size=np.asarray(topography.pixel_size), origin=np.asarray(corner)
        )
        self.said = self.folder.path / "said.txt"
        options = ["--hand", hand, *(["--dark"] if dark else [])]
        options += [] if recording is None else ["--recording", str(recording)]
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
        with open(self.said, "wb") as errors:
            self.process = subprocess.Popen(
                [sys.executable, "-P", "-m", "nanotouch_app.live.window", str(surface), *options],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors, env=environment, text=True, bufsize=1,
            )  # fmt: skip
        self.asked: queue.Queue[dict[str, Any]] = queue.Queue()
        self.listener = threading.Thread(target=self._listen, daemon=True)
        self.listener.start()

    def _listen(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            try:
                self.asked.put(json.loads(line))
            except json.JSONDecodeError:  # a library's own line
                continue
        self.asked.put({"do": "leave"})

    def tell(self, message: dict[str, Any]) -> None:
        """Tell the window something; it may be gone."""
        assert self.process.stdin is not None
        try:
            self.process.stdin.write(json.dumps(message) + "\n")
            self.process.stdin.flush()
        except (BrokenPipeError, ValueError):
            self.asked.put({"do": "leave"})

    def wait_ready(self) -> str:
        """Until the first picture is drawn; an error with what VTK has said if there is none. It says nothing."""
        try:
            first = self.asked.get(timeout=START_TIME)
        except queue.Empty:
            self.close()
            raise Error(f"the window did not open within {START_TIME:g} s") from None
        if first["do"] != "ready":
            status = self.process.wait(5.0)
            said = self._said() or [f"it died of {_cause(status)}"]
            self.close()
            raise Error(f"the window could not be opened: {said[-1]}")
        return ""

    def serve(self, host: Any, first: dict[str, Any] | None = None) -> None:
        """Until the person leaves: what is asked, what happens by itself, the clock. ``first`` is asked at once."""
        host.report()
        properties = host.properties()
        if properties:
            path = self.folder.path / "properties.npz"
            np.savez(path, **properties)
            self.tell({"tell": "properties", "path": str(path)})
        serve(self, host, first)
        self._check_end()

    def _said(self) -> list[str]:
        """Its lines, of whatever went wrong."""
        return self.said.read_text(errors="replace").strip().splitlines()

    def _check_end(self) -> None:
        """An error where the window has not left by itself."""
        try:
            status = self.process.wait(2.0)
        except subprocess.TimeoutExpired:  # it still says goodbye
            return
        if status:
            said = "".join(f" ({line})" for line in self._said()[-1:])
            raise Error(
                f"the window died of {_cause(status)}{said}; the session has ended in order, and what was recorded is "
                "kept"
            )

    def close(self) -> None:
        """End the window."""
        wires = [wire for wire in (self.process.stdin, self.process.stdout) if wire is not None]
        if self.process.poll() is None:
            _let_go(wires[0])
            try:
                self.process.wait(3.0)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.listener.join(1.0)
        for wire in wires:
            _let_go(wire)
        self.folder.close()


def _let_go(wire: IO[str]) -> None:
    """Close it, whether or not somebody still hears what was said last."""
    with suppress(BrokenPipeError):
        wire.close()


def _cause(status: int) -> str:
    """Of the end of a process: a signal's name, or its status."""
    return signal.Signals(-status).name if status < 0 else f"status {status}"
