# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch curve``: the four models over the gap, as a table and a picture."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from nanotouch.contact import MODELS
from nanotouch_app.main import main

image = pytest.importorskip("matplotlib.image")


def table(file: Path) -> dict[str, np.ndarray]:
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    values = np.array([[float(value) for value in line.split(",")] for line in lines[1:]])
    return dict(zip(lines[0].split(","), values.T, strict=True))


def test_default_scene(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["curve", "--out", str(tmp_path / "out")]) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"curve.csv", "curve.png"}
    curves = table(tmp_path / "out" / "curve.csv")
    assert list(curves) == ["gap [m]", *(f"{model} force [N]" for model in MODELS)]
    gap = curves["gap [m]"]
    assert gap[0] > 0 > gap[-1]
    assert (np.diff(gap) < 0).all()
    assert all(np.isfinite(values).all() for values in curves.values())
    # Hertz and JKR by their closed forms: pull-off under grips is 5/6 of 1.5 pi w R
    delta = np.maximum(-gap, 0.0)
    modulus = 135e9 / (2 * (1 - 0.35**2))
    np.testing.assert_allclose(curves["hertz force [N]"], 4 / 3 * modulus * math.sqrt(20e-9) * delta**1.5, rtol=1e-9)
    assert -curves["jkr force [N]"].min() == pytest.approx(1.5 * math.pi * 0.144 * 20e-9, rel=1e-3)
    assert curves["dmt force [N]"].min() == pytest.approx(-2 * math.pi * 0.144 * 20e-9, rel=0.02)
    assert f"DMT             pull-off {2 * math.pi * 0.144 * 20:.3f} nN" in said.out
    assert image.imread(tmp_path / "out" / "curve.png")[..., :3].std() > 0.02


@pytest.mark.parametrize(
    "scene",
    [
        "[medium]\nrelative_humidity = 0\n[adhesion]\nwork_of_adhesion_mJ_per_m2 = 0\nhamaker_constant_zJ = 0\n",
        "[medium]\nrelative_humidity = 0\n[sample]\nyoungs_modulus_MPa = 0.6\npoisson_ratio = 0.5\n",
        "[tip]\nradius_um = 10\n",
    ],
    ids=["no adhesion", "rubber", "colloid"],
)
def test_any_scene(scene: str, tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(scene)
    assert main(["curve", "--scene", str(file), "--out", str(tmp_path)]) == 0
    curves = table(tmp_path / "curve.csv")
    assert curves["hertz force [N]"].max() > 0.0
    assert all(np.isfinite(values).all() for values in curves.values())
