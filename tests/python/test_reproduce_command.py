# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch reproduce`` from end to end, and its page in the documentation."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import pytest
import reproduced
from nanotouch_app.main import main
from nanotouch_app.studies import reproduce
from nanotouch_app.studies.reproduce.statement import quantity

pytest.importorskip("matplotlib")

DOCS = Path(__file__).resolve().parents[2] / "docs" / "evidence" / "reproduction.md"


@pytest.fixture(autouse=True)
def _computed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reproduce, "reproduction", reproduced.reproduction)


def read(path: Path) -> tuple[list[str], list[list[float]]]:
    with path.open(encoding="utf-8") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    return rows[0], [[float(cell) for cell in row] for row in rows[1:]]


def test_command_leaves_pictures_tables_and_statements(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["reproduce", "--out", str(tmp_path)]) == 0
    names = [f"fig{number}.{kind}" for number in reproduce.FIGURES for kind in ("csv", "png")]
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted([*names, "statements.json"])
    for number in reproduce.FIGURES:
        assert (tmp_path / f"fig{number}.png").stat().st_size > 50_000
        headers, rows = read(tmp_path / f"fig{number}.csv")
        assert all(header.endswith("]") and " [" in header for header in headers)
        assert len(rows) > 1000
    written: dict[str, Any] = json.loads((tmp_path / "statements.json").read_text())
    assert list(written) == [f"fig{number}" for number in reproduce.FIGURES]
    said = capsys.readouterr().out
    for figure in written.values():
        assert all(parameter["source"] for parameter in figure["parameters"])
        for entry in figure["statements"]:
            assert entry["verdict"] in ("holds", "does not hold", "cannot be compared")
            assert math.isfinite(entry["number"])
            assert f"{entry['verdict'].upper()}: {entry['statement']}" in said


def test_one_figure(tmp_path: Path) -> None:
    assert main(["reproduce", "--figure", "6", "--out", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["fig6.csv", "fig6.png", "statements.json"]
    headers, rows = read(tmp_path / "fig6.csv")
    row = min(rows, key=lambda values: abs(values[0] - 1e-9))
    assert row[headers.index("corrected capillary force [N]")] == pytest.approx(-27.14e-9, rel=1e-3)


@pytest.mark.parametrize("arguments", [["--figure", "7"], ["--figure", "6", "20"], ["--out", "{file}"]])
def test_one_sentence_and_nothing_written(
    arguments: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "file"
    file.touch()
    given = [argument.replace("{file}", str(file)) for argument in arguments]
    assert main(["reproduce", *given, *([] if "--out" in given else ["--out", str(tmp_path / "out")])]) == 2
    error = capsys.readouterr().err
    assert error.startswith("nanotouch reproduce: ")
    assert error.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_page_says_what_the_command_says() -> None:
    page = DOCS.read_text(encoding="utf-8")
    for number in reproduce.FIGURES:
        for entry in reproduce.reproduction(number).statements:
            assert (
                f"| {entry.statement} | {entry.verdict} | {entry.quantity}: {quantity(entry.number, entry.unit)} |"
                in page
            )
