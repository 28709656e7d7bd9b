# SPDX-License-Identifier: BSD-3-Clause
"""Many files: one row for each curve, whatever some files are like; a repeated run goes on; decisions by hand hold."""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path
from typing import Any

import nanotouch as nt
import pytest
from synthetic import known_curve, write_ibw_curve

pytest.importorskip("nanotouch._fit", reason="built without Ceres")
pytest.importorskip("afmformats")

from nanotouch import batch

RADIUS = {"radius": 30e-9}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Two good files, one damaged, one of another kind."""
    made = tmp_path / "day1"
    made.mkdir()
    write_ibw_curve(made / "a.ibw", known_curve())
    write_ibw_curve(made / "b.ibw", known_curve())
    (made / "cut.ibw").write_bytes((made / "a.ibw").read_bytes()[:1000])
    (made / "notes.md").write_text("a good day")
    return made


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def test_one_row_for_each_curve_and_bad_files_do_not_stop_it(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "results.csv"
    summary = batch.fit_files([folder], out, "jkr", long=True, **RADIUS)
    rows = rows_of(out)
    assert [(Path(row["file"]).name, row["status"]) for row in rows] == [
        ("a.ibw", "undetermined"), ("b.ibw", "undetermined"),
        ("cut.ibw", "failed"), ("notes.md", "failed")]  # fmt: skip
    assert summary.fitted == summary.count("failed") == 2
    assert "cut.ibw" in rows[2]["reason"]
    one = nt.fit.fit_curve(nt.curves.read(folder / "a.ibw")[0], "jkr", **RADIUS)
    assert float(rows[0]["work_of_adhesion [J/m^2]"]) == one.values["work_of_adhesion"]
    assert float(rows[0]["work_of_adhesion sigma [J/m^2]"]) == one.sigma["work_of_adhesion"]
    assert float(rows[0]["contact_point sigma calibration [m]"]) == one.sigma_calibration["contact_point"]
    assert bool(int(rows[0]["effective_modulus determined"])) == one.identifiable["effective_modulus"]
    assert rows[0]["notes"] == "; ".join(one.notes)
    stored = json.loads((tmp_path / "results.csv.json").read_text())
    assert stored["settings"]["radius"] == 30e-9
    assert stored["version"] == nt.__version__
    assert stored["files"][str(folder / "a.ibw")] == rows[0]["sha256"] != ""


def test_a_repeated_run_redoes_what_has_changed_only(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "results.csv"
    first = batch.fit_files([folder], out, "jkr", **RADIUS)
    write_ibw_curve(folder / "b.ibw", known_curve(seed=2))
    fitted: list[str] = []
    fit_curve = nt.fit.fit_curve
    monkeypatch.setattr("nanotouch.batch.files.fit_curve", lambda c, **k: fitted.append(c.name) or fit_curve(c, **k))
    second = batch.fit_files([folder], out, "jkr", **RADIUS)
    assert fitted == ["b.ibw"]
    assert second.reused == 3
    assert second.rows[0] == first.rows[0]
    assert second.rows[1] != first.rows[1]


def test_a_run_that_was_killed_in_a_line_goes_on(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "results.csv"
    whole = batch.fit_files([folder], out, "jkr", **RADIUS)
    table, journal = out.read_bytes(), tmp_path / "results.csv.journal"
    lines = journal.read_bytes().splitlines(keepends=True)
    journal.write_bytes(b"".join(lines[:2]) + lines[2][: len(lines[2]) // 2])
    out.unlink()
    again = batch.fit_files([folder], out, "jkr", **RADIUS)
    assert again.reused == 1
    assert again.rows == whole.rows
    assert out.read_bytes() == table


def test_other_settings_are_refused(folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "results.csv"
    batch.fit_files([folder / "a.ibw"], out, "jkr", uncertainties=nt.fit.Uncertainties(radius=0.1), **RADIUS)
    with pytest.raises(nt.errors.InvalidValue, match="settings"):
        batch.fit_files([folder / "a.ibw"], out, "dmt", **RADIUS)


def test_decisions_by_hand(folder: Path, tmp_path: Path) -> None:
    sidecar = tmp_path / "day1.toml"
    curve = nt.curves.read(folder / "b.ibw")[0]
    report = nt.curves.analyse(curve)
    far = float(curve.retract.z.max())  # type: ignore[union-attr]
    contact = report.contact_point
    sidecar.write_text(
        f'["a.ibw"]\nexclude = "tip crashed"\n["day1/b.ibw"]\ncontact_point_nm = {contact * 1e9!r}\n'
        f'baseline_nm = [{(far - 100e-9) * 1e9!r}, {far * 1e9!r}]\n["c.ibw"]\nexclude = "never measured"\n'
    )
    out = tmp_path / "results.csv"
    summary = batch.fit_files([folder], out, "jkr", sidecar=sidecar, long=True, **RADIUS)
    first, second = rows_of(out)[:2]
    assert (first["status"], first["reason"]) == ("excluded", "tip crashed")
    assert float(second["contact_point [m]"]) == pytest.approx(contact, abs=1e-15)
    assert float(second["contact_point sigma [m]"]) == 0.0
    assert second["by hand"] == "baseline, contact_point"
    assert summary.unused == ["c.ibw"]
    sidecar.write_text('["a.ibw"]\nexclude = "tip crashed"\n')  # the decision on b is taken back: b alone is redone
    again = batch.fit_files([folder], out, "jkr", sidecar=sidecar, **RADIUS)
    assert again.reused == 3
    assert again.rows[1]["by hand"] == ""


def test_one_curve_of_a_map(tmp_path: Path) -> None:
    sidecar = batch.Sidecar.from_toml(write(tmp_path / "s.toml", '["m.jpk-force-map#3"]\nexclude = "no contact"\n'))
    assert sidecar.of(Path("x/m.jpk-force-map"), 3).exclude == "no contact"
    assert sidecar.of(Path("x/m.jpk-force-map"), 2).exclude == ""
    assert sidecar.of(Path("x/xm.jpk-force-map"), 3).exclude == ""


def write(path: Path, text: str) -> Path:
    path.write_text(text)
    return path


@pytest.mark.parametrize(("text", "message"), [
    ("[a", "is not a TOML file"),
    ('["a"]\nexlude = "x"\n', "expected one or more of"),
    ('["a"]\nexclude = ""\n', "reason in words"),
    ('["a"]\ncontact_point_nm = "3"\n', "contact_point_nm"),
    ('["a"]\ncontact_point_nm = nan\n', "contact_point_nm"),
    ('["a"]\nbaseline_nm = [3.0, 2.0]\n', "two numbers that grow"),
    ('["a"]\nsha256 = "%s"\n' % ("0" * 64), "expected one or more of"),
    ('["a"]\nexclude = "x"\nsha256 = "0abc"\n', "64 hexadecimal digits"),
    ('a = 3\n', "expected one or more of"),
])  # fmt: skip
def test_a_wrong_sidecar_is_refused_in_one_sentence(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(nt.errors.ReadError, match=message):
        batch.Sidecar.from_toml(write(tmp_path / "s.toml", text))


def test_names_stand_for_files(folder: Path) -> None:
    found = batch.files_of([folder / "a.ibw", folder, str(folder / "*.ibw")])
    assert [file.name for file in found] == ["a.ibw", "b.ibw", "cut.ibw", "notes.md"]
    with pytest.raises(nt.errors.InvalidValue, match=r"nothing\*"):
        batch.files_of([folder / "nothing*"])


def test_contact_sheets(folder: Path, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib")
    from nanotouch.batch import sheet

    summary = batch.fit_files([folder], tmp_path / "results.csv", "jkr", **RADIUS)
    written = sheet.draw(summary.pictures * 16, tmp_path, "fits")
    assert [path.name for path in written] == ["fits-01.png", "fits-02.png"]
    full, two = (path.stat().st_size for path in written)
    assert full > 20_000
    assert two > 10_000  # one row of a sheet


def test_the_calibration_table_reaches_every_file(folder: Path, tmp_path: Path) -> None:
    table = write(tmp_path / "table.csv", "file,spring_constant,sensitivity\nb.*,2N/m,\nmisspelt*,3N/m,\n")
    summary = batch.fit_files([folder], tmp_path / "r.csv", "jkr", reading={"calibration": table}, **RADIUS)
    assert summary.rows[0]["spring_constant [N/m]"] != 2.0
    assert summary.rows[1]["spring_constant [N/m]"] == 2.0
    assert summary.unused == ["misspelt*"]


def test_the_command(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    main: Any = pytest.importorskip("nanotouch_app.main").main
    out = tmp_path / "out" / "results.csv"
    assert main(["fit", str(folder), "--model", "jkr", "--radius", "30nm", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "4 curves: 0 ok, 2 undetermined, 2 failed" in said
    assert "notes.md" in said
    assert sorted(path.name for path in out.parent.iterdir()) == [
        "results-01.png", "results.csv", "results.csv.journal", "results.csv.json"]  # fmt: skip
    assert main(["fit", str(folder), "--out", str(tmp_path)]) == 2
    assert "results.csv" in capsys.readouterr().err


NAMES = [
    b"a\xff.ibw",
    b"new\nline.ibw",
    b'comma, "quote".ibw',
    "Größe µm 漢字.ibw".encode(),
    b"$a$\\b$.ibw",
    b"=SUM(A1).ibw",
]


@pytest.mark.skipif(os.name != "posix", reason="other systems do not have such names")
@pytest.mark.usefixtures("undrawn")
def test_any_name_a_file_can_have(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Bytes that are no UTF-8, line ends, formulas of matplotlib: a row, a picture and a line of text for each."""
    pytest.importorskip("matplotlib")
    main: Any = pytest.importorskip("nanotouch_app.main").main
    folder = tmp_path / "names"
    folder.mkdir()
    write_ibw_curve(tmp_path / "a.ibw", known_curve())
    for name in NAMES:
        (folder / os.fsdecode(name)).write_bytes((tmp_path / "a.ibw").read_bytes())
    (folder / os.fsdecode(b"cut\xff.ibw")).write_bytes(b"short")
    out = tmp_path / "results.csv"
    for _ in range(2):  # the second reads the journal
        assert main(["fit", str(folder), "--model", "jkr", "--radius", "30nm", "--out", str(out)]) == 0
        assert "7 curves: 0 ok, 6 undetermined, 1 failed" in capsys.readouterr().out
    found = {Path(row["file"]).name for row in rows_of(out)}
    written = [os.fsdecode(name).encode("utf-8", "backslashreplace").decode() for name in [*NAMES, b"cut\xff.ibw"]]
    assert found == set(written)
    one = str(folder / os.fsdecode(NAMES[0]))
    assert main(["fit", one, "--model", "jkr", "--radius", "30nm", "--out", str(tmp_path / "one")]) == 0


