# SPDX-License-Identifier: BSD-3-Clause
"""A header that says something twice, and not the same: the file is refused."""

from __future__ import annotations

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
    ("kind", "old", "new", "message"),
    [
        ("nanoscope", rb"LSB\) ([0-9.]+)", None, "full scale .* but value per count"),
        ("nanoscope", rb"(?<=Data length: )1536", b"1538", "1538 bytes for 32 x 24 pixels"),
        ("nanoscope", rb"(?<=Scan Size: )4000", b"2000", "image width .* but scan size"),
        ("igor", rb"(?s)(?<=.{200})\x00", b"\x01", "check sum of its header is wrong"),
        ("igor", rb"FastScanSize: 3", b"FastScanSize: 9", "FastScanSize .* but pixels times"),
        ("nanosurf", rb"(?<=Image size=)4", b"8", "image size .* but of the channel"),
        ("nanosurf", rb"(?<=4\xb5m\r\nPoints=)32", b"33", "Points of the scan 33, but"),
        ("nanosurf", rb"\Z", b"xx", "bytes of data, but its channels take"),
        ("wsxm", rb"(?<=header size: )\d", b"9", "header size .* but its end"),
        ("wsxm", rb"(?<=Z Amplitude: )40", b"44", "Z amplitude .* but range of the heights"),
        ("wsxm", rb"\Z", b"xx", "bytes of data for 768 pixels"),
        ("picoview", rb"\Z", b"xx", "bytes of data for 1 x 768 pixels"),
    ],
)
def test_a_header_that_contradicts_itself_is_refused(
    tmp_path: Path, kind: str, old: bytes, new: bytes | None, message: str
) -> None:
    path = WRITERS[kind](tmp_path / "image")
    content = path.read_bytes()
    if new is None:  # the full scale, doubled
        damaged = re.sub(old, lambda m: m[0].replace(m[1], b"%.6f" % (2 * float(m[1]))), content, count=1)
    else:
        damaged = re.sub(old, new, content, count=1)
    assert damaged != content
    path.write_bytes(damaged)
    with pytest.raises(ReadError, match=message) as caught:
        images.read(path)
    assert caught.value.reader.startswith("SurfaceTopography/") or kind == "igor"
