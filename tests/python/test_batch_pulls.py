# SPDX-License-Identifier: BSD-3-Clause
"""A folder of pulls: every rupture in a table, and histograms of forces and contour lengths."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from nanotouch import batch, curves
from nanotouch_app.main import main
from test_curves_chains import pulled

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("matplotlib")
pytest.importorskip("h5py")
pytest.importorskip("afmformats")

CONTOURS = (120e-9, 240e-9, 400e-9)


def test_a_folder_of_pulls_gives_a_histogram(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "pulls"
    folder.mkdir()
    for seed in range(2):
        made = pulled(seed, CONTOURS, (200e-12, 250e-12, 300e-12), 0.4e-9, "worm-like")
        curves.write(folder / f"{seed}.h5", [made])
    out = tmp_path / "results.csv"
    assert main(["fit", str(folder), "--radius", "20nm", "--out", str(out)]) == 0
    assert "6 ruptures of 2 curves, force 2" in capsys.readouterr().out
    with (tmp_path / "results-ruptures.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == 6
    for row, contour in zip(rows, CONTOURS * 2, strict=True):
        assert float(row["contour_length [m]"]) == pytest.approx(contour, rel=0.03)
    steps = [float(row["contour_length step [m]"]) for row in rows if row["contour_length step [m]"]]
    np.testing.assert_allclose(steps, [120e-9, 160e-9] * 2, rtol=0.05)
    assert (tmp_path / "results-ruptures.png").stat().st_size > 10_000


def test_the_histograms_hold_every_value(tmp_path: Path) -> None:
    curves.write(tmp_path / "a.h5", [pulled(1, CONTOURS, (200e-12, 250e-12, 300e-12), 0.4e-9, "worm-like")])
    summary = batch.fit_files([tmp_path / "a.h5"], tmp_path / "r.csv", radius=20e-9)
    found = batch.pulls(summary, segment_length=0.4e-9)
    figure = found.draw()
    counts = [sum(patch.get_height() for patch in panel.patches) for panel in figure.axes]
    assert counts == [3, 3, 2]
    assert found.force == pytest.approx([200e-12, 250e-12, 300e-12], rel=0.1)
