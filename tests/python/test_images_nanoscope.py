# SPDX-License-Identifier: BSD-3-Clause
"""NanoScope images: size, lines, direction and channels are checked against everything else that the header says."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("cv2")

from nanotouch import images
from nanotouch.errors import ReadError

NX, NY, SENSITIVITY, FULL = 32, 16, 25.0, 4.0  # pixels, lines, nm/V, V
HEADER = 4096


@dataclass(frozen=True)
class Picture:
    """One channel as its header states it; `counts` is what is stored."""

    counts: np.ndarray
    name: str = "Height"
    lines: int = NY
    aspect: str | None = "1:1"
    size: str = "8 8 ~m"
    way: str | None = "Trace"
    scan_line: str = "Main"
    more: tuple[str, ...] = ()
    samples: str = str(NX)
    scale: str = f"V [Sens. Zsens] (0.0000610352 V/LSB) {FULL:.7g} V"
    kind: str = "<i2"
    width: int = 2


def picture(lines: int = NY, seed: int = 0, **more: object) -> Picture:
    counts = np.random.default_rng(seed).integers(-30000, 30000, (lines, NX))
    return replace(Picture(counts), lines=lines, **more)  # type: ignore[arg-type]


def write(path: Path, *pictures: Picture, scan: tuple[str, ...] = (), version: str = "0x08150300") -> Path:
    """A file of these channels; `scan` are lines of the scan's section."""
    stated = ("Operating mode: Image", "Scan Size: 8000 nm", f"Samps/line: {NX}", *scan)
    lines = ["*File list", f"Version: {version}", "Start context: OL", f"Data length: {HEADER}", "*Scanner list",
             f"@Sens. Zsens: V {SENSITIVITY} nm/V", "*Ciao scan list", *stated]  # fmt: skip
    data = b""
    for one in pictures:
        stored = one.counts.astype(one.kind).tobytes()
        lines += ["*Ciao image list", f"Data offset: {HEADER + len(data)}", f"Data length: {len(stored)}",
                  f"Bytes/pixel: {one.width}", f"Samps/line: {one.samples}", f"Number of lines: {one.lines}",
                  f"Scan Size: {one.size}", f"Scan Line: {one.scan_line}", *one.more]  # fmt: skip
        lines += [f"Aspect Ratio: {one.aspect}"] if one.aspect else []
        lines += [f"Line Direction: {one.way}"] if one.way else []
        lines += [f'@2:Image Data: S [{one.name}] "{one.name}"', f"@2:Z scale: {one.scale}"]
        data += stored
    text = "".join(f"\\{line}\r\n" for line in [*lines, "*File list end"]).encode("latin-1") + b"\x1a"
    path.write_bytes(text.ljust(HEADER, b"\0") + data)
    return path


def metres(one: Picture) -> np.ndarray:
    return one.counts * (FULL / 65536 * SENSITIVITY * 1e-9)


def test_an_ordinary_picture(tmp_path: Path) -> None:
    one = picture(NX)
    read = images.read(write(tmp_path / "a.spm", one, scan=(f"Lines: {NX}", "Aspect Ratio: 1:1")))
    np.testing.assert_allclose(read.heights, metres(one), rtol=1e-12)  # row 0 is the lower edge, as stored
    assert read.size == pytest.approx((8e-6, 8e-6))
    assert read.notes == ()


SIZES = [
    # lines, aspect, scan size of the picture; of the scan: lines, aspect, more; height [um]
    (16, "2:1", "8 8 ~m", 16, "2:1", (), 4.0),  # square pixels
    (16, "2:1", "8 4 ~m", 16, "2:1", (), 4.0),  # said outright
    (22, "0.7", "8 8 ~m", 22, "0.7", (), 5.5),  # one number is height over width; 22/32 = 0.69
    (32, "1:1", "8 8 ~m", 32, "1:1", (), 8.0),
    (16, "1:1", "8 8 ~m", 16, "1:1", (), 8.0),  # half the lines over the same height
    (16, None, "8 4 ~m", 16, None, (), 4.0),
    (16, None, "8 8 ~m", 16, "2:1", (), 4.0),  # the aspect stands with the scan alone
    (8, "4:1", "8 8 ~m", 32, "1:1", (), 2.0),  # stopped after a quarter
    (8, "2:1", "8 8 ~m", 16, "1:1", (), 4.0),  # stopped after half, pixels twice as high as wide
    (8, "4:1", "8 4 ~m", 16, "2:1", (), 2.0),  # a scan 2:1 that was stopped, its full height stated
    (16, "2:1", "8 8 ~m", 16, "2:1", ("Slow Axis Size: 4000 nm",), 4.0),
    (8, "4:1", "8 8 ~m", 16, "2:1", ("Slow Axis Size: 4000 nm",), 2.0),
    (16, "1:1", "8 8 ~m", 16, "1:1", ("Slow Axis Size: 6000 nm",), 6.0),
    (16, "2:1", "4 4 ~m", 32, "1:1", ("Slow Axis Size: 8000 nm",), 2.0),  # of another scan: 4 um here
]


