# SPDX-License-Identifier: BSD-3-Clause
"""Every example of every ``--help`` and of the README works as written, in order, in an empty folder."""

from __future__ import annotations

import io
import json
import os
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import nanotouch as nt
import pytest
from nanotouch import presets
from nanotouch_app.common import output
from nanotouch_app.data import samples
from nanotouch_app.examples import EXAMPLES, FIRST
from nanotouch_app.main import COMMANDS, build_parser, main

for module in ("mcap", "tqdm", "matplotlib", "gwyfile", "h5py", "vtkmodules"):
    pytest.importorskip(module)
README = Path(__file__).parents[2] / "README.md"
LONG = (
    "nanotouch live silicon_in_air --film touch.gif",
    "nanotouch bench --quick",
    "nanotouch reproduce --figure 5",
)
ELSEWHERE = ("nanotouch workflow --pixels 48", "nanotouch tradeoff --quick")  # test_workflow.py, test_tradeoff.py
NEEDS = {"map": "xarray", "live": "PIL", "scan": "gwyfile"}
WINDOW = ("nanotouch live",)  # needs a display and a hand


@pytest.fixture
def empty(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, undrawn: None) -> Path:
    """A folder; pictures are those of the tests of each command."""
    monkeypatch.chdir(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


def works(line: str) -> bool:
    """Run one line of an example; the status may be 0, or 1 for an answer that is no."""
    words = shlex.split(line)
    assert words[0] == "nanotouch"
    if "--help" in words:
        with pytest.raises(SystemExit) as ended:
            main(words[1:])
        return ended.value.code == 0
    return main(words[1:]) in (0, 1)


def test_every_command_has_an_example() -> None:
    assert set(EXAMPLES) == set(COMMANDS)
    parser = build_parser()
    (commands,) = (action for action in parser._actions if isinstance(action.choices, dict))
    for name, command in dict(commands.choices or {}).items():
        assert EXAMPLES[name][0][0] in command.format_help() or name == "live", name


def test_the_examples_work_in_their_order(empty: Path) -> None:
    for command, lines in EXAMPLES.items():
        if command in NEEDS:
            pytest.importorskip(NEEDS[command])
        for line, _ in lines:
            if line not in (*LONG, *ELSEWHERE):
                assert works(line), line


@pytest.mark.slow
@pytest.mark.parametrize("line", LONG)
def test_the_long_examples_work(line: str, empty: Path) -> None:
    assert works(line)


def readme() -> list[str]:
    """The command lines of the README, in order."""
    blocks = re.findall(r"^```\n(nanotouch\b.*?)^```$", README.read_text(), re.MULTILINE | re.DOTALL)
    lines = [re.split(r"\s{2,}#", line)[0].strip() for block in blocks for line in block.splitlines()]
    return [line for line in lines if line]


@pytest.mark.skipif(not README.exists(), reason="needs the source tree")
def test_the_examples_of_the_readme_work_in_order() -> None:
    """Each is one of the examples, which are run above, and they come in the same order."""
    ran = iter([line for lines in EXAMPLES.values() for line, _ in lines])
    lines = [line for line in readme() if line not in ("nanotouch", *WINDOW)]
    assert 6 <= len(lines) <= 8  # what fits on a screen
    for line in lines:
        assert line in ran, line


def test_without_a_command_it_says_what_to_try(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([]) == 0
    said = capsys.readouterr().out
    assert all(line in said for line, _ in FIRST)
    with pytest.raises(SystemExit):
        main(["--help"])
    told = capsys.readouterr()
    assert "exit status:" in told.out + told.err


def test_the_help_loads_no_command() -> None:
    program = """if True:
        import sys
        from nanotouch_app.main import main
        try:
            main(["--help"])
        except SystemExit:
            pass
        heavy = ("nanotouch.images", "nanotouch.curves", "nanotouch.touch", "nanotouch.scene", "nanotouch_app.data")
        sys.exit([name for name in sys.modules if name.startswith(heavy)])
    """
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    line = [sys.executable, "-c", program]
    done = subprocess.run(line, env=environment, capture_output=True, text=True, check=False)
    assert done.stderr.splitlines()[-1] == "[]", done  # sys.exit of a list prints it


def test_python_m_nanotouch_is_the_command() -> None:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-m", "nanotouch", "--version"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout + done.stderr) == (0, f"nanotouch {nt.__version__}\n")


def test_samples_are_what_they_say(empty: Path) -> None:
    """The fit of the curve and the scene: what is known comes out."""
    assert main(["samples"]) == 0
    (curve,) = nt.curves.read("curve.h5")
    found = nt.fit.fit_curve(curve, "maugis", radius=samples.RADIUS)
    assert abs(found.values["effective_modulus"] - samples.MODULUS) < 4.0 * found.sigma["effective_modulus"]
    assert nt.images.read("scan.gwy").shape == (512, 512)
    assert nt.Scene.from_tables(tomllib.loads(Path("scene.toml").read_text())).tip.radius == samples.RADIUS
    assert main(["samples"]) == 2  # nothing is replaced
    assert main(["samples", "--overwrite"]) == 0


@pytest.mark.parametrize("name", presets.FELT)
def test_presets_are_scenes_of_every_command(name: str, empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["margins", name, "--no-map"]) in (0, 1)
    assert main(["curve", "--scene", name]) == 0
    capsys.readouterr()
    assert main(["plan", name, "--json"]) == 0
    planned = json.loads(capsys.readouterr().out)
    assert main(["touch", "--scene", name, "--surface", "flat", "--duration", "0.2s", "--json"]) in (0, 2)
    said = capsys.readouterr()
    if said.out:
        touched = json.loads(said.out)["planned_pull_off_force_N"]
        assert touched == pytest.approx(planned["pull_off_force"], rel=1e-6)
    else:
        assert "not armed" in said.err


def test_a_preset_that_is_none(capsys: pytest.CaptureFixture[str]) -> None:
    for command in (["plan"], ["touch", "--scene"], ["margins"], ["curve", "--scene"]):
        assert main([*command, "silicon_in_aid"]) == 2
        assert "did you mean silicon_in_air" in capsys.readouterr().err


def test_results_as_data(empty: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """All of stdout is JSON; what is not known is null."""
    asked = ["samples", "touch --duration 0.2s --out t", "info t/recording.mcap", "margins --no-map", "curve",
             "image scan.gwy", "export t/recording.mcap --out t.csv", "recover cut.mcap --out r.mcap",
             "fit curve.h5 --radius 20nm", "plan silicon_in_air", "doctor"]  # fmt: skip
    for line in asked:
        assert main([*line.split(), "--json"]) == 0, line
        answer = json.loads(capsys.readouterr().out, parse_constant=refused)
        assert isinstance(answer, dict)
        assert answer


def refused(constant: str) -> Any:
    raise AssertionError(f"{constant} is not JSON")


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize("command", [["plan", "silicon_in_air"], ["live", "--list"], ["scan", "--forecast"]])
def test_a_terminal_gets_no_line_that_is_too_wide(
    command: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The words are those that a file gets."""
    assert main(command) == 0
    plain = capsys.readouterr().out
    for columns in (60, 80) if command[0] != "scan" else (60,):  # whose forecast takes seconds
        shown = Terminal()
        with monkeypatch.context() as patch:
            patch.setenv("COLUMNS", str(columns))
            patch.setattr(sys, "stdout", shown)
            assert main(command) == 0
        lines = shown.getvalue().splitlines()
        timed = "on this machine"  # measured anew each time
        assert max(map(len, lines)) < columns < max(map(len, plain.splitlines()))
        assert shown.getvalue().partition(timed)[0].split() == plain.partition(timed)[0].split()


def test_a_wrapped_line_goes_on_below_its_text() -> None:
    assert output.wrapped("limits:  one two three", 17) == "limits:  one two\n    three"
    assert output.wrapped("limits:  one two three four", 27) == "limits:  one two three four"
    assert output.wrapped("hand:  one two three four", 21) == "hand:  one two three\n       four"
    assert output.wrapped("written to /a/long-path/that/is/one/word", 20).split()[-1] == "/a/long-path/that/is/one/word"


def test_seconds_are_shown_of_what_takes_long(monkeypatch: pytest.MonkeyPatch) -> None:
    shown = Terminal()
    monkeypatch.setattr(sys, "stderr", shown)
    with output.busy("planning", after=0.0):
        while "planning ... " not in shown.getvalue():
            pass
    assert shown.getvalue().endswith("\r")
    log = io.StringIO()
    monkeypatch.setattr(sys, "stderr", log)
    with output.busy("planning", after=0.0):
        pass
    assert log.getvalue() == ""
