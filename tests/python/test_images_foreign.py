# SPDX-License-Identifier: BSD-3-Clause
"""Images that say one thing and hold another: refused or told by name, and what others write is read all the same."""

from __future__ import annotations

import re
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
import synthetic

sys.path.insert(0, str(Path(__file__).parents[1] / "corpus"))
import surf_image
from nanotouch import images
from nanotouch.errors import ReadError

Y, X = np.mgrid[:8, :12]
NOISE = np.random.default_rng(7).normal(size=X.shape)
PICTURE = np.round(3.0 * X + Y * Y + 5.0 * np.sin(X * Y / 5.0) + NOISE, 3)  # [nm], from the top
HEIGHTS = PICTURE[::-1] * 1e-9
GWY = "# Channel: Height\n# Width: 1.2 µm\n# Height: 0.8 µm\n# Value units: nm\n"


def rows(values: np.ndarray, form: str = "%.3f") -> str:
    return "".join("\t".join(form % value for value in row) + "\n" for row in values)


def text(path: Path, content: str) -> Path:
    path.write_text(content, encoding="utf-8")
    return path


def check(topography: images.Topography, heights: np.ndarray = HEIGHTS, atol: float = 1e-15) -> None:
    np.testing.assert_allclose(topography.heights, heights, atol=atol)
    assert topography.size == pytest.approx((0.8e-6, 1.2e-6))


# --- text -------------------------------------------------------------------------------------------------------------


def test_two_matrices_under_one_header_are_refused(tmp_path: Path) -> None:
    check(images.read(text(tmp_path / "a.txt", GWY + rows(PICTURE))))
    with pytest.raises(ReadError, match="tables of 8 and 8 rows under one header"):
        images.read(text(tmp_path / "b.txt", GWY + rows(PICTURE) + "\n" + rows(-PICTURE)))
    spaced = GWY + rows(PICTURE).replace("\n", "\n\n")  # an empty line behind every row is no second table
    check(images.read(text(tmp_path / "c.txt", spaced)))


@pytest.mark.parametrize("cut", [2, 3, 4, 5])
def test_a_matrix_that_is_cut_inside_its_last_number_is_refused(tmp_path: Path, cut: int) -> None:
    with pytest.raises(ReadError, match="cut off"):
        images.read(text(tmp_path / "a.txt", (GWY + rows(PICTURE))[:-cut]))
    missing = rows(PICTURE).replace(f"{PICTURE[2, 3]:.3f}", "nan")
    with pytest.raises(ReadError, match="cut off"):
        images.read(text(tmp_path / "c.txt", (GWY + missing)[:-cut]))
    check(images.read(text(tmp_path / "b.txt", (GWY + rows(PICTURE))[:-1])))  # whole, without an end of line


SPIP = ("File Format = ASCII\nOriginal file: a.mdt\nx-pixels = 12\ny-pixels = 8\nx-length = 1200\ny-length = 800\n"
        "Bit2nm = 0.1\nVoidpixels = 0\nStart of Data :\n")  # fmt: skip


@pytest.mark.parametrize("mark", ["", "# "])
def test_the_scale_of_spip_counts(tmp_path: Path, mark: str) -> None:
    stored = np.round(PICTURE * 10)
    header = "".join(mark + line + "\n" for line in SPIP.splitlines())
    path = text(tmp_path / "a.txt", header + rows(stored, "%d"))
    check(images.read(path), stored[::-1] * 1e-10)
    with pytest.raises(ReadError, match="contradicts the z unit"):
        images.read(path, z_unit="um")


def test_sizes_are_kept_where_the_unit_of_the_heights_is_given(tmp_path: Path) -> None:
    path = text(tmp_path / "a.txt", GWY.replace("# Value units: nm\n", "") + rows(PICTURE))
    check(images.read(path, z_unit="nm"))
    with pytest.raises(ReadError, match=re.escape("give the height unit (z unit)")):
        images.read(path)
    assert images.channels(path)[0].size == pytest.approx((0.8e-6, 1.2e-6))


def test_a_text_image_in_volts_is_refused_by_its_unit(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="'Height' is in 'V', not a length"):
        images.read(text(tmp_path / "a.txt", GWY.replace("nm", "V") + rows(PICTURE)))


