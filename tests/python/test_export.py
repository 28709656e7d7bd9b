# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch export``: the tables hold what the file held, with units; errors are one sentence and leave nothing."""

from __future__ import annotations

import argparse
import csv
from pathlib import Path

import numpy as np
import pytest
from nanotouch import curves, images, maps, record
from nanotouch.curves import ForceCurve, Segment
from nanotouch.errors import Error, InvalidValue, ReadError
from nanotouch.touch.record import Recording
from nanotouch_app.data import export
from synthetic import DATA, asymmetric, write_gwy

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
    monkeypatch.setattr(curves, "read", lambda file: found)
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


def a_curve(name: str = "made", pause: bool = False, force: bool = True) -> ForceCurve:
    rng = np.random.default_rng(7)
    z = np.linspace(1e-6, 0, 60)
    parts = [("approach", z), *([("pause", np.zeros(20))] if pause else []), ("retract", z[::-1])]
    segments, start = [], 0.0
    for role, height in parts:
        values = 1e-9 * rng.standard_normal(height.size)
        time = start + np.arange(height.size) * 1e-3
        start = time[-1] + 1e-3
        segments.append(Segment(role, time, height, "height (measured)", values if force else None, values / 0.05))
    meta = {"spring constant": 0.05, "sensitivity": 4e-8, "grid index x": 3, "notes": ("ours",), "enum": 0}
    return ForceCurve(tuple(segments), meta, name)


def test_an_igor_wave_opens_in_afmformats_in_igor2_and_here(tmp_path: Path) -> None:
    """Doubles: all that is lost is the rounding of force -> deflection -> force."""
    afmformats = pytest.importorskip("afmformats")
    binarywave = pytest.importorskip("igor2.binarywave")
    made = a_curve(pause=True)
    assert made.approach is not None
    assert made.retract is not None
    file = curves.write(tmp_path / "c.ibw", [made])
    wave = binarywave.load(file)["wave"]
    assert wave["wave_header"]["bname"] == b"nanotouch"
    assert [label for label in wave["labels"][1] if label] == [b"Raw", b"Defl", b"ZSnsr"]
    (theirs,) = afmformats.load_data(file)
    force = np.concatenate([made.approach.force, made.retract.force])  # type: ignore[list-item]
    np.testing.assert_allclose(theirs["force"], force, rtol=1e-14)
    np.testing.assert_array_equal(theirs["height (measured)"], np.concatenate([made.approach.z, made.retract.z]))
    assert theirs.metadata["spring constant"] == 0.05
    assert not theirs["segment"].any()  # of any .ibw: why export speaks of nanite's "segment discovery"
    (ours,) = curves.read(file)
    assert ours.spring_constant == 0.05
    assert ours.approach is not None
    np.testing.assert_allclose(ours.approach.force, made.approach.force[: len(ours.approach)], rtol=1e-12)  # type: ignore[index,arg-type]
    with pytest.raises(InvalidValue, match="holds one curve, not 2"):
        curves.write(tmp_path / "two.ibw", [made, made])
    with pytest.raises(InvalidValue, match=r"\.ibw needs approach"):
        curves.write(tmp_path / "half.ibw", [ForceCurve(made.segments[:1], made.meta, "half")])


@pytest.mark.parametrize("ending", [".h5", ".tab"])
@pytest.mark.parametrize("pause", [False, True])
def test_curves_open_in_afmformats_and_here(ending: str, pause: bool, tmp_path: Path) -> None:
    afmformats = pytest.importorskip("afmformats")
    pytest.importorskip("h5py")
    made = a_curve(pause=pause)
    file = curves.write(tmp_path / f"c{ending}", [made])
    (theirs,) = afmformats.load_data(file)
    assert made.approach is not None
    assert made.retract is not None
    np.testing.assert_array_equal(theirs.appr["force"], made.approach.force)
    np.testing.assert_array_equal(theirs.retr["height (measured)"], made.retract.z)
    np.testing.assert_array_equal(theirs.retr["time"], made.retract.time)
    assert theirs.metadata["spring constant"] == 0.05
    assert theirs.metadata["grid index x"] == 3
    (ours,) = curves.read(file)
    assert [segment.role for segment in ours.segments] == [segment.role for segment in made.segments]
    for mine, back in zip(made.segments, ours.segments, strict=True):
        np.testing.assert_array_equal(back.force, mine.force)
        np.testing.assert_array_equal(back.z, mine.z)


