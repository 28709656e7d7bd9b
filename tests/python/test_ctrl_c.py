# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C in the long commands: answered within a second, whatever the compiled code has in hand; what is done is kept,
and how much that is is said. Each runs in a process of its own."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from nanotouch import awaiting, manipulation, maps
from nanotouch.awaiting import awaited, each
from nanotouch_app.main import main
from nanotouch_app.studies.workflow import steps
from synthetic import write_nanoscope

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("xarray")
pytest.importorskip("h5netcdf")
pytest.importorskip("matplotlib")

WITHIN = 5.0  # [s]; one is due, and the machine may be busy with other tests
RAMP, SENSITIVITY, STIFFNESS = 300e-9, 41e-9, 0.5  # m, m/V, N/m
KNOWN = ["--radius", "20nm", "--spring-constant", "0.5N/m"]


def begun(line: list[str], ignored: bool = False) -> subprocess.Popen[str]:
    """The command, in a process in which a shell lets Ctrl-C through or ignores it."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    handler = signal.SIG_IGN if ignored else signal.default_int_handler
    before = signal.signal(signal.SIGINT, handler)  # what is ignored is handed down
    try:
        return subprocess.Popen(
            [sys.executable, "-m", "nanotouch_app", *line],
            env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
    finally:
        signal.signal(signal.SIGINT, before)


def stopped(line: list[str], there: Callable[[], bool], later: float = 0.0) -> str:
    """What a command says that is stopped once something is there, and some time [s] later."""
    process = begun(line)
    while not there():
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    time.sleep(later)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    said = process.communicate()[1]
    assert time.monotonic() - sent < WITHIN
    assert process.returncode == 130, said
    return said.strip().splitlines()[-1]


def ramps(count: int) -> list[tuple[np.ndarray, np.ndarray]]:
    sample = maps.synthesize(
        np.full((1, count), 1e8), np.array([[0.01]]), radius=20e-9, spring_constant=STIFFNESS, depth=20e-9,
        clearance=RAMP - 20e-9, points=600, noise=20e-12, model="dmt",
    )  # fmt: skip
    volts = sample.values / STIFFNESS / SENSITIVITY
    return [(curve[:600][::-1], curve[600:]) for curve in volts.reshape(count, 1200)]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Of many curves."""
    (tmp_path / "day").mkdir()
    first = write_nanoscope(tmp_path / "day/000.spm", ramps(1), ramp=RAMP, sensitivity=SENSITIVITY).read_bytes()
    for number in range(1, 300):
        (tmp_path / f"day/{number:03}.spm").write_bytes(first)
    return tmp_path / "day"


def lines(path: Path) -> int:
    return path.read_bytes().count(b"\n") if path.exists() else 0


def test_a_push_keeps_its_way(tmp_path: Path) -> None:
    line = ["push", "--to", "400um,3um", "--tolerance", "1nm", "--out", str(tmp_path / "out")]
    said = stopped(line, (tmp_path / "out").exists, 1.0)
    if "nothing is kept" not in said:
        pushes = int(said.split("; ")[1].split()[0])
        assert 0 < pushes < 200
        assert "kept in" in said
        assert lines(tmp_path / "out/push.csv") > 5 * pushes  # eight points a push, and a head


def test_a_workflow_keeps_its_finished_steps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its steps take a minute; here the first is a push, and the next never ends."""
    done = manipulation.push(manipulation.latex(500e-9), (1e-6, 0.0))

    def work(_pixels: int, _seed: int, kept: Callable[[str, object], None]) -> None:
        kept("pushed", done)
        threading.Timer(0.1, signal.raise_signal, [signal.SIGINT]).start()
        time.sleep(2.0)

    monkeypatch.setattr(steps, "work", work)
    start = time.monotonic()
    assert main(["workflow", "--out", str(tmp_path / "out")]) == 130
    assert time.monotonic() - start < WITHIN
    assert f"push.csv: 1 of 5 files is kept in {tmp_path / 'out'}" in capsys.readouterr().err
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["push.csv"]


def test_a_workflow_answers_while_it_scans(tmp_path: Path) -> None:
    out = tmp_path / "out"
    said = stopped(["workflow", "--pixels", "512", "--out", str(out)], out.exists, 0.5)
    assert "nothing is kept" in said
    assert not out.exists()


def test_a_map_keeps_its_finished_curves(tmp_path: Path) -> None:
    file = write_nanoscope(tmp_path / "map.000", 12 * ramps(48), ramp=RAMP, sensitivity=SENSITIVITY)
    out = tmp_path / "out"
    line = ["map", str(file), "--model", "maugis", *KNOWN, "--out", str(out)]
    said = stopped(line, lambda: any(out.glob("map.blocks/block-*.npz")))
    kept = 64 * len(list(out.glob("map.blocks/block-*.npz")))
    assert 0 < kept < 576
    assert f"{kept} curves are kept: --out {out} goes on from them" in said


@pytest.mark.parametrize("command", ["fit", "report"])
def test_a_table_keeps_its_finished_files(folder: Path, tmp_path: Path, command: str) -> None:
    out = tmp_path / "out"
    journal = out / "results.csv.journal"
    place = out / "results.csv" if command == "fit" else out
    said = stopped([command, str(folder), *KNOWN, "--out", str(place)], lambda: lines(journal) > 2)
    kept = lines(journal) - 1
    assert 0 < kept < 300
    assert f"{kept} files are kept in {journal}: --out {place} goes on from there" in said


def test_where_ctrl_c_is_ignored_a_command_goes_on(folder: Path, tmp_path: Path) -> None:
    """In the background of a script."""
    out = tmp_path / "results.csv"
    process = begun(
        ["fit", *(str(folder / f"{number:03}.spm") for number in range(8)), *KNOWN, "--out", str(out)], True
    )
    while lines(out.with_name("results.csv.journal")) < 2:
        assert process.poll() is None, process.communicate()
        process.send_signal(signal.SIGINT)
        time.sleep(0.05)
    said = process.communicate()
    assert process.returncode == 0, said
    assert "8 curves" in said[0]


def test_compiled_code_is_not_waited_for() -> None:
    """A sleep stands for it: no signal ends it."""
    timer = threading.Timer(0.1, signal.raise_signal, [signal.SIGINT])
    start = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        awaited(lambda: time.sleep(2.0))
    assert time.monotonic() - start < 1.5
    assert awaiting.left()
    with pytest.raises(ZeroDivisionError):
        awaited(lambda: 1 / 0)
    assert awaited(lambda: threading.current_thread() is threading.main_thread()) is False


def test_python_code_that_is_left_behind_ends() -> None:
    steps: list[int] = []

    def work() -> None:
        while True:
            steps.append(1)
            time.sleep(1e-3)

    threading.Timer(0.1, signal.raise_signal, [signal.SIGINT]).start()
    with pytest.raises(KeyboardInterrupt):
        awaited(work)
    done = len(steps)
    time.sleep(0.05)
    assert len(steps) == done > 0


def test_lines_end_while_one_is_computed() -> None:
    """What the compiled code has in hand, here 5 s of it, is not waited for; the lines before are kept."""
    computes, told = threading.Event(), list[int]()

    def work(number: int) -> int:
        if number == 2:
            computes.wait(5.0)
        return number

    def waits(done: int) -> bool:
        return done < 2

    start = time.monotonic()
    assert each(work, range(9), lambda _, number: told.append(number), waits, 2) == 2
    assert time.monotonic() - start < 3.0
    assert told == [0, 1]
    computes.set()
