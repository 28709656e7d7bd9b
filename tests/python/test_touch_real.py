# SPDX-License-Identifier: BSD-3-Clause
"""A rig file as a scene: a script moves its real halves at hard pace; margins and plan read the rest of it."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import record
from nanotouch_app.main import main

ROOT = Path(__file__).parents[2]
RIG = ROOT / "docs/examples/rig/rig.toml"


@pytest.fixture(scope="module")
def stage(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A rig file whose slave is a shared object that calls itself real: a stage over a spring."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = tmp_path_factory.mktemp("rig")
    source = ROOT / "tests" / "c" / "real_backend.c"
    flags = ["-std=c11", "-O1", "-fPIC", "-shared", "-D_POSIX_C_SOURCE=200809L", f"-I{ROOT}/libnanotouch/include"]
    subprocess.run([compiler, *flags, "-o", str(folder / "stage.so"), str(source)], check=True)
    file = folder / "rig.toml"
    file.write_text(
        "[stage]\naxes = 1\n[gains]\nrate_Hz = 200\n[slave]\nbackend = 'shared_object'\npath = 'stage.so'\n"
        "[master]\ngauge = 'no'\n"
    )
    return file


def test_a_script_runs_at_the_pace_of_the_clock(stage: Path) -> None:
    file = nt.rig_file.read(stage, allow_code=True)
    rig = nt.Rig.from_tables(file.rig)
    settings = nt.Settings.for_rig(rig)
    settings.update_from_tables(file.rig)
    session = nt.Session(rig=rig, settings=settings, slave=file.slave, preflight=False, minimum_margin=0.0)
    done: list[float] = []
    recording = session.run(0.5, progress=done.append)
    assert done[-1] == 1.0
    assert not session.progress.runs
    assert 1 <= len(recording.time) <= 100  # a busy machine loses periods
    assert np.all(np.diff(recording.time) > 0.0)
    assert np.all(np.isnan(recording.gap))  # nobody knows the truth


def test_an_error_on_the_way_ends_the_thread(stage: Path) -> None:
    file = nt.rig_file.read(stage, allow_code=True)
    session = nt.Session(rig=nt.Rig.from_tables(file.rig), slave=file.slave, preflight=False, minimum_margin=0.0)

    def fail(_: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        session.run(1.0, progress=fail)
    assert not session.progress.runs


@pytest.mark.usefixtures("undrawn")
def test_the_command(stage: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    options = ["--no-window", "--minimum-margin", "0", "--duration", "0.5s"]
    assert main(["touch", "--scene", str(stage), "--allow-code", *options, "--out", str(out)]) == 0
    told = capsys.readouterr().out
    assert "recording.mcap" in told
    rows = record.read(out / "recording.mcap")
    assert np.all(np.isfinite(rows.stage_position))
    assert json.loads((out / "summary.json").read_text())


def test_margins_and_plan_read_a_rig_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["margins", str(RIG), "--no-map", "--out", str(tmp_path / "margins")]) in (0, 1)
    assert "verdict: " in capsys.readouterr().out
    assert main(["plan", str(RIG)]) == 0
    assert main(["touch", "--scene", str(RIG), "--no-window", "--out", str(tmp_path / "touch")]) == 2
    assert "/dev/spidev0.0: open: " in capsys.readouterr().err
    assert not (tmp_path / "touch").exists()
