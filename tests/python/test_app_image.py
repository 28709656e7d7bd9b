# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch image``: prints what each step took away, writes table, picture and processed image."""

from __future__ import annotations

import csv
import json
import warnings
from pathlib import Path

import numpy as np
import pytest
import synthetic

for module in ("SurfaceTopography", "cv2", "scipy", "matplotlib"):
    pytest.importorskip(module)

from nanotouch import images, surface  # noqa: E402
from nanotouch_app.main import main  # noqa: E402
from nanotouch_app.touching import touch  # noqa: E402

IMAGES = sorted((synthetic.DATA / "images").glob("*.*"))
SIDE = 10e-6


def results(folder: Path) -> dict[str, object]:
    answer: dict[str, object] = json.loads((folder / "image.json").read_text())
    return answer


def dotted(path: Path, noise: float = 0.1e-9) -> Path:
    """Quantum dots on a slope, as a file."""
    dots = surface.dots(500e-9, 256, count=12)
    rough = dots.heights + noise * np.random.default_rng(1).standard_normal(dots.shape)
    return synthetic.write_gwy(path, synthetic.tilted(rough, 500e-9, 0.02, -0.01), (500e-9, 500e-9))


def test_dots_from_file_to_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    assert main(["image", str(dotted(tmp_path / "dots.gwy")), "--grains", "--verbose", "--out", str(out)]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert {path.name for path in out.iterdir()} == {"image.json", "image.png", "image.gwy", "grains.csv"}
    assert "by SurfaceTopography/gwy, 256 x 256 pixels, 500 x 500 nm" in said.out
    assert "auto levelling: height range" in said.out
    assert "a tilt of 1.28 degrees" in said.out
    assert "chosen: plane+lines, " in said.out
    assert "runner-up: plane+rows, " in said.out
    table = said.out.split("  number")[1].splitlines()
    assert table[0].split() == ["height", "(nm)", "diameter", "(nm)", "volume", "(nm^3)", "x", "(nm)", "y", "(nm)"]
    assert all(len(line.removesuffix("  border").split()) == 6 for line in table[1:11])
    with open(out / "grains.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 12
    facts = results(out)
    assert facts["grains"]["count"] == 12  # type: ignore[index]
    assert facts["tilt"] == {"dz_dy": pytest.approx(0.02, rel=0.01), "dz_dx": pytest.approx(-0.01, rel=0.01)}
    again = images.read(out / "image.gwy")
    assert again.height_range == pytest.approx(surface.dots(500e-9, 256, count=12).height_range, abs=1e-9)


@pytest.mark.usefixtures("undrawn")
def test_every_step_and_its_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Lines along the fast axis under the plain alignment: the loss is printed, not raised; then the grating kept."""
    heights, _ = synthetic.grating(128, along_y=False)
    heights = heights + 0.3e-9 * np.random.default_rng(2).standard_normal(heights.shape)
    heights[70, 20:80] += 30e-9
    heights[100, 100] += 200e-9
    file = synthetic.write_gwy(tmp_path / "grating.gwy", heights, (SIDE, SIDE))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert main(["image", str(file), "--level", "medians", "--out", str(tmp_path / "a")]) == 0
    said = capsys.readouterr().out
    assert "warning: medians erased what looks like 7 steps along the fast axis, up to 480" in said
    assert results(tmp_path / "a")["warnings"]
    steps = ["--scars", "--despeckle", "--smooth", "50nm", "--tip", "100nm,17deg"]
    assert main(["image", str(file), *steps, "--out", str(tmp_path / "b")]) == 0
    said = capsys.readouterr().out
    assert "1 scar (60 pixels) repaired" in said
    assert "1 speckled pixel repaired" in said
    assert "smoothed by a Gaussian of 50 nm" in said
    assert "tip undone: up to" in said
    assert 460e-9 < images.read(tmp_path / "b" / "image.gwy").height_range < 490e-9
    assert main(["image", str(file), "--level", "none", "--tip", "blind", "--out", str(tmp_path / "c")]) == 0
    assert "tip from the image" in capsys.readouterr().out
    size = min(31, (min(images.read(file).shape) // 2 - 1) | 1)
    tip = images.estimate_tip(images.read(file), size).heights
    assert np.array_equal(np.loadtxt(tmp_path / "c" / "tip.csv", delimiter=","), tip)  # the same doubles


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--level", "rows+bumps"], "method: 'rows+bumps'"),
        (["--tip", "10"], "10"),
        (["--tip", "10nm,1rad,2"], "--tip 10nm,1rad,2"),
        (["--pits"], "--pits goes with --grains"),
        (["--grains", "much"], "much"),
    ],
)
def test_wrong_options_end_with_one_sentence(
    tmp_path: Path, options: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = dotted(tmp_path / "dots.gwy")
    assert main(["image", str(file), *options, "--out", str(tmp_path / "out")]) == 2
    said = capsys.readouterr().err
    assert message in said
    assert said.count("\n") == 1


@pytest.mark.skipif(not IMAGES, reason="needs ../shared/data/images")
@pytest.mark.parametrize("file", IMAGES, ids=lambda path: path.suffix)
def test_every_real_image_all_the_way(file: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Read, levelled, repaired, dilated, eroded, counted; what each must hold whatever the surface."""
    raw = images.read(file)
    out = tmp_path / "out"
    assert main(["image", str(file), "--scars", "--despeckle", "--grains", "--out", str(out)]) == 0
    assert "roughness" in capsys.readouterr().out
    clean = images.read(out / "image.gwy")
    assert clean.shape == raw.shape
    assert clean.size == pytest.approx(raw.size)
    # what is left of tilt and rows is no more than before, but for what the surface itself adds
    assert clean.height_range <= 1.05 * raw.height_range
    assert clean.masked_pixels <= 0.02 * clean.heights.size
    rough = images.roughness(clean)
    assert 0 < rough.arithmetic <= rough.rms < rough.peak_to_peak
    tip = images.Paraboloid(10e-9)
    dilated = images.dilate(clean, tip)
    assert (dilated.heights >= clean.heights).all()
    eroded, _ = images.erode(dilated, tip)
    assert (eroded.heights >= clean.heights - 1e-18).all()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        table = images.grains(clean)
    assert table.coverage <= 1.0
    assert (table.height >= table.mean_height).all()


@pytest.mark.skipif(not IMAGES, reason="needs ../shared/data/images")
@pytest.mark.parametrize("file", IMAGES, ids=lambda path: path.suffix)
def test_what_touch_makes_of_every_real_image(file: Path) -> None:
    """The surface that is touched after `prepare`: no rows erased, nothing invented beyond the image's heights."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        clean, (level_report, _) = images.prepare(images.read(file))
    plane = images.level(images.read(file), "plane")[0]
    rows = level_report.steps[1].removed_range
    assert rows <= 0.25 * plane.height_range
    assert np.abs((clean.heights - plane.heights)[~clean.mask]).max() <= 1.2 * rows + 1e-9
    assert touch.describe(clean).startswith(file.name)


def test_several_images_with_one_configuration(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A folder for each, a table of all; what is no image is a row; the command line goes before the file."""
    made, out, config = tmp_path / "day", tmp_path / "out", tmp_path / "day.toml"
    made.mkdir()
    dotted(made / "a.gwy")
    dotted(made / "b.gwy", noise=0.2e-9)
    (made / "notes.txt").write_text("a good day")
    config.write_text('level = "plane"\ngrains = "auto"\nspectrum = true\n')
    asked = ["image", str(made), "--config", str(config), "--grains", "2nm"]
    assert main([*asked, "--out", str(out)]) == 0
    assert "2 images of 3" in capsys.readouterr().out
    with (out / "images.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["status"] for row in rows] == ["ok", "ok", "failed"]
    assert [row["grains"] for row in rows[:2]] == ["12", "12"]
    for row in rows[:2]:
        facts = results(out / row["folder"])
        assert facts["removed"] == {"1_plane_m": pytest.approx(10e-9, rel=1.0)}
        assert facts["grains"]["threshold_m"] == 2e-9  # type: ignore[index]
        assert facts["parameters"]["Sq"]["value"] == float(row["Sq [m]"])  # type: ignore[index]
        assert (out / row["folder"] / "spectrum.png").stat().st_size > 10_000
    for wrong in ("levl = 'plane'", "scars = 'yes'", "level = 3"):
        config.write_text(wrong)
        assert main([*asked, "--out", str(tmp_path / "b")]) == 2
        assert "day.toml" in capsys.readouterr().err
    assert main(["image", str(made / "notes.txt"), str(made / "no.gwy")]) == 2
