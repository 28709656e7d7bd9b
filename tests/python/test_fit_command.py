# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch fit``: on files with a known answer, and on measured ones where they are present."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from nanotouch_app.main import main
from synthetic import DATA, known_curve, write_ibw_curve, write_jpk

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("afmformats")
pytest.importorskip("matplotlib")

CURVES = DATA / "curves"


def test_leaves_numbers_and_a_picture(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The tip follows the base, so the curve is the cantilever's: w from the pull-off, no modulus."""
    curve = known_curve()
    file = write_ibw_curve(tmp_path / "curve.ibw", curve)
    assert main(["fit", str(file), "--model", "jkr", "--radius", "30nm", "--out", str(tmp_path / "out")]) == 0
    found = json.loads((tmp_path / "out" / "fit.json").read_text())
    assert found["pull_off_force_N"] == pytest.approx(curve.pull_off_force, rel=0.01)
    assert found["snap_in_force_N"] == pytest.approx(curve.snap_in_force, rel=0.03)
    assert found["values"]["work_of_adhesion"] == pytest.approx(
        curve.pull_off_force / (1.5 * 3.14159 * 30e-9), rel=0.02
    )
    assert found["tip_radius_m"] == 30e-9
    assert not found["identifiable"]["effective_modulus"]
    assert (tmp_path / "out" / "fit.png").stat().st_size > 20_000
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["fit.json", "fit.png", "ruptures.csv"]
    assert "not determined" in capsys.readouterr().out


def test_a_window_and_a_baseline_are_those_of_the_fit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = str(write_ibw_curve(tmp_path / "curve.ibw", known_curve()))
    asked = ["fit", file, "--model", "hertz", "--radius", "30nm", "--out", str(tmp_path / "out"), "--overwrite"]
    points = []
    for more in ([], ["--window", "1nN,30nN", "--baseline", "line"]):
        assert main([*asked, *more]) == 0
        points.append(int(capsys.readouterr().out.split(" points,")[0].split()[-1]))
    assert 0 < points[1] < points[0]
    for more in (["--window", "3nN,1nN"], ["--window", "1nN"], ["--window", "1nN,3nN", "--stability"]):
        assert main([*asked, *more]) != 0
        assert "window" in capsys.readouterr().err


def test_scene_gives_tip_sample_and_adhesion(tmp_path: Path) -> None:
    file = write_ibw_curve(tmp_path / "curve.ibw", known_curve())
    scene = tmp_path / "scene.toml"
    scene.write_text("[tip]\nradius_nm = 12\n")
    assert main(["fit", str(file), "--scene", str(scene), "--out", str(tmp_path / "out")]) == 0
    found = json.loads((tmp_path / "out" / "fit.json").read_text())
    assert found["tip_radius_m"] == pytest.approx(12e-9)
    assert "youngs_modulus" in found["values"]
    assert not any(text.startswith("tip radius") for text in found["assumptions"])


def test_compares_laws_and_draws_stability(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write_ibw_curve(tmp_path / "curve.ibw", known_curve())
    out = tmp_path / "out"
    options = ["--model", "pyramid", "--half-angle", "25deg", "--known-to", "spring_constant=10", "--compare"]
    options += ["--known-to", "half_angle=1deg", "--verbose"]
    assert main(["fit", str(file), *options, "--stability", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    for part in (
        "by evidence:",
        "pyramid",
        "maugis",
        "spring constant to 10 %",
        "half angle to 1 deg",
        "stability.png",
    ):
        assert part in said
    assert (out / "stability.png").stat().st_size > 10_000
    found = json.loads((out / "fit.json").read_text())
    assert found["half_angle_rad"] == pytest.approx(0.43633, abs=1e-5)
    assert (
        found["sigma_calibration"]["effective_modulus"] is None or found["sigma_calibration"]["effective_modulus"] > 0
    )


@pytest.mark.parametrize(
    "arguments",
    [
        ["nothing.ibw"],
        ["{file}", "--radius", "20"],
        ["{file}", "--radius=-20nm"],
        ["{file}", "--index", "3"],
        ["{file}", "--spring-constant", "0N/m"],
        ["{file}", "--out", "{file}"],
    ],
)
def test_one_sentence_and_nothing_written(
    arguments: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = write_ibw_curve(tmp_path / "curve.ibw", known_curve(n=300))
    out = tmp_path / "out"
    given = [argument.replace("{file}", str(file)) for argument in arguments]
    assert main(["fit", *given, *([] if "--out" in given else ["--out", str(out)])]) == 2
    error = capsys.readouterr().err
    assert error.startswith("nanotouch fit: ")
    assert error.count("\n") == 1
    assert not out.exists() or not list(out.iterdir())


def test_uncalibrated_file_names_the_spring_constant(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    known = known_curve()
    segments = [("extend", known.approach_z, known.approach_force), ("retract", known.retract_z, known.retract_force)]
    file = write_jpk(tmp_path / "curve.jpk-force", segments, spring_constant=None)
    assert main(["fit", str(file), "--out", str(tmp_path / "out")]) == 2
    assert "spring constant" in capsys.readouterr().err


@pytest.mark.skipif(not CURVES.is_dir(), reason="the measured curves are not there")
def test_silicon_nitride_curve(tmp_path: Path) -> None:
    file = CURVES / "fmt-igor-fd_SiN_FD_plot.ibw"
    assert main(["fit", str(file), "--out", str(tmp_path)]) == 0
    found = json.loads((tmp_path / "fit.json").read_text())
    assert found["pull_off_force_N"] == pytest.approx(12.8e-9, abs=0.05e-9)
    assert found["snap_in_force_N"] == pytest.approx(3.0e-9, abs=0.05e-9)
    # the fit puts the true sensitivity at 1.7 times the assumed one, and its forces with it
    assumed = found["fitted_pull_off_force_N"] / found["values"]["sensitivity"]
    assert assumed == pytest.approx(12.8e-9, abs=3 * found["residual_rms_N"])
    assert not found["identifiable"]["effective_modulus"]  # a straight line at half the cantilever's slope
    assert any("tip radius" in text for text in found["assumptions"])


@pytest.mark.skipif(not CURVES.is_dir(), reason="the measured curves are not there")
@pytest.mark.parametrize("model", ["hertz", "dmt", "jkr", "maugis"])
def test_every_measured_curve_is_fitted(model: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """With the pictures of one model: all have the same."""
    if model != "maugis":
        request.getfixturevalue("undrawn")
    files = sorted(path for path in CURVES.iterdir() if path.is_file())
    assert files
    for file in files:
        assert main(["fit", str(file), "--model", model, "--out", str(tmp_path / file.name)]) == 0
        assert (tmp_path / file.name / "fit.png").stat().st_size > 20_000 or model != "maugis"
