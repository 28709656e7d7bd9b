# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch touch``, in every mode and on every built-in surface: the files it promises, and nothing else."""

from __future__ import annotations

import io
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from nanotouch import record
from nanotouch.scene.surface import grating
from nanotouch_app import view
from nanotouch_app.common import output
from nanotouch_app.main import main
from nanotouch_app.touching import report as told
from nanotouch_app.touching import touch
from nanotouch_app.touching.summary import words
from synthetic import write_ibw_image, write_matrix

pytest.importorskip("mcap")
pytest.importorskip("tqdm")
image = pytest.importorskip("matplotlib.image")
pytest.importorskip("vtkmodules")

KEYS = {  # of the interface, and beyond
    "models", "snap_in_force_N", "pull_off_force_N", "hand_pull_off_force_N", "position_tracking_rms_m",
    "force_tracking_rms_N", "loop_rate_Hz", "steps", "stability_margin", "force_limit_N", "force_overshoot_N",
    "surface", "mode", "hand_snap_in_force_N", "planned_pull_off_force_N", "largest_force_N", "alpha_p", "alpha_f",
    "dents", "largest_sideways_force_N", "touched", "duration_s", "incomplete", "stability", "calm", "states",
    "reasons", "seed", "version",
}  # fmt: skip
ALWAYS = {"recording.mcap", "summary.json", "time.png", "force_gap.png", "view.png"}


