# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch info``: what a file holds, whatever its name says."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
import pytest
import synthetic

for module in ("SurfaceTopography", "cv2", "afmformats"):
    pytest.importorskip(module)

from nanotouch.errors import ReadError  # noqa: E402
from nanotouch_app.data import info  # noqa: E402
from nanotouch_app.main import main  # noqa: E402


def answer(file: Path, capsys: pytest.CaptureFixture[str]) -> str:
    parser = argparse.ArgumentParser()
    info.add_parser(parser.add_subparsers())
    args = parser.parse_args(["info", str(file)])
    assert args.run(args) == 0
    return capsys.readouterr().out


def test_as_data(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    heights = synthetic.asymmetric()
    path = synthetic.write_ibw_image(tmp_path / "image.ibw", {"PhaseTrace": heights, "HeightTrace": heights}, 1.25e-7)
    assert main(["info", str(path), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert [(row["name"], row["default"]) for row in facts["channels"]] == [
        ("PhaseTrace", False),
        ("HeightTrace", True),
    ]
    assert facts["channels"][1]["pixels"] == [32, 24]  # along x, along y
    assert facts["channels"][1]["size_m"] == pytest.approx([4e-6, 3e-6], rel=1e-6)  # 32-bit numbers in the file
    assert facts["heights_m"] == pytest.approx([0.0, 40e-9], rel=1e-6)


def test_a_scene_is_sent_to_its_command(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text("[tip]\nradius_nm = 20\n")
    with pytest.raises(ReadError, match="nanotouch plan"):
        info.describe(tmp_path / "scene.toml")


def test_an_image(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    heights = synthetic.asymmetric()
    path = synthetic.write_ibw_image(tmp_path / "image.ibw", {"PhaseTrace": heights, "HeightTrace": heights}, 1.25e-7)
    text = answer(path, capsys)
    assert "AFM image, 2 channels" in text
    assert "32 x 24 pixels, 4 x 3 µm, unit m  <- read by default" in text
    assert "heights 0 .. 40 nm, pixel 125 x 125 nm" in text


def test_an_image_that_lacks_its_scale_is_still_described(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = answer(synthetic.write_matrix(tmp_path / "bare.txt", synthetic.asymmetric(), None, unit=None), capsys)
    assert "size not stated, unit not stated" in text
    assert "cannot be touched as it is" in text


def test_a_curve_of_the_same_ending(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = answer(synthetic.write_ibw_curve(tmp_path / "curve.ibw", synthetic.known_curve(n=100)), capsys)
    assert "1 force curve" in text
    assert "spring constant: 0.8 N/m" in text
    assert "approach 100 points, height (measured) 0.8 -> 0.28 um" in text
    assert "retract 100 points" in text


def test_neither(tmp_path: Path) -> None:
    path = tmp_path / "letter.txt"
    path.write_text("Dear Sir, thank you for your scan of 10 um.\n")
    with pytest.raises(ReadError, match=r"as a force curve: .*; as an image: not an AFM image") as caught:
        info.describe(path)
    assert "\n" not in str(caught.value)
    with pytest.raises(ReadError, match=r"nothing\.gwy: no such file$"):
        info.describe(tmp_path / "nothing.gwy")


def test_a_long_map_is_cut_short(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    h5py = pytest.importorskip("h5py")
    z = np.concatenate([np.linspace(1e-6, 0, 50), np.linspace(0, 1e-6, 50)])
    path = tmp_path / "map.h5"
    with h5py.File(path, "w") as file:
        file.attrs.update({"software": "synthetic", "software version": "1"})
        for number in range(25):
            group = file.create_group(str(number))
            group.attrs["imaging mode"] = "force-distance"
            group["force"], group["height (measured)"] = np.where(z < 1e-7, 1e-9, 0.0), z
            group["segment"] = np.repeat([0, 1], 50).astype(np.uint8)
    text = answer(path, capsys)
    assert "25 force curves" in text
    assert "and 5 more" in text
