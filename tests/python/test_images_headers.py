# SPDX-License-Identifier: BSD-3-Clause
"""A header that says something twice, and not the same: told; data that are not there: refused."""

from __future__ import annotations

import gzip
import re
from pathlib import Path

import numpy as np
import pytest
import synthetic
import synthetic_images

pytest.importorskip("SurfaceTopography")
pytest.importorskip("cv2")

from nanotouch import images
from nanotouch.errors import ReadError

SIDE = (3e-6, 4e-6)


def nanoscope(path: Path) -> Path:
    return synthetic_images.write_nanoscope_image(path, synthetic.asymmetric(), SIDE)


def igor(path: Path) -> Path:
    return synthetic.write_ibw_image(path, {"HeightTrace": synthetic.asymmetric()}, 1.25e-7)


def nanosurf(path: Path) -> Path:
    return synthetic.write_nid(path, synthetic.asymmetric(), SIDE)


def wsxm(path: Path) -> Path:
    return synthetic_images.write_wsxm(path, synthetic.asymmetric(), SIDE)


def picoview(path: Path) -> Path:
    return synthetic_images.write_mi(path, synthetic.asymmetric(), SIDE)


WRITERS = {"nanoscope": nanoscope, "igor": igor, "nanosurf": nanosurf, "wsxm": wsxm, "picoview": picoview}


@pytest.mark.parametrize("kind", WRITERS)
def test_the_whole_file_is_read(tmp_path: Path, kind: str) -> None:
    topography = images.read(WRITERS[kind](tmp_path / "image"))
    # the coarsest is int16 over the range: 40 nm / 65536, half a count
    np.testing.assert_allclose(
        topography.heights - topography.heights.min(), synthetic.asymmetric(), rtol=0, atol=1e-12
    )
    assert topography.pixel_size == pytest.approx((1.25e-7, 1.25e-7), rel=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (rb"Dim2Range=", b"Dim2Range=-", r"\[DataSet-0:0\] states Dim2Range as -4.*, expected a number above 0"),
        (rb"Dim2Unit=m", b"Dim2Unit=m\r\nDim2Range=1e-6", r"states Dim2Range as 1e-6 and as 4"),
    ],
)
def test_a_nanosurf_scale_that_is_none_is_refused(tmp_path: Path, old: bytes, new: bytes, message: str) -> None:
    path = nanosurf(tmp_path / "image.nid")
    path.write_bytes(re.sub(old, new, path.read_bytes(), count=1))
    with pytest.raises(ReadError, match=message):
        images.read(path)


def test_a_nanosurf_scale_without_its_lowest_value_is_noted(tmp_path: Path) -> None:
    path = nanosurf(tmp_path / "image.nid")
    path.write_bytes(re.sub(rb"Dim2Min=[^\r]*\r\n", b"", path.read_bytes(), count=1))
    assert images.read(path).notes == ("[DataSet-0:0] states no Dim2Min: its lowest value is taken as 0",)


NOTES = [
    ("nanoscope", rb"(?<=Scan Size: )4000", b"2000", "image width .* but scan size"),
    ("igor", rb"FastScanSize: 3", b"FastScanSize: 9", "FastScanSize .* but pixels times"),
    ("nanosurf", rb"(?<=Image size=)4", b"8", "image size .* but of the channel"),
    ("nanosurf", rb"(?<=4\xb5m\r\nPoints=)32", b"33", "Points of the scan 33, but"),
    ("wsxm", rb"(?<=header size: )\d", b"9", "header size .* but its end"),
    ("wsxm", rb"(?<=Z Amplitude: )40", b"44", "Z amplitude .* but range of the heights"),
]


@pytest.mark.parametrize(("kind", "old", "new", "message"), NOTES)
def test_what_no_format_promises_is_told_and_read(
    tmp_path: Path, kind: str, old: bytes, new: bytes, message: str
) -> None:
    path = WRITERS[kind](tmp_path / "image")
    assert images.read(path).notes == ()
    path.write_bytes(re.sub(old, new, path.read_bytes(), count=1))
    (note,) = images.read(path).notes
    assert re.search(f"its header contradicts itself: {message}", note)


def test_the_full_scale_of_nanoscope_is_no_power_of_two_times_its_digit(tmp_path: Path) -> None:
    """In real files V per LSB times 65536 is anything: the heights follow from the full scale."""
    path = WRITERS["nanoscope"](tmp_path / "image")
    expected = images.read(path)
    path.write_bytes(re.sub(rb"\(([0-9.]+) V/LSB", lambda m: m[0].replace(m[1], b"9" + m[1][1:]), path.read_bytes()))
    np.testing.assert_array_equal(images.read(path).heights, expected.heights)