def test_matrices_and_points_of_wsxm(tmp_path: Path) -> None:
    head = "WSxM file copyright UAM\nWSxM ASCII {} file\n"
    sides = "X Amplitude: 1.2 um\nY Amplitude: 0,8 um\nZ Amplitude: 77.9 nm\n\n"
    path = text(tmp_path / "a.txt", head.format("Matrix") + sides.replace(",", ".") + rows(PICTURE))
    found = images.read(path)
    check(found)
    assert any("upper edge" in note for note in found.notes)
    points = [(x * 100.0, (7 - y) * 100.0, PICTURE[y, x]) for y in range(8) for x in range(12)]
    order = np.random.default_rng(0).permutation(len(points))
    lines = "".join("{:.4f}\t{:.4f}\t{:.3f}\n".format(*points[n]) for n in order)
    path = text(tmp_path / "b.txt", head.format("XYZ") + "X[nm]\tY[nm]\tZ[nm]\n\n" + lines)
    check(images.read(path))
    cut = lines.rpartition("\n")[0].rpartition("\n")[0] + "\n"
    with pytest.raises(ReadError, match="no whole raster"):
        images.read(text(tmp_path / "c.txt", head.format("XYZ") + "X[nm]\tY[nm]\tZ[nm]\n\n" + cut))
    with pytest.raises(ReadError, match="'V', not a length"):
        images.read(text(tmp_path / "d.txt", head.format("XYZ") + "X[nm]\tY[nm]\tZ[V]\n\n" + lines))


# --- binary -----------------------------------------------------------------------------------------------------------


def test_an_asylum_height_in_volts_is_no_length(tmp_path: Path) -> None:
    """The wave says V, its channel's name a height: 78 V were 78 m, or 78 nm."""
    path = synthetic.write_ibw_image(tmp_path / "a.ibw", {"HeightTrace": HEIGHTS}, 1e-7)
    check(images.read(path))
    content = bytearray(path.read_bytes())
    assert content[64 + 148 : 64 + 149] == b"m"
    content[64 + 148 : 64 + 149] = b"V"
    checksum = int(np.frombuffer(bytes(content[: 64 + 320]), "<i2").astype(np.int64).sum())
    (old,) = struct.unpack_from("<h", content, 2)
    struct.pack_into("<h", content, 2, int(np.array(old - checksum, np.int64).astype(np.int16)))
    path.write_bytes(bytes(content))
    assert [(one.unit, one.kind) for one in images.channels(path)] == [("V", "voltage")]
    with pytest.raises(ReadError, match="no height channel"):
        images.read(path)


@pytest.mark.parametrize("title", ["Phase", "Amplitude error", "Deflection [Fwd]"])
def test_a_simple_field_whose_title_is_no_height_has_to_be_asked_for(tmp_path: Path, title: str) -> None:
    facts = {"XRes": 12, "YRes": 8, "XReal": 1.2e-6, "YReal": 8e-7, "XYUnits": "m", "ZUnits": "m", "Title": title}
    header = ("Gwyddion Simple Field 1.0\n" + "".join(f"{k} = {v}\n" for k, v in facts.items())).encode()
    path = tmp_path / "a.gsf"
    path.write_bytes(header + b"\0" * (4 - len(header) % 4) + (PICTURE * 1e-9).astype("<f4").tobytes())
    with pytest.raises(ReadError, match="no height channel"):
        images.read(path)
    check(images.read(path, title), atol=1e-14)


def test_heights_with_an_imaginary_part_are_refused(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="real numbers, not complex128"):
        images.Topography(HEIGHTS * (1.0 + 1.0j), (1e-7, 1e-7))  # type: ignore[arg-type]
    np.save(tmp_path / "a.npy", HEIGHTS * (1.0 + 1.0j))
    with pytest.raises(ReadError, match="an array of complex128 of the shape"):
        images.read(tmp_path / "a.npy", z_unit="m", pixel_size=1e-7)


STP = ("WSxM file copyright UAM\r\nSxM Image file\r\nImage header size: {}\r\n\r\n[Control]\r\n\r\n"
       "    X Amplitude: 1,2 um\r\n    Y Amplitude: 0,8 um\r\n\r\n[General Info]\r\n\r\n"
       "    Acquisition channel: Topography\r\n    Image Data Type: double\r\n"
       "    Number of columns: 12\r\n    Number of rows: 8\r\n"
       "    Z Amplitude: {} nm\r\n\r\n"
       "[Miscellaneous]\r\n\r\n    Version: 1.0 (April 2000)\r\n\r\n[Header end]\r\n")  # fmt: skip


