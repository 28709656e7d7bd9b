# SPDX-License-Identifier: BSD-3-Clause
"""The window under Xvfb with a synthetic mouse: the tip follows, a picture is drawn, the session outlives it."""

from __future__ import annotations

import ctypes.util
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
import pytest
from nanotouch_app.live.desk import Desk
from nanotouch_app.live.host import Host
from nanotouch_app.live.picture import Layout
from nanotouch_app.live.subject import of_preset

ROOT = Path(__file__).parents[2]
XDND = Path(__file__).with_name("xdnd.py")
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

    size = (1440, 900)

    def __init__(self, screen: str, monkeypatch: pytest.MonkeyPatch, preset: str = "silicon_in_air") -> None:
        monkeypatch.setenv("DISPLAY", screen)
        subject = of_preset(preset)
        self.screen = screen
        self.desk = Desk(subject.topography)
        self.host = Host(subject, self.desk.tell)
        self.desk.wait_ready()  # the window outlives a slow start
        self.host.report()
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


def _slide_to_dry(live: Live) -> None:
    """The slider of humidity to its left end: the pull-off becomes that of the law in dry air."""
    x, y, _, height = Layout(*live.size).controls
    live.x("mousemove", round(x + 100), round(live.size[1] - (y + height - 8 - 38)))
    live.x("mousedown", 1)
    live.x("mousemove", round(x + 4), round(live.size[1] - (y + height - 8 - 38)))
    live.x("mouseup", 1)
    live.serve(lambda frame: live.host.session.scene["medium.relative_humidity"] == 0.0)
    dry, _ = nt.presets.silicon_in_air()
    dry["medium.relative_humidity"] = 0.0
    assert live.host.session.plan.pull_off_force == pytest.approx(dry.plan().pull_off_force, rel=1e-9)


def _recorded(path: Path, desk: Desk | None) -> Any:
    """A scripted touch of a stepped session, with a window that watches it or without."""
    host = Host(of_preset("silicon_in_air"), lambda message: None, out=str(path), stepped=True)
    if desk is not None:
        desk.tell(host.world())
    host.advance(0.1)
    for request, duration in (({"do": "press", "on": True}, 0.8), ({"do": "wheel", "steps": -4.0}, 0.2),
                              ({"do": "press", "on": False}, 0.5)):  # fmt: skip
        host.answer(request)
        host.advance(duration)
    host.close()
    return nt.record.read(path)


