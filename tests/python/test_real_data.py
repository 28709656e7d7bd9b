# SPDX-License-Identifier: BSD-3-Clause
"""Every real image and every real curve that is at hand is read, with and without the guard; what is known of them."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
import synthetic

pytest.importorskip("SurfaceTopography")
pytest.importorskip("afmformats")

from nanotouch import curves, images

if not synthetic.DATA.is_dir():
    pytest.skip(f"real data not here: {synthetic.DATA}", allow_module_level=True)

IMAGES = sorted(path for path in (synthetic.DATA / "images").glob("*") if path.is_file())
CURVES = sorted(path for path in (synthetic.DATA / "curves").rglob("*") if path.is_file() and path.suffix != ".txt")


def _name(path: Path) -> str:
    return path.name


@pytest.mark.parametrize("path", IMAGES, ids=_name)
def test_every_image(path: Path) -> None:
    topography = images.read(path)
    assert 1e-9 < topography.height_range < 2e-6
    assert 0.5e-6 < max(topography.size) < 25e-6
    assert [channel.name for channel in images.channels(path) if channel.default] == [topography.channel]
    if sys.platform == "linux":
        guarded = images.read(path, untrusted=True)
        np.testing.assert_array_equal(guarded.heights, topography.heights)
        assert guarded.pixel_size == topography.pixel_size


@pytest.mark.parametrize("path", IMAGES, ids=_name)
def test_every_image_survives_being_written(path: Path, tmp_path: Path) -> None:
    pytest.importorskip("gwyfile")
    original = images.read(path)
    for ending in (".gwy", ".h5"):
        back = images.read(images.write(tmp_path / f"out{ending}", original))
        np.testing.assert_array_equal(back.heights, original.heights)
        assert back.pixel_size == pytest.approx(original.pixel_size, rel=1e-12)


@pytest.mark.parametrize("path", CURVES, ids=_name)
def test_every_curve(path: Path) -> None:
    found = curves.read(path)
    for curve in found:
        assert curve.approach is not None
        assert curve.retract is not None
        for segment in curve.segments:
            assert segment.force is not None
            assert segment.deflection is not None
            np.testing.assert_allclose(segment.force, curve.spring_constant * segment.deflection, rtol=1e-12)
    if sys.platform == "linux":
        guarded = curves.read(path, untrusted=True)
        assert [dict(curve.meta) for curve in guarded] == [dict(curve.meta) for curve in found]
        for one, other in zip(guarded, found, strict=True):
            for a, b in zip(one.segments, other.segments, strict=True):
                for key in ("time", "z", "force", "deflection"):
                    np.testing.assert_array_equal(getattr(a, key), getattr(b, key))


def test_uncalibrated_files_are_flagged() -> None:
    flagged = {path.name for path in CURVES if "placeholders" in curves.read(path)[0].meta}
    assert flagged == {"Test.000", "Test.001", "Test.003"}
