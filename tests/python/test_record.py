# SPDX-License-Identifier: BSD-3-Clause
"""Recordings: what is written comes back equal; damage is reported; what is cut short is kept, and marked with why."""

from __future__ import annotations

import csv
import json
import pickle
import sys
import tracemalloc
from pathlib import Path

import draws
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nanotouch import record
from nanotouch.errors import Error, InvalidValue, MissingExtra, ReadError
from nanotouch.touch._recorder import KILLED, ending
from nanotouch.touch.record import COLUMNS, Recording, Writer

METADATA: dict[str, object] = {"alpha_p": 4e-6, "alpha_f": 2e6, "master_start": -0.01, "start_height": 6e-7, "seed": 3}
METADATA["scene"] = {"tip": {"radius": 2e-8}}


def columns(rows: int, seed: int = 0) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    made = {name: rng.standard_normal(rows) * 1e-9 for name in COLUMNS}
    made["time"] = np.arange(rows) * 1e-4
    made["state"] = rng.integers(0, 4, rows)
    made["phase"] = rng.integers(0, 3, rows)
    made["reasons"], made["flags"] = rng.integers(0, 2**32, (2, rows))
    return made


def same(one: Recording, other: Recording) -> bool:
    names = list(one.columns) == list(other.columns)
    return names and all(
        np.array_equal(one.columns[n], other.columns[n], equal_nan=COLUMNS[n].dtype == "<f8") for n in one.columns
    )


def test_attributes_slices_and_scaling() -> None:
    recording = Recording(columns(100), METADATA)
    assert len(recording) == 100
    assert len(recording[10:20]) == 10
    assert len(recording[recording.time < 0.005]) == 50
    np.testing.assert_array_equal(recording.scaled_slave_force, 2e6 * recording.slave_force)
    np.testing.assert_array_equal(recording.scaled_stage_position, recording.stage_position / 4e-6 - 0.01)
    np.testing.assert_allclose(recording.tip_height, 6e-7 - recording.stage_position + recording.deflection)
    tilted = Recording(columns(100), METADATA | {"rig": {"probe": {"tilt": np.pi / 3}}})
    np.testing.assert_allclose(tilted.tip_height, 6e-7 - recording.stage_position + 0.5 * recording.deflection)
    with pytest.raises(AttributeError, match="no column 'colour'"):
        recording.colour  # noqa: B018
    with pytest.raises(InvalidValue, match="lacks 'alpha_f'"):
        Recording({"time": [0.0], "slave_force": [0.0]}).scaled_slave_force  # noqa: B018


def test_pickle() -> None:
    recording = Recording(columns(10), METADATA)
    copy = pickle.loads(pickle.dumps(recording))
    assert same(recording, copy)
    assert copy.metadata == METADATA


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"x": [0.0]}, "needs the column 'time'"),
        ({"time": [0.0], "colour": [0.0]}, "unknown column 'colour'"),
        ({"time": [0.0], "x": [0.0, 1.0]}, "has 2 rows"),
        ({"time": [0.0], "state": [0.5]}, "integers from 0 to 255"),
        ({"time": [0.0], "state": [256]}, "integers from 0 to 255"),
        ({"time": [0.0], "state": [float("nan")]}, "integers from 0 to 255"),
        ({"time": [0.0], "x": [1j]}, "real numbers"),
        ({"time": [0.0], "x": [[1.0]]}, "one dimension"),
        ({"time": [0.0], "x": np.ma.array([1.0], mask=[True])}, "unmasked"),
    ],
)
def test_wrong_columns_are_refused(wrong: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidValue, match=message):
        Recording(wrong)  # type: ignore[arg-type]


@settings(max_examples=25, deadline=None)
@given(
    blocks=st.lists(st.integers(0, 300), max_size=8),
    names=st.sets(st.sampled_from([n for n in COLUMNS if n != "time"])),
    nan=st.booleans(),
)
def test_round_trip(tmp_path_factory: pytest.TempPathFactory, blocks: list[int], names: set[str], nan: bool) -> None:
    path = tmp_path_factory.mktemp("record") / "recording.mcap"
    whole = {name: values for name, values in columns(sum(blocks)).items() if name == "time" or name in names}
    if nan and "gap" in whole and sum(blocks):
        whole["gap"][0], whole["gap"][-1] = np.nan, -np.inf
    start = 0
    with Writer(path, METADATA) as writer:
        for rows in blocks:
            writer.append({name: values[start : start + rows] for name, values in whole.items()})
            start += rows
    back = record.read(path)
    assert back.metadata == METADATA
    if blocks:
        assert same(Recording(whole), back)
    assert len(back) == writer.rows == sum(blocks)
    assert [p.name for p in path.parent.iterdir()] == ["recording.mcap"]


