# SPDX-License-Identifier: BSD-3-Clause
"""Masks by height, by a picture, by grain; what they leave out of levelling and roughness."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import synthetic

cv2 = pytest.importorskip("cv2")

from nanotouch import images  # noqa: E402
from nanotouch.errors import InvalidValue, ReadError  # noqa: E402
from nanotouch_app.main import main  # noqa: E402

NM = 1e-9


def dots() -> tuple[images.Topography, np.ndarray]:
    """Six caps of 10 nm on a flat of 0.1 nm rms, and where they are."""
    rng = np.random.default_rng(4)
    y, x = np.indices((96, 128))
    cap = np.zeros((96, 128))
    for cy, cx in ((20, 20), (20, 60), (20, 100), (70, 30), (70, 70), (70, 110)):
        cap = np.maximum(cap, 1 - ((y - cy) ** 2 + (x - cx) ** 2) / 100.0)
    heights = 10 * NM * np.sqrt(np.maximum(cap, 0.0)) + 0.1 * NM * rng.standard_normal(cap.shape)
    return images.Topography(heights, (1e-8, 1e-8)), cap > 0.02


def test_by_height() -> None:
    image, where = dots()
    mask = images.mask_above(image, 1 * NM)
    assert (mask ^ where).mean() < 0.01
    assert images.roughness(image, mask).rms == pytest.approx(0.1 * NM, rel=0.1)
    assert images.roughness(image).rms > 1 * NM
    assert (images.mask_above(image)[where]).mean() > 0.95  # by itself: three standard deviations
    pits = images.Topography(-image.heights, image.pixel_size)
    np.testing.assert_array_equal(images.mask_above(pits, 1 * NM, below=True), mask)
    for wrong in (0.0, -1e-9, float("nan")):
        with pytest.raises(InvalidValue, match="height"):
            images.mask_above(image, wrong)


def test_by_a_picture_as_the_image_is_shown(tmp_path: Path) -> None:
    image, where = dots()
    drawn = np.where(where, 255, 0).astype(np.uint8)
    drawn[:10, :10] = 255  # the lower left corner of the image
    assert cv2.imwrite(str(tmp_path / "mask.png"), drawn[::-1])  # row 0 of a picture is its top
    np.testing.assert_array_equal(images.mask_image(tmp_path / "mask.png", image), drawn > 0)
    cv2.imwrite(str(tmp_path / "small.png"), drawn[:50])
    with pytest.raises(InvalidValue, match="128 x 50 pixels, expected those of the image, 128 x 96"):
        images.mask_image(tmp_path / "small.png", image)
    (tmp_path / "text.png").write_text("no picture")
    with pytest.raises(ReadError, match="not a picture"):
        images.mask_image(tmp_path / "text.png", image)


def test_by_grain() -> None:
    image, where = dots()
    table = images.grains(image)
    assert len(table) == 6
    assert (images.mask_grains(table) ^ where).mean() < 0.01
    one = images.mask_grains(table, [2])
    assert one.sum() == table.pixels[1]
    with pytest.raises(InvalidValue, match=r"particle 7: expected 1 \.\. 6"):
        images.mask_grains(table, [7])


@pytest.mark.parametrize("what", ["1nm", "grains", "picture"])
@pytest.mark.usefixtures("undrawn")
def test_the_command_leaves_out_what_is_masked(what: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    image, where = dots()
    path = synthetic.write_gwy(tmp_path / "dots.gwy", image.heights, image.size)
    if what == "picture":
        what = str(tmp_path / "mask.png")
        cv2.imwrite(what, np.where(where, 255, 0).astype(np.uint8)[::-1])
    assert main(["image", str(path), "--mask", what, "--out", str(tmp_path / "out")]) == 0
    facts = json.loads((tmp_path / "out" / "image.json").read_text())
    assert facts["masked_share"] == pytest.approx(where.mean(), abs=0.02)
    assert facts["roughness"]["Sq_m"] == pytest.approx(0.1 * NM, rel=0.3)
    assert "masked: " in capsys.readouterr().out