@pytest.fixture(autouse=True)
def no_display(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


@pytest.mark.parametrize(
    ("arguments", "duration"),
    [
        (["--mode", "point"], 5.0),
        (["--mode", "point", "--surface", "dots", "--at", "100nm,0.2um"], 5.0),
        (["--mode", "scan", "--surface", "flat", "--line", "0um,2um,6um,2um"], 8.0),
        (["--mode", "scan", "--line", "0.1um,2um,1.5um,2um"], 20.0),
        (["--mode", "topography", "--surface", "dots"], 5.0),
    ],
    ids=lambda value: "-".join(value) if isinstance(value, list) else None,
)
def test_leaves_what_it_promises(
    arguments: list[str], duration: float, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "new" / "out"
    assert main(["touch", *arguments, "--duration", f"{duration}s", "--out", str(out)]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    line = {"line.png"} if "point" not in arguments else set()
    assert names(out) == ALWAYS | line
    assert all(name in said.out.splitlines()[-1] for name in names(out))

    summary = json.loads((out / "summary.json").read_text())
    assert set(summary) == KEYS
    recording = record.read(out / "recording.mcap")
    # every step of the script is rounded to a tick
    assert len(recording) == summary["steps"] == pytest.approx(duration * 1e4, abs=10)
    assert summary["loop_rate_Hz"] == 1e4
    assert summary["mode"] == arguments[1]
    assert summary["incomplete"] is None
    assert summary["states"] == {"RUN": len(recording), "HOLD": 0, "RETRACT": 0, "LATCHED": 0}
    assert summary["stability_margin"] > 1.5
    assert summary["largest_force_N"] == recording.tip_force.max()
    assert len(summary["models"]) >= 3
    for picture in (ALWAYS | line) - {"recording.mcap", "summary.json"}:
        pixels = image.imread(out / picture)
        assert min(pixels.shape[:2]) > 400, picture
        assert pixels[..., :3].std() > 0.02, f"{picture} is blank"


def test_what_it_says_is_what_it_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    """On a flat at the defaults: the plan's 18 nN, felt through alpha_f."""
    assert main(["touch", "--surface", "flat", "--verbose", "--out", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    summary = json.loads((tmp_path / "summary.json").read_text())
    pull_off = summary["pull_off_force_N"]
    assert pull_off == pytest.approx(summary["planned_pull_off_force_N"], rel=0.1)  # smoothed against the noise
    assert summary["hand_pull_off_force_N"] == pytest.approx(summary["alpha_f"] * pull_off, rel=1e-12)
    assert 0.0 < summary["snap_in_force_N"] < pull_off
    assert f"{pull_off * 1e9:.1f} nN at the tip" in said
    assert f"{summary['stability_margin']:.1f} (1 is the limit)" in said
    assert all(line in said for line in summary["models"])
    assert "surface: flat, 6 x 6 um" in said
    assert summary["position_tracking_rms_m"] < 5e-9  # the paper's stage: 1 nm steps


def test_a_touch_is_told_in_four_answers(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    """What was touched, what was felt, was it safe, what to try next: short lines, the numbers of summary.json."""
    assert main(["touch", "--surface", "flat", "--out", str(tmp_path)]) == 0
    lines = capsys.readouterr().out.splitlines()
    summary = json.loads((tmp_path / "summary.json").read_text())
    titles = [line.split()[0] for line in lines if not line.startswith(" ")]
    assert titles == ["touched", "felt", "safe", "try", "written"]
    assert max(len(line) for line in lines[:-1]) <= 120
    assert len(lines) <= 9  # eight, and which files were written
    said = "\n".join(lines)
    assert f"pull-off {summary['pull_off_force_N'] * 1e9:.1f} nN at the tip" in said
    assert f"yes: no stop, and {summary['largest_force_N'] * 1e9:.1f} nN is below the limit" in said
    assert "nanotouch touch --surface flat --mode scan" in said
    assert "nanotouch touch --surface flat --verbose" in said


def test_a_touch_that_was_stopped_is_not_called_safe() -> None:
    facts = {
        "force_limit_N": 400e-9, "largest_force_N": 114.8e-9, "loop_rate_Hz": 1e4, "reasons": ["force limit"],
        "states": {"RUN": 100, "HOLD": 0, "RETRACT": 0, "LATCHED": 0},
    }  # fmt: skip
    assert told.verdict(facts) == "yes: no stop, and 114.8 nN is below the limit of 400 nN"
    assert told.verdict(facts | {"largest_force_N": 401e-9}) == "no stop, but 401.0 nN is above the limit of 400 nN"
    stopped = facts | {"states": {"RUN": 100, "HOLD": 20, "RETRACT": 3000, "LATCHED": 0}}
    assert told.verdict(stopped) == "it was stopped: HOLD for 0.002 s, RETRACT for 0.3 s (force limit)"


def test_a_touch_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    assert main(["touch", "--surface", "flat", "--duration", "1s", "--json", "--out", str(tmp_path)]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert printed.pop("folder") == str(tmp_path)
    assert set(printed.pop("files")) <= names(tmp_path)
    assert printed == json.loads((tmp_path / "summary.json").read_text())


def test_same_seed_same_recording(tmp_path: Path, undrawn: None) -> None:
    for name, seed in (("one", "3"), ("two", "3"), ("three", "4")):
        assert main(["touch", "--seed", seed, "--duration", "1s", "--out", str(tmp_path / name)]) == 0
    one, two, three = ((tmp_path / name / "recording.mcap").read_bytes() for name in ("one", "two", "three"))
    assert one == two != three


def test_overwrite_replaces_all_of_the_first_run(tmp_path: Path, undrawn: None) -> None:
    """What a scan left does not stand beside the results of a point; the user's own files stay."""
    (tmp_path / "notes.txt").write_text("mine")
    short = ["--surface", "flat", "--out", str(tmp_path)]
    assert main(["touch", "--mode", "scan", "--duration", "6s", *short]) == 0
    assert names(tmp_path) == ALWAYS | {"line.png", "notes.txt"}
    assert main(["touch", "--duration", "1s", *short, "--overwrite"]) == 0
    assert names(tmp_path) == ALWAYS | {"notes.txt"}
    assert json.loads((tmp_path / "summary.json").read_text())["mode"] == "point"


def test_touches_an_image(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    """Tilted by 2 degrees, read through its own format, levelled, and felt where it was asked for."""
    heights = grating(pixels=64, height=100e-9).heights
    tilt = 0.035 * 6e-6 / 64 * np.arange(64)
    file = write_ibw_image(tmp_path / "grating.ibw", {"HeightRetrace": heights + tilt}, 6e-6 / 64)
    out = tmp_path / "out"
    line = ["touch", str(file), "--at", "1.5um,3um", "--duration", "4s", "--out", str(out)]
    assert main(line) == 0
    said = capsys.readouterr().out
    assert "levelling: height range" in said
    assert "removed" not in said  # the steps are for --verbose
    assert main([*line, "--verbose", "--overwrite"]) == 0
    assert "a tilt of 2 degrees" in capsys.readouterr().out
    assert "touched  grating.ibw, 6 x 6 um, 64 x 64 pixels" in said
    assert "LevelReport(" not in said
    recording = record.read(out / "recording.mcap")
    assert recording.x[-1] == pytest.approx(1.5e-6, rel=1e-6)
    # a ridge (0.75 .. 2.25 um) of a levelled image, half of which is ridge
    assert recording.surface_height[-1] == pytest.approx(50e-9, abs=5e-9)


def test_image_without_units_is_touched_with_them(tmp_path: Path, undrawn: None) -> None:
    file = write_matrix(tmp_path / "matrix.txt", grating(pixels=32, height=100e-9).heights * 1e9, None, None)
    out = tmp_path / "out"
    arguments = ["touch", str(file), "--duration", "1s", "--out", str(out)]
    assert main(arguments) == 2
    assert not out.exists()
    assert main([*arguments, "--pixel-size", "100nm", "--z-unit", "nm"]) == 0
    assert np.ptp(record.read(out / "recording.mcap").surface_height) == 0.0


def test_scene_file(tmp_path: Path, undrawn: None) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(
        "[tip]\nradius_nm = 40\n[probe]\nspring_constant_N_per_m = 20\n[gains]\nrate_kHz = 5\nforce_gain = 1\n"
    )
    out = tmp_path / "out"
    assert main(["touch", "--scene", str(file), "--duration", "1s", "--out", str(out)]) == 0
    summary = json.loads((out / "summary.json").read_text())
    assert summary["loop_rate_Hz"] == 5e3
    assert summary["planned_pull_off_force_N"] == pytest.approx(2 * np.pi * 0.144 * 40e-9, rel=0.02)
    metadata = record.read(out / "recording.mcap").metadata
    assert metadata["spring_constant"] == 20.0
    assert metadata["settings"]["gains"]["force_gain"] == 1.0


def test_too_short_to_touch(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    """Nothing was felt: it says so, with null in the summary."""
    assert main(["touch", "--duration", "0.05s", "--verbose", "--out", str(tmp_path)]) == 0
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["force_tracking_rms_N"] is None
    assert summary["pull_off_force_N"] is None
    said = capsys.readouterr().out
    assert "none: never touched" in said
    assert "pull-off          none" in said
    assert not summary["touched"]
    touched = words(summary | {"touched": True})
    assert "snap-in           none: no sudden pull on the way in" in touched
    assert "pull-off          none: no sudden release on the way out" in touched


def test_window_opens_where_there_is_a_display(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, undrawn: None) -> None:
    opened: list[float] = []
    monkeypatch.setattr(view, "open_window", lambda _topography, _recording, radius: opened.append(radius))
    arguments = ["touch", "--duration", "0.5s", "--out", str(tmp_path), "--overwrite"]
    assert main(arguments) == 0
    assert not opened
    monkeypatch.setenv("DISPLAY", ":0")
    assert main([*arguments, "--no-window"]) == 0
    assert not opened
    assert main(arguments) == 0
    assert opened == [20e-9]


def test_as_a_command(tmp_path: Path) -> None:
    """In a process of its own, with warnings as errors."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-W", "error", "-m", "nanotouch_app", "touch", "--duration", "1s", "--no-window"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    assert names(tmp_path / "nanotouch-out") == ALWAYS
    assert done.stdout.splitlines()[-1].startswith("written to nanotouch-out/: recording.mcap, summary.json, ")


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.mark.parametrize(("stream", "shown"), [(Terminal(), True), (io.StringIO(), False)])
def test_progress_bar_on_a_terminal_only(stream: io.StringIO, shown: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", stream)
    with output.progress_bar("touching") as progress:
        progress(0.1)
        assert stream.getvalue() == ""  # nothing in the first second
        time.sleep(1.1)
        progress(0.5)
        progress(1.0)
    assert ("touching:  50%" in stream.getvalue()) == shown


def test_promised_files_are_listed_once() -> None:
    assert set(touch.FILES) == ALWAYS | {"line.png"}


def test_approach_and_curve(undrawn: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["touch", "--surface", "flat", "--mode", "approach", "--out", str(tmp_path / "a")]) == 0
    found = json.loads((tmp_path / "a" / "summary.json").read_text())
    assert names(tmp_path / "a") == ALWAYS | {"summary.json"}
    assert found["position_tracking_rms_m"] is None
    assert main(["touch", "--surface", "flat", "--mode", "curve", "--verbose", "--out", str(tmp_path / "c")]) == 0
    found = json.loads((tmp_path / "c" / "summary.json").read_text())
    assert found["stability_margin"] is None
    assert found["force_tracking_rms_N"] is None
    assert found["pull_off_force_N"] == pytest.approx(found["planned_pull_off_force_N"], rel=0.3)  # noise of 13 nN
    said = capsys.readouterr().out
    assert "none: no loop through the hand" in said
    assert "N_p = 400" in said


def test_how_the_loop_is_closed(undrawn: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["touch", "--surface", "flat", "--out", str(tmp_path), "--duration", "2s", "--overwrite", "--verbose"]
    assert main([*command, "--control", "paper"]) == 2  # its own stage loop is unstable
    assert "not armed: stability margin 0 (exact contact), at least 1.5" in capsys.readouterr().err
    assert main([*command, "--control", "paper", "--minimum-margin", "0"]) == 0
    assert "ARMED AGAINST THE VERDICT" in capsys.readouterr().out
    options = ["--control", "impedance", "--delay", "1ms", "--probe-model", "dynamic", "--force-range=-20nN,480nN"]
    assert main([*command, *options]) == 0
    read = record.read(tmp_path / "recording.mcap")
    assert read.metadata["control"] == "impedance"
    assert read.metadata["probe_model"] == "dynamic"
    assert read.metadata["settings"]["gains"]["delay"] == 11.0  # periods of 0.1 ms, with the rig's own
    assert read.metadata["alpha_f"] == pytest.approx(10.0 / 500e-9)  # Eq. 19, a gauge or motor of 5 N
    assert main([*command, "--rate", "2kHz", "--delay", "1ms"]) == 0
    read = record.read(tmp_path / "recording.mcap")
    assert read.metadata["loop_rate"] == 2e3
    assert read.metadata["settings"]["gains"]["delay"] == 3.0
    assert len(read) == pytest.approx(4000, abs=8)
    assert "at 2 kHz" in capsys.readouterr().out
    assert main(["touch", "--rate", "1MHz", "--out", str(tmp_path)]) == 2
    assert "a lower --rate" in capsys.readouterr().err
    (tmp_path / "recording.mcap").rename(tmp_path / "test.mcap")
    assert main([*command, "--force-range", str(tmp_path / "test.mcap")]) == 0
    assert main([*command, "--force-range", "plan"]) == 0
    assert main([*command, "--force-range", "5"]) == 2


def test_an_image_is_levelled_as_it_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str], undrawn: None) -> None:
    """A bow of 40 nm: found by itself, left to a plane, left alone; and a method that is none."""
    y, x = np.indices((64, 64)) / 63.0 - 0.5
    heights = 160e-9 * x**2 + 0.1e-9 * np.random.default_rng(1).standard_normal(x.shape) + 20e-9 * y
    file = str(write_matrix(tmp_path / "bow.txt", heights, (6e-6, 6e-6)))
    ranges = {}
    for method in ("auto", "plane", "none"):
        assert main(["touch", file, "--level", method, "--duration", "0.2s", "--out", str(tmp_path / method)]) == 0
        said = capsys.readouterr().out
        ranges[method] = float(said.partition("heights over ")[2].split()[0])
        assert ("levelling: height range" in said) == (method != "none")
    assert ranges["auto"] < 2.0
    assert 35.0 < ranges["plane"] < 45.0
    assert ranges["none"] > 50.0
    assert main(["touch", file, "--level", "flatten"]) != 0
    assert "method: 'flatten'" in capsys.readouterr().err


def test_no_pictures(tmp_path: Path) -> None:
    assert (
        main(["touch", "--surface", "flat", "--duration", "0.5s", "--no-pictures", "--out", str(tmp_path / "out")]) == 0
    )
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"recording.mcap", "summary.json"}


def test_a_limit_below_the_noise_of_the_lever_asks_for_no_longer_touch() -> None:
    facts = {"reasons": ["force limit"], "duration_s": 125.0}
    assert told.untouched(facts) == [
        "a softer lever or a higher force limit: the sensor read more than the limit, and nothing was touched"
    ]
    assert told.untouched(facts | {"reasons": ["invalid sample"]}) == []
    assert told.untouched(facts | {"reasons": []}) == ["a longer --duration than 125 s: nothing was touched"]