def test_the_file_describes_itself(tmp_path: Path) -> None:
    """Read with the mcap package and the schema alone, without our reader."""
    reader = pytest.importorskip("mcap.reader")
    recording = Recording(columns(1000), METADATA)
    record.write(tmp_path / "r.mcap", recording)
    with open(tmp_path / "r.mcap", "rb") as file:
        messages = reader.make_reader(file, validate_crcs=True).iter_messages(topics=["nanotouch/touch"])
        ((schema, channel, message),) = list(messages)
    listed = json.loads(schema.data)["columns"]
    assert channel.topic == "nanotouch/touch"
    assert schema.encoding == "nanotouch.columns"
    offset = 0
    for column in listed:
        assert column["unit"] == COLUMNS[column["name"]].unit
        values = np.frombuffer(message.data, column["dtype"], 1000, offset)
        np.testing.assert_array_equal(values, recording.columns[column["name"]])
        offset += values.nbytes
    assert offset == len(message.data)


@pytest.mark.parametrize("keep", [0.3, 0.6, 0.95, 0.999])
def test_a_truncated_file_gives_what_is_whole(tmp_path: Path, keep: float) -> None:
    path = tmp_path / "r.mcap"
    recording = Recording(columns(50_000), METADATA)
    record.write(path, recording)
    data = path.read_bytes()
    path.write_bytes(data[: int(keep * len(data))])
    with pytest.warns(UserWarning, match="is damaged"):
        back = record.read(path)
    assert same(recording[: len(back)], back)
    assert len(back) >= (keep - 0.25) * 50_000  # a block of 10 000 rows is a fifth
    assert back.metadata == METADATA | {"incomplete": "it ends early"}


@pytest.mark.parametrize("content", [b"", b"prose, not a recording", b"\x89MCAP0\r\n", b"\x89MCAP0\r\n" + bytes(200)])
def test_other_files_are_refused(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "other.mcap"
    path.write_bytes(content)
    with pytest.raises(ReadError, match=r"other\.mcap is not a recording"):
        record.read(path)
    with pytest.raises(ReadError, match="No such file"):
        record.read(tmp_path / "missing.mcap")


class Interrupted(KeyboardInterrupt):
    def __str__(self) -> str:
        return "stopped by SIGTERM"


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (KeyboardInterrupt(), "stopped by SIGINT"),
        (Interrupted(), "stopped by SIGTERM"),
        (Error("the rig is gone"), "the rig is gone"),
        (ZeroDivisionError("division by zero"), "ZeroDivisionError: division by zero"),
        (RuntimeError("\u00e9" * 1000), "RuntimeError: " + "\u00e9" * 60),
    ],
)
def test_an_exception_keeps_the_rows_and_says_why(tmp_path: Path, error: BaseException, reason: str) -> None:
    def cut_short() -> None:
        with writer:
            writer.append(columns(1000))
            writer.append(columns(10))
            raise error

    writer = Writer(tmp_path / "r.mcap", METADATA)
    with pytest.raises(type(error)):
        cut_short()
    assert [path.name for path in tmp_path.iterdir()] == ["r.mcap"]
    back = record.read(tmp_path / "r.mcap")  # warnings are errors here: the file is a whole one
    assert len(back) == writer.rows == 1010
    assert back.incomplete is not None
    assert back.incomplete == reason or (len(reason) > 60 and back.incomplete.startswith(reason))
    assert back.metadata == METADATA | {"incomplete": back.incomplete}
    assert writer.saved == f"1010 rows up to 0.0009 s are in {tmp_path / 'r.mcap'}, marked as incomplete"
    with pytest.raises(Error, match="this recording has ended"):
        writer.append(columns(10))


def test_an_exception_before_the_first_row_leaves_no_file(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt), Writer(tmp_path / "r.mcap"):
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == []


def test_an_exception_keeps_the_recording_of_before(tmp_path: Path) -> None:
    record.write(tmp_path / "r.mcap", Recording(columns(10)))
    writer = Writer(tmp_path / "r.mcap")

    def inconsistent() -> None:
        with writer:
            writer.append({"time": [0.0]})
            writer.append({"time": [1.0], "x": [0.0]})

    with pytest.raises(InvalidValue, match="the file has time"):
        inconsistent()
    assert len(record.read(tmp_path / "r.mcap")) == 10
    assert {path.name for path in tmp_path.iterdir()} == {"r.mcap", writer.path.name}
    assert len(record.read(writer.path)) == 1


@pytest.fixture
def killed(tmp_path: Path) -> Path:
    """What kill -9 between two blocks leaves."""
    writer = Writer(tmp_path / "r.mcap", METADATA)
    writer.append(columns(1000))
    part = next(tmp_path.glob("r.mcap.*.part"))
    content = part.read_bytes()
    writer.discard()
    part.write_bytes(content)
    return part


def test_a_killed_process_leaves_a_finished_file(killed: Path) -> None:
    """That other readers of MCAP read, too."""
    reader = pytest.importorskip("mcap.reader")
    back = record.read(killed)
    assert same(back, Recording(columns(1000)))
    assert back.incomplete == "the program that recorded it was killed"
    with open(killed, "rb") as file:
        found = reader.NonSeekingReader(file, validate_crcs=True).iter_messages(topics=["nanotouch/touch"])
        assert len(list(found)) == 1