def test_a_window_changes_no_bit_of_a_recording(screen: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    alone = _recorded(tmp_path / "alone.mcap", None)
    monkeypatch.setenv("DISPLAY", screen)
    desk = Desk(of_preset("silicon_in_air").topography)
    try:
        desk.wait_ready()
        watched = _recorded(tmp_path / "watched.mcap", desk)
        assert desk.process.poll() is None
    finally:
        desk.close()
    assert len(alone) == len(watched) == 16_000
    for name, column in alone.columns.items():
        assert column.tobytes() == watched.columns[name].tobytes(), name


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
        live.x("keydown", "space")
        live.serve(lambda frame: frame["tip_force"][2] > 0.8 * live.host.core.state["press"])
        live.x("keyup", "space")
        live.serve(lambda frame: frame["gap"] > 0.0)
        live.x("key", "p")
        live.serve(lambda frame: live.host.paused)
        picture = tmp_path / "picture.png"
        live.desk.tell({"tell": "picture", "path": str(picture)})
        live.serve(lambda frame: any(one["do"] == "saved" for one in live.asked))
        pixels = pytest.importorskip("matplotlib.image").imread(picture)[..., :3]
        assert pixels.shape == (900, 1440, 3)
        assert len(np.unique((pixels * 255).astype(int).reshape(-1, 3), axis=0)) > 500
        live.x("key", "p")
        live.serve(lambda frame: not live.host.paused)
        live.x("key", "e", "3", "p")  # VTK by itself leaves at an E
        live.serve(lambda frame: live.host.paused)
        live.x("key", "p")
        _slide_to_dry(live)
        live.x("key", "q")
        live.serve(lambda frame: any(one["do"] == "leave" for one in live.asked))
        ticks = live.host.session.progress.ticks
        live.serve(lambda frame: live.host.session.progress.ticks > ticks + 100)  # it outlives the window
    finally:
        live.host.close()
        live.desk.close()


def test_a_person_scratches_gold_with_mouse_and_space(
    screen: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The drawn surface has the groove, and Z takes it back."""
    live = Live(screen, monkeypatch, "soft_gold")
    image = pytest.importorskip("matplotlib.image")

    def picture(name: str) -> Any:
        live.asked.clear()
        path = tmp_path / f"{name}.png"
        live.desk.tell({"tell": "picture", "path": str(path)})
        live.serve(lambda frame: any(one["do"] == "saved" for one in live.asked))
        return image.imread(path)[..., :3]

    try:
        live.x("mousemove", 440, 380)
        live.x("keydown", "space")
        before = live.serve(lambda frame: frame["tip_force"][2] > 0.8 * live.host.core.state["press"])
        live.x("mousedown", 1)
        live.x("mousemove_relative", "--", 60, 0)
        live.x("mouseup", 1)
        live.serve(lambda frame: frame["tip_position"][0] > before["tip_position"][0] + 10e-9)
        live.x("key", "z")
        live.serve(lambda frame: any(one["do"] == "undo" for one in live.asked))
        live.x("keyup", "space")
        live.serve(lambda frame: frame["gap"] > 5e-9)
        live.serve(lambda frame: any(dent.imprint[:2] != dent.imprint[2:4] for dent in live.host.dents))
        grooved = picture("groove")
        live.x("key", "z")
        live.serve(lambda frame: not live.host.dents)
        flat = picture("flat")
        view = np.s_[200:700, 100:800]
        assert np.abs(grooved[view] - flat[view]).max() > 0.1
    finally:
        live.host.close()
        live.desk.close()


def test_a_session_opens_a_window_that_watches(screen: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("DISPLAY", screen)
    session = nt.Session(seed=1)
    window = session.live()
    try:
        watched = session.run(0.5)
        assert window.poll() is None
    finally:
        window.communicate(timeout=PATIENCE)  # its input ends, and so does it
    alone = nt.Session(seed=1).run(0.5)
    assert watched.gap.tobytes() == alone.gap.tobytes()
    assert window.returncode == 0


def test_a_window_leads_the_session_of_this_program(screen: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its wheel goes through the queue: the tip comes down, touches and presses."""
    monkeypatch.setenv("DISPLAY", screen)
    session = nt.Session(rig=nt.Rig(master={"motor": "no", "gauge": "no"}), seed=1, recorded=False)
    window = session.live(hand=True)
    environment, end = {**os.environ, "DISPLAY": screen}, time.monotonic() + PATIENCE
    observer = nt.frames.attach(session._name)
    try:
        session.start("wall")
        subprocess.run(["xdotool", "mousemove", "440", "380"], env=environment, check=True)
        while observer.newest() is None or not observer.newest()["tip_force"][2] > 2e-8:
            assert time.monotonic() < end, "the hand does not press"
            subprocess.run(["xdotool", "click", "5"], env=environment, check=True)
            time.sleep(0.02)
        assert session.state == "RUN"
    finally:
        session.halt()
        window.communicate(timeout=PATIENCE)
        observer.close()


def _real_stage(folder: Path) -> Path:
    """A rig file whose slave is a shared object that calls itself real."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    source = ROOT / "tests" / "c" / "real_backend.c"
    flags = ["-std=c11", "-O1", "-fPIC", "-shared", "-D_POSIX_C_SOURCE=200809L", f"-I{ROOT}/libnanotouch/include"]
    subprocess.run([compiler, *flags, "-o", str(folder / "stage.so"), str(source)], check=True)
    file = folder / "rig.toml"
    file.write_text("[stage]\naxes = 1\n[slave]\nbackend = 'shared_object'\npath = 'stage.so'\n")
    return file


def test_the_command_leads_a_real_stage_at_hard_pace(screen: str, tmp_path: Path) -> None:
    """The wheel moves its hand, whatever the scheduler does with the deadlines; Q leaves, and the stage is lifted."""
    environment = {**os.environ, "DISPLAY": screen}
    kept = tmp_path / "touch.mcap"
    command = [sys.executable, "-m", "nanotouch_app", "live", str(_real_stage(tmp_path)), "--allow-code",
               "--record", str(kept)]  # fmt: skip
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True) as view:
        assert view.stdout is not None
        said = view.stdout.readline()
        assert "rig.toml: hard pace, for its slave is real" in said
        assert "your mouse leads the hand" in said
        assert "force on the hand: none" in view.stdout.readline()
        observer, end = nt.frames.attach(f"session-{view.pid}-1"), time.monotonic() + PATIENCE
        subprocess.run(["xdotool", "mousemove", "440", "380"], env=environment, check=True)
        start = None
        while start is None or not observer.newest()["master_position"][2] > start + 1e-5:
            assert time.monotonic() < end, "the hand does not move"
            subprocess.run(["xdotool", "click", "5"], env=environment, check=True)
            if start is None and observer.newest() is not None:
                start = observer.newest()["master_position"][2]
            time.sleep(0.02)
        observer.close()
        subprocess.run(["xdotool", "key", "q"], env=environment, check=True)
        assert view.wait(PATIENCE) == 0
    recording = nt.record.read(kept)
    assert recording.master_position.max() > start + 1e-5
    assert np.diff(recording.time).max() < 1.5 * np.median(np.diff(recording.time))  # no tick is lost


def test_no_window_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("vtkmodules")
    monkeypatch.setattr("nanotouch.touch.views.WINDOW", "nanotouch_app.live.nothing")
    with pytest.raises(nt.Error, match="could not be opened"):
        nt.Session(seed=1, recorded=False).live()


def test_a_window_that_dies_ends_the_session_in_words(screen: str, monkeypatch: pytest.MonkeyPatch) -> None:
    live = Live(screen, monkeypatch)
    try:
        live.desk.process.kill()
        with pytest.raises(nt.Error, match="the window died of SIGKILL"):
            live.desk.serve(live.host)
    finally:
        live.host.close()
        live.desk.close()


def test_a_file_that_is_dropped_on_the_window_is_touched(
    screen: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the protocol of X11's desktops, with a name that has to be quoted there."""
    if ctypes.util.find_library("X11") is None:
        pytest.skip("libX11 is not installed: apt-get install libx11-6")
    image = tmp_path / "my image.gwy"
    nt.images.write(image, nt.surface.dots(size=400e-9, pixels=64, count=6, seed=4))
    live = Live(screen, monkeypatch)
    try:
        search = ["xdotool", "search", "--name", "nanotouch live"]
        window = subprocess.run(search, capture_output=True, text=True, check=True).stdout.split()[-1]
        with subprocess.Popen([sys.executable, XDND, window, str(image)]) as source:
            live.serve(lambda frame: live.host.subject.name == image.stem)
            assert source.wait(PATIENCE) == 0
        live.serve(lambda frame: frame["tip_position"][0] > 100e-9)  # the middle of it
    finally:
        live.host.close()
        live.desk.close()
