# SPDX-License-Identifier: BSD-3-Clause
"""Ratings, groups of curves and the page about a folder: against other definitions, with real good and bad curves."""

from __future__ import annotations

import csv
import html.parser
import json
from pathlib import Path

import nanotouch as nt
import numpy as np
import pytest
from nanotouch import batch, curves
from nanotouch.batch.groups import anderson_darling, label_by, spreads, without_files
from nanotouch.batch.table import SHORT
from nanotouch_app.main import main
from synthetic import DATA, known_curve, write_ibw_curve
from synthetic_tethers import Made, make

_fit = pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("afmformats")
pytest.importorskip("matplotlib")

CORPUS = DATA / "corpus" / "curves"


def by_definition(indentation: np.ndarray, force: np.ndarray, fitted: np.ndarray) -> float:
    """The rule of docs/fit.md, written again."""
    deep = indentation >= 0.25 * indentation.max()
    thirds = np.array_split(np.abs(force - fitted)[deep], 3)
    left = sum(part.max() for part in thirds) / np.abs(force).max()
    return float(10.0 / (1.0 + (2.0 * np.log(1.0 + left) / 0.17) ** 1.4))


def test_rating_follows_its_definition() -> None:
    rng = np.random.default_rng(3)
    for share in (0.0, 0.01, 0.03, 0.1, 0.3):
        indentation = np.linspace(-20e-9, 400e-9, 600)
        fitted = 1e-9 * np.clip(indentation / 400e-9, 0, None) ** 1.5
        force = fitted + share * 1e-9 * np.sin(indentation / 30e-9) + 1e-12 * rng.standard_normal(600)
        found = _fit.rating(indentation, force, fitted, 1e-12)
        assert found == pytest.approx(by_definition(indentation, force, fitted), abs=0.02)
    assert _fit.rating(indentation, 1e-12 * rng.standard_normal(600), 0.0 * fitted, 1e-12) == 0.0


def test_a_curve_of_another_law_is_a_misfit_and_a_noisy_one_is_none() -> None:
    """A cone fitted by Hertz leaves a few per cent; a bow of the contact a fifth."""
    good = make(Made(noise=10e-12))
    result = nt.fit.fit_curve(good, "hertz", radius=1e-6)
    assert result.status == "ok"
    assert result.rating > 8.0
    noisy = nt.fit.fit_curve(make(Made(noise=100e-12)), "hertz", radius=1e-6)
    assert noisy.status == "ok"
    assert noisy.rating < result.rating
    segments = []
    for segment in good.segments:
        assert segment.force is not None
        bent = segment.force + 3e-9 * np.sin(segment.z / 60e-9) * (segment.z < 0)
        segments.append(curves.Segment(segment.role, segment.time, segment.z, segment.z_channel, bent))
    bad = nt.fit.fit_curve(curves.ForceCurve(tuple(segments), good.meta, "bent"), "hertz", radius=1e-6)
    assert bad.status == "misfit"
    assert bad.rating < 4.5


RATED = {  # nanite 4.2.3, Extra Trees on zef18, of the same files
    "curves/fmt-jpk-fd_qi-data-2021.04.13.jpk-qi-series": 9.0,
    "curves/fmt-jpk-fd_spot3-0192.jpk-force": 3.6,
    "curves/map-data-2022.10.29-12.27.34.564.jpk-force-map": 2.4,
    "corpus/curves/fmt-jpk-fd_map0d_extracted.jpk-force-map": 3.6,
    "corpus/curves/nanite/fmt-jpk-fd_single_tilted-baseline-drift-mitotic_2021-01-29.jpk-force": 4.1,
}


@pytest.mark.skipif(not CORPUS.is_dir(), reason="without the corpus of real files")
def test_real_curves_are_rated_about_as_nanite_rates_them() -> None:
    ours = []
    for name in RATED:
        curve = curves.read(DATA / name)[0]
        ours.append(nt.fit.fit_curve(curve, "hertz", radius=1e-6).rating)
    theirs = np.array(list(RATED.values()))
    assert np.abs(np.array(ours) - theirs).max() < 3.0
    assert np.corrcoef(ours, theirs)[0, 1] > 0.85


@pytest.mark.skipif(not CORPUS.is_dir(), reason="without the corpus of real files")
def test_bad_curves_of_nanite_are_rejected() -> None:
    for file in sorted((CORPUS / "nanite").glob("*bad*")):
        try:
            result = nt.fit.fit_curve(curves.read(file)[0], "auto", radius=1e-6)
        except nt.errors.Error:
            continue
        assert result.status == "misfit"
        assert result.rating < 1.0


def test_anderson_darling_against_scipy() -> None:
    stats = pytest.importorskip("scipy.stats")
    rng = np.random.default_rng(0)
    for values in (rng.standard_normal(50), rng.exponential(size=80), rng.standard_normal(9)):
        count = values.size
        scaled = (np.sort(values) - values.mean()) / values.std(ddof=1)
        logs = stats.norm.logcdf(scaled) + stats.norm.logsf(scaled)[::-1]
        squared = -count - np.mean((2 * np.arange(1, count + 1) - 1) * logs)
        assert anderson_darling(values) == pytest.approx(squared * (1 + 0.75 / count + 2.25 / count**2), rel=1e-9)


def rows(values: np.ndarray, group: str = "") -> list[dict[str, object]]:
    return [{"status": "ok", "group": group, "rating": 9.0, "E* [Pa]": v} for v in values]


