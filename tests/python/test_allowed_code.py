# SPDX-License-Identifier: BSD-3-Clause
"""No file names code: a shared object runs from a rig file that the user has allowed, and from nothing else."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import nanotouch as nt
import pytest
from nanotouch import rig_file
from nanotouch.errors import InvalidValue
from nanotouch.touch import allowed_code
from nanotouch_app import main as command

MARKER = """#include <stdio.h>
__attribute__((constructor)) static void run(void) { FILE *f = fopen("%s", "w"); if (f) fclose(f); }
"""
KINDS = ("scene.toml", "surface.toml", "law.toml", "iio.toml", "image.gsf", "curve.csv", "map.nc", "recording.mcap",
         "recording.json", "results.zip")  # fmt: skip


@pytest.fixture(autouse=True)
def _own_configuration(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "configuration"))


@pytest.fixture
def marker(tmp_path: Path, undrawn: None) -> Path:
    """A folder whose ``height.png`` is a shared object that leaves ``ran`` when it is loaded, with Python modules that
    do the same, under names that ours import."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    ran = folder / "ran"
    source = tmp_path / "mark.c"
    source.write_text(MARKER % ran)
    subprocess.run([compiler, "-shared", "-fPIC", "-o", str(folder / "height.png"), str(source)], check=True)
    for name in ("numpy", "h5py", "mcap", "evil", "SurfaceTopography", "matplotlib"):
        (folder / f"{name}.py").write_text(f"open({str(ran)!r}, 'w')\nraise ImportError('from the folder')\n")
    return folder


def _files(folder: Path) -> list[Path]:
    """A file of each kind that tries to have ``height.png`` or ``evil`` loaded."""
    slave = '[slave]\nbackend = "shared_object"\npath = "height.png"\n'
    made = {
        "scene.toml": "[tip]\nradius_nm = 20\n" + slave,
        "surface.toml": '[surface]\nimage = "height.png"\nreader = "evil"\n',
        "law.toml": "[terms.evil]\nstrength = 1\n",
        "iio.toml": '[slave]\nbackend = "iio"\ncontext = "../height.png:"\n',
        "recording.json": json.dumps({"slave": {"backend": "shared_object", "path": "height.png"}}),
    }
    for name in KINDS:
        (folder / name).write_text(made.get(name, slave))
    return [folder / name for name in KINDS]


def _lines(file: str) -> list[list[str]]:
    """Every command with this file, wherever it takes one."""
    out = ["--out", "out", "--overwrite"]
    return [
        ["touch", "--scene", file, "--no-window", *out], ["touch", file, "--no-window", *out],
        ["scan", "--scene", file, *out], ["scan", file, *out], ["scan", "--scene", file, "--forecast"],
        ["live", file], ["live", file, "--browser", "--port", "0"], ["live", file, "--film", "film.gif"],
        ["live", file, "--radius", "30nm"],
        ["margins", file, "--no-map", *out], ["plan", file], ["plan", "--surface", file], ["curve", "--scene", file],
        ["fit", file, "--scene", file, *out], ["fit", file, "--calibration", file, *out],
        ["indent", "--scene", file, *out], ["image", file, *out], ["image", file, "--config", file, *out],
        ["map", file, *out], ["info", file], ["report", file], ["review", file], ["export", file, "x.csv"],
        ["recover", file], ["recalibrate", file, *out], ["rig", "check", file],
        ["rig", "probe", file, "--seconds", "0.1"], ["rig", "calibrate", file], ["samples", file],
        ["push", file], ["bench", file], ["workflow", file],
    ]  # fmt: skip


def test_every_command_has_a_line() -> None:
    named = {line[0] for line in _lines("file")}
    no_file = {"reproduce", "tradeoff", "latency", "doctor"}
    assert named | no_file == set(command.COMMANDS)


