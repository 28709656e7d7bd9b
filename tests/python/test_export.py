# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch export``: the tables hold what the file held, with units; errors are one sentence and leave nothing."""

from __future__ import annotations

import argparse
import csv
import json
from pathlib import Path

import numpy as np
import pytest
from nanotouch import curves, record
from nanotouch.curves import ForceCurve, Segment
from nanotouch.errors import Error, InvalidValue, ReadError
from nanotouch.record import Recording
from nanotouch_app import export

pytest.importorskip("mcap")
pytest.importorskip("tqdm")


def run(*arguments: str | Path) -> int:
    parser = argparse.ArgumentParser()
    export.add_parser(parser.add_subparsers())
    args = parser.parse_args(["export", *map(str, arguments)])
    return int(args.run(args))


def table(path: Path) -> tuple[list[str], dict[str, list[str]]]:
    """Comments and columns of a CSV file."""
    lines = path.read_text().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    header, *rows = csv.reader(lines[len(comments) :])
    return comments, dict(zip(header, map(list, zip(*rows, strict=True)), strict=True))


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    rng = np.random.default_rng(2)
    made = {"time": np.arange(3000) * 1e-4, "gap": rng.standard_normal(3000) * 1e-9, "state": np.arange(3000) % 4}
    record.write(tmp_path / "recording.mcap", Recording(made, {"alpha_f": 2e6}))
    return tmp_path / "recording.mcap"


@pytest.fixture
def curve(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> tuple[Path, list[ForceCurve]]:
    """Two curves; one of them without force, as without a spring constant."""
    z = np.linspace(1e-6, 0, 50)
    force, time = 1e-9 * np.sin(1e7 * z), np.linspace(0, 1, 50)
    first = [Segment("approach", time, z, "height (measured)", force, force / 8)]
    first += [Segment("retract", 1 + time, z[::-1], "height (measured)", force[::-1], force[::-1] / 8)]
    second = [Segment("approach", time, z, "height (piezo)", None, force / 8)]
    found = [ForceCurve(tuple(first), {"spring constant": 8.0}, "a.x"), ForceCurve(tuple(second), {"enum": 1}, "a.x")]
    path = tmp_path / "a.x"
    path.write_text("stands for a force curve file")
    monkeypatch.setattr(curves, "read", lambda file, untrusted: found)
    return path, found


def test_recording_to_csv(recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(recording, "--out", tmp_path / "r.csv") == 0
    assert capsys.readouterr().out == f"{tmp_path}/r.csv: 3000 rows, 3 columns\n"
    comments, columns = table(tmp_path / "r.csv")
    assert comments == ["# alpha_f: 2000000.0"]
    assert list(columns) == ["time [s]", "state", "gap [m]"]
    np.testing.assert_array_equal(np.array(columns["gap [m]"], float), record.read(recording).gap)


def test_recording_to_hdf5(recording: Path, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    assert run(recording, "--out", tmp_path / "r.hdf5") == 0
    with h5py.File(tmp_path / "r.hdf5") as file:
        assert file["gap"].attrs["unit"] == "m"
        np.testing.assert_array_equal(file["gap"][:], record.read(recording).gap)


def test_damaged_recording_is_reported(recording: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    recording.write_bytes(recording.read_bytes()[:-300])
    assert run(recording, "--out", tmp_path / "r.csv") == 0
    assert "recording.mcap is damaged" in capsys.readouterr().err


def test_curves_to_csv(curve: tuple[Path, list[ForceCurve]], tmp_path: Path) -> None:
    path, found = curve
    assert run(path, "--out", tmp_path / "c.csv") == 0
    comments, columns = table(tmp_path / "c.csv")
    assert "# z: height (measured), height (piezo)" in comments
    assert list(columns) == ["curve", "segment", "role", "time [s]", "z [m]", "deflection [m]", "force [N]"]
    assert columns["role"] == ["approach"] * 50 + ["retract"] * 50 + ["approach"] * 50
    assert columns["curve"] == ["0"] * 100 + ["1"] * 50
    force = np.array(columns["force [N]"], float)
    np.testing.assert_array_equal(force[50:100], found[0].segments[1].force)
    assert np.isnan(force[100:]).all()


def test_curves_to_hdf5(curve: tuple[Path, list[ForceCurve]], tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path, found = curve
    assert run(path, "--out", tmp_path / "c.h5") == 0
    with h5py.File(tmp_path / "c.h5") as file:
        segment = file["curve 0/segment 1"]
        assert segment.attrs["role"] == "retract"
        assert segment["force"].attrs["unit"] == "N"
        np.testing.assert_array_equal(segment["force"][:], found[0].segments[1].force)
        assert "force" not in file["curve 1/segment 0"]
        assert json.loads(file["curve 0"].attrs["spring constant"]) == 8.0


def test_errors_leave_nothing(recording: Path, tmp_path: Path) -> None:
    prose = tmp_path / "prose.txt"
    prose.write_text("no table here")
    before = sorted(tmp_path.iterdir())
    with pytest.raises(InvalidValue, match=r"the ending must be \.csv, \.h5 or \.hdf5"):
        run(recording, "--out", tmp_path / "r.xlsx")
    with pytest.raises(ReadError, match=r"nowhere\.mcap"):
        run(tmp_path / "nowhere.mcap", "--out", tmp_path / "r.csv")
    with pytest.raises(Error, match="prose"):
        run(prose, "--out", tmp_path / "r.csv")
    with pytest.raises(Error, match="cannot write"):
        run(recording, "--out", tmp_path / "missing" / "r.csv")
    assert sorted(tmp_path.iterdir()) == before
