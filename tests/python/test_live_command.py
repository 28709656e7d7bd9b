# SPDX-License-Identifier: BSD-3-Clause
"""What `nanotouch live` refuses before it opens anything, and how it says so."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import nanotouch as nt
import pytest

pytest.importorskip("vtkmodules")
from nanotouch_app import view
from nanotouch_app.live import desk as desks
from nanotouch_app.live import offer
from nanotouch_app.main import main


def _refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    assert main(["live", *words]) == 2
    return capsys.readouterr().err


def test_a_wrong_name_is_told_before_the_display(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    assert "missing.ibw: neither a file nor a preset" in _refused(capsys, "missing.ibw")
    assert "DISPLAY is not set" in _refused(capsys, "silicon_in_air")


@pytest.mark.parametrize(("option", "ending"), [("--film", ".gif"), ("--record", ".mcap")])
def test_a_file_that_exists_is_refused_by_its_own_option(
    tmp_path: Path, option: str, ending: str, capsys: pytest.CaptureFixture[str]
) -> None:
    held = tmp_path / f"held{ending}"
    held.write_text("mine")
    assert f"name another {option}, or add --overwrite" in _refused(capsys, option, str(held))
    assert held.read_text() == "mine"


@pytest.mark.parametrize(("option", "valid"), [("--film", ".gif, .mp4, .png"), ("--record", ".mcap")])
@pytest.mark.parametrize("name", ["foo.txt", "foo", "foo.mcap.gz"])
def test_a_file_of_another_kind_is_refused_with_the_valid_ones(
    tmp_path: Path, option: str, valid: str, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    made = tmp_path / name
    assert f"{made}: valid endings are {valid}" in _refused(capsys, option, str(made))
    assert not made.exists()


def test_what_a_killed_view_leaves_is_removed_by_the_next(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    program = (
        "import os, signal; from nanotouch.touch.scratch import Scratch; kept = Scratch(); "
        "print(kept.path, flush=True); "
    )
    with subprocess.Popen([sys.executable, "-c", program + "input()"], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                          text=True) as lives:  # fmt: skip
        assert lives.stdout is not None
        alive = Path(lives.stdout.readline().strip())
        killed = subprocess.run([sys.executable, "-c", program + "os.kill(os.getpid(), signal.SIGKILL)"],
                                capture_output=True, text=True, check=False)  # fmt: skip
        left, other = Path(killed.stdout.strip()), tmp_path / "nanotouch-live-not-ours"
        other.mkdir()
        assert left.is_dir()
        assert left.parent == tmp_path
        own = desks.Scratch()
        assert sorted(tmp_path.iterdir()) == sorted((alive, own.path, other))
        own.close()
        assert not own.path.exists()
        lives.communicate("\n")


@pytest.mark.parametrize(("option", "name"), [("--film", "a.png"), ("--record", "a.mcap")])
def test_a_missing_folder_is_told_before_the_work(
    tmp_path: Path, option: str, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert f"{tmp_path / 'none'} is not a folder" in _refused(capsys, option, str(tmp_path / "none" / name))


def test_a_hand_that_there_is_none_of_is_told_before_the_display(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    assert "--hand foot: valid are auto, none, gamepad, spacemouse" in _refused(capsys, "--hand", "foot")


def test_a_film_ends_at_a_signal_that_comes_while_vtk_draws(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """VTK prints what is raised inside its callbacks, and goes on."""
    works, reason = view.probe()
    if not works:
        pytest.skip(reason)
    drawn = []

    def paint(self: Any, item: Any, context: Any) -> bool:
        if not drawn:
            drawn.append(item)
            signal.raise_signal(signal.SIGINT)
        return True

    monkeypatch.setattr("nanotouch_app.live.picture._Item.Paint", paint)
    monkeypatch.setattr("nanotouch_app.live.film.RATE", 4.0)
    out = tmp_path / "touch.gif"
    assert main(["live", "--film", str(out)]) == 128 + signal.SIGINT
    assert capsys.readouterr().err == "nanotouch live: stopped by SIGINT\n"
    assert drawn
    assert not out.exists()


def test_options_that_would_do_nothing_are_refused(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    film = tmp_path / "a.gif"
    assert "--task cannot be used with it" in _refused(capsys, "--film", str(film), "--task", "find")
    assert "--browser cannot be used with it" in _refused(capsys, "--film", str(film), "--browser")
    assert "--page cannot be used with it" in _refused(capsys, "--page", "a.html")
    assert "--port cannot be used with it" in _refused(capsys, "--port", "8000")
    assert "no force curve: --radius cannot be used with it" in _refused(capsys, "mica_in_air", "--radius", "30nm")
    monkeypatch.setattr("nanotouch_app.live.command.record.is_recording", lambda path: True)
    played = tmp_path / "touch.mcap"
    played.write_text("a recording")
    said = _refused(capsys, str(played), "--task", "find", "--record", str(tmp_path / "b.mcap"))
    assert "touch.mcap is a recording, which is played: --task and --record cannot be used with it" in said


def test_a_window_that_is_killed_while_it_opens_says_by_what(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    killed = tmp_path / "killed"
    killed.write_text(f"#!{sys.executable}\nimport os, signal\nos.kill(os.getpid(), signal.SIGKILL)\n")
    killed.chmod(0o755)
    monkeypatch.setattr(desks.sys, "executable", str(killed))
    desk = desks.Desk(nt.surface.grating())
    with pytest.raises(nt.Error, match="could not be opened: it died of SIGKILL"):
        desk.wait_ready()


@pytest.mark.parametrize(
    ("terminal", "display", "told"),
    [
        (False, "", "not at a terminal"),
        (True, "no display: DISPLAY is not set", "no display: DISPLAY is not set"),
        (True, "", "now with your own hand"),
    ],
)
def test_the_demo_ends_in_the_live_view_where_somebody_is_there(
    terminal: bool, display: str, told: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("vtkmodules")
    begun: list[list[str]] = []

    def check() -> None:
        if display:
            raise nt.Error(display)

    def command(arguments: list[str]) -> int:
        begun.append(arguments)
        return 0

    monkeypatch.setattr("sys.stdin.isatty", lambda: terminal)
    monkeypatch.setattr("sys.stdout.isatty", lambda: terminal)
    monkeypatch.setattr("nanotouch_app.live.display.check", check)
    monkeypatch.setattr("nanotouch_app.main.main", command)
    assert offer.main(["my image.gwy"]) == 0
    said = capsys.readouterr().out
    assert told in said
    assert 'nanotouch live "my image.gwy"' in said
    assert begun == ([["live", "my image.gwy"]] if terminal and not display else [])


def test_a_window_that_has_left_may_still_be_told_something(monkeypatch: pytest.MonkeyPatch) -> None:
    """What it did not hear any more is no error, neither then nor when the wire is closed."""
    monkeypatch.delenv("DISPLAY", raising=False)
    desk = desks.Desk(nt.surface.grating())
    desk.process.kill()
    desk.process.wait()
    desk.tell({"tell": "note", "text": "nobody hears it"})
    assert desk.process.stdin is not None
    desk.close()
    assert desk.process.stdin.closed