def test_decimal_commas_of_wsxm(tmp_path: Path) -> None:
    """The first number is the lower right corner."""
    amplitude = f"{np.ptp(PICTURE):.3f}".replace(".", ",")
    header = STP.format(1000, amplitude).encode()
    header = STP.format(f"{len(header):4d}", amplitude).encode()
    path = tmp_path / "a.stp"
    path.write_bytes(header + PICTURE[::-1, ::-1].astype("<f8").tobytes())
    found = images.read(path)
    check(found)
    assert found.notes == ()
    unclear = header.replace(b"1,2 um", b"1,200 nm").replace(b"0,8 um", b"800 nm")
    path.write_bytes(unclear.replace(amplitude.encode(), b"78") + PICTURE.astype("<f8").tobytes())
    with pytest.raises(ReadError, match="the comma of '1,200 nm' may be a decimal one, or between thousands"):
        images.read(path)


def test_a_range_of_three_numbers_is_refused_in_words(tmp_path: Path) -> None:
    header = (b":NANONIS_VERSION:\n2\n:SCANIT_TYPE:\n FLOAT MSBFIRST\n:SCAN_PIXELS:\n 12 8\n"
              b":SCAN_RANGE:\n 1.2E-6 8E-7 5E-7\n"
              b":SCAN_DIR:\ndown\n:DATA_INFO:\n\tChannel\tName\tUnit\tDirection\tCalibration\tOffset\n"
              b"\t14\tZ\tm\tforward\t1\t0\n\n:SCANIT_END:\n\n\n") + b"\x1a\x04"  # fmt: skip
    (tmp_path / "a.sxm").write_bytes(header + (PICTURE * 1e-9).astype(">f4").tobytes())
    with pytest.raises(ReadError, match=re.escape("SCAN_RANGE is '1.2E-6 8E-7 5E-7', expected two lengths [m]")):
        images.read(tmp_path / "a.sxm")


@pytest.mark.parametrize(("at", "form", "value", "message"), [
    (18, "h", 3, "an object of the type 3, expected 2, a surface"),
    (290, "h", 4, "the inversion 4, expected 0 .. 3"),
    (128, "f", 0.0, "a spacing of heights of 0, expected a positive number"),
    (164, "5s", b"Phase", "is named 'Phase', which is no height"),
])  # fmt: skip
def test_what_is_no_surface_of_digital_surf(tmp_path: Path, at: int, form: str, value: object, message: str) -> None:
    path = surf_image.write(np.random.default_rng(1), tmp_path, plain=True).path
    content = bytearray(path.read_bytes())
    struct.pack_into(f"<{form}", content, at, value)
    path.write_bytes(bytes(content))
    with pytest.raises(ReadError, match=re.escape(message)):
        images.read(path)


def test_a_height_beyond_the_limits_of_digital_surf_is_told(tmp_path: Path) -> None:
    """A point that was not measured, though the header says that there is none, for one."""
    path = surf_image.write(np.random.default_rng(1), tmp_path, plain=True).path
    content = bytearray(path.read_bytes())
    (low,) = struct.unpack_from("<i", content, 100)
    struct.pack_into("<i", content, 512, low - 2)
    path.write_bytes(bytes(content))
    assert any("1 heights beyond its lowest and highest" in note for note in images.read(path).notes)


def test_a_row_with_a_comment_behind_it_is_a_row(tmp_path: Path) -> None:
    check(images.read(text(tmp_path / "a.txt", GWY + rows(PICTURE)[:-1] + " # the end\n")))


@pytest.mark.parametrize("between", [" = ", ": ", "="])
@pytest.mark.parametrize("key", ["Bit2nm", "bit2nm"])
def test_the_scale_of_spip_counts_however_it_is_written(tmp_path: Path, between: str, key: str) -> None:
    header = SPIP.replace(" = ", between).replace("Bit2nm", key).replace("0.1", "1E-1")
    check(images.read(text(tmp_path / "a.txt", header + rows(PICTURE * 10, "%.2f"))), atol=1e-12)
    with pytest.raises(ReadError, match="'y-pixels' as 18, its table has 8"):
        images.read(text(tmp_path / "b.txt", header.replace(f"y-pixels{between}8", "y-pixels = 18") + rows(PICTURE)))
    told = images.read(text(tmp_path / "c.txt", header.replace("Start", "z-unit = nm\nStart") + rows(PICTURE)))
    assert any("the unit counts" in note for note in told.notes)


@pytest.mark.parametrize("values", [HEIGHTS > 0.0, np.zeros((8, 12), "m8[s]"), np.zeros((2, 8, 12))])
def test_arrays_that_are_no_pictures_are_refused_by_their_type(tmp_path: Path, values: np.ndarray) -> None:
    np.save(tmp_path / "a.npy", values)
    with pytest.raises(ReadError, match=r"an array of .*; images are real numbers in two dimensions"):
        images.read(tmp_path / "a.npy", z_unit="m", pixel_size=1e-7)
