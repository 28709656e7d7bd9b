# SPDX-License-Identifier: BSD-3-Clause
"""Everyday levelling against known truth: drift goes, structures stay; the report says what the others would give."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
import synthetic
import synthetic_levelling as known

pytest.importorskip("cv2")

from nanotouch import images

NM = 1e-9


def topography(heights: synthetic.Array) -> images.Topography:
    return images.Topography(heights, (10e-6 / len(heights),) * 2)


def levelled(heights: synthetic.Array, method: str = "auto") -> tuple[synthetic.Array, images.LevelReport]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        result, report = images.level(topography(heights), method)
    return result.heights, report


def error(result: synthetic.Array, truth: synthetic.Array) -> float:
    off = result - truth
    return float((off - off.mean()).std())


def scene(name: str, seed: int, **scan: float) -> tuple[synthetic.Array, synthetic.Array]:
    rng = np.random.default_rng(seed)
    truth = known.SURFACES[name](rng, 200)
    return truth, known.scanned(truth, rng, **scan)


@pytest.mark.parametrize(
    ("name", "most"),
    [("DNA", 0.3), ("particles", 0.5), ("diagonal step", 1.2), ("island", 1.4), ("step along", 0.8)],
)
def test_drift_goes_and_the_surface_stays(name: str, most: float) -> None:
    """Offsets of 1 nm, a random walk of 0.3 nm a row, a bow of 4 nm: the median of five scans."""
    scenes = [scene(name, seed) for seed in range(101, 106)]
    errors = [error(levelled(scan)[0], truth) for truth, scan in scenes]
    before = [error(levelled(scan, "plane+rows")[0], truth) for truth, scan in scenes]
    assert np.median(errors) < most * NM
    assert np.median(errors) < 0.6 * np.median(before)


@pytest.mark.parametrize("name", known.SURFACES)
def test_a_surface_without_drift_is_left(name: str) -> None:
    truth, scan = scene(name, 7, offsets=0.0, drift=0.0, bow=0.0)
    assert error(levelled(scan)[0], truth) < 1.05 * error(levelled(scan, "plane+rows")[0], truth) + 0.05 * NM


@pytest.mark.parametrize("name", [name for name in known.SURFACES if "grating" in name or name in ("wave", "cell")])
def test_gratings_waves_and_cells_stay(name: str) -> None:
    """As high as they are, whatever lies over them."""
    truth, scan = scene(name, 8)
    result, _ = levelled(scan)
    scale = float(np.polyfit(truth.ravel(), result.ravel(), 1)[0])
    assert scale == pytest.approx(1.0, abs=0.02 if "shallow" not in name else 0.2)


@pytest.mark.parametrize("along_y", [True, False])
def test_a_grating_of_480_nm_keeps_its_step(along_y: bool) -> None:
    heights, ridge = synthetic.grating(256, duty=0.4, along_y=along_y)
    rng = np.random.default_rng(3)
    rows = 1 * NM * rng.standard_normal((256, 1))
    result, report = levelled(
        synthetic.tilted(heights + rows + 0.3 * NM * rng.standard_normal(heights.shape), 10e-6, 0.02, 0.03)
    )
    step = float(np.median(result[ridge]) - np.median(result[~ridge]))
    assert step == pytest.approx(480 * NM, abs=0.5 * NM)
    medians = next(one for one in report.candidates if one.method.endswith("medians"))
    assert medians.step_kept < 0.1  # which is why it is not chosen, however smooth it leaves the image


def test_the_report_says_what_the_runner_up_would_have_given() -> None:
    _, scan = scene("DNA", 9)
    result, report = levelled(scan)
    chosen, runner_up = report.candidates[:2]
    assert (chosen.method, runner_up.method) == ("poly2+lines", "poly2+rows")
    assert chosen.rms == pytest.approx(float(result.std()), rel=0.02)
    assert runner_up.rms == pytest.approx(float(levelled(scan, "poly2+rows")[0].std()), rel=0.02)
    assert chosen.step_kept > 0.9
    assert chosen.anisotropy < 0.2 * runner_up.anisotropy
    assert "chosen: poly2+lines" in str(report)
    assert "runner-up: poly2+rows" in str(report)
    assert levelled(scan, "poly2+lines")[1].candidates == ()


def test_what_leaves_drift_says_what_takes_it_out_and_nothing_advises_against() -> None:
    _, scan = scene("DNA", 9)
    assert "look like drift: lines takes it out" in levelled(scan, "poly2+rows")[1].steps[1].note
    assert levelled(scan, "poly2+medians")[1].warnings == ()
    _, grating = scene("grating along 50 %", 9)
    (warning,) = levelled(grating, "plane+medians")[1].warnings
    assert "medians erased what looks like" in warning


def test_one_step_across_the_image_stays_with_a_word() -> None:
    """A step of the surface or a change of the tip: nobody can tell."""
    truth, scan = scene("step along", 12)
    result, report = levelled(scan)
    assert np.median(result[100:120]) - np.median(result[50:70]) == pytest.approx(
        20 * NM, abs=3 * NM
    )  # a random walk of 0.3 nm over 50 rows
    assert any("across whole rows kept; if the tip changed there" in text for text in report.warnings)
    assert truth.shape == result.shape


def test_a_spike_among_disturbed_pixels_goes() -> None:
    rng = np.random.default_rng(5)
    heights = 1 * NM * rng.standard_normal((100, 100))
    heights[40, 30:60] += 14 * NM  # a disturbed line
    heights[40, 44:46] = [229 * NM, 494 * NM]
    clean, report = images.despeckle(topography(heights))
    assert report.largest > 450 * NM
    assert clean.height_range < 60 * NM


@pytest.mark.parametrize("seed", [0, 3])
def test_rows_that_stray_make_no_bow_of_a_grating_along_them(seed: int) -> None:
    """Offsets and a random walk over round lines of 10 nm were read as a bow: 2.6 and 8.3 nm off, a plane 1.7."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[:256, :256] / 256.0
    round_edge = np.exp(-0.5 * (np.arange(-3, 4) / 0.8) ** 2)
    profile = np.pad(10.0 * NM * ((np.arange(256) // 24) % 2 == 0), 3, mode="edge")
    truth = np.convolve(profile, round_edge / round_edge.sum(), "valid")[:, None] + 0.0 * x
    strays = 0.5 * rng.standard_normal(256) + 0.25 * np.cumsum(rng.standard_normal(256))
    bow = 15.0 * rng.standard_normal() * y + 12.0 * (x - 0.5) ** 2 + 6.0 * (y - 0.5) ** 2
    scan = truth + NM * (strays[:, None] + 30.0 * x + bow + 0.15 * rng.standard_normal(y.shape))
    flat = np.column_stack([np.ones(y.size), x.ravel(), y.ravel()])

    def beside_a_plane(result: synthetic.Array) -> float:
        off = (result - truth).ravel()
        return float(np.std(off - flat @ np.linalg.lstsq(flat, off, rcond=None)[0]))

    assert beside_a_plane(levelled(scan)[0]) < beside_a_plane(scan)


@pytest.mark.parametrize(("name", "most"), [("sample_0.stp", 0.15), ("sample_0.jpk-qi-image", 9.0), ("nid-1.nid", 4.4)])
def test_real_images(name: str, most: float) -> None:
    """Banded by 5.4, 17 and 7.3 nm by plane and rows alone; the third is of its height sensor, which is noisier."""
    path: Path = synthetic.DATA / "corpus" / "images" / name
    if not path.exists():
        pytest.skip(f"real data not here: {path}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        result, _ = images.level(images.read(path))
        clean, _ = images.prepare(images.read(path))
    assert images.roughness(result).rms < most * NM
    assert clean.height_range < 100 * NM  # the spike of 490 nm in the second has gone


def lattice(kind: str) -> synthetic.Array:
    """Structures whose walls have harmonics, or leave few points of a tile flat; 256 pixels."""
    y, x = np.mgrid[:256, :256].astype(float)
    if kind == "holes":
        return -60 * NM * ((x % 48 < 30) & (y % 48 < 30))
    if kind == "lines along":
        return 20 * NM * (y % 37 < 13)
    return 20 * NM * (x % 37 < 13)


@pytest.mark.parametrize("kind", ["holes", "lines along", "lines across"])
def test_a_bow_is_seen_through_a_lattice(kind: str) -> None:
    """The walls' harmonics are no fine grating, and walls do not hide the slope of a tile."""
    truth = lattice(kind)
    rng = np.random.default_rng(3)
    scan = known.scanned(truth, rng, offsets=0.0, drift=0.0, bow=5 * NM)
    assert error(levelled(scan, "plane+lines")[0], truth) > 1.0 * NM
    assert error(levelled(scan)[0], truth) < 0.2 * NM
