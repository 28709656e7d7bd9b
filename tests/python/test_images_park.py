# SPDX-License-Identifier: BSD-3-Clause
"""Park Systems' TIFF, made here by the published layout; SurfaceTopography is the other reader."""

from __future__ import annotations

import struct
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
import synthetic
from nanotouch.errors import ReadError

NY, NX, SIDE = 24, 32, (1.5, 2.0)  # µm
GAIN, SCALE, OFFSET = -0.02, 0.5, 3.0


def park(path: Path, stored: np.ndarray, version: int, unit: str = "nm", scale: float = SCALE) -> Path:
    """A file of one page; `stored` has the lower line first."""

    def text(words: str, count: int) -> bytes:
        return words.encode("utf-16-le").ljust(2 * count, b"\0")

    ny, nx = stored.shape
    header = struct.pack("<I", 0) + text("Z Height", 32) + text("Contact", 8)
    header += struct.pack("<d2I2IdIdIII", 0.0, 0, 0, nx, ny, 0.0, 0, 0.1, 1, 0, 0)
    header += struct.pack("<6d", SIDE[1], SIDE[0], 0.0, 0.0, 1.0, 0.1) + text("V", 8)
    header += struct.pack("<5d", 0.0, 0.0, GAIN, scale, OFFSET) + text(unit, 8) + struct.pack("<3i3I", 0, 0, 0, 0, 0, 1)
    if version == 2:
        kind = {"<i2": 0, "<i4": 1, "<f4": 2}[stored.dtype.newbyteorder("<").str]
        header += struct.pack("<2d", 1.0, 1.0) + text("", 24) + struct.pack("<2I2d", kind, 0, 0.0, 0.0) + text("", 20)
    data = stored.tobytes()
    place = 8 + 2 + 12 * 13 + 4
    rows = [(256, 4, 1, nx), (257, 4, 1, ny), (258, 3, 1, 8), (259, 3, 1, 1), (262, 3, 1, 1), (273, 4, 1, place),
            (277, 3, 1, 1), (278, 4, 1, ny), (279, 4, 1, nx * ny), (50432, 4, 1, 0x0E031301),
            (50433, 4, 1, 0x1000000 + version), (50434, 1, len(data), place + nx * ny),
            (50435, 7, len(header), place + nx * ny + len(data))]  # fmt: skip
    directory = struct.pack("<H", len(rows)) + b"".join(struct.pack("<2H2I", *row) for row in rows) + bytes(4)
    path.write_bytes(b"II*\0" + struct.pack("<I", 8) + directory + bytes(nx * ny) + data + header)
    return path


@pytest.mark.parametrize(("version", "dtype"), [(1, "<i2"), (2, "<i2"), (2, "<i4"), (2, "<f4")])
def test_heights_size_and_orientation(tmp_path: Path, version: int, dtype: str) -> None:
    stored = np.round(1e11 * synthetic.asymmetric(NY, NX)).astype(dtype)
    file = park(tmp_path / "a.tiff", stored, version)
    found = nt.images.read(file)
    assert found.source == "nanotouch/park"
    assert found.size == pytest.approx((1e-6 * SIDE[0], 1e-6 * SIDE[1]))
    assert found.heights == pytest.approx(1e-9 * GAIN * (SCALE * stored.astype(float) + OFFSET), rel=1e-14)
    (channel,) = nt.images.channels(file)
    assert (channel.name, channel.shape, channel.unit, channel.default) == ("Z Height", (NY, NX), "nm", True)


def test_another_reader_agrees(tmp_path: Path) -> None:
    pytest.importorskip("SurfaceTopography")
    from nanotouch.images import surfacetopography

    file = park(tmp_path / "a.tiff", np.round(1e11 * synthetic.asymmetric(NY, NX)).astype("<i4"), 2)
    theirs, ours = surfacetopography.read(file, None), nt.images.read(file)
    assert ours.heights == pytest.approx(1e-6 * theirs.values, rel=1e-12)
    assert ours.pixel_size == pytest.approx(theirs.pixel_size)


def test_a_scale_of_0_is_1_and_no_unit_is_the_micrometre(tmp_path: Path) -> None:
    stored = np.round(1e9 * synthetic.asymmetric(NY, NX)).astype("<f4")
    found = nt.images.read(park(tmp_path / "a.tiff", stored, 2, unit="", scale=0.0))
    assert found.heights == pytest.approx(1e-6 * GAIN * (stored + OFFSET), rel=1e-6)


def test_what_is_cut_or_no_length_is_refused(tmp_path: Path) -> None:
    stored = np.round(1e11 * synthetic.asymmetric(NY, NX)).astype("<i4")
    with pytest.raises(ReadError, match="'V'"):
        nt.images.read(park(tmp_path / "v.tiff", stored, 2, unit="V"), "Z Height")
    whole = park(tmp_path / "a.tiff", stored, 2).read_bytes()
    for length in (len(whole) - 560, len(whole) - 900, 60, 9):
        (tmp_path / "cut.tiff").write_bytes(whole[:length])
        with pytest.raises(ReadError):
            nt.images.read(tmp_path / "cut.tiff")


def test_real_file() -> None:
    path = synthetic.DATA / "images/example_ps.tiff"
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    found = nt.images.read(path, untrusted=True)
    assert found.shape == (512, 512)
    assert found.size == pytest.approx((1e-6, 1e-6))
    assert found.height_range == pytest.approx(36.69e-9, rel=1e-3)  # by SurfaceTopography
