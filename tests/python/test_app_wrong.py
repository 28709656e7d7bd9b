# SPDX-License-Identifier: BSD-3-Clause
"""Wrong input to every sub-command: status 2 and one line, with the value and what is valid; no traceback, nothing left
behind. Then what no table can hold: streams that are closed or full, and bugs of our own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from nanotouch import Scene, surface
from nanotouch.errors import InvalidValue
from nanotouch_app.common import guard, surfaces
from nanotouch_app.main import COMMANDS, main
from nanotouch_app.studies import plan
from wrong_inputs import CASES, make_files

for module in ("cv2", "SurfaceTopography", "afmformats", "mcap", "xarray", "matplotlib"):
    pytest.importorskip(module)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wrong")
    make_files(folder)
    return folder


def status_of(arguments: list[str]) -> int:
    try:
        return main(arguments)
    except SystemExit as stop:
        return int(stop.code or 0)


def test_there_are_many_and_of_every_command() -> None:
    assert len(CASES) >= 200
    elsewhere = {"recover", "push", "indent"}  # the last two: test_push_indent.py
    assert {arguments[0] for arguments, _ in CASES} >= {*COMMANDS} - elsewhere


@pytest.mark.parametrize(("arguments", "words"), CASES, ids=lambda value: " ".join(value)[:60].encode("unicode_escape"))
def test_one_line(
    arguments: list[str], words: list[str], files: Path,
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(files)
    monkeypatch.setitem(surfaces.BUILT_IN, "grating", lambda: surface.grating(pixels=64))  # sooner dilated
    before = sorted(files.rglob("*"))
    assert status_of(arguments) == 2
    said = capsys.readouterr().err
    assert said.startswith("nanotouch")
    assert (said.count("\n"), said[-1]) == (1, "\n")
    assert said[:-1].isprintable()
    assert len(said) < 700
    assert "Traceback" not in said
    for word in words:
        assert word in said
    assert sorted(files.rglob("*")) == before


@pytest.mark.parametrize("content", [b"\xef\xbb\xbf[tip]\nradius_nm = 30\n", b"[tip]\r\nradius_nm = 30\r\n"])
def test_what_editors_add_is_read(content: bytes, tmp_path: Path) -> None:
    """A byte-order mark; carriage returns."""
    file = tmp_path / "scene.toml"
    file.write_bytes(content)
    assert Scene.from_toml(file).tip.radius == 30e-9


def test_a_value_may_begin_with_a_minus(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    arguments = ["margins", "--no-map", "--out", str(tmp_path), "--force-range", "-20nN,500nN"]
    assert main(arguments) == 0
    assert "REFUSED" not in capsys.readouterr().out


def test_a_budget_of_nothing_is_no_plan() -> None:
    with pytest.raises(InvalidValue, match="budget = 0: it must be above 0"):
        Scene().plan(budget=0.0)


@pytest.mark.parametrize(
    ("text", "bodies"),
    [
        ("[sample]\nyoungs_modulus_Pa = 135\n", ["sample"]),
        ("[tip]\nyoungs_modulus_Pa = 135\n[medium]\nkind = 'liquid'\n", ["tip"]),
        ("[sample]\nyoungs_modulus_Pa = 135\n[medium]\nkind = 'liquid'\n", []),
        ("[sample]\nyoungs_modulus_kPa = 3\n", []),
    ],
)
def test_a_modulus_meant_in_gigapascals_is_noticed(
    text: str, bodies: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(text)
    for command in (["plan"], ["margins", "--no-map", "--out", str(tmp_path)]):
        assert main([*command, str(file)]) in (0, 1)
        told = [line for line in capsys.readouterr().out.splitlines() if "Young's modulus" in line]
        assert len(told) == len(bodies)
        for line, body in zip(told, bodies, strict=True):
            assert body in line
            assert line.endswith("perhaps meant in GPa: 135 Pa, limit 2 kPa")


def fail(failure: BaseException, monkeypatch: pytest.MonkeyPatch) -> int:
    def run(_: object) -> int:
        raise failure

    monkeypatch.setattr(plan, "run", run)
    return main(["plan", "silicon_in_air"])


def test_a_bug_is_told_as_ours(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert fail(ZeroDivisionError("division\nby zero"), monkeypatch) == guard.BUG == 70
    said = capsys.readouterr().err
    assert said.startswith(
        "nanotouch plan: a bug of nanotouch, please report it: ZeroDivisionError: division\\nby zero"
    )
    assert said.endswith("(NANOTOUCH_DEBUG=1 shows where it happened)\n")
    monkeypatch.setenv("NANOTOUCH_DEBUG", "1")
    with pytest.raises(ZeroDivisionError):
        fail(ZeroDivisionError(), monkeypatch)


@pytest.mark.parametrize(
    ("failure", "status", "words"),
    [
        (MemoryError(), 2, "nanotouch plan: there is not enough memory for this\n"),
        (OSError(28, "No space left on device", "x.csv"), 2, "nanotouch plan: x.csv: No space left on device\n"),
        (OSError(5, "Input/output error"), 2, "nanotouch plan: reading or writing failed: Input/output error\n"),
        (BrokenPipeError(), 1, ""),
        (KeyboardInterrupt(), 130, "nanotouch plan: stopped\n"),
    ],
)
def test_what_may_happen_is_no_bug(
    failure: BaseException, status: int, words: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert fail(failure, monkeypatch) == status
    assert capsys.readouterr().err == words


FULL = "cannot write to standard output: No space left on device"
CLOSED = "standard output is closed"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="/dev/full is of Linux")
@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize(
    ("line", "status", "words"),
    [
        ("plan silicon_in_air >/dev/full", 2, FULL),
        ("--help >/dev/full", 2, FULL),
        ("plan silicon_in_air >&-", 2, CLOSED),
        ("margins --no-map >&-", 2, CLOSED),
        ("plan silicon_in_air 2>&-", 0, ""),
        ("plan nowhere.toml 2>&-", 2, ""),
        ("plan nowhere.toml 2>/dev/full", 2, ""),
        ("plan silicon_in_air <&- >&- 2>&-", 2, ""),
        ("info nowhere | true", 0, "no such file"),
        ("plan --help | true", 0, ""),
    ],
)
def test_streams_that_fail(line: str, status: int, words: str, unbuffered: str, tmp_path: Path) -> None:
    """In processes of their own: no complaint of Python's at exit, either."""
    paths = os.pathsep.join(path for path in sys.path if path)
    done = subprocess.run(
        ["sh", "-c", f"{sys.executable} -m nanotouch_app {line}"], cwd=tmp_path, capture_output=True, text=True,
        env={**os.environ, "PYTHONPATH": paths, "PYTHONUNBUFFERED": unbuffered}, check=False,
    )  # fmt: skip
    assert done.returncode == status
    assert words in done.stderr
    assert done.stderr.count("\n") == bool(words)
    assert list(tmp_path.iterdir()) == []


def test_a_file_that_was_cut_short(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """HDF5 says it in the terms of its own superblock."""
    h5py = pytest.importorskip("h5py")
    whole, cut = tmp_path / "whole.h5", tmp_path / "cut.h5"
    with h5py.File(whole, "w") as file:
        file["heights"] = range(5000)
    size = whole.stat().st_size
    cut.write_bytes(whole.read_bytes()[:3000])
    assert status_of(["info", str(cut)]) == 2
    assert f"cut short: 3000 bytes of {size} are there" in capsys.readouterr().err
