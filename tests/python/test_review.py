# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch review``: what is decided by key or mouse lies in a sidecar, and a batch obeys it."""

from __future__ import annotations

import io
from pathlib import Path

import pytest
from nanotouch import Contact, batch, curves, maps
from nanotouch.errors import Error, InvalidValue, ReadError
from nanotouch_app.data.review_window import Board, show
from nanotouch_app.main import main

pytest.importorskip("h5py")
pytest.importorskip("afmformats")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "gels"
    made.mkdir()
    for seed in range(3):
        contact = Contact(1e-6, 5e4, 0.0)
        curve = curves.synthesize(contact, "hertz", spring_constant=0.1, noise=10e-12, points=400, seed=seed)
        curves.write(made / f"{seed}.h5", [curve])
    return made


def test_keys_write_a_sidecar_that_a_batch_obeys(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    side = folder.parent / "side.toml"
    typed = "x tip crashed\nc 12.5nm\nwhat\nk\n-\nn\nb 100nm 50nm\nk\n"
    monkeypatch.setattr("sys.stdin", io.StringIO(typed))
    line = ["review", str(folder), "--sidecar", str(side), "--radius", "1um", "--model", "hertz"]
    assert main(line) == 0
    said = capsys.readouterr().out
    assert "1/3" in said
    assert "'what': k keep" in said
    assert "expected two that grow" in said
    assert "3 curves, 1 excluded" in said
    read = batch.Sidecar.from_toml(side)
    assert read.of(folder / "0.h5", 0).exclude == "tip crashed"
    assert read.of(folder / "1.h5", 0).contact_point == 12.5e-9  # the same double
    summary = batch.fit_files([folder], folder.parent / "r.csv", "hertz", sidecar=side, radius=1e-6)
    assert [row["status"] for row in summary.rows].count("excluded") == 1


def test_what_is_undone_leaves_no_trace(folder: Path) -> None:
    side = folder.parent / "side.toml"
    review = batch.Review([folder], side, "hertz", radius=1e-6)
    review.decide(review.places[0], exclude="no contact", baseline=(1e-7, 2e-7))
    again = batch.Review([folder], side, "hertz", radius=1e-6)
    decision = again.decision(again.places[0])
    assert decision.exclude == "no contact"
    assert decision.baseline == pytest.approx((1e-7, 2e-7))
    again.decide(again.places[0], exclude="", baseline=None)
    assert batch.Sidecar.from_toml(side).decisions == {}


def pixels(board: Board, z: float) -> tuple[float, float]:
    """Where z [nm] is drawn, in the middle of the panel's height."""
    x, y = board.panel.transData.transform((z, sum(board.panel.get_ylim()) / 2.0))
    return float(x), float(y)


def test_mouse_and_keys_of_the_window(folder: Path) -> None:
    figure_module = pytest.importorskip("matplotlib.figure")
    backend = pytest.importorskip("matplotlib.backends.backend_agg")
    events = pytest.importorskip("matplotlib.backend_bases")
    figure = figure_module.Figure()
    backend.FigureCanvasAgg(figure)
    review = batch.Review([folder], folder.parent / "side.toml", "hertz", radius=1e-6)
    board = Board(review, figure)
    at = board.lines["contact"] * 1e9
    events.MouseEvent("button_press_event", figure.canvas, *pixels(board, at), button=1)._process()
    events.MouseEvent("button_release_event", figure.canvas, *pixels(board, at - 3.0), button=1)._process()
    assert review.decision(review.places[0]).contact_point == pytest.approx((at - 3.0) * 1e-9, abs=1e-12)
    events.KeyEvent("key_press_event", figure.canvas, "x")._process()
    assert review.decision(review.places[0]).exclude
    assert board.number == 1
    events.KeyEvent("key_press_event", figure.canvas, "left")._process()
    events.KeyEvent("key_press_event", figure.canvas, "u")._process()
    assert review.decision(review.places[0]) == batch.Decision()


def test_without_a_display_the_terminal_is_named(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    monkeypatch.setattr(pyplot, "get_backend", lambda: "agg")
    with pytest.raises(Error, match="leave out --show"):
        show(batch.Review([folder], folder.parent / "side.toml", "hertz", radius=1e-6))


def test_two_reviews_at_once_keep_each_others_decisions(folder: Path) -> None:
    """Also what an editor writes meanwhile; a sidecar that it breaks is left alone."""
    side = folder.parent / "side.toml"
    one, other = (batch.Review([folder], side, "hertz", radius=1e-6) for _ in range(2))
    one.decide(one.places[0], exclude="no contact")
    other.decide(other.places[1], exclude="jumps")
    one.decide(one.places[2], contact_point=5e-9)
    read = batch.Sidecar.from_toml(side)
    assert [read.of(folder / f"{k}.h5", 0).exclude for k in range(3)] == ["no contact", "jumps", ""]
    side.write_text(broken := "[half\n", encoding="utf-8")
    with pytest.raises(ReadError, match="TOML"):
        one.decide(one.places[0], exclude="")
    assert side.read_text(encoding="utf-8") == broken


def test_a_decision_by_a_short_name_is_changed_and_not_shadowed(folder: Path) -> None:
    side = folder.parent / "side.toml"
    side.write_text('["0.h5"]\nexclude = "by hand"\n\n["1.h5"]\ncontact_point_nm = 100\n', encoding="utf-8")
    review = batch.Review([folder], side, "hertz", radius=1e-6)
    review.decide(review.places[0], exclude="")
    review.decide(review.places[1], contact_point=50e-9)
    read = batch.Sidecar.from_toml(side)
    assert read.of(folder / "0.h5", 0) == batch.Decision()
    assert read.of(folder / "1.h5", 0).contact_point == pytest.approx(50e-9)
    assert list(read.decisions) == ["1.h5"]
    longer = batch.Sidecar({"1.h5": batch.Decision("a"), "gels/1.h5": batch.Decision("b")})
    assert longer.of(folder / "1.h5", 0).exclude == "b"


def test_what_is_said_of_a_whole_map_is_not_undone_for_one_curve(folder: Path) -> None:
    side = folder.parent / "side.toml"
    whole = [curves.read(folder / f"{k}.h5")[0] for k in range(3)]
    curves.write(folder / "map.h5", whole)
    side.write_text('["map.h5"]\nexclude = "drift"\n', encoding="utf-8")
    review = batch.Review([folder / "map.h5"], side, "hertz", radius=1e-6)
    with pytest.raises(InvalidValue, match="says it of all curves of the file"):
        review.decide(review.places[1], exclude="")
    assert batch.Sidecar.from_toml(side).of(folder / "map.h5", 1).exclude == "drift"


def test_a_sidecar_holds_from_every_folder_and_unknown_names_are_told(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    side = folder.parent / "side.toml"
    monkeypatch.chdir(folder)
    review = batch.Review(["../gels"], side, "hertz", radius=1e-6)
    review.decide(review.places[0], exclude="tip crashed")
    text = side.read_text(encoding="utf-8") + '\n["1.h5#7"]\nexclude = "no such curve"\n'
    side.write_text(text, encoding="utf-8")
    line = ["--radius", "1um", "--model", "hertz", "--sidecar", str(side)]
    for number, (place, names) in enumerate(((folder, ["0.h5", "1.h5"]), (folder.parent, ["gels"]))):
        monkeypatch.chdir(place)
        summary = batch.fit_files(names, folder.parent / f"r{number}.csv", "hertz", radius=1e-6, sidecar=side)
        assert summary.rows[0]["status"] == "excluded"
        assert summary.unused == ["1.h5#7"]
    assert main(["report", "gels", *line, "--out", "out"]) == 0
    assert "'1.h5#7' of the sidecar" in capsys.readouterr().out


def test_a_decision_holds_for_the_content_that_was_looked_at(folder: Path) -> None:
    """A file is replaced under its name: fit and review say so, map refuses; a new decision holds again."""
    side, line = folder.parent / "side.toml", {"model": "hertz", "radius": 1e-6}
    review = batch.Review([folder], side, **line)
    review.decide(review.places[0], exclude="no contact", contact_point=5e-9)
    review.decide(review.places[1], exclude="jumps")
    (folder / "2.h5").replace(folder / "0.h5")
    rows = batch.fit_files([folder], folder.parent / "r.csv", sidecar=side, **line).rows
    assert [row["status"] for row in rows] == ["failed", "excluded"]
    assert "made on other content" in rows[0]["reason"]
    again = batch.Review([folder], side, **line)
    assert again.fitted(again.places[0]) == rows[0]["reason"]
    pytest.importorskip("xarray")
    with pytest.raises(InvalidValue, match=r"0\.h5: its decision in the sidecar was made on other content"):
        maps.fit(folder / "0.h5", sidecar=side, **line)
    assert again.decide(again.places[0], exclude="jumps").contact_point is None  # that was of the other file
    rows = batch.fit_files([folder], folder.parent / "s.csv", sidecar=side, **line).rows
    assert [row["reason"] for row in rows] == ["jumps", "jumps"]
    assert maps.fit(folder / "0.h5", sidecar=side, **line).reason.item() == "excluded: jumps"
    again.decide(again.places[0], exclude="")
    assert len(batch.Sidecar.from_toml(side).decisions) == 1
