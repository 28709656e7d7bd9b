# SPDX-License-Identifier: BSD-3-Clause
"""Particles of known size are found, parted and measured; the real image of grains where it is there."""

from __future__ import annotations

import csv
import warnings
from pathlib import Path

import numpy as np
import pytest
import synthetic

pytest.importorskip("cv2")

from nanotouch import images
from nanotouch.errors import InvalidValue

N, PIXEL = 400, 1e-9


def cap(x: float, y: float, diameter: float, height: float) -> synthetic.Array:
    """A spherical cap on N x N pixels [m]."""
    j, i = np.indices((N, N)) * PIXEL
    radius = (0.25 * diameter**2 + height**2) / (2 * height)
    off = (i - x) ** 2 + (j - y) ** 2
    return np.where(off < 0.25 * diameter**2, np.sqrt(np.maximum(radius**2 - off, 0.0)) - radius + height, 0.0)


def quantum_dots(seed: int, count: int = 40) -> tuple[synthetic.Array, synthetic.Array]:
    """Caps of 15 .. 40 nm, a third as high, that do not touch: heights, and x, y, diameter, height of each."""
    rng = np.random.default_rng(seed)
    dots: list[tuple[float, float, float, float]] = []
    heights = np.zeros((N, N))
    while len(dots) < count:
        d, (x, y) = rng.uniform(15e-9, 40e-9), rng.uniform(0, N * PIXEL, 2)
        if all(np.hypot(x - o[0], y - o[1]) > 0.5 * (d + o[2]) + 4e-9 for o in dots):
            dots.append((x, y, d, d / 3))
            heights = np.maximum(heights, cap(x, y, d, d / 3))
    return heights, np.array(dots)


def topography(heights: synthetic.Array) -> images.Topography:
    return images.Topography(heights, (PIXEL, PIXEL))


@pytest.mark.parametrize("noise", [0.0, 0.1e-9, 0.3e-9])
@pytest.mark.parametrize("seed", [1, 2])
def test_dots_of_known_size(noise: float, seed: int) -> None:
    heights, dots = quantum_dots(seed)
    rough = heights + noise * np.random.default_rng(seed).standard_normal(heights.shape)
    table = images.grains(topography(rough + 7e-9))
    assert len(table) == len(dots)
    assert table.base == pytest.approx(7e-9, abs=0.02e-9 + 0.1 * noise)
    assert table.noise == pytest.approx(noise, rel=0.1, abs=1e-13)
    for x, y, d, h in dots:
        k = int(np.argmin(np.hypot(table.x - x, table.y - y)))
        cut = min(x, y, N * PIXEL - x, N * PIXEL - y) < d / 2
        if cut:
            assert table.border[k] or min(x, y, (N - 1) * PIXEL - x, (N - 1) * PIXEL - y) > d / 2 - 2 * PIXEL
            continue
        assert np.hypot(table.x[k] - x, table.y[k] - y) < 0.1 * PIXEL + 0.3 * noise
        # the top lies up to half a pixel off, and the highest of a few pixels is up to three sigma of noise too high
        assert -0.02e-9 < table.height[k] - h + (0.5 * PIXEL) ** 2 / d * 2 < 0.1e-9 + 3.5 * noise
        # at the threshold a cap is narrower than at its foot; a circle of pixels is off by a fraction of one
        threshold, radius = table.threshold, (0.25 * d**2 + h**2) / (2 * h)
        there = 2 * np.sqrt(radius**2 - (radius - h + threshold) ** 2)
        assert table.diameter[k] == pytest.approx(there, abs=0.5 * PIXEL + noise)
        volume = np.pi * (h - threshold) ** 2 * (3 * radius - (h - threshold)) / 3 + threshold * np.pi * there**2 / 4
        assert table.volume[k] == pytest.approx(volume, rel=0.03)
        assert table.mean_height[k] == pytest.approx(table.volume[k] / table.area[k], rel=1e-12)
    assert (np.diff(table.height) <= 0).all()


def test_dots_that_touch_are_parted_by_their_saddle() -> None:
    """Two dots 30 nm apart with a saddle at half their height; a dimpled one with a saddle of 5 % stays one."""
    rng = np.random.default_rng(3)
    two = np.maximum(cap(100e-9, 100e-9, 40e-9, 13e-9), cap(130e-9, 104e-9, 40e-9, 10e-9))
    dimpled = cap(250e-9, 250e-9, 60e-9, 15e-9) - cap(250e-9, 250e-9, 10e-9, 0.7e-9)
    image = topography(two + dimpled + 0.2e-9 * rng.standard_normal((N, N)))
    table = images.grains(image)
    assert len(table) == 3
    assert sorted(table.height) == pytest.approx([10e-9, 13e-9, 14.6e-9], abs=0.8e-9)
    one = np.argmin(np.hypot(table.x - 130e-9, table.y - 104e-9))
    assert np.hypot(table.x[one] - 130e-9, table.y[one] - 104e-9) < 3e-9  # less the part beyond the saddle
    assert len(images.grains(image, split=False)) == 2


