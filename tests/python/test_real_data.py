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

import nanotouch as nt
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


def test_a_tilted_baseline_is_what_nanite_differs_by() -> None:
    """nanite 4.2.3 without its step against tilts, by plain least squares of its law; and with the tilt taken off."""
    least_squares = pytest.importorskip("scipy.optimize").least_squares
    name = "fmt-jpk-fd_single_tilted-baseline-drift-mitotic_2021-01-29.jpk-force"
    path = next(synthetic.DATA.rglob(name), None)
    if path is None:
        pytest.skip(f"real data not here: {name}")
    (curve,) = curves.read(path)
    approach, k = curve.approach, curve.spring_constant
    assert approach is not None
    assert approach.force is not None
    assert k is not None
    free = approach.z > approach.z.min() + 1.2e-6
    line = np.polyfit(approach.z[free], approach.force[free], 1)
    assert line[0] == pytest.approx(-51e-6, rel=0.02)

    def modulus(force: np.ndarray) -> tuple[float, float]:
        tip = approach.z + force / k
        offset = float(np.mean(force[: len(force) // 10]))

        def left(p: np.ndarray) -> np.ndarray:
            pressed = np.maximum(p[1] * 1e-6 - tip, 0.0)
            return 1e10 * (4e-3 / 3.0 / 0.75 * np.exp(p[0]) * pressed**1.5 + p[2] * 1e-9 - force + offset)

        start = [np.log(3e3), 1e6 * float(approach.z.min()) + 0.6, 0.0]
        found = least_squares(left, start)
        return float(np.exp(found.x[0])), 1e-10 * float(np.sqrt(2.0 * found.cost / len(force)))

    with_tilt, level = modulus(approach.force), modulus(approach.force - np.polyval(line, approach.z))
    assert with_tilt[0] == pytest.approx(3581, rel=0.01)  # nanite's
    assert with_tilt[1] > 7.0 * level[1]
    ours = nt.fit.fit_curve(curve, "hertz", radius=1e-6, poisson_ratio=0.5)
    assert level[0] == pytest.approx(ours.values["youngs_modulus"], rel=0.02)
    assert level[1] == pytest.approx(ours.report.noise, rel=0.1)