@pytest.mark.parametrize(
    ("kind", "data"), [("nanoscope", 1536), ("nanosurf", 3072), ("wsxm", 6144), ("picoview", 3072)]
)
def test_data_that_are_not_there_are_refused_more_than_is_needed_is_not(tmp_path: Path, kind: str, data: int) -> None:
    path = WRITERS[kind](tmp_path / "image")
    content = path.read_bytes()
    expected = images.read(path).heights
    path.write_bytes(content + b"\r\n")
    np.testing.assert_array_equal(images.read(path).heights, expected)
    for left in (data - 2, data // 2):
        path.write_bytes(content[: len(content) - data + left])
        with pytest.raises(ReadError):
            images.read(path)


@pytest.mark.parametrize(
    ("kind", "old", "new"),
    [("nanosurf", rb"\r\nLines=\d+\r", b"\r\nLines=8\r"), ("nanosurf", rb"\nPoints=\d+\r", b"\nPoints=16\r"),
     ("picoview", rb"yPixels( +)\d+", rb"yPixels\g<1>12"), ("picoview", rb"xPixels( +)\d+", rb"xPixels\g<1>16")],
)  # fmt: skip
def test_fewer_pixels_than_there_are_data_are_refused(tmp_path: Path, kind: str, old: bytes, new: bytes) -> None:
    path = WRITERS[kind](tmp_path / "image")
    changed = re.sub(old, new, path.read_bytes())
    assert changed != path.read_bytes()
    path.write_bytes(changed)
    with pytest.raises(ReadError, match="its points, lines or bits are wrong"):
        images.read(path)


@pytest.mark.parametrize(("name", "words"), [("a.axz", "Anasys Analysis Studio"), ("a.spm.gz", "packed by gzip")])
def test_packed_files_are_refused_by_name(tmp_path: Path, name: str, words: str) -> None:
    (tmp_path / name).write_bytes(gzip.compress(b"<?xml version='1.0'?><Document/>"))
    with pytest.raises(ReadError, match=words):
        images.read(tmp_path / name)


def test_a_wrong_check_sum_is_refused(tmp_path: Path) -> None:
    path = igor(tmp_path / "image")
    content = path.read_bytes()
    path.write_bytes(re.sub(rb"(?s)(?<=.{200})\x00", b"\x01", content, count=1))
    with pytest.raises(ReadError, match="check sum of its header is wrong"):
        images.read(path)


@pytest.mark.parametrize("unit", [b"nm", b"\xb5m", b"\xc2\xb5m", b"\x83\xcam", b"\xc5", b"\xc3\x85"])
def test_lines_of_one_wsxm_header_may_differ_in_encoding(tmp_path: Path, unit: bytes) -> None:
    path = wsxm(tmp_path / "image")
    expected = images.read(path).pixel_size
    content = path.read_bytes()
    scale = {b"n": 1.0, b"\xc5": 10.0, b"\xc3": 10.0}.get(unit[:1], 1e-3)
    number = re.search(rb"X Amplitude: ([0-9.]+) nm", content)
    assert number
    content = content.replace(number[0], b"X Amplitude: %.9g %s" % (float(number[1]) * scale, unit))
    path.write_bytes(content.replace(b"[Control]", b"[Environment]\r\n    Temperature: 0 \xbaC\r\n[Control]", 1))
    assert images.read(path).pixel_size == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (rb"Number of rows: \d+", b"Number of rows: 8", "8 rows and 32 columns .* make"),
        (rb"( *X Amplitude: )(\d+)", rb"\g<0> nm\r\n\g<1>7", "'X Amplitude' is stated as '.*' and as '7 nm'"),
    ],
)
def test_a_wsxm_header_that_contradicts_itself_is_refused(tmp_path: Path, old: bytes, new: bytes, message: str) -> None:
    path = wsxm(tmp_path / "image")
    path.write_bytes(re.sub(old, new, path.read_bytes(), count=1))
    with pytest.raises(ReadError, match=message):
        images.read(path)


def test_a_wsxm_header_without_its_y_amplitude_is_told(tmp_path: Path) -> None:
    path = wsxm(tmp_path / "image")
    path.write_bytes(re.sub(rb" *Y Amplitude:[^\n]*\n", b"", path.read_bytes(), count=1))
    assert "its header states no Y Amplitude: taken as the X Amplitude" in images.read(path).notes