def test_pits_are_particles_of_the_surface_turned_over() -> None:
    heights, _ = quantum_dots(4, 15)
    up, down = images.grains(topography(heights)), images.grains(topography(-heights), pits=True)
    for name, column in up.columns().items():
        np.testing.assert_array_equal(column, down.columns()[name])
    assert up.base == -down.base
    assert str(up).replace("particles above", "pits deeper than").replace("height", "depth") == str(down)


def test_border_small_and_masked() -> None:
    heights = np.zeros((N, N))
    heights[0:8, 50:60] = heights[100:110, 100:110] = heights[200:202, 200:203] = 10e-9
    table = images.grains(topography(heights))
    assert (len(table), table.border.tolist(), table.pixels.tolist()) == (2, [True, False], [80, 100])
    assert len(images.grains(topography(heights), smallest=6)) == 3
    assert table.coverage == 180 / N**2
    inner = ~table.border
    assert (table.x[inner], table.y[inner]) == (pytest.approx([104.5e-9]), pytest.approx([104.5e-9]))
    with pytest.raises(InvalidValue, match="smallest"):
        images.grains(topography(heights), smallest=0)
    for wrong in ("high", 0.0, -1e-9, float("nan")):
        with pytest.raises(InvalidValue, match="threshold"):
            images.grains(topography(heights), wrong)


def test_noise_alone_has_no_particles() -> None:
    rng = np.random.default_rng(5)
    table = images.grains(topography(1e-9 * rng.standard_normal((N, N))), "flat")
    assert len(table) == 0
    assert "no particles above" in str(table)