@pytest.mark.parametrize(("lines", "aspect", "size", "scan_lines", "scan_aspect", "more", "height"), SIZES)
def test_the_height_agrees_with_aspect_and_lines(
    tmp_path: Path, lines: int, aspect: str | None, size: str, scan_lines: int, scan_aspect: str | None,
    more: tuple[str, ...], height: float,
) -> None:  # fmt: skip
    scan = (f"Lines: {scan_lines}", *([f"Aspect Ratio: {scan_aspect}"] if scan_aspect else []), *more)
    read = images.read(write(tmp_path / "a.spm", picture(lines, aspect=aspect, size=size), scan=scan))
    assert read.shape == (lines, NX)
    assert read.size[0] == pytest.approx(height * 1e-6, rel=1e-9)
    assert read.notes == ()


def test_lines_and_samples_against_the_aspect_are_told(tmp_path: Path) -> None:
    read = images.read(write(tmp_path / "a.spm", picture(32, aspect="2:1"), scan=("Lines: 32", "Aspect Ratio: 2:1")))
    assert read.size[0] == pytest.approx(8e-6)
    assert any("contradicts itself" in note and "aspect" in note for note in read.notes)


@pytest.mark.parametrize("micro", [b"~m", b"\xb5m", "µm".encode(), b"\x83\xcam", b"um"])
def test_micro_in_every_encoding(tmp_path: Path, micro: bytes) -> None:
    path = write(tmp_path / "a.spm", picture(NX))
    path.write_bytes(path.read_bytes().replace(b"8 8 ~m", b"8 8 " + micro))
    assert images.read(path).size == pytest.approx((8e-6, 8e-6))


def test_the_lines_are_those_that_the_data_hold(tmp_path: Path) -> None:
    held = picture(16)
    for stated, more in ((32, ()), (32, ("Valid data start Y: 0", "Valid data len Y: 16"))):
        read = images.read(write(tmp_path / "a.spm", replace(held, lines=stated, more=more), scan=("Lines: 4",)))
        np.testing.assert_allclose(read.heights, metres(held), rtol=1e-12)
        assert read.size[0] == pytest.approx(4e-6)  # 8 um for the 32 lines that are stated
        assert any("states 32 lines, but its data hold 16" in note for note in read.notes)
    read = images.read(write(tmp_path / "b.spm", replace(picture(32), lines=16), scan=("Lines: 16",)))
    assert read.shape == (32, NX)
    assert any("states 16 lines, but its data hold 32" in note for note in read.notes)


def test_data_that_end_early_for_no_reason_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path / "a.spm", picture(32))
    path.write_bytes(path.read_bytes().replace(b"Data length: 2048", b"Data length: 1024"))
    with pytest.raises(ReadError, match="1024 bytes of data, but its header states 2048"):
        images.read(path)


@pytest.mark.parametrize(
    ("changed", "note"),
    [({"samples": "16"}, "states 16 x 32 pixels, but its data are 32 x 32, as the scan"),
     ({"samples": "64"}, "states 64 x 32 pixels, but its data are 32 x 32, as the scan"),
     ({"lines": 16}, "states 32 x 16 pixels, but its data are 32 x 32, as the scan")],
)  # fmt: skip
def test_pixels_that_the_data_do_not_hold_are_those_of_the_scan(
    tmp_path: Path, changed: dict[str, Any], note: str
) -> None:
    one = picture(NX)
    path = write(tmp_path / "a.spm", replace(one, **changed), scan=(f"Lines: {NX}", "Aspect Ratio: 1:1"))
    read = images.read(path)
    np.testing.assert_allclose(read.heights, metres(one), rtol=1e-12)
    assert read.size == pytest.approx((8e-6, 8e-6))
    assert read.notes == (f"it {note}",)