def test_the_next_process_of_that_number_leaves_it_alone(killed: Path) -> None:
    content = killed.read_bytes()
    record.write(killed.with_name("r.mcap"), Recording(columns(5)))
    assert killed.read_bytes() == content
    assert len(record.read(killed.with_name("r.mcap"))) == 5


@pytest.mark.parametrize("torn", [False, True])
def test_recover(killed: Path, torn: bool) -> None:
    if torn:  # in the middle of the second block
        chunk = b"\x06" + (10_000).to_bytes(8, "little") + bytes(1000)
        killed.write_bytes(killed.read_bytes()[: -len(ending(KILLED))] + chunk)
    content = killed.read_bytes()
    path, found = record.recover(killed)
    assert path == killed.with_name("r.mcap")
    back = record.read(path)
    assert same(back, Recording(columns(1000)))
    assert same(back, found)
    assert back.incomplete
    assert {key: back.metadata[key] for key in METADATA} == METADATA
    assert killed.read_bytes() == content
    with pytest.raises(Error, match=r"r\.mcap: it exists already"):
        record.recover(killed)
    assert record.recover(path)[0] == killed.with_name("r.recovered.mcap")


def test_recover_has_nothing_to_do(tmp_path: Path) -> None:
    record.write(tmp_path / "r.mcap", Recording(columns(5)))
    with pytest.raises(InvalidValue, match="is whole: there is nothing to recover"):
        record.recover(tmp_path / "r.mcap")
    assert len(list(tmp_path.iterdir())) == 1


def test_a_folder_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for target in (tmp_path / "file" / "r.mcap", tmp_path / "missing" / "r.mcap"):
        with pytest.raises(Error, match=r"cannot write .*r\.mcap: "):
            Writer(target)
    with pytest.raises(Error, match=r"cannot write .*r\.csv: "):
        Recording(columns(3)).to_csv(tmp_path / "missing" / "r.csv")
    with pytest.raises(Error, match=r"cannot write .*r\.h5: "):
        Recording(columns(3)).to_hdf5(tmp_path / "missing" / "r.h5")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_a_disk_that_is_full_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    part = tmp_path / "full.part"
    part.symlink_to("/dev/full")
    monkeypatch.setattr("nanotouch.touch._recorder._new_part", lambda _: part.open("wb"))
    with pytest.raises(Error, match=r"cannot write .*r\.mcap: No space left on device; no rows were recorded"):
        Writer(tmp_path / "r.mcap")
    assert list(tmp_path.iterdir()) == []


def test_values_that_json_cannot_hold_are_refused(tmp_path: Path) -> None:
    for value in (float("nan"), np.zeros(3), object()):
        with pytest.raises(InvalidValue, match="JSON-able"):
            Writer(tmp_path / "r.mcap", {"value": value})
    with pytest.raises(InvalidValue, match="not finite"), Writer(tmp_path / "r.mcap") as writer:
        writer.append({"time": [0.0, np.nan]})
    assert list(tmp_path.iterdir()) == []


def test_memory_does_not_grow(tmp_path: Path) -> None:
    block = columns(1000)

    def peak(blocks: int) -> int:
        tracemalloc.start()
        with Writer(tmp_path / "r.mcap") as writer:
            for _ in range(blocks):
                writer.append(block)
        _, most = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        return most

    peak(10)  # imports
    few, many = draws.count(60, 250), draws.count(240, 1000)
    assert peak(many) < peak(few) + 20_000  # 180 blocks are 21 MB of rows


def test_csv_reads_back(tmp_path: Path) -> None:
    recording = Recording(columns(25_000), METADATA)
    steps: list[float] = []
    recording.to_csv(tmp_path / "r.csv", steps.append)
    assert steps == [0.4, 0.8, 1.0]
    lines = (tmp_path / "r.csv").read_text().splitlines()
    comments = [line for line in lines if line.startswith("#")]
    assert "# alpha_f: 2000000.0" in comments
    header, *rows = csv.reader(lines[len(comments) :])
    assert header[:2] == ["time [s]", "x [m]"]
    assert "state" in header
    table = np.array(rows, dtype=float).T
    for name, values in zip(recording.columns, table, strict=True):
        np.testing.assert_array_equal(values, recording.columns[name].astype(float))


def test_hdf5_reads_back(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    recording = Recording(columns(2000), METADATA)
    recording.to_hdf5(tmp_path / "r.h5")
    with h5py.File(tmp_path / "r.h5") as file:
        assert json.loads(file.attrs["scene"]) == METADATA["scene"]
        for name, values in recording.columns.items():
            np.testing.assert_array_equal(file[name][:], values)
            assert file[name].attrs["unit"] == COLUMNS[name].unit


@pytest.mark.parametrize("module", ["mcap.writer", "h5py"])
def test_a_missing_package_names_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtra, match="pip install mcap h5py"):
        Writer(tmp_path / "r.mcap") if module == "mcap.writer" else Recording(columns(2)).to_hdf5(tmp_path / "r.h5")
    assert list(tmp_path.iterdir()) == []