@pytest.mark.parametrize("kind", KINDS)
def test_no_command_loads_what_a_file_names(kind: str, marker: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(marker)
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.setattr("nanotouch_app.live.display.check", lambda: _refuse())
    monkeypatch.setattr("nanotouch_app.browser.desk.BrowserDesk", lambda *_, **__: _refuse())
    file = next(one for one in _files(marker) if one.name == kind)
    for line in _lines(str(file)):
        try:
            status = command.main(line)
        except SystemExit as end:
            status = int(end.code or 0)
        assert status in (0, 1, 2), line
        assert not (marker / "ran").exists(), line


def _refuse() -> None:
    raise InvalidValue("no window in this test")


def test_a_program_of_its_own_in_a_folder_from_elsewhere(marker: Path) -> None:
    """Neither the command nor the workers that it starts import from the folder in which they are called."""
    program = Path(sys.executable).with_name("nanotouch")
    line = [str(program)] if program.exists() else [sys.executable, "-P", "-m", "nanotouch_app"]
    (scene,) = [one for one in _files(marker) if one.name == "scene.toml"]
    for rest in (["info", "image.gsf"], ["touch", "--scene", scene.name, "--out", "o"]):
        done = subprocess.run([*line, *rest], cwd=marker, capture_output=True, text=True, timeout=120)
        assert done.returncode == 2, done
    assert "names code" in done.stderr
    assert "nanotouch rig allow" in done.stderr
    assert not (marker / "ran").exists()
    line = [*line, "touch", "--scene", scene.name, "--out", "o", "--allow-code"]
    assert subprocess.run(line, cwd=marker, capture_output=True, timeout=120).returncode == 2  # it is no stage
    assert (marker / "ran").exists(), "this is how a file that is loaded shows"


def _rig(folder: Path, path: str = "stage.so") -> Path:
    file = folder / "rig.toml"
    file.write_text(f"[stage]\naxes = 1\n[slave]\nbackend = 'shared_object'\npath = {json.dumps(path)}\n")
    return file


def _is_read(file: Path, **options: bool) -> bool:
    try:
        return isinstance(rig_file.read(file, **options).slave, nt.hal.SharedObject)
    except InvalidValue as refused:
        assert str(file) in str(refused)  # noqa: PT017  some are refused, some not
        return False


def test_what_is_allowed_is_remembered_for_this_file_and_content(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = _rig(tmp_path)
    (tmp_path / "stage.so").write_bytes(b"first")
    assert not _is_read(file)
    assert _is_read(file, allow_code=True)
    assert not _is_read(file), "for once is not for good"
    assert command.main(["rig", "check", str(file)]) == 0
    assert "not allowed yet" in capsys.readouterr().out
    assert command.main(["rig", "allow", str(file)]) == 0
    assert _is_read(file)
    assert command.main(["rig", "check", str(file)]) == 0
    assert "not allowed" not in capsys.readouterr().out.splitlines()[-1]
    copy = tmp_path / "scene.toml"
    shutil.copy(file, copy)
    assert not _is_read(copy), "another file that names the same code"
    (tmp_path / "stage.so").write_bytes(b"second")
    assert not _is_read(file), "the code has changed"
    assert os.stat(allowed_code.configuration()).st_mode & 0o077 == 0


@pytest.mark.parametrize("way", ["link", "up", "whole", "folder_link"])
def test_code_lies_beside_its_rig_file_or_in_a_folder_of_the_user(way: str, tmp_path: Path) -> None:
    other, folder = tmp_path / "other", tmp_path / "rig"
    other.mkdir()
    folder.mkdir()
    (other / "stage.so").write_bytes(b"code")
    (folder / "stage.so").symlink_to(other / "stage.so")
    (folder / "sub").symlink_to(other)
    path = {"link": "stage.so", "up": "../other/stage.so", "whole": str(other / "stage.so"),
            "folder_link": "sub/stage.so"}[way]  # fmt: skip
    file = _rig(folder, path)
    with pytest.raises(InvalidValue, match="outside the folder of the rig file"):
        rig_file.read(file, allow_code=True)
    assert command.main(["rig", "allow", str(file)]) == 2
    kept = allowed_code.configuration()
    kept.mkdir(parents=True)
    (kept / "code_folders").write_text(f"# of the laboratory\n{other}\n")
    assert _is_read(file, allow_code=True)
    (kept / "code_folders").write_text("other\n")
    with pytest.raises(InvalidValue, match="whole path"):
        rig_file.read(file, allow_code=True)


@pytest.mark.parametrize("text", ["[", "[1]", '{"a": 1}', "[" * 100000, "\x00"])
def test_a_list_that_is_spoilt_allows_nothing(text: str, tmp_path: Path) -> None:
    file = _rig(tmp_path)
    (tmp_path / "stage.so").write_bytes(b"code")
    kept = allowed_code.configuration()
    kept.mkdir(parents=True)
    (kept / "allowed_code.json").write_text(text)
    with pytest.raises(InvalidValue, match="repair or delete it"):
        rig_file.read(file)


def test_tables_alone_need_the_word_of_the_caller(tmp_path: Path) -> None:
    (tmp_path / "stage.so").write_bytes(b"code")
    tables = {"slave": {"backend": "shared_object", "path": "stage.so"}}
    with pytest.raises(InvalidValue, match="not allowed"):
        rig_file.from_tables(tables, tmp_path)
    assert rig_file.from_tables(tables, tmp_path, allow_code=True).slave is not None