def test_many_curves_to_hdf5_and_one_to_text(tmp_path: Path) -> None:
    pytest.importorskip("afmformats")
    file = curves.write(tmp_path / "many.h5", [a_curve(), a_curve()])
    assert run(file, "--out", tmp_path / "again.hdf5") == 0
    with pytest.raises(InvalidValue, match="holds one curve, not 2"):
        run(file, "--out", tmp_path / "all.tab")
    assert run(file, "--index", "1", "--out", tmp_path / "one.tab") == 0
    with pytest.raises(InvalidValue, match=r"0 \.\. 1"):
        run(file, "--index", "2", "--out", tmp_path / "two.tab")
    with pytest.raises(InvalidValue, match="no force"):
        curves.write(tmp_path / "none.h5", [a_curve(force=False)])
    assert not (tmp_path / "none.h5").exists()


def test_a_calibration_is_given_where_the_file_states_none(tmp_path: Path) -> None:
    pytest.importorskip("afmformats")
    source = DATA / "corpus" / "curves" / "asylum-pairs" / "Line0000Point0000Defl.ibw"
    if not source.is_file():
        pytest.skip("without the corpus of real files")
    with pytest.raises(InvalidValue, match="spring constant"):
        run(source, "--out", tmp_path / "c.h5")
    assert run(source, "--spring-constant", "0.1N/m", "--out", tmp_path / "c.h5") == 0
    ours, back = curves.read(source, spring_constant=0.1)[0], curves.read(tmp_path / "c.h5")[0]
    assert ours.retract is not None
    assert back.retract is not None
    np.testing.assert_array_equal(back.retract.force, ours.retract.force)