@pytest.mark.parametrize(
    ("changed", "words"),
    [({"samples": "32 64"}, "'Samps/line' is '32 64', expected one whole number"),
     ({"width": 4}, "2048 bytes of data are not 32 lines of 32 samples of 4 bytes"),
     ({"scale": "V [Sens. Zsens] (0.0000610352 V/LSB) -4 V"}, "states no range")],
)  # fmt: skip
def test_what_contradicts_the_data_is_refused(tmp_path: Path, changed: dict[str, Any], words: str) -> None:
    with pytest.raises(ReadError, match=re.escape(words)):
        images.read(write(tmp_path / "a.spm", replace(picture(NX), **changed), scan=(f"Lines: {NX}",)))


def test_lines_that_were_not_measured_are_left_out(tmp_path: Path) -> None:
    one = picture(32, more=("Valid data start X: 0", "Valid data len X: 32", "Valid data start Y: 20",
                            "Valid data len Y: 12"))  # fmt: skip
    read = images.read(write(tmp_path / "a.spm", one))
    np.testing.assert_allclose(read.heights, metres(one)[20:], rtol=1e-12)
    assert read.size[0] == pytest.approx(3e-6)
    assert read.notes == ("20 of 32 lines were not measured ('Valid data len Y') and are left out",)


def test_places_in_the_file_that_cannot_be(tmp_path: Path) -> None:
    def moved(old: str, new: str) -> Path:
        path = write(tmp_path / "a.spm", picture(NX, 1), picture(NX, 2, name="Phase"))
        path.write_bytes(path.read_bytes().replace(f"Data offset: {old}".encode(), f"Data offset: {new}".encode()))
        return path

    assert any("overlap" in note and "Phase" in note for note in images.read(moved("6144", "5144")).notes)
    with pytest.raises(ReadError, match="begin at 40, inside of the header"):
        images.read(moved("4096", "0040"), "Height")
    with pytest.raises(ReadError, match="no channel of heights can be read: 'Height': its data are to begin at 40"):
        images.read(moved("4096", "0040"))
    beyond = picture(NX, more=("Valid data start Y: 20", "Valid data len Y: 20"))
    (note,) = images.read(write(tmp_path / "b.spm", beyond)).notes
    assert "32 lines are held, but 'Valid data' tells of 20 to 40" in note


def test_trace_is_the_default_and_names_tell_it_from_retrace(tmp_path: Path) -> None:
    pictures = [picture(NX, 1, way="Retrace", scan_line="Interleave"), picture(NX, 2, way="Retrace"),
                picture(NX, 3, way="Trace"), picture(NX, 4, name="Phase", scale="V (0.005 V/LSB) 360 º")]  # fmt: skip
    path = write(tmp_path / "a.spm", *pictures)
    names = [one.name for one in images.channels(path)]
    assert names == ["Height retrace interleave", "Height retrace", "Height trace", "Phase"]
    assert images.read(path).channel == "Height trace"
    np.testing.assert_allclose(images.read(path, "height RETRACE").heights, metres(pictures[1]), rtol=1e-12)


BAD = {
    "empty": (picture(0, samples="0 0"), "it is empty"),
    "without a scale": (picture(NX, scale="C nothing"), "Z scale"),
    "unknown scale": (picture(NX, scale="V [Sens. Nobody] (1 V/LSB) 1 V"), "'Sens. Nobody'"),
    "odd width": (picture(NX, width=3), "3 bytes per value"),
}


@pytest.mark.parametrize("kind", BAD)
def test_one_bad_channel_leaves_the_others_readable(tmp_path: Path, kind: str) -> None:
    bad, reason = BAD[kind]
    good = picture(NX, 5)
    path = write(tmp_path / "a.spm", replace(bad, name="Phase"), good)
    read = images.read(path)
    np.testing.assert_allclose(read.heights, metres(good), rtol=1e-12)
    (note,) = read.notes
    assert "channel 'Phase' left out" in note
    assert reason in note
    assert [(one.name, one.kind) for one in images.channels(path)] == [("Phase", "unreadable"), ("Height", "height")]
    with pytest.raises(ReadError, match="channel 'Phase' cannot be read"):
        images.read(path, "Phase")
    with pytest.raises(ReadError, match="none of its channels can be read: 'Phase'"):
        images.read(write(tmp_path / "b.spm", replace(bad, name="Phase")))


