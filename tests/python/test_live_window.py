# SPDX-License-Identifier: BSD-3-Clause
"""The window under Xvfb with a synthetic mouse: the tip follows, a picture is drawn, the session outlives it."""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nanotouch_app.live.desk import Desk
from nanotouch_app.live.host import Host
from nanotouch_app.live.subject import of_preset

PATIENCE = 60.0  # of a loaded machine that draws in software [s]


@pytest.fixture(scope="module")
def screen() -> Iterator[str]:
    """A display of its own."""
    pytest.importorskip("vtkmodules")
    if shutil.which("Xvfb") is None or shutil.which("xdotool") is None:
        pytest.skip("Xvfb and xdotool are not installed: apt-get install xvfb xdotool")
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1440x900x24"], pass_fds=[write], stderr=subprocess.DEVNULL
    )
    os.close(write)
    with os.fdopen(read) as pipe:
        name = f":{pipe.readline().strip()}"
    yield name
    server.terminate()
    server.wait()


class Live:
    """Host and window, served by hand."""

    def __init__(self, screen: str, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("DISPLAY", screen)
        subject = of_preset("silicon_in_air")
        self.screen = screen
        self.desk = Desk(subject.topography)
        self.host = Host(subject, self.desk.tell)
        self.desk.wait_ready()  # the window outlives a slow start
        self.desk.tell(self.host.world())
        self.asked: list[dict[str, Any]] = []

    def x(self, *arguments: object) -> None:
        """What mouse and keys do."""
        subprocess.run(["xdotool", *map(str, arguments)], env={**os.environ, "DISPLAY": self.screen}, check=True)

    def serve(self, until: Callable[[Any], bool], act: Callable[[], None] = lambda: None) -> Any:
        """The first frame of which this holds, while the window is served."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            while not self.desk.asked.empty():
                self.asked.append(self.desk.asked.get())
                if self.asked[-1]["do"] not in ("saved", "leave"):
                    self.host.answer(self.asked[-1])
            self.host.tick()
            frame = self.host.observer.newest()
            if frame is not None and until(frame):
                return frame
            act()
            time.sleep(0.02)
        raise AssertionError(f"it never came; asked was {self.asked[-5:]}")


def test_a_person_touches_with_the_mouse(screen: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    live = Live(screen, monkeypatch)
    try:
        live.x("mousemove", 440, 380)
        live.serve(lambda frame: frame["tip_force"][2] > 2e-8, lambda: live.x("click", 5))
        before = live.serve(lambda frame: True)
        live.x("mousedown", 1)
        live.x("mousemove_relative", "--", 40, 0)
        live.x("mouseup", 1)
        moved = live.serve(lambda frame: frame["tip_position"][0] > before["tip_position"][0] + 5e-9)
        assert abs(moved["tip_position"][1] - before["tip_position"][1]) < 5e-9
        live.x("key", "p")
        live.serve(lambda frame: live.host.paused)
        picture = tmp_path / "picture.png"
        live.desk.tell({"tell": "picture", "path": str(picture)})
        live.serve(lambda frame: any(one["do"] == "saved" for one in live.asked))
        pixels = pytest.importorskip("matplotlib.image").imread(picture)[..., :3]
        assert pixels.shape == (900, 1440, 3)
        assert len(np.unique((pixels * 255).astype(int).reshape(-1, 3), axis=0)) > 500
        live.x("key", "p")
        live.x("key", "q")
        live.serve(lambda frame: any(one["do"] == "leave" for one in live.asked))
        ticks = live.host.session.progress.ticks
        live.serve(lambda frame: live.host.session.progress.ticks > ticks + 100)  # it outlives the window
    finally:
        live.host.close()
        live.desk.close()