def test_log_normal_where_it_fits() -> None:
    rng = np.random.default_rng(1)
    found = spreads(rows(np.exp(rng.normal(np.log(5e3), 0.4, 400)), "a") + rows(rng.uniform(1e3, 2e4, 400), "b"))
    a, b = (spread for spread in found if spread.quantity == "E* [Pa]")
    assert a.log_normal is True
    assert a.geometric_mean == pytest.approx(5e3, rel=0.08)
    assert a.geometric_deviation == pytest.approx(np.exp(0.4), rel=0.1)
    assert b.log_normal is False
    assert a.percentiles[2] == pytest.approx(np.median(a.values))


def test_log_normal_is_rejected_in_5_per_cent_of_true_ones() -> None:
    rng = np.random.default_rng(2)
    kept = [spreads(rows(np.exp(rng.standard_normal(40))))[0].log_normal for _ in range(400)]
    assert 0.90 < np.mean(kept) < 0.985


def test_groups_by_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    table = tmp_path / "groups.csv"
    table.write_text("file,group\nday1/*,control\n*.ibw,treated\n")
    label = label_by(table)
    assert [label(Path(f"x/{name}")) for name in ("day1/a.ibw", "b.ibw", "c.spm")] == ["control", "treated", "no group"]
    table.write_text("file,group\na.ibw,one\na.ibw,two\nday1/*,control\nc.ibw,misspelt\n")
    assert without_files(table, [Path("a.ibw"), Path("day1/a.ibw")]) == ["a.ibw", "day1/*", "c.ibw"]
    assert without_files("folder", [Path("a.ibw")]) == []
    monkeypatch.chdir(tmp_path)  # a folder above is in the table, as for the calibration table
    table.write_text(f"file,group\n{tmp_path.name}/a.ibw,here\n")
    assert label_by(table)(Path("a.ibw")) == "here"
    table.write_text("name;label\n")
    with pytest.raises(nt.errors.ReadError, match="file,group"):
        label_by(table)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "day"
    for group, seeds in (("wild", (1, 2)), ("mutant", (3,))):
        (made / group).mkdir(parents=True)
        for seed in seeds:
            write_ibw_curve(made / group / f"{seed}.ibw", known_curve(seed=seed))
    (made / "wild" / "<b>cut.ibw").write_bytes(b"no curve")
    return made


class Page(html.parser.HTMLParser):
    """Its text, and what it would load."""

    def __init__(self) -> None:
        super().__init__()
        self.text, self.loads = "", []

    def handle_data(self, data: str) -> None:
        self.text += data

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.loads += [value for name, value in attrs if name in ("src", "href")]
        assert tag not in ("script", "iframe")


def test_report_of_a_folder(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    command = ["report", str(folder), "--radius", "30nm", "--out", str(out)]
    assert main(command) == 0
    said = capsys.readouterr().out
    assert "wild: pull-off force" in said
    page = Page()
    page.feed((out / "report.html").read_text())
    assert all(str(load).startswith("data:image/png;base64,") for load in page.loads)
    assert len(page.loads) >= 2
    with (out / "results.csv").open(newline="") as stream:
        table = list(csv.DictReader(stream))
    assert list(table[0]) == [name for name in SHORT if not name.startswith("E ")]
    assert [row["group"] for row in table] == ["mutant", "wild", "wild", "wild"]
    digest = json.loads((out / "results.csv.json").read_text())["files"][str(folder / "wild" / "1.ibw")]
    for part in ("Methods", "30 nm", nt.__version__, digest, "<b>cut.ibw", "failed", "Rejected, and why"):
        assert part in page.text
    assert not any(row["status"] == "ok" and row["E* [Pa]"] == "" for row in table)
    assert main(command) == 2  # results are there
    assert main([*command, "--overwrite", "--model", "jkr", "--long"]) == 0
    with (out / "results.csv").open(newline="") as stream:
        assert len(next(csv.reader(stream))) > 40


def test_report_of_folders_of_one_name(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Each is a group, told apart by what stands above it; a folder named twice counts once."""
    other = tmp_path / "night" / "wild"
    other.mkdir(parents=True)
    write_ibw_curve(other / "1.ibw", known_curve(seed=5))
    out, named = tmp_path / "out", [str(folder / "wild"), str(other), str(other)]
    assert main(["report", *named, "--radius", "30nm", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "4 curves: " in said
    assert "day/wild: pull-off force" in said
    assert "night/wild: pull-off force" in said
    assert "Force curves of wild, wild" in (out / "report.html").read_text()
    assert main(["report", str(folder), str(tmp_path / "none"), "--out", str(tmp_path / "b")]) == 2


def test_a_tip_that_the_file_states(tmp_path: Path) -> None:
    """It is taken and said; what is given comes before it."""
    made = curves.read(write_ibw_curve(tmp_path / "1.ibw", known_curve()))[0]
    stated = curves.ForceCurve(made.segments, dict(made.meta) | {"tip radius": 27.5e-6}, made.name)
    result = nt.fit.fit_curve(stated, "hertz")
    assert result.radius == 27.5e-6
    assert "tip radius 27.5 µm (as the file states)" in result.assumptions
    assert result.radius_given
    assert nt.fit.fit_curve(stated, "hertz", radius=1e-6).radius == 1e-6


def test_report_without_a_radius_says_so(folder: Path, tmp_path: Path) -> None:
    assert main(["report", str(folder), "--out", str(tmp_path / "out")]) == 0
    assert "NOT given" in (tmp_path / "out" / "report.html").read_text()


def test_summary_counts_what_is_fitted(folder: Path, tmp_path: Path) -> None:
    summary = batch.fit_files([folder / "wild"], tmp_path / "r.csv", "jkr", radius=30e-9, groups="folder")
    assert summary.fitted == 2
    assert summary.count("failed") == 1
    assert {spread.group for spread in summary.spreads} == {"wild"}