def test_a_file_that_is_cut_off_keeps_its_whole_channels(tmp_path: Path) -> None:
    good = picture(NX, 5)
    path = write(tmp_path / "a.spm", good, picture(NX, name="Phase"))
    path.write_bytes(path.read_bytes()[:-2])
    assert any("'Phase' left out" in note and "cut off" in note for note in images.read(path).notes)
    np.testing.assert_allclose(images.read(path).heights, metres(good), rtol=1e-12)


@pytest.mark.parametrize(("kind", "width"), [("<i4", 4), ("<i4", 2), ("<i2", 2)])
def test_values_of_four_bytes_from_version_9_2_on(tmp_path: Path, kind: str, width: int) -> None:
    """The header says two bytes over values of four, and the range follows what it says."""
    one = picture(NX, kind=kind, width=width)
    one = replace(one, counts=one.counts * (65536 if width == 4 else 1))
    read = images.read(write(tmp_path / "a.spm", one, version="0x09300000"))
    np.testing.assert_allclose(read.heights, one.counts * (FULL / 256**width * SENSITIVITY * 1e-9), rtol=1e-12)


def test_half_the_lines_in_four_bytes_are_no_two_bytes(tmp_path: Path) -> None:
    one = replace(picture(NX // 2, kind="<i4"), lines=NX)
    read = images.read(write(tmp_path / "a.spm", one, version="0x09300000"))
    np.testing.assert_allclose(read.heights, metres(one), rtol=1e-12)


def test_sensitivities_in_millivolts_and_without_a_unit(tmp_path: Path) -> None:
    one = picture(NX, scale=f"V [Sens. Zsens] (0.06 mV/LSB) {1e3 * FULL:.7g} mV")
    np.testing.assert_allclose(images.read(write(tmp_path / "a.spm", one)).heights, metres(one), rtol=1e-12)
    path = write(tmp_path / "b.spm", picture(NX))
    path.write_bytes(path.read_bytes().replace(b"25.0 nm/V", b"25.0     "))
    read = images.read(path)
    np.testing.assert_allclose(read.heights, metres(picture(NX)), rtol=1e-12)
    assert read.notes == ("the header states 'Sens. Zsens' as 25 without a unit: taken as nm/V",)


def test_an_ordinary_file_is_read_as_surface_topography_does(tmp_path: Path) -> None:
    io = pytest.importorskip("SurfaceTopography.IO")
    path = write(tmp_path / "a.spm", picture(NX, 6), scan=(f"Lines: {NX}",))
    with io.open_topography(str(path)) as reader:
        theirs = reader.topography()
    ours = images.read(path)
    np.testing.assert_allclose(ours.heights, theirs.heights().T[::-1] * 1e-9, rtol=1e-9)
    assert ours.size == pytest.approx([side * 1e-9 for side in theirs.physical_sizes[::-1]])


def test_two_values_of_one_scale_are_refused(tmp_path: Path) -> None:
    path = write(tmp_path / "a.spm", picture(), scan=("@Sens. Other: V 1.0 nm/V", "@Sens. Other: V 2.0 nm/V"))
    with pytest.raises(ReadError, match=r"'@Sens\. Other' is stated as 'V 1\.0 nm/V' and as 'V 2\.0 nm/V'"):
        images.read(path)
    again = write(tmp_path / "b.spm", picture(), scan=("Note: one", "Note: two", "Scan Size: 8000 nm"))
    np.testing.assert_array_equal(images.read(again).heights, images.read(write(tmp_path / "c.spm", picture())).heights)


@pytest.mark.parametrize("number", ["790,3658", "1,790.5", "12.5,"])
def test_a_sensitivity_that_is_no_number_is_named(tmp_path: Path, number: str) -> None:
    path = write(tmp_path / "a.spm", picture())
    path.write_bytes(path.read_bytes().replace(f"V {SENSITIVITY} nm/V".encode(), f"V {number} nm/V".encode()))
    with pytest.raises(ReadError, match=r"does not say what 'Sens\. Zsens' is"):
        images.read(path)
