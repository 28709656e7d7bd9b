# SPDX-License-Identifier: BSD-3-Clause
"""Heights along a line and their histogram, on surfaces in closed form."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("scipy")

from nanotouch import images
from nanotouch.errors import InvalidValue

DX, DY = 10e-9, 20e-9
NY, NX = 60, 90


def plane(slope_x: float, slope_y: float) -> images.Topography:
    x, y = np.arange(NX) * DX, np.arange(NY) * DY
    return images.Topography(slope_x * x + slope_y * y[:, None], (DY, DX))


@pytest.mark.parametrize(
    ("start", "end"),
    [((50e-9, 100e-9), (800e-9, 100e-9)), ((100e-9, 1000e-9), (100e-9, 50e-9)), ((50e-9, 50e-9), (700e-9, 1100e-9))],
)
@pytest.mark.parametrize("width", [0.0, 60e-9])
def test_a_line_over_a_plane(start: tuple[float, float], end: tuple[float, float], width: float) -> None:
    found = images.section(plane(0.3, -0.1), start, end, width=width)
    length = float(np.hypot(end[0] - start[0], end[1] - start[1]))
    assert found.over[-1] == pytest.approx(length)
    assert np.diff(found.over).max() <= DX * 1.0001
    part = found.over / length
    expected = 0.3 * (start[0] + part * (end[0] - start[0])) - 0.1 * (start[1] + part * (end[1] - start[1]))
    np.testing.assert_allclose(found.values, expected, atol=1e-15)


def test_a_width_averages_across_the_line() -> None:
    """A ridge along y: across the line its mean, along it itself."""
    heights = np.zeros((NY, NX))
    heights[:, 40:50] = 5e-9
    image = images.Topography(heights, (DY, DX))
    along = images.section(image, (450e-9, 100e-9), (450e-9, 1000e-9), width=200e-9)
    assert along.values == pytest.approx(5e-9 * 10 / 21, rel=0.05)
    across = images.section(image, (5e-9, 600e-9), (895e-9, 600e-9), width=200e-9)
    assert across.values.max() == pytest.approx(5e-9)


def test_what_is_refused() -> None:
    image = plane(0.1, 0.0)
    for line, message in (
        (((-1e-9, 0.0), (1e-7, 0.0)), "the image reaches"),
        (((0.0, 0.0), (1e-6, 0.0)), "the image reaches"),
        (((float("nan"), 0.0), (1e-7, 0.0)), "the image reaches"),
        (((1e-7, 1e-7), (1e-7, 1e-7)), "at least a pixel"),
    ):
        with pytest.raises(InvalidValue, match=message):
            images.section(image, *line)
    with pytest.raises(InvalidValue, match="width"):
        images.section(image, (0.0, 0.0), (1e-7, 0.0), width=-1e-9)
    with pytest.raises(InvalidValue, match="bins"):
        images.histogram(image, 1)
    with pytest.raises(InvalidValue, match="all are equal"):
        images.histogram(plane(0.0, 0.0))


def test_a_histogram_is_a_density_of_the_measured_heights() -> None:
    rng = np.random.default_rng(1)
    heights = 2e-9 * rng.standard_normal((400, 400))
    mask = np.zeros(heights.shape, bool)
    mask[:10] = True
    heights[mask] = 1e-6
    found = images.histogram(images.Topography(heights, (DY, DX), mask=mask), 200)
    step = found.over[1] - found.over[0]
    assert found.values.sum() * step == pytest.approx(1.0)
    assert found.over.max() < 2e-8
    normal = np.exp(-0.5 * (found.over / 2e-9) ** 2) / (2e-9 * np.sqrt(2 * np.pi))
    assert np.abs(found.values - normal).max() < 0.05 * normal.max()


def test_tables_and_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    pytest.importorskip("matplotlib")
    from nanotouch_app.main import main

    monkeypatch.chdir(tmp_path)
    images.write("a.gwy", plane(0.05, 0.02))
    command = ["image", "a.gwy", "--level", "none", "--histogram", "--json", "--out", "out"]
    assert main([*command, "--line", "100nm,200nm,800nm,200nm,40nm"]) == 0
    written = json.loads(capsys.readouterr().out)["files"]
    assert {"line.csv", "line.png", "histogram.csv", "histogram.png"} <= set(written)
    table = np.genfromtxt("out/line.csv", delimiter=",", skip_header=1)
    np.testing.assert_allclose(np.diff(table[:, 1]) / np.diff(table[:, 0]), 0.05, rtol=1e-6)
    assert main([*command, "--overwrite", "--line", "1um,2um"]) != 0
    assert "write it like" in capsys.readouterr().err