def test_dense_grains_are_parted_by_otsu() -> None:
    """Two levels of 0 and 20 nm, half of the area each: the threshold lies between them."""
    rng = np.random.default_rng(6)
    heights = np.where((np.indices((N, N)) // 20).sum(axis=0) % 2, 20e-9, 0.0) + 3e-9 * rng.standard_normal((N, N))
    table = images.grains(topography(heights), "otsu")
    assert table.threshold == pytest.approx(10e-9, abs=2e-9)
    assert table.base == pytest.approx(0.0, abs=0.2e-9)
    assert table.coverage == pytest.approx(0.5, abs=0.01)


def test_the_table_as_csv(tmp_path: Path) -> None:
    table = images.grains(topography(quantum_dots(7, 10)[0]))
    table.to_csv(tmp_path / "dots.csv")
    with open(tmp_path / "dots.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 10
    for name, values in table.columns().items():
        assert [float(row[name]) for row in rows] == values.tolist(), name  # the same doubles
    assert [row["border"] for row in rows] == [str(int(b)) for b in table.border]
    assert set(rows[0]) == {"number", *table.columns()}
    assert "10 particles" in str(table)


@pytest.mark.parametrize("seed", [1, 2])
def test_dots_raise_no_doubt(seed: int) -> None:
    """Warnings are errors in these tests; many dots on a flat give none."""
    rough = quantum_dots(seed, 90)[0] + 0.3e-9 * np.random.default_rng(seed).standard_normal((N, N))
    assert images.grains(topography(rough)).warnings == ()


@pytest.mark.parametrize(
    ("under", "said"),
    [
        (lambda x, y: 4e-9 * (x > 0.4), "a terrace, the bow of a scanner"),
        (lambda x, y: 30e-9 * ((x - 0.5) ** 2 + (y - 0.5) ** 2), "nm higher in some rows than in others"),
        (lambda x, y: 4e-9 * ((x > 0.4) + 1.0 * (x > 0.7)), "the base is hardly a flat; look for pits"),
    ],
    ids=["terrace", "bow", "stairs"],
)
def test_what_lies_under_the_dots_is_said(under: object, said: str) -> None:
    """The same dots on a terrace, on a bow of the scanner, on stairs."""
    y, x = np.indices((N, N)) / N
    heights = quantum_dots(1)[0] + under(x, y) + 0.2e-9 * np.random.default_rng(1).standard_normal((N, N))  # type: ignore[operator]
    with warnings.catch_warnings(record=True) as raised:
        warnings.simplefilter("always")
        table = images.grains(topography(heights))
    assert [str(warning.message) for warning in raised] == list(table.warnings)
    assert said in " ".join(table.warnings)
    assert f"warning: {table.warnings[0]}" in str(table)


def test_noise_alone_is_said() -> None:
    heights = 1e-9 * np.random.default_rng(1).standard_normal((N, N))
    with pytest.warns(UserWarning, match="times the noise of a pixel"):
        images.grains(topography(heights), "otsu")


def test_in_noise_alone_nothing_is_found() -> None:
    """Otsu parts noise in two halves; a faint particle in it is found alone."""
    heights = 1e-9 * np.random.default_rng(2).standard_normal((N, N))
    assert len(images.grains(topography(heights))) == 0
    heights[20:26, 20:26] += 8e-9
    assert len(images.grains(topography(heights))) == 1


def test_the_sizes_are_those_of_whole_particles() -> None:
    """One in the middle, one that the border cuts: one size is told, not a range of one; none where all are cut."""
    both = topography(cap(200e-9, 200e-9, 40e-9, 12e-9) + cap(0.0, 100e-9, 40e-9, 12e-9))
    assert "2 particles above" in (text := str(images.grains(both)))
    assert "of the others height 11.99 nm, diameter" in text.replace("12 nm", "11.99 nm")
    alone = str(images.grains(topography(cap(0.0, 100e-9, 40e-9, 12e-9))))
    assert alone.startswith("1 particle above")
    assert "height" not in alone


def test_dots_over_bands_that_levelling_left() -> None:
    """Bands of 2 nm along the rows under dots of 5 to 13 nm: without their measure the threshold would be 10 nm."""
    heights, dots = quantum_dots(3)
    rng = np.random.default_rng(3)
    bands = 2e-9 * np.sin(np.arange(N) / 25.0)[:, None]
    with pytest.warns(UserWarning, match="4.0. nm higher in some rows than in others"):
        table = images.grains(topography(heights + bands + 0.2e-9 * rng.standard_normal(heights.shape)))
    assert len(table) == len(dots)
    assert table.noise == pytest.approx(0.2e-9, rel=0.2)
    assert table.threshold < 1.3e-9
    for x, y, d, h in dots:
        k = int(np.argmin(np.hypot(table.x - x, table.y - y)))
        if d / 2 < min(x, y, N * PIXEL - x, N * PIXEL - y):
            assert table.height[k] == pytest.approx(h, abs=0.8e-9)


def test_particles_of_a_real_image() -> None:
    path = synthetic.DATA / "corpus" / "images" / "sample_0.jpk-qi-image"
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        table = images.grains(images.prepare(images.read(path))[0])
    assert 22 <= len(table) <= 26  # a person counts 24


def test_what_was_filled_in_is_no_particle() -> None:
    """Missing pixels between high rims look like particles; one of which less than half is missing stays whole."""
    rng = np.random.default_rng(4)
    two = cap(100e-9, 100e-9, 40e-9, 12e-9) + cap(250e-9, 250e-9, 40e-9, 12e-9)
    heights = two + 0.1e-9 * rng.standard_normal((N, N))
    missing = np.zeros((N, N), bool)
    missing[80:121, 80:121] = True  # all of the first, and its rim
    missing[249:252, 200:300] = True  # a repaired row across the second
    image = images.Topography(heights, (PIXEL, PIXEL), mask=missing)
    with pytest.warns(UserWarning, match="left out: 1 particle of pixels that were mostly filled in"):
        table = images.grains(image)
    assert len(table) == 1
    assert table.x[0] == pytest.approx(250e-9, abs=PIXEL)
    assert table.diameter[0] == pytest.approx(40e-9, abs=4 * PIXEL)
    assert not table.labels[80:121, 80:121].any()


def test_a_speck_does_not_part_the_heights() -> None:
    """Otsu's height lies between the classes of dense grains, also where one pixel in a thousand is far off."""
    rng = np.random.default_rng(5)
    dense = np.where(rng.random((N, N)) < 0.5, 0.0, 10e-9) + 0.5e-9 * rng.standard_normal((N, N))
    specks = dense.copy()
    specks[rng.random((N, N)) < 1e-3] = -1e-6
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        clean, marred = (images.grains(topography(z), "otsu", split=False) for z in (dense, specks))
    assert marred.threshold == pytest.approx(clean.threshold, abs=0.5e-9)
    assert 1.5e-9 < marred.threshold < 8e-9
