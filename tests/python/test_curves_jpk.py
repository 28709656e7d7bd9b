# SPDX-License-Identifier: BSD-3-Clause
"""JPK archives: the same numbers as afmformats, maps in linear time, damaged archives refused."""

from __future__ import annotations

import cProfile
import pstats
import zipfile
from pathlib import Path

import numpy as np
import pytest
import synthetic
from nanotouch import curves, maps
from nanotouch.curves import jpk
from nanotouch.errors import InvalidValue, ReadError

KNOWN = synthetic.known_curve(n=100)
REAL = sorted((synthetic.DATA / "curves").glob("*.jpk*")) if synthetic.DATA.is_dir() else []


def single(path: Path) -> Path:
    segments = [("extend", KNOWN.approach_z, KNOWN.approach_force), ("retract", KNOWN.retract_z, KNOWN.retract_force)]
    return synthetic.write_jpk(path, segments, spring_constant=0.8, sensitivity=6e-8)


def test_segments_of_other_styles_are_left_out_and_named(tmp_path: Path) -> None:
    """A modulated hold between approach and retraction: both are read, with the time that the hold took."""
    wave = 1e-9 * np.sin(np.arange(200))
    segments = [("extend", KNOWN.approach_z, KNOWN.approach_force), *[("modulation", wave, wave)] * 2,
                ("retract", KNOWN.retract_z, KNOWN.retract_force)]  # fmt: skip
    (curve,) = curves.read(synthetic.write_jpk(tmp_path / "a.jpk-force", segments, spring_constant=0.8))
    assert [segment.role for segment in curve.segments] == ["approach", "retract"]
    np.testing.assert_allclose(curve.segments[1].force, KNOWN.retract_force, atol=1e-15)  # type: ignore[arg-type]
    assert curve.segments[1].time[0] == pytest.approx(3.0)
    assert curve.meta["notes"] == ("2 segments of style 'modulation' left out",)
    with pytest.raises(ReadError, match="no segments of style extend, pause, retract, only modulation"):
        curves.read(synthetic.write_jpk(tmp_path / "b.jpk-force", segments[1:2]))


def test_a_curve_of_two_points_is_read_and_not_analysed(tmp_path: Path) -> None:
    """What an instrument stores that was broken off at once."""
    point = np.zeros(1)
    segments = [("extend", point, point), ("retract", point, point)]
    (curve,) = curves.read(synthetic.write_jpk(tmp_path / "a.jpk-force", segments))
    assert [len(segment) for segment in curve.segments] == [1, 1]
    with pytest.raises(InvalidValue, match="at least 16 points"):
        curves.analyse(curve)


