# SPDX-License-Identifier: BSD-3-Clause
"""What goes wrong ends with one sentence on stderr and status 2: no traceback, nothing under a final name."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
from nanotouch.extras import ADDS, advice
from nanotouch_app.main import COMMANDS, GROUPS, build_parser, main
from synthetic import write_matrix

HEIGHTS = 1e-9 * np.random.default_rng(1).random((16, 16))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A working folder with files that are wrong in various ways."""
    monkeypatch.chdir(tmp_path)
    Path("empty.ibw").touch()
    Path("prose.txt").write_text("Dear colleague,\n\nthe image will follow tomorrow.\n")
    Path("noise.dat").write_bytes(bytes(range(256)) * 40)
    Path("file").write_text("not a folder\n")
    holes = HEIGHTS.copy()
    holes[1:] = np.nan
    write_matrix(Path("holes.txt"), holes, (1e-6, 1e-6))
    write_matrix(Path("no_unit.txt"), HEIGHTS, None, None)
    Path("soft.toml").write_text("[probe]\nspring_constant_N_per_m = 0\n")
    Path("metres.toml").write_text("[tip]\nradius_m = 20\n")
    Path("bare.toml").write_text("[tip]\nradius = 20\n")
    Path("typo.toml").write_text("[tip]\nradus_nm = 20\n")
    Path("unstable.toml").write_text("[gains]\nforce_gain = 10000\n")
    Path("broken.toml").write_text("[tip\n")
    return tmp_path


CASES: dict[str, tuple[list[str], list[str]]] = {
    "missing image": (["touch", "nowhere.ibw"], ["nowhere.ibw", "no such file"]),
    "empty image": (["touch", "empty.ibw"], ["empty.ibw", "empty"]),
    "prose": (["touch", "prose.txt"], ["prose.txt"]),
    "noise": (["touch", "noise.dat"], ["noise.dat"]),
    "a folder": (["touch", "."], ["folder"]),
    "holes": (["touch", "holes.txt"], ["holes.txt", "of the pixels are missing", "90 %"]),
    "no unit": (["touch", "no_unit.txt"], ["no_unit.txt", "unit"]),
    "k_c = 0": (["touch", "--scene", "soft.toml"], ["[probe] spring_constant_N_per_m = 0", "0.0001 .. 10000"]),
    "R in metres": (["touch", "--scene", "metres.toml"], ["[tip] radius_m = 20", "1e-10 .. 0.001"]),
    "no unit in key": (["touch", "--scene", "bare.toml"], ["radius lacks its unit", "radius_nm"]),
    "typo in key": (["curve", "--scene", "typo.toml"], ["radus_nm", "did you mean radius_nm"]),
    "unstable": (["touch", "--scene", "unstable.toml"], ["stability margin", "1.5"]),
    "broken scene": (["touch", "--scene", "broken.toml"], ["broken.toml is not a TOML file"]),
    "missing scene": (["curve", "--scene", "nowhere.toml"], ["nowhere.toml", "no such file"]),
    "no unit at": (["touch", "--at", "2.5,3"], ["'2.5' has no unit", "2.5um"]),
    "wrong unit at": (["touch", "--at", "2.5kg,3um"], ["'kg'", "um"]),
    "one length": (["touch", "--at", "2.5um"], ["1 lengths instead of 2", "2.5um,3um"]),
    "decimal comma": (["touch", "--at", "2,5um,3um"], ["3 lengths instead of 2"]),
    "at outside": (["touch", "--at", "2.5um,30um"], ["(2.5 um, 30 um) is outside", "0 .. 6 um"]),
    "line outside": (["touch", "--mode", "scan", "--line", "0um,0um,7um,0um"], ["(7 um, 0 um) is outside"]),
    "line of a point": (["touch", "--mode", "scan", "--line", "1um,1um,1um,1um"], ["length"]),
    "line in point mode": (["touch", "--line", "0um,0um,1um,0um"], ["--line goes with"]),
    "at in scan mode": (["touch", "--mode", "scan", "--at", "0um,0um"], ["--at goes with"]),
    "image and surface": (["touch", "prose.txt", "--surface", "dots"], ["not both"]),
    "pixel size without image": (["touch", "--pixel-size", "1nm"], ["--pixel-size goes with an IMAGE"]),
    "channel without image": (["touch", "--channel", "Height"], ["--channel goes with an IMAGE"]),
    "no time": (["touch", "--duration", "0s"], ["--duration 0s", "above 0 s"]),
    "too long": (["touch", "--duration", "1e9s"], ["--duration 1e9s", "600 s"]),
    "bare time": (["touch", "--duration", "20"], ["no unit", "20s"]),
    "out is a file": (["touch", "--duration", "1s", "--out", "file"], ["cannot write into file", "it is a file"]),
    "out is under a file": (["curve", "--out", "file/out"], ["cannot write into file/out", "Not a directory"]),
    "info on prose": (["info", "prose.txt"], ["prose.txt"]),
    "info on nothing": (["info", "nowhere"], ["nowhere", "no such file"]),
    "fit on prose": (["fit", "prose.txt"], ["prose.txt"]),
    "fit on nothing": (["fit", "nowhere.ibw"], ["nowhere.ibw", "no such file"]),
    "export nothing": (["export", "nowhere.mcap", "--out", "x.csv"], ["nowhere.mcap", "no such file"]),
    "export as text": (["export", "prose.txt", "--out", "x.txt"], [".csv, .h5, .hdf5"]),
    "export prose": (["export", "prose.txt", "--out", "x.csv"], ["prose.txt"]),
}