def test_images_to_gwy_and_gsf(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A file of two channels, one with a mask: opened by gwyfile, SurfaceTopography and here; the right way up."""
    gwyfile = pytest.importorskip("gwyfile")
    pytest.importorskip("SurfaceTopography")
    heights = asymmetric()
    phase = np.cos(heights * 1e9)
    hole = np.zeros(heights.shape, bool)
    hole[3:5, 6] = True
    write_gwy(tmp_path / "in.gwy", heights, (2e-6, 3e-6), hole, {"Phase": (phase, "deg")})
    assert run(tmp_path / "in.gwy", "--out", tmp_path / "out.gwy") == 0
    container = gwyfile.load(str(tmp_path / "out.gwy"))
    fields = gwyfile.util.get_datafields(container)
    assert len(fields) == 2
    by_unit = {str(getattr(field.si_unit_z, "unitstr", "")): field for field in fields.values()}
    np.testing.assert_allclose(by_unit["deg"].data[::-1], phase, rtol=1e-12)
    np.testing.assert_allclose(np.where(hole, 0, by_unit["m"].data[::-1]), np.where(hole, 0, heights), atol=1e-18)
    assert by_unit["m"].xreal == pytest.approx(3e-6)
    masks = [container[key] for key in container if key.endswith("/mask")]
    assert any(np.array_equal(mask.data[::-1] > 0.5, hole) for mask in masks)
    assert run(tmp_path / "in.gwy", "--out", tmp_path / "out.gsf") == 0
    assert "2 missing ones are NaN" in capsys.readouterr().out
    back = images.read(tmp_path / "out.gsf")
    np.testing.assert_allclose(np.where(hole, 0, back.heights), np.where(hole, 0, heights), atol=1e-14)
    assert back.size == pytest.approx((2e-6, 3e-6))
    content = (tmp_path / "out.gsf").read_bytes()  # once more, by the format's description
    facts = dict(line.split(" = ") for line in content[: content.index(0)].decode().splitlines()[1:])
    assert (facts["XRes"], facts["YRes"], facts["ZUnits"]) == ("32", "24", "m")
    values = np.frombuffer(content[-4 * 32 * 24 :], "<f4").reshape(24, 32)
    np.testing.assert_array_equal(np.isnan(values[::-1]), hole)
    np.testing.assert_array_equal(back.mask, hole)
    np.testing.assert_array_equal(values[::-1][~hole], back.heights.astype("<f4")[~hole])
    assert (len(content) - values.nbytes) % 4 == 0
    assert set(content[content.index(0) : -values.nbytes]) == {0}


def test_a_map_to_gwy(tmp_path: Path) -> None:
    gwyfile = pytest.importorskip("gwyfile")
    xarray = pytest.importorskip("xarray")
    values = np.arange(20.0).reshape(4, 5) + 1.0
    flags = np.zeros((4, 5), np.uint32)
    flags[1, 2] = 256
    marks = {"flag_masks": np.array([64, 256], np.uint32), "flag_meanings": "waves effective_modulus_undetermined"}
    data = xarray.Dataset(
        {"effective_modulus": (("y", "x"), values, {"units": "Pa"}), "flags": (("y", "x"), flags, marks)},
        {"y": ("y", np.arange(4) * 1e-7, {"units": "m"}), "x": ("x", np.arange(5) * 2e-7, {"units": "m"})},
    )
    (plane,) = maps.planes(data)
    images.write_planes(tmp_path / "map.gwy", [plane])
    container = gwyfile.load(str(tmp_path / "map.gwy"))
    field = container["/0/data"]
    assert (field.xreal, field.yreal) == pytest.approx((1e-6, 4e-7))
    assert container["/0/mask"].data[::-1][1, 2] == 1.0
    assert container["/0/mask"].data.sum() == 1.0
    assert field.data[::-1][3, 4] == 20.0
    data.to_netcdf(tmp_path / "map.nc", engine="h5netcdf")
    assert run(tmp_path / "map.nc", "--out", tmp_path / "map.gsf") == 0
    content = (tmp_path / "map.gsf").read_bytes()
    facts = dict(line.split(" = ") for line in content[: content.index(0)].decode().splitlines()[1:])
    assert (facts["ZUnits"], facts["Title"], float(facts["XReal"])) == ("Pa", "effective_modulus", pytest.approx(1e-6))
    back = np.frombuffer(content[-80:], "<f4").reshape(4, 5)[::-1]
    assert np.isnan(back[1, 2])
    assert back[3, 4] == 20.0
    with pytest.raises(InvalidValue, match="determines no such quantity"):
        run(tmp_path / "map.nc", "--channel", "thickness", "--out", tmp_path / "other.gsf")


@pytest.mark.skipif(not (DATA / "corpus").is_dir(), reason="without the corpus of real files")
@pytest.mark.parametrize("name", ["nid-1.nid", "sample_0.jpk-qi-image", "fdc_image_1.ibw"])
def test_real_images_go_out_whole(name: str, tmp_path: Path) -> None:
    gwyfile = pytest.importorskip("gwyfile")
    source = DATA / "corpus" / "images" / name
    assert run(source, "--out", tmp_path / "out.gwy") == 0
    fields = gwyfile.util.get_datafields(gwyfile.load(str(tmp_path / "out.gwy")))
    assert len(fields) >= 2
    again = images.read(tmp_path / "out.gwy")
    np.testing.assert_allclose(again.heights, images.read(source, again.channel).heights, rtol=1e-6, atol=1e-15)


def test_errors_leave_nothing(recording: Path, tmp_path: Path) -> None:
    prose = tmp_path / "prose.txt"
    prose.write_text("no table here")
    before = sorted(tmp_path.iterdir())
    with pytest.raises(InvalidValue, match=r"the ending must be \.csv, .* or \.gsf"):
        run(recording, "--out", tmp_path / "r.xlsx")
    with pytest.raises(ReadError, match=r"nowhere\.mcap"):
        run(tmp_path / "nowhere.mcap", "--out", tmp_path / "r.csv")
    with pytest.raises(Error, match="prose"):
        run(prose, "--out", tmp_path / "r.csv")
    with pytest.raises(Error, match="cannot write"):
        run(recording, "--out", tmp_path / "missing" / "r.csv")
    assert sorted(tmp_path.iterdir()) == before