def as_map(path: Path, count: int, curve: Path | None = None) -> Path:
    """A single curve `count` times, as JPK writes maps: what all share stands once."""
    curve = curve or single(path.with_suffix(".jpk-force"))
    with zipfile.ZipFile(curve) as one, zipfile.ZipFile(path, "w") as many:
        lines = ["type=force-scan-map", "force-scan-map.position-pattern.grid.ilength=4"]
        lines += [f"force-scan-map.position-pattern.grid.jlength={count // 4}"]
        for key, value in (("xcenter", 2e-6), ("ycenter", 1e-6), ("ulength", 4e-6), ("vlength", 2e-6)):
            lines.append(f"force-scan-map.position-pattern.grid.{key}={value}")
        many.writestr("header.properties", "\n".join(lines) + "\n")
        names = [name for name in one.namelist() if name.startswith("segments/")]
        shared: dict[str, str] = {}
        for number, channel in enumerate(("vDeflection", "measuredHeight", "height")):
            for line in one.read("segments/0/segment-header.properties").decode().splitlines():
                key, _, value = line.partition("=")
                if key.startswith(f"channel.{channel}.conversion-set"):
                    shared[f"lcd-info.{number}.{key.removeprefix(f'channel.{channel}.')}"] = value
        many.writestr("shared-data/header.properties", "".join(f"{k}={v}\n" for k, v in shared.items()))
        many.writestr("index/", "")
        for index in range(count):
            x, y = (index % 4 + 0.5) * 1e-6, (index // 4 + 0.5) * 2e-6 / (count // 4)
            head = f"force-scan-series.header.position.x={x}\nforce-scan-series.header.position.y={y}\n"
            many.writestr(f"index/{index}/", "")
            many.writestr(
                f"index/{index}/header.properties", f"{head}force-scan-series.header.position-index={index}\n"
            )
            for name in names:
                content = one.read(name)
                if name.endswith("segment-header.properties"):
                    kept = [li for li in content.decode().splitlines() if ".conversion-set" not in li]
                    kept += ["channel.vDeflection.lcd-info.*=0", "channel.measuredHeight.lcd-info.*=1"]
                    kept += ["channel.height.lcd-info.*=2"]
                    content = "\n".join(kept).encode()
                many.writestr(f"index/{index}/{name}", content)
    return path


def compared(path: Path, **given: float) -> None:
    """With afmformats' own arrays, and what both say of the curve."""
    afmformats = pytest.importorskip("afmformats")
    ours, theirs = curves.read(path, **given), afmformats.load_data(path)  # type: ignore[arg-type]
    assert len(ours) == len(theirs)
    for one, other in zip(ours, theirs, strict=True):
        marks = np.asarray(other["segment"])
        for number, segment in enumerate(one.segments):
            part = marks == number
            for key, column in (("time", "time"), ("z", segment.z_channel), ("force", "force")):
                np.testing.assert_allclose(getattr(segment, key), np.asarray(other[column])[part], rtol=1e-12, atol=0)
        for key in set(one.meta) & set(other.metadata) - {"format", "path", "time"}:
            expected = other.metadata[key]
            same = one.meta[key] == (pytest.approx(expected, rel=1e-12) if isinstance(expected, float) else expected)
            assert same, key
        assert one.meta["time"].startswith(other.metadata["time"][:8])
        assert {"spring constant", "sensitivity", "enum", "duration", "point count"} <= set(one.meta)


def test_a_single_curve_equals_afmformats(tmp_path: Path) -> None:
    compared(single(tmp_path / "curve.jpk-force"))


def test_a_map_equals_afmformats(tmp_path: Path) -> None:
    path = as_map(tmp_path / "map.jpk-force-map", 8)
    compared(path)
    found = curves.read(path)
    assert [(c.meta["grid index x"], c.meta["grid index y"]) for c in found] == [(i % 4, i // 4) for i in range(8)]
    with jpk.Archive(path) as archive:
        assert len(archive) == 8
        np.testing.assert_array_equal(archive[5].segments[1].force, found[5].segments[1].force)  # type: ignore[arg-type]


def test_a_map_is_fitted_from_its_archive_without_reading_it_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same blocks as from all curves in memory, with the same correction of the spring constant."""
    pytest.importorskip("xarray")
    volume = pytest.importorskip("nanotouch.maps.volume")
    path = as_map(tmp_path / "map.jpk-force-map", 8)
    given = {"spring_constant": 0.4, "sensitivity": None, "calibration": None}
    whole = volume.CurveVolume.of(curves.read(path, **given), path.name, path)
    monkeypatch.setattr(jpk, "read", None)
    streamed = volume.volume_of(path, None, False, given | {"untrusted": False})
    assert streamed.shape == whole.shape == (2, 4)
    assert streamed.coordinates.keys() == whole.coordinates.keys() == {"y", "x"}
    for start, stop in ((0, 3), (3, 8)):
        one, other = streamed.block(start, stop), whole.block(start, stop)
        for key in ("z", "force", "edges", "spring_constant"):
            np.testing.assert_array_equal(getattr(one, key), getattr(other, key))
    assert (one.spring_constant == 0.4).all()


@pytest.mark.parametrize("path", REAL, ids=lambda path: path.name)
def test_real_files_equal_afmformats(path: Path) -> None:
    compared(path)


def test_the_style_says_what_a_segment_is(tmp_path: Path) -> None:
    """Also in orders that afmformats refuses."""
    approach = ("extend", KNOWN.approach_z, KNOWN.approach_force)
    rest = ("pause", np.full(30, 2.8e-7), np.full(30, 1.6e-8))
    (curve,) = curves.read(synthetic.write_jpk(tmp_path / "a.jpk-force", [approach, rest, rest]))
    assert [s.role for s in curve.segments] == ["approach", "pause", "pause"]
    assert curve.retract is None


def test_the_work_grows_as_the_number_of_curves(tmp_path: Path) -> None:
    """afmformats' grows as its square. Counted in calls, which no load of the machine changes."""
    calls = []
    for count in (32, 128):
        path = as_map(tmp_path / f"{count}.jpk-force-map", count)
        profile = cProfile.Profile()
        profile.runcall(curves.read, path)
        calls.append(pstats.Stats(profile).total_calls)  # type: ignore[attr-defined]
    assert calls[1] < 4.05 * calls[0]


def test_a_curve_of_a_map_without_points_is_left_out_and_noted(tmp_path: Path) -> None:
    whole, path = as_map(tmp_path / "whole.jpk-force-map", 8), tmp_path / "a.jpk-force-map"
    with zipfile.ZipFile(whole) as old, zipfile.ZipFile(path, "w") as new:
        for item in old.infolist():
            lost = item.filename.startswith("index/3/") and item.filename.endswith(".dat")
            new.writestr(item, b"" if lost else old.read(item))
    found = curves.read(path)
    assert [curve.meta["enum"] for curve in found] == [0, 1, 2, 4, 5, 6, 7]
    assert "1 curve of 8 without points left out" in found[0].meta["notes"]


def edited(tmp_path: Path, *pairs: tuple[bytes, bytes]) -> Path:
    """The single curve with other words in the headers of its segments."""
    path = tmp_path / "edited.jpk-force"
    with zipfile.ZipFile(single(tmp_path / "whole.jpk-force")) as whole, zipfile.ZipFile(path, "w") as other:
        for item in whole.infolist():
            content = whole.read(item)
            for old, new in pairs if item.filename.endswith("segment-header.properties") else ():
                assert old in content
                content = content.replace(old, new)
            other.writestr(item, content)
    return path


DISTANCE, FORCE = (b"channel.vDeflection.conversion-set.conversion." + name for name in (b"distance.", b"force."))


def test_units_of_conversions_count(tmp_path: Path) -> None:
    """6e-8 m/V is 60 nm/V, and 0.8 N/m is 0.8 nN/nm."""
    pairs = [
        (DISTANCE + b"scaling.multiplier=6e-08", DISTANCE + b"scaling.multiplier=60.0"),
        (DISTANCE + b"scaling.unit.unit=m", DISTANCE + b"scaling.unit.unit=nm"),
        (FORCE + b"scaling.unit.unit=N", FORCE + b"scaling.unit.unit=nN"),
    ]
    (curve,), (plain,) = curves.read(edited(tmp_path, *pairs)), curves.read(edited(tmp_path))
    assert curve.meta["sensitivity"] == pytest.approx(6e-8)
    assert curve.meta["spring constant"] == pytest.approx(0.8)
    np.testing.assert_allclose(curve.segments[0].force, plain.segments[0].force, rtol=1e-12)  # type: ignore[arg-type]
    with pytest.raises(ReadError, match=r"force\.scaling\.unit is 'K', expected N with or without a prefix"):
        curves.read(edited(tmp_path, (FORCE + b"scaling.unit.unit=N", FORCE + b"scaling.unit.unit=K")))


def test_what_a_header_says_twice_or_not_in_full_is_told(tmp_path: Path) -> None:
    twice = (FORCE + b"base", FORCE + b"scaling.multiplier=0.9\n" + FORCE + b"base")
    with pytest.raises(ReadError, match=r"multiplier' as '0\.9' and as '0\.8'"):
        curves.read(edited(tmp_path, twice))
    with pytest.raises(ReadError, match="force is converted from 'volts', expected 'distance'"):
        curves.read(
            edited(tmp_path, (FORCE + b"base-calibration-slot=distance", FORCE + b"base-calibration-slot=volts"))
        )
    (curve,) = curves.read(edited(tmp_path, (FORCE + b"scaling.offset=0.0", FORCE + b"scaling.offset=1e-9")))
    assert "an offset of the force of 1 nN is left out" in curve.meta["notes"][0]


def test_properties_are_those_of_java(tmp_path: Path) -> None:
    """A value that goes on in the next line, an escaped letter; a number is one as Java writes it."""
    parted = (FORCE + b"scaling.multiplier=0.8", FORCE + b"scaling.multiplier=0.\\\n   8")
    escaped = (FORCE + b"scaling.unit.unit=N", FORCE + b"scal\\u0069ng.unit.unit=\\u004e")
    (curve,), (plain,) = curves.read(edited(tmp_path, parted, escaped)), curves.read(edited(tmp_path))
    assert curve.meta["spring constant"] == 0.8
    np.testing.assert_array_equal(curve.segments[0].force, plain.segments[0].force)  # type: ignore[arg-type]
    with pytest.raises(ReadError, match="multiplier' is '0_8', no number"):
        curves.read(edited(tmp_path, (FORCE + b"scaling.multiplier=0.8", FORCE + b"scaling.multiplier=0_8")))


def test_a_conversion_that_is_not_defined_is_none(tmp_path: Path) -> None:
    undefined = (FORCE + b"base", FORCE + b"defined=false\n" + FORCE + b"base")
    with pytest.raises(ReadError, match="states no spring constant"):
        curves.read(edited(tmp_path, undefined))
    (curve,) = curves.read(edited(tmp_path, undefined), spring_constant=0.4)
    assert curve.meta["spring constant"] == 0.4


def test_data_is_read_from_the_file_that_the_header_names(tmp_path: Path) -> None:
    """No other file is taken instead, and none outside the segment."""
    style = b"force-segment-header.settings.style"
    for name in ("channels/other.dat", "../0/channels/vDeflection.dat", "/etc/passwd"):
        named = (style, f"channel.vDeflection.data.file.name={name}\n".encode() + style)
        with pytest.raises(ReadError, match=f"outside the segment|segments/0/{name} is missing"):
            curves.read(edited(tmp_path, named))
    named = (style, b"channel.vDeflection.data.file.name=channels/vDeflection.dat\n" + style)
    assert len(curves.read(edited(tmp_path, named))) == 1


def test_a_retraction_alone_is_read_and_told(tmp_path: Path) -> None:
    path = tmp_path / "half.jpk-force"
    with zipfile.ZipFile(single(tmp_path / "whole.jpk-force")) as whole, zipfile.ZipFile(path, "w") as half:
        for item in whole.infolist():
            if not item.filename.startswith("segments/0/"):
                half.writestr(item, whole.read(item))
    (curve,) = curves.read(path)
    assert [segment.role for segment in curve.segments] == ["retract"]
    assert curve.meta["notes"] == ("segment 0 is not in the archive",)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (b"num-points=100", b"num-points=101", "100 heights, 100 forces, but states 101"),
        (b"type=signedinteger", b"type=complex", "type 'complex', which is not read"),
        (b"force-segment-header.duration=1.0", b"", "lacks 'force-segment-header.duration'"),
        (b"duration=1.0", b"duration=nan", "'nan', no number"),
        (
            b"calibration-slot=volts",
            b"calibration-slot=force",
            "lacks 'channel.measuredHeight.conversion-set.conversion.force",
        ),
        (
            b"force.scaling.multiplier=",
            b"force.scaling.multiplier=9",
            "two values of its spring constant, 90.8 and 0.8",
        ),
    ],
)
def test_a_damaged_archive_is_refused(tmp_path: Path, old: bytes, new: bytes, message: str) -> None:
    path = tmp_path / "damaged.jpk-force"
    with zipfile.ZipFile(single(tmp_path / "whole.jpk-force")) as whole, zipfile.ZipFile(path, "w") as damaged:
        for item in whole.infolist():
            content = whole.read(item)
            if item.filename == "segments/0/segment-header.properties":
                assert old in content
                content = content.replace(old, new)
            damaged.writestr(item, content)
    with pytest.raises(ReadError, match=message) as caught:
        curves.read(path)
    assert caught.value.reader == "nanotouch/jpk"


def test_archives_behind_something_else_and_endless_properties_are_refused(tmp_path: Path) -> None:
    """A zip archive is found by its end: what stands before it does not make it harmless."""
    path = tmp_path / "bomb.jpk-force"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("header.properties", bytes(17 << 20))
    with pytest.raises(ReadError, match=r"header\.properties is longer than 16 MiB"):
        curves.read(path)
    huge = path.read_bytes().replace((17 << 20).to_bytes(4, "little"), (3000 << 20).to_bytes(4, "little"))
    path.write_bytes(b"not a zip archive, it seems" + huge)
    with pytest.raises(ReadError, match="unpacks to 3000 MiB"):
        curves.read(path)


def test_a_grid_that_puts_two_curves_into_one_pixel_is_refused(tmp_path: Path) -> None:
    """The second was lost without a word: 4 of 8 curves, marked ok."""
    pytest.importorskip("xarray")
    path, wrong = as_map(tmp_path / "map.jpk-force-map", 8), tmp_path / "wrong.jpk-force-map"
    with zipfile.ZipFile(path) as archive, zipfile.ZipFile(wrong, "w") as other:
        for name in archive.namelist():
            other.writestr(name, archive.read(name).replace(b"grid.ilength=4", b"grid.ilength=2"))
    with pytest.raises(InvalidValue, match="curves 0 and 1 both lie at row 0, column 0 of a grid of 2 x 2"):
        maps.fit(wrong, "hertz", radius=1e-6)
