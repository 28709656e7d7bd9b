# SPDX-License-Identifier: BSD-3-Clause
"""Each run has a folder of its own: a new one, or the one it is told, which holds no results of another run."""

from __future__ import annotations

import subprocess
import sys
from argparse import Namespace
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path

import pytest
from nanotouch.errors import Error
from nanotouch_app.common import output
from nanotouch_app.main import COMMANDS, build_parser, main

pytest.importorskip("tqdm")
pytest.importorskip("matplotlib")
FILES = ("a.json", "b.png")


def asked(out: Path | None = None, overwrite: bool = False) -> Namespace:
    return Namespace(out=out, overwrite=overwrite)


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def run(folder: Path) -> Path:
    with output.folder(asked(), FILES) as out:
        (out / "a.json").touch()
    return out


def test_every_run_has_a_new_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with ThreadPoolExecutor(16) as pool:
        folders = list(pool.map(run, [tmp_path] * 64))
    assert len(set(folders)) == 64
    assert names(tmp_path) == {"nanotouch-out", *(f"nanotouch-out-{number}" for number in range(2, 65))}


def test_two_commands_at_once(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "nanotouch_app", "curve"]
    runs = [subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.DEVNULL) for _ in range(2)]
    assert [process.wait() for process in runs] == [0, 0]
    assert names(tmp_path) == {"nanotouch-out", "nanotouch-out-2"}
    assert names(tmp_path / "nanotouch-out") == names(tmp_path / "nanotouch-out-2") == {"curve.csv", "curve.png"}


def test_results_are_not_replaced_unless_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    curve = ["curve", "--out", str(tmp_path)]
    (tmp_path / "notes.txt").write_text("mine")
    assert main(curve) == 0
    (tmp_path / "curve.csv").write_text("of value")
    capsys.readouterr()
    assert main(curve) == 2
    said = capsys.readouterr().err
    assert said.startswith(
        f"nanotouch curve: {tmp_path} holds results already (curve.csv, curve.png): name another --out"
    )
    assert said.count("\n") == 1
    assert (tmp_path / "curve.csv").read_text() == "of value"
    assert main([*curve, "--overwrite"]) == 0
    assert (tmp_path / "curve.csv").read_text() != "of value"
    assert names(tmp_path) == {"notes.txt", "curve.csv", "curve.png"}


def test_a_folder_in_use_is_refused(tmp_path: Path) -> None:
    """By a second run that is told the same folder, until the first has ended."""
    pytest.importorskip("fcntl")
    out = tmp_path / "new" / "out"

    def second() -> None:
        with output.folder(asked(out, overwrite=True), FILES):
            raise AssertionError("not reached")

    with output.folder(asked(out), FILES):
        with pytest.raises(Error, match=r"another run writes into .*out at this moment"):
            second()
        assert out.is_dir()
    assert names(tmp_path) == set()


@pytest.mark.parametrize("out", [None, Path("a/b/c")])
def test_a_refused_run_leaves_no_empty_folder(
    out: Path | None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)

    def refused(keep: bool) -> None:
        with output.folder(asked(out), FILES) as made:
            if keep:
                (made / "a.json").touch()
            raise Error("too far")

    with pytest.raises(Error, match="too far"):
        refused(keep=False)
    assert names(tmp_path) == set()
    with pytest.raises(Error, match="too far"):
        refused(keep=True)
    assert [path.name for path in tmp_path.rglob("*.json")] == ["a.json"]


def test_only_what_it_made_is_removed(tmp_path: Path) -> None:
    with ExitStack() as stack:
        stack.enter_context(output.folder(asked(tmp_path), FILES))
    assert tmp_path.is_dir()


@pytest.mark.parametrize("file", ["table.csv", "costs.json"])
def test_a_single_file_is_not_replaced_either(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path(file).write_text("of value")
    commands = [["fit", "no.ibw", "--out", file], ["export", "no.mcap", "--out", file]]
    for command in commands if file == "table.csv" else [["bench", "--out", file]]:
        assert main(command) == 2
        assert f"{file} exists already" in capsys.readouterr().err
    assert Path(file).read_text() == "of value"


@pytest.mark.parametrize(
    "command", [name for name in COMMANDS if name not in ("info", "plan", "doctor", "recover", "rig", "review")]
)  # review goes on with the file that it is told
def test_every_command_that_writes_takes_the_option(command: str) -> None:
    (commands,) = (action for action in build_parser()._actions if isinstance(action.choices, dict))
    assert dict(commands.choices or {})[command].get_default("overwrite") is False
