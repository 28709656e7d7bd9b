# SPDX-License-Identifier: BSD-3-Clause
"""nanotouch.images.write: what is written opens in other readers with heights, size, unit, title, offset and mask."""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import synthetic

pytest.importorskip("SurfaceTopography")
pytest.importorskip("cv2")

from nanotouch import images
from nanotouch.errors import Error, InvalidValue, ReadError

PIXEL = (1.0e-7, 1.25e-7)
OFFSET = (3e-6, -2e-6)


def topography(holes: int = 0) -> images.Topography:
    heights = synthetic.asymmetric()
    mask = np.zeros(heights.shape, bool)
    mask.flat[5 : 5 + 40 * holes : 40] = True
    return images.Topography(heights, PIXEL, "scan.ibw", "HeightTrace", "SurfaceTopography/ibw", mask)


@pytest.mark.parametrize("ending", [".gwy", ".h5", ".hdf5"])
def test_what_is_written_reads_back(tmp_path: Path, ending: str) -> None:
    if ending == ".gwy":
        pytest.importorskip("gwyfile")
    original = topography(holes=3)
    path = images.write(tmp_path / f"out{ending}", original, offset=OFFSET)
    (found,) = images.channels(path)
    assert (found.name, found.shape, found.unit, found.default) == ("HeightTrace", (24, 32), "m", True)
    back = images.read(path)
    measured = ~original.mask
    np.testing.assert_array_equal(back.heights[measured], original.heights[measured])
    np.testing.assert_array_equal(back.mask, original.mask)
    assert back.pixel_size == pytest.approx(PIXEL, rel=1e-12)
    assert back.channel == "HeightTrace"


def test_gsf_keeps_the_mask_and_24_bits_of_a_height(tmp_path: Path) -> None:
    original = topography(holes=3)
    back = images.read(images.write(tmp_path / "out.gsf", original))
    np.testing.assert_array_equal(back.mask, original.mask)
    measured = ~original.mask
    np.testing.assert_allclose(back.heights[measured], original.heights[measured], rtol=2.0**-24)


def test_hdf5_keeps_filled_heights_as_they_are(tmp_path: Path) -> None:
    """However many: what was repaired before is not filled again."""
    original = topography()
    repaired = images.Topography(original.heights, PIXEL, mask=original.heights > 30e-9)
    back = images.read(images.write(tmp_path / "out.h5", repaired))
    np.testing.assert_array_equal(back.heights, repaired.heights)
    np.testing.assert_array_equal(back.mask, repaired.mask)
    assert back.masked_pixels > 0.05 * back.mask.size


def test_gwy_in_gwyfile_and_surfacetopography(tmp_path: Path) -> None:
    """Two independent readers of Gwyddion's format."""
    gwyfile = pytest.importorskip("gwyfile")
    path = images.write(tmp_path / "out.gwy", topography(holes=2), title="Höhe, geglättet", offset=OFFSET)
    container = gwyfile.load(str(path))
    field = container["/0/data"]
    assert container["/0/data/title"] == "Höhe, geglättet"
    assert (field["xres"], field["yres"]) == (32, 24)
    assert (field.xreal, field.yreal) == pytest.approx((32 * PIXEL[1], 24 * PIXEL[0]), rel=1e-14)
    # Gwyddion's y grows downwards: its corner is the upper left one
    assert (field.xoff, field.yoff) == pytest.approx((OFFSET[1], -(OFFSET[0] + 24 * PIXEL[0])), rel=1e-14)
    assert (field.si_unit_xy.unitstr, field.si_unit_z.unitstr) == ("m", "m")
    np.testing.assert_array_equal(field.data[::-1], synthetic.asymmetric())
    np.testing.assert_array_equal(container["/0/mask"].data[::-1] != 0, topography(holes=2).mask)

    io = pytest.importorskip("SurfaceTopography.IO")
    with io.open_topography(str(path)) as reader:
        assert reader.format() == "gwy"
        loaded = reader.topography()
        assert tuple(loaded.physical_sizes) == pytest.approx((32 * PIXEL[1], 24 * PIXEL[0]), rel=1e-14)
        assert loaded.unit == "m"
        values = np.ma.asarray(loaded.heights())
        shown = np.ma.filled(values, np.nan).T[::-1]
        measured = ~topography(holes=2).mask
        np.testing.assert_array_equal(shown[measured], synthetic.asymmetric()[measured])


def test_a_picture_of_no_known_place_is_at_the_origin(tmp_path: Path) -> None:
    gwyfile, h5py = pytest.importorskip("gwyfile"), pytest.importorskip("h5py")
    field = gwyfile.load(str(images.write(tmp_path / "out.gwy", topography())))["/0/data"]
    assert (field.xoff, field.yoff) == (0.0, 0.0)
    with h5py.File(images.write(tmp_path / "out.h5", topography())) as file:
        np.testing.assert_array_equal(file.attrs["offset"], 0.0)


