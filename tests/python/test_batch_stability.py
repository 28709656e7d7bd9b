# SPDX-License-Identifier: BSD-3-Clause
"""E(delta) of many curves: each keeps its modulus at every depth, and the median is that of the moduli."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic import KnownCurve, write_ibw_curve

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("afmformats")
pytest.importorskip("matplotlib")

from nanotouch import batch

MODULI = (20e3, 30e3, 40e3)  # Pa
RADIUS, STIFFNESS, CONTACT, NOISE = 1e-6, 0.1, 1e-6, 5e-12


def soft(modulus: float, seed: int, points: int = 1500) -> KnownCurve:
    """Hertz: the base stands at contact - delta - F/k, in both directions."""
    rng = np.random.default_rng(seed)
    depth = np.linspace(0.0, 400e-9, 4000)
    load = 4.0 / 3.0 * modulus * np.sqrt(RADIUS) * depth**1.5
    base = CONTACT - depth - load / STIFFNESS
    z = np.linspace(3e-6, base[-1], points)
    forces = [np.interp(z, base[::-1], load[::-1]) + NOISE * rng.standard_normal(points) for _ in range(2)]
    return KnownCurve(z, forces[0], z[::-1], forces[1][::-1], 0.0, 0.0, CONTACT, STIFFNESS, NOISE)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Three soft curves and a text."""
    made = tmp_path / "soft"
    made.mkdir()
    for number, modulus in enumerate(MODULI):
        write_ibw_curve(made / f"{number}.ibw", soft(modulus, number))
    (made / "notes.md").write_text("a good day")
    return made


def test_table_picture_and_median(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main: Any = pytest.importorskip("nanotouch_app.main").main
    out = folder / "results.csv"
    asked = ["fit", str(folder), "--model", "hertz", "--radius", "1um", "--out", str(out)]
    assert main([*asked, "--stability"]) == 0
    assert "E*(delta) of 3 curves" in capsys.readouterr().out
    with (folder / "results-stability.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 3 * 12
    for number, modulus in enumerate(MODULI):
        deepest = [row for row in rows if Path(row["file"]).name == f"{number}.ibw"][-1]
        assert float(deepest["effective_modulus [Pa]"]) == pytest.approx(modulus, rel=0.05)
    assert (folder / "results-stability.png").stat().st_size > 10_000
    assert main([*asked, "--stability"]) == 0, "its own table and picture are no curves"
    assert "4 curves" in capsys.readouterr().out
    assert main([*asked, "--stability", "--window", "0N,1nN"]) == 2
    assert "leave out --window" in capsys.readouterr().err


def test_median_of_the_curves_that_have_one(folder: Path, tmp_path: Path) -> None:
    known: dict[str, Any] = {"reading": {"spring_constant": STIFFNESS}, "radius": RADIUS}
    summary = batch.fit_files([folder], tmp_path / "r.csv", "hertz", **known)
    found = batch.stabilities(summary, **known)
    depths, quartiles = found.median()
    assert depths[0] < 0.5 * depths[-1]
    np.testing.assert_allclose(quartiles[1], 30e3, rtol=0.1)
    np.testing.assert_allclose(quartiles[2] / quartiles[0], np.sqrt(40 / 20), rtol=0.2)  # of the logarithms
    none = batch.Stabilities([], [])
    assert none.median()[0].size == 0
    assert "no curve" in str(none)
    none.draw(save=tmp_path / "none.png")
