# SPDX-License-Identifier: BSD-3-Clause
"""A touch that is interrupted, killed or out of disk space: every row that was due is there, in a file that says why it
ended. ``tests/heavy/kills.py`` does the same fifty times."""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
import time
from pathlib import Path

import pytest
from nanotouch import record
from nanotouch_app.common import stop
from nanotouch_app.main import main

if sys.platform == "win32":
    pytest.skip("signals of POSIX", allow_module_level=True)

import interruptions

for module in ("mcap", "tqdm", "matplotlib"):
    pytest.importorskip(module)

DURATION = "100s"
REASONS = {
    "SIGINT": "stopped by SIGINT",
    "SIGTERM": "stopped by SIGTERM",
    "SIGKILL": "the program that recorded it was",
}


@pytest.mark.parametrize("number", interruptions.SIGNALS, ids=lambda number: number.name)
def test_a_signal(number: signal.Signals, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    ending = interruptions.signalled(out, number, 0.1, DURATION)
    assert ending.status == interruptions.STATUS[number], ending.said
    recording = ending.recording
    assert recording is not None
    assert len(recording) >= ending.due
    assert recording.incomplete is not None
    assert REASONS[number.name] in recording.incomplete or "it ends early" in recording.incomplete
    replayed = recording.replay()
    assert replayed.motor_force.tobytes() == recording.motor_force.tobytes()
    assert replayed.incomplete == recording.incomplete
    assert main(["info", str(out / "recording.mcap")]) == 0
    assert f"recording, {len(recording)} rows" in (told := capsys.readouterr().out)
    assert f"INCOMPLETE: {recording.incomplete}" in told
    if number == signal.SIGKILL:
        return
    file = out / "recording.mcap"
    rows = f"{len(recording)} rows up to {recording.time[-1]:.6g} s are in {file}, marked as incomplete"
    assert ending.said == f"nanotouch touch: stopped by {number.name}; {rows}\n"
    assert {path.name for path in out.iterdir()} == {"recording.mcap", "summary.json"}
    summary = json.loads((out / "summary.json").read_text())
    assert (summary["incomplete"], summary["steps"]) == (recording.incomplete, len(recording))


def test_a_full_disk(tmp_path: Path) -> None:
    out = tmp_path / "out"
    ending = interruptions.out_of_space(out, "20s", 500_000)
    assert ending.status == 2
    assert ending.recording is not None
    assert len(ending.recording) == ending.due > 5000
    assert ending.recording.incomplete == f"cannot write {out / 'recording.mcap'}: File too large"
    assert ending.said.startswith(f"nanotouch touch: {ending.recording.incomplete}; {ending.due} rows up to ")
    assert ending.said.count("\n") == 1


def test_a_signal_before_the_first_row_leaves_no_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(record.Writer, "append", lambda *_: os.kill(os.getpid(), signal.SIGTERM))
    monkeypatch.setattr(record.Writer, "update", lambda *_: None)
    before = signal.getsignal(signal.SIGTERM)
    assert main(["touch", "--duration", "1s", "--out", str(tmp_path / "new" / "out")]) == 143
    assert list(tmp_path.iterdir()) == []
    assert capsys.readouterr().err == "nanotouch touch: stopped by SIGTERM; no rows were recorded\n"
    assert signal.getsignal(signal.SIGTERM) is before


def test_signals_wait_for_the_end_of_a_block_but_not_twice() -> None:
    def block(signals: int) -> None:
        with stop.between_blocks() as check:
            for _ in range(signals):
                os.kill(os.getpid(), signal.SIGTERM)
                time.sleep(0)  # the interpreter handles it
                reached.append(1)
            check()
            raise AssertionError("not reached")

    for signals, blocks in ((1, 1), (2, 1)):
        reached: list[int] = []
        with pytest.raises(stop.Stopped, match="stopped by SIGTERM") as caught:
            block(signals)
        assert len(reached) == blocks
        assert caught.value.number == signal.SIGTERM


def test_what_is_ignored_stays_ignored_and_threads_are_left_alone() -> None:
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with stop.on_signals():
            os.kill(os.getpid(), signal.SIGHUP)
    finally:
        signal.signal(signal.SIGHUP, before)
    failures: list[BaseException] = []

    def handle() -> None:
        try:
            with stop.on_signals(), stop.between_blocks() as check:
                check()
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=handle)
    thread.start()
    thread.join()
    assert failures == []


def test_recover_says_what_it_has(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    part = tmp_path / "r.mcap.12.part"
    record.write(part, record.Recording({"time": [0.0, 0.5]}, {"incomplete": "killed"}))
    assert main(["recover", str(part), "--out", str(tmp_path / "found.mcap")]) == 0
    assert capsys.readouterr().out == f"{tmp_path / 'found.mcap'}: 2 rows up to 0.5 s, incomplete: killed\n"
    assert main(["recover", str(part), "--out", str(tmp_path / "found.mcap")]) == 2
    assert "it exists already" in capsys.readouterr().err