def test_hdf5_in_h5py_and_surfacetopography(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = images.write(tmp_path / "out.h5", topography(holes=1), title="Height", offset=OFFSET)
    with h5py.File(path) as file:
        np.testing.assert_array_equal(file["height"][...][::-1], synthetic.asymmetric())
        assert file["height"].attrs["units"] == b"m"
        assert file["height"].fletcher32  # damage is noticed
        assert file["height"].dims[0][0].name == "/y"
        y, x = file["y"][...], file["x"][...]
        assert (y[-1], x[0]) == pytest.approx((OFFSET[0] + 0.5 * PIXEL[0], OFFSET[1] + 0.5 * PIXEL[1]), rel=1e-12)
        np.testing.assert_array_equal(file["mask"][...][::-1] != 0, topography(holes=1).mask)
        np.testing.assert_allclose(file.attrs["offset"], OFFSET)
    io = pytest.importorskip("SurfaceTopography.IO")
    with io.open_topography(str(path)) as reader:  # takes [x, y]; a picture's rows are its x
        names = [channel.name for channel in reader.channels]
        assert "height" in names
        loaded = reader.topography(channel_index=names.index("height"), physical_sizes=(1.0, 1.0))
        np.testing.assert_array_equal(loaded.heights()[::-1], synthetic.asymmetric())


def test_a_damaged_hdf5_image_is_refused(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = images.write(tmp_path / "out.h5", topography())
    whole = path.read_bytes()
    with h5py.File(path) as file:
        place = file["height"].id.get_chunk_info(0).byte_offset
    path.write_bytes(whole[: place + 20] + bytes([whole[place + 20] ^ 4]) + whole[place + 21 :])
    with pytest.raises(ReadError, match="nanotouch/hdf5"):
        images.read(path)
    path.write_bytes(whole)
    with h5py.File(path, "a") as file:
        file.attrs["pixel_size"] = (1e-7, 1e-7)
    with pytest.raises(ReadError, match="contradicts itself: x does not go in steps of 1e-07 m"):
        images.read(path)


def test_refusals(tmp_path: Path) -> None:
    with pytest.raises(InvalidValue, match=r"written as \.gwy, \.gsf, \.h5, \.hdf5"):
        images.write(tmp_path / "out.spm", topography())
    with pytest.raises(InvalidValue, match="offset"):
        images.write(tmp_path / "out.h5", topography(), offset=(0.0, 1.0, 2.0))  # type: ignore[arg-type]
    with pytest.raises(InvalidValue, match="offset"):
        images.write(tmp_path / "out.h5", topography(), offset=(0.0, float("nan")))
    with pytest.raises(InvalidValue, match="title"):
        images.write(tmp_path / "out.h5", topography(), title="a\0b")
    with pytest.raises(Error, match="cannot write"):
        images.write(tmp_path / "no folder" / "out.h5", topography())
    assert list(tmp_path.iterdir()) == []  # nothing half written is left


def text_at(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(0, at)
    return data[at:end].decode("utf-8"), end + 1


def object_at(data: bytes, at: int) -> tuple[str, dict[str, tuple[str, Any]], int]:
    """An object as "Format of Gwyddion files" of Gwyddion's user guide describes it: its name, its size, its
    components with type and value; and where it ends."""
    name, at = text_at(data, at)
    (size,) = struct.unpack_from("<I", data, at)
    at, end = at + 4, at + 4 + size
    parts: dict[str, tuple[str, Any]] = {}
    while at < end:
        key, at = text_at(data, at)
        kind, at = chr(data[at]), at + 1
        if kind == "s":
            value, at = text_at(data, at)
        elif kind == "o":
            inner, content, at = object_at(data, at)
            value = (inner, content)
        elif kind == "D":
            (count,) = struct.unpack_from("<I", data, at)
            value, at = np.frombuffer(data, "<f8", count, at + 4), at + 4 + 8 * count
        else:
            form = {"b": "<B", "i": "<i", "d": "<d"}[kind]
            (value,) = struct.unpack_from(form, data, at)
            at += struct.calcsize(form)
        assert key not in parts
        parts[key] = (kind, value)
    assert at == end
    return name, parts, at


def test_gwy_byte_by_byte(tmp_path: Path) -> None:
    """Read by the description of the format alone: every object, its components, their types, nothing left over."""
    pytest.importorskip("gwyfile")
    original = topography(holes=3)
    data = images.write(tmp_path / "out.gwy", original, title="Höhe", offset=OFFSET).read_bytes()
    assert data[:4] == b"GWYP"
    name, container, end = object_at(data, 4)
    assert (name, end) == ("GwyContainer", len(data))
    assert {key: kind for key, (kind, _) in container.items()} == {
        "/0/data": "o", "/0/data/title": "s", "/0/data/visible": "b", "/0/mask": "o", "/0/meta": "o"}  # fmt: skip
    assert (container["/0/data/title"][1], container["/0/data/visible"][1]) == ("Höhe", 1)
    for key, unit, values in (("/0/data", "m", original.heights), ("/0/mask", "", original.mask)):
        inner, field = container[key][1]
        assert inner == "GwyDataField"
        assert {part: kind for part, (kind, _) in field.items()} == {
            "xres": "i", "yres": "i", "xreal": "d", "yreal": "d", "xoff": "d", "yoff": "d", "si_unit_xy": "o",
            "si_unit_z": "o", "data": "D"}  # fmt: skip
        assert field["si_unit_xy"][1] == ("GwySIUnit", {"unitstr": ("s", "m")})
        assert field["si_unit_z"][1] == ("GwySIUnit", {"unitstr": ("s", unit)})
        assert (field["yres"][1], field["xres"][1]) == values.shape
        assert (field["yreal"][1], field["xreal"][1]) == pytest.approx(original.size)
        assert (field["xoff"][1], field["yoff"][1]) == pytest.approx((OFFSET[1], -(OFFSET[0] + original.size[0])))
        np.testing.assert_array_equal(field["data"][1].reshape(values.shape)[::-1], values)
    inner, meta = container["/0/meta"][1]
    assert inner == "GwyContainer"
    assert meta == {"Name": ("s", "scan.ibw"), "Read by": ("s", "SurfaceTopography/ibw")}
