# SPDX-License-Identifier: BSD-3-Clause
"""Nanonis, JPK movies, TopoStats, Gwyddion Simple Field, NT-MDT's arrays, Asylum's heights of other names.

Every file is made here from the description of its format, with an asymmetric picture.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import synthetic

h5py = pytest.importorskip("h5py")
pytest.importorskip("SurfaceTopography")

from nanotouch import images  # noqa: E402
from nanotouch.errors import ReadError  # noqa: E402

HEIGHTS = synthetic.asymmetric()
NY, NX = HEIGHTS.shape
SIDE = (3e-6, 4e-6)
ROUNDING = 2.0**-22  # of single precision


def write_sxm(
    path: Path, *, direction: str = "down", end: bytes = b"\n\n\x1a\x04", order: str = ">f4", name: str = "Z"
) -> Path:
    rows = HEIGHTS[::-1] if direction.lower() == "down" else HEIGHTS
    current = 1e-9 * np.arange(NX) * np.ones((NY, 1))
    pictures = [rows, (rows + 1e-9)[:, ::-1], current, current[:, ::-1]]
    first = "MSB" if order == ">f4" else "LSB"
    header = [
        ":NANONIS_VERSION:", "2", ":SCANIT_TYPE:", f"              FLOAT            {first}FIRST",
        ":REC_DATE:", " 16.12.2015",
        ":SCAN_PIXELS:", f"       {NX}       {NY}", ":SCAN_RANGE:", f"           {SIDE[1]:E}           {SIDE[0]:E}",
        ":SCAN_DIR:", direction, ":Current>Gain:", "LN 10^9", ":DATA_INFO:",
        "\tChannel\tName\tUnit\tDirection\tCalibration\tOffset", f"\t14\t{name}\tm\tboth\t-8.71E-10\t0.000E+0",
        "\t0\tCurrent\tA\tboth\t-1.000E-10\t-8.014E-13", "", ":SCANIT_END:",
    ]  # fmt: skip
    data = b"".join(np.ascontiguousarray(p, order).tobytes() for p in pictures)
    path.write_bytes("\n".join(header).encode("latin-1") + end + data)
    return path


def write_movie(path: Path, frames: int = 3) -> Path:
    with h5py.File(path, "w") as file:
        file.attrs["file-format-info"] = np.bytes_("JPK SCAN")
        measurement = file.create_group("Measurement_000")
        grid = {"ilength": NX, "jlength": NY, "ulength": SIDE[1], "vlength": SIDE[0]}
        for key, value in grid.items():
            measurement.attrs[f"position-pattern.grid.{key}"] = value
        for number, (name, fancy, key, retrace) in enumerate(
            [("height", "Height", "Height", True), ("measuredHeight", "Height (measured)", "MeasuredHeight", False),
             ("phase", "Lock-In Phase", "Phase", False)]
        ):  # fmt: skip
            channel = measurement.create_group(f"Channel_{number:03}")
            channel.attrs["channel.name"] = np.bytes_(name)
            channel.attrs["channel.fancy-name"] = np.bytes_(fancy)
            channel.attrs["retrace"] = np.bytes_("true" if retrace else "false")
            channel.attrs["net-encoder.scaling.multiplier"] = -1e-13
            channel.attrs["net-encoder.scaling.offset"] = 5e-8
            channel.attrs["net-encoder.scaling.unit.unit"] = np.bytes_("deg" if name == "phase" else "m")
            stack = np.stack([(HEIGHTS + n * 1e-9).ravel() for n in range(frames)], axis=1)
            channel[key] = np.round((stack - 5e-8) / -1e-13).astype("i4")
            channel["thumbnail"] = np.zeros((NX * NY, 1), "i4")
    return path


def write_topostats(path: Path) -> Path:
    with h5py.File(path, "w") as file:
        file["image"] = HEIGHTS[::-1] * 1e9
        file["image_original"] = HEIGHTS[::-1] * 1e9 + 5.0
        file["pixel_to_nm_scaling"] = 125.0
        file["topostats_file_version"] = "0.2"
        file.create_group("grain_masks")["above"] = np.zeros((NY, NX), bool)
    return path


def write_gsf(path: Path) -> Path:
    header = f"Gwyddion Simple Field 1.0\nXRes = {NX}\nYRes = {NY}\nXReal = {SIDE[1] * 1e6}\nYReal = {SIDE[0] * 1e6}\n"
    header += "XYUnits = um\nZUnits = m\nTitle = Height\n"
    raw = header.encode()
    path.write_bytes(raw + b"\0" * (4 - len(raw) % 4) + HEIGHTS[::-1].astype("<f4").tobytes())
    return path


def write_mdt(path: Path) -> Path:
    def axis(name: str, unit: str, scale: float, count: int, kind: int) -> bytes:
        texts = name.encode() + unit.encode()
        fixed = struct.pack("<3I", len(name), 0, len(unit)) + struct.pack("<QdQ", 1, 0.0, 0)
        fixed += struct.pack("<2d2QiI", 0.0, scale, 0, count - 1, kind, 0)
        fixed = struct.pack("<I", len(fixed) + 4) + fixed + b"\0" * 4
        return struct.pack("<I", 4 + len(fixed) + len(texts)) + fixed + texts

    def frame(at: int, title: str, unit: str, values: np.ndarray) -> bytes:
        scale = 1e-4
        axes = [axis("x", "um", 0.125, NX, -4), axis("y", "um", 0.125, NY, -4), axis("z", unit, scale, 1, -8)]
        fixed = struct.pack("<Q5I", NX * NY, 8, 2, 1, 0, 0) + b"\0" * 5
        variables = struct.pack("<2I", 0, len(fixed)) + fixed + b"".join(axes)
        extra, data = b"\7" * 11, np.round(values / scale).astype("<i8").tobytes()
        head = 76
        sizes = [len(title), 0, 0, len(extra), 0, len(variables), 0, len(data)]
        body = title.encode() + extra + variables
        sizes[6] = at + 22 + head + len(body)
        block = struct.pack("<2I", head, head + len(body)) + b"\0" * 36 + struct.pack("<8I", *sizes) + body + data
        return struct.pack("<IH16x", 22 + len(block), 106) + block

    text = struct.pack("<IH16x", 22 + 5, 3) + b"hello"
    frames = [text]
    for title, unit, values in (("Height", "nm", HEIGHTS * 1e9), ("Current", "nA", HEIGHTS * 1e9)):
        frames.append(frame(33 + sum(map(len, frames)), title, unit, values))
    header = b"\x01\xb0\x93\xff" + struct.pack("<I4xH19x", sum(map(len, frames)), len(frames) - 1)
    path.write_bytes(header + b"".join(frames))
    return path


MAPS = {"MapAdhesion": HEIGHTS, "MapHeight": HEIGHTS}
FILES = {
    "sxm": (lambda folder: write_sxm(folder / "a.sxm"), "Z"),
    "movie": (lambda folder: write_movie(folder / "a.h5-jpk"), "Height (measured) trace frame 1"),
    "topostats": (lambda folder: write_topostats(folder / "a.topostats"), "image"),
    "gsf": (lambda folder: write_gsf(folder / "a.gsf"), "Height"),
    "mdt": (lambda folder: write_mdt(folder / "a.mdt"), "Height"),
    "ibw": (lambda folder: synthetic.write_ibw_image(folder / "a.ibw", MAPS, 1.25e-7), "MapHeight"),
}  # fmt: skip


@pytest.mark.parametrize("name", FILES)
def test_heights_are_read_in_metres_the_right_way_up(tmp_path: Path, name: str) -> None:
    make, channel = FILES[name]
    path = make(tmp_path)
    topography = images.read(path)
    assert topography.channel == channel
    np.testing.assert_allclose(topography.heights, HEIGHTS, rtol=0, atol=max(1e-13, 40e-9 * ROUNDING))
    assert topography.pixel_size == pytest.approx((1.25e-7, 1.25e-7), rel=1e-6)
    listed = images.channels(path)
    assert [one.name for one in listed if one.default] == [channel]
    assert all(one.shape == (NY, NX) for one in listed)
    guarded = images.read(path, untrusted=True)
    np.testing.assert_array_equal(guarded.heights, topography.heights)
    assert guarded.notes == topography.notes


@pytest.mark.parametrize("name", FILES)
def test_cut_files_are_refused_in_one_sentence(tmp_path: Path, name: str) -> None:
    path = FILES[name][0](tmp_path)
    content = path.read_bytes()
    for size in (40, len(content) // 5):
        path.write_bytes(content[:size])
        with pytest.raises(ReadError) as caught:
            images.read(path)
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize("direction", ["up", "down"])
def test_a_nanonis_scan_goes_up_or_down_and_back(tmp_path: Path, direction: str) -> None:
    path = write_sxm(tmp_path / "a.sxm", direction=direction)
    np.testing.assert_allclose(images.read(path).heights, HEIGHTS, atol=1e-14)
    back = images.read(path, "z backward")
    np.testing.assert_allclose(back.heights, HEIGHTS + 1e-9, atol=1e-14)
    with pytest.raises(ReadError, match="'ampere', not a length"):
        images.read(path, "Current")
    text = path.read_bytes()
    for old, new, message in (
        (b"MSBFIRST", b"PDPFIRST", "FLOAT PDPFIRST"),
        (b"both\t-8", b"four\t-8", "expected number, name, unit, direction"),
        (b":SCAN_DIR:", b":SCAN_XXX:", "lacks SCAN_DIR"),
        (b"\x1a\x04", b"\x1a\x05", "does not end"),
    ):
        path.write_bytes(text.replace(old, new, 1))
        with pytest.raises(ReadError, match=message):
            images.read(path)


@pytest.mark.parametrize(
    "spelling",
    [{"order": "<f4"}, {"direction": "DOWN"}, {"direction": "Up"}, {"name": "[P1]_Z"}, {"end": b"\r\n\r\n\x1a\x04"}],
)
def test_spellings_of_a_nanonis_scan(tmp_path: Path, spelling: dict[str, Any]) -> None:
    path = write_sxm(tmp_path / "a.sxm", **spelling)
    np.testing.assert_allclose(images.read(path).heights, HEIGHTS, atol=1e-14)


def test_a_cut_nanonis_scan_gives_the_pictures_it_holds(tmp_path: Path) -> None:
    path = write_sxm(tmp_path / "a.sxm")
    path.write_bytes(path.read_bytes()[: -NX * NY * 4 * 2 - 8])
    whole = images.read(path)
    np.testing.assert_allclose(whole.heights, HEIGHTS, atol=1e-14)
    assert "it is cut off after this picture" in whole.notes[0]
    with pytest.raises(ReadError, match="it is cut off"):
        images.read(path, "Z backward")


def test_spellings_of_a_movie(tmp_path: Path) -> None:
    """Two measurements of one name, attributes that are arrays or truth values, a channel without a scale."""
    path = write_movie(tmp_path / "a.h5-jpk")
    with h5py.File(path, "r+") as file:
        file.copy("Measurement_000", "Measurement_001")
        file.create_group("Measurement_002").create_group("Channel_000").attrs["channel.name"] = np.bytes_("height")
        first = file["Measurement_000"]
        first.attrs["position-pattern.grid.ilength"] = np.array([NX])
        first["Channel_000"].attrs["retrace"] = True
        first["Channel_001"].attrs["channel.fancy-name"] = np.array([b"Height (measured)"])
        for key in ("multiplier", "offset"):
            del first["Channel_002"].attrs[f"net-encoder.scaling.{key}"]
    names = [one.name for one in images.channels(path)]
    assert len(names) == len(set(names)) == 18
    assert "Height (measured) trace#2 frame 1" in names
    assert "Height retrace frame 1" in names
    for name in ("Height (measured) trace frame 1", "height (measured) trace#2 frame 1"):
        np.testing.assert_allclose(images.read(path, name).heights, HEIGHTS, atol=1e-13)


def test_lines_that_were_not_scanned_are_masked(tmp_path: Path) -> None:
    path = write_sxm(tmp_path / "a.sxm")
    content = bytearray(path.read_bytes())
    start = content.index(b"\x1a\x04") + 2
    content[start : start + 4 * NX * 6] = np.full(6 * NX, np.nan, ">f4").tobytes()  # the six upper lines
    path.write_bytes(bytes(content))
    topography = images.read(path)
    assert topography.mask[-6:].all()
    assert topography.masked_pixels == 6 * NX
    assert "25 % of the pixels are missing" in topography.notes[0]


def test_last_lines_of_zeros_were_not_scanned(tmp_path: Path) -> None:
    """So some versions leave them; all of a picture at 0 is a channel in which nothing was measured."""
    path = write_sxm(tmp_path / "a.sxm")
    content = bytearray(path.read_bytes())
    start = content.index(b"\x1a\x04") + 2
    content[start + 4 * NX * (NY - 6) : start + 4 * NX * NY] = bytes(4 * NX * 6)  # the six lower lines
    path.write_bytes(bytes(content))
    topography = images.read(path)
    assert topography.mask[:6].all()
    assert topography.masked_pixels == 6 * NX
    np.testing.assert_allclose(topography.heights[6:], HEIGHTS[6:], atol=1e-14)
    assert any("the last 6 lines of the scan hold 0 alone" in note for note in topography.notes)
    content[start : start + 4 * NX * NY] = bytes(4 * NX * NY)
    path.write_bytes(bytes(content))
    flat = images.read(path)
    assert flat.masked_pixels == 0
    assert "all heights are equal" in flat.notes[0]


def test_a_comment_of_a_nanonis_scan_may_hold_the_mark_of_its_end(tmp_path: Path) -> None:
    path = write_sxm(tmp_path / "a.sxm")
    path.write_bytes(path.read_bytes().replace(b":REC_DATE:", b":COMMENT:\nsee\n:SCANIT_END:\nthere\n:REC_DATE:", 1))
    np.testing.assert_allclose(images.read(path).heights, HEIGHTS, atol=1e-14)


def test_a_nanonis_scan_of_two_ranges_is_refused(tmp_path: Path) -> None:
    path = write_sxm(tmp_path / "a.sxm")
    path.write_bytes(path.read_bytes().replace(b":SCAN_DIR:", b":SCAN_RANGE:\n8E-6 6E-6\n:SCAN_DIR:", 1))
    with pytest.raises(ReadError, match=r"SCAN_RANGE as '4.*' and as '8E-6 6E-6'"):
        images.read(path)


@pytest.mark.parametrize(
    ("new", "message"),
    [
        (struct.pack("<d", -1e-6), "/0/data: xreal is -1e-06"),
        (struct.pack("<d", 1e-6) + b"xreal\0d" + struct.pack("<d", 2e-6), "'xreal' that differ: 1e-06 and 2e-06"),
    ],
    ids=["negative", "twice"],
)
def test_a_width_of_gwyddion_is_positive_and_stated_once(tmp_path: Path, new: bytes, message: str) -> None:
    path = tmp_path / "a.gwy"
    images.write(path, images.Topography(HEIGHTS, (SIDE[0] / NY, SIDE[1] / NX)))
    content = path.read_bytes()
    at = content.index(b"xreal\0d") + 7
    content = bytearray(content[:at] + new + content[at + 8 :])
    more, start = len(new) - 8, content.index(b"GwyDataField\0") + 13
    for where in (content.index(b"GwyContainer\0") + 13, start):  # lengths of the objects around it
        struct.pack_into("<I", content, where, struct.unpack_from("<I", content, where)[0] + more)
    path.write_bytes(content)
    with pytest.raises(ReadError, match=message):
        images.read(path)


@pytest.mark.parametrize(
    ("old", "new"),
    [(b".000000E", b",000000E"), (b":SCAN_", b":Scan_"), (b"\n", b"\r\n"), (b":REC_DATE:", b":REC_M\xfc\xb5:")],
    ids=["decimal commas", "small letters", "other ends of lines", "latin-1"],
)
def test_odd_headers_of_a_nanonis_scan(tmp_path: Path, old: bytes, new: bytes) -> None:
    path = write_sxm(tmp_path / "a.sxm")
    header, mark, data = path.read_bytes().partition(b"\x1a\x04")
    assert old in header
    path.write_bytes(header.replace(old, new) + mark + data)
    found = images.read(path)
    np.testing.assert_allclose(found.heights, HEIGHTS, atol=1e-14)
    assert found.size == pytest.approx(SIDE)


def test_every_frame_of_a_movie_is_a_channel(tmp_path: Path) -> None:
    path = write_movie(tmp_path / "a.h5-jpk")
    assert images.read(path).notes == ("frame 1 of 3; name another as the channel",)
    third = images.read(path, "height retrace frame 3")
    np.testing.assert_allclose(third.heights, HEIGHTS + 2e-9, atol=1e-13)
    assert third.notes == ()
    assert len(images.channels(path)) == 9


def test_an_asylum_height_without_a_unit_of_its_own_is_told(tmp_path: Path) -> None:
    topography = images.read(FILES["ibw"][0](tmp_path))
    assert topography.notes == ("no unit of 'MapHeight' is stated: taken as m, in which such files hold heights",)


REAL = {
    "di-1.di": ((512, 512), (500e-9, 500e-9)),
    "A151216.123306-02602.sxm": ((128, 128), (2e-9, 2e-9)),
    "sample_0.h5-jpk": ((128, 128), (150e-9, 150e-9)),
    "fdc_image_1.ibw": ((26, 26), (52e-6, 52e-6)),
    "frt-2.frt": (None, (60e-3, 30e-3)),
}


@pytest.mark.parametrize("name", REAL)
def test_real_files_that_were_refused(name: str) -> None:
    path = synthetic.DATA / "corpus" / "images" / name
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    topography = images.read(path)
    shape, size = REAL[name]
    assert shape is None or topography.shape == shape
    assert topography.size == pytest.approx(size, rel=1e-3)


def test_a_field_of_another_size_than_its_header_says_is_refused(tmp_path: Path) -> None:
    """Half the columns stated: it was read sheared."""
    path = write_gsf(tmp_path / "a.gsf")
    path.write_bytes(path.read_bytes().replace(f"XRes = {NX}".encode(), f"XRes = {NX // 2}".encode()))
    with pytest.raises(ReadError, match="bytes long, but its header states"):
        images.read(path)


@pytest.mark.parametrize("ending", ["gwy", "gsf"])
def test_a_current_is_no_height_in_angstrom_and_is_written_as_it_was(ending: str, tmp_path: Path) -> None:
    """Gwyddion writes ampere as A, which elsewhere is the angstrom: picoamperes came out as heights."""
    objects = pytest.importorskip("gwyfile.objects")
    frame = {"xreal": SIDE[1], "yreal": SIDE[0], "si_unit_xy": "m"}
    container = objects.GwyContainer()
    for number, (title, unit) in enumerate((("Topography", "A"), ("Height", "m"))):
        data = np.ascontiguousarray(HEIGHTS[::-1], dtype=np.float64)
        container[f"/{number}/data"] = objects.GwyDataField(data, si_unit_z=unit, **frame)
        container[f"/{number}/data/title"] = title
    container.tofile(str(tmp_path / "a.gwy"))
    listed = {channel.name: (channel.unit, channel.default) for channel in images.channels(tmp_path / "a.gwy")}
    assert listed == {"Height": ("m", True), "Topography": ("ampere", False)}
    with pytest.raises(ReadError, match="'ampere', not a length"):
        images.read(tmp_path / "a.gwy", "Topography")
    planes, _ = images.planes(tmp_path / "a.gwy")
    (current,) = (plane for plane in planes if plane.unit == "ampere")
    images.write_planes(tmp_path / f"b.{ending}", [current])
    (again,) = images.planes(tmp_path / f"b.{ending}")[0]
    assert again.unit == "ampere"
    np.testing.assert_allclose(again.values, current.values, rtol=1e-6)