def test_what_a_run_is_given_is_no_curve(folder: Path) -> None:
    """Table, sidecar and the results themselves may lie among the curves; names with brackets are names."""
    table = write(folder / "table.csv", "file,spring_constant,sensitivity\nb.*,2N/m,\n")
    sidecar = write(folder / "day.toml", '["cut.ibw"]\nexclude = "cut off"\n')
    for _ in range(2):
        summary = batch.fit_files(
            [folder], folder / "r[1].csv", "jkr", sidecar=sidecar, reading={"calibration": str(table)}, **RADIUS
        )
        (folder / "r[1]-01.png").write_bytes(b"a sheet")
        assert [Path(row["file"]).name for row in summary.rows] == ["a.ibw", "b.ibw", "cut.ibw", "notes.md"]
    with pytest.raises(nt.errors.InvalidValue, match="no curve"):
        batch.fit_files([table], folder / "other.csv", reading={"calibration": str(table)})


def test_many_failures_are_counted(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main: Any = pytest.importorskip("nanotouch_app.main").main
    for number in range(23):
        (tmp_path / f"{number:02d}.ibw").write_bytes(b"no wave")
    assert main(["fit", str(tmp_path), "--out", str(tmp_path / "results.csv")]) == 1
    assert "and 3 more in the table" in capsys.readouterr().out