@pytest.mark.parametrize(("arguments", "words"), CASES.values(), ids=CASES.keys())
def test_one_sentence(arguments: list[str], words: list[str], folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    before = sorted(folder.rglob("*"))
    assert main(arguments) == 2
    said = capsys.readouterr()
    assert said.err.startswith(f"nanotouch {arguments[0]}: ")
    assert said.err.count("\n") == 1
    assert len(said.err) < 500
    assert all(word in said.err for word in words), said.err
    assert sorted(folder.rglob("*")) == before


def test_results_that_cannot_be_replaced(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder where a result should be written."""
    (folder / "out" / "summary.json").mkdir(parents=True)
    assert main(["touch", "--duration", "1s", "--out", "out", "--overwrite"]) == 2
    assert "cannot replace out/summary.json" in capsys.readouterr().err
    assert [path.name for path in (folder / "out").iterdir()] == ["summary.json"]


@pytest.mark.parametrize(
    "arguments",
    [["touhc"], ["touch", "--mode", "hover"], ["touch", "--seed", "x"], ["touch", "a", "b"], ["export", "a"]],
)
def test_wrong_usage(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    assert caught.value.code == 2
    said = capsys.readouterr().err
    assert "error: " in said
    assert said.count("\n") == 1


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as caught:
        main([command, "--help"])
    assert caught.value.code == 0
    said = capsys.readouterr().out
    assert said.startswith(f"usage: nanotouch {command}")
    assert command in build_parser().format_help()


def run(*arguments: str, blocked: tuple[str, ...] = (), cwd: Path) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own, without the named packages."""
    code = f"import sys\nfor name in {blocked!r}: sys.modules[name] = None\n"
    code += f"from nanotouch_app.main import main\nsys.exit(main({list(arguments)!r}))"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-W", "error", "-c", code]
    return subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)


EXTRAS = ("cv2", "scipy", "SurfaceTopography", "afmformats", "mcap", "h5py", "vtk", "vtkmodules", "aiohttp", "tqdm")
EXTRAS = (*EXTRAS, "matplotlib", "xarray", "nanotouch._fit")


@pytest.mark.parametrize(
    ("arguments", "extra"),
    [
        (["touch", "no_unit.txt"], "images"),
        (["touch"], "record"),
        (["curve"], "app"),
        (["info", "no_unit.txt"], "curves"),
        (["image", "no_unit.txt"], "images"),
        (["fit", "prose.txt"], "curves"),
        (["map", "prose.txt"], "maps"),
        (["export", "prose.txt", "--out", "x.csv"], "curves"),
    ],
)
def test_missing_extra_is_named(arguments: list[str], extra: str, folder: Path) -> None:
    done = run(*arguments, blocked=EXTRAS, cwd=folder)
    assert done.returncode == 2, done.stderr
    assert f"(extra {extra}, {ADDS[extra]}): {advice(extra)}" in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_touch_needs_the_recorder_only(folder: Path) -> None:
    """Pictures and bars are left out, and it is said what would bring them."""
    blocked = [name for name in EXTRAS if name not in ("mcap", "h5py")]
    done = run("touch", "--duration", "0.2s", "--out", "small", blocked=blocked, cwd=folder)
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (folder / "small").iterdir()) == ["recording.mcap", "summary.json"]
    assert "picture left out: matplotlib" in done.stdout
    assert "pip install vtk" in done.stdout


def test_help_and_doctor_need_nothing(tmp_path: Path) -> None:
    for arguments in (["--help"], ["--version"], ["doctor"]):
        done = run(*arguments, blocked=EXTRAS, cwd=tmp_path)
        assert done.returncode == 0, done.stderr
        assert done.stderr == ""
        assert "nanotouch" in done.stdout


def test_reader_of_the_output_goes_away(tmp_path: Path) -> None:
    """``nanotouch curve | true``"""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = f"{sys.executable} -m nanotouch_app curve | true"
    done = subprocess.run(
        command, shell=True, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert done.stderr == ""


def test_the_version_loads_no_command() -> None:
    code = "from nanotouch_app.main import main\ntry: main(['--version'])\nexcept SystemExit: pass\n"
    code += "import sys; print(*sorted(name for name in sys.modules if name.startswith('nanotouch_app.')))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    version, loaded = done.stdout.splitlines()
    assert version == f"nanotouch {nt.__version__}"
    assert "nanotouch_app.main" in loaded.split()
    commands = {f"nanotouch_app.{package}.{name}" for package, names in GROUPS.values() for name in names}
    assert not commands & set(loaded.split())
