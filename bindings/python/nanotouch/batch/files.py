# SPDX-License-Identifier: BSD-3-Clause
"""Fit every curve of many files: see :func:`fit_files`."""

from __future__ import annotations

import csv
import glob
import json
import os
from collections.abc import Callable, Iterable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import nanotouch

from .._digest import file_digest
from .._words import counted, printable
from .._writing import replacing
from ..contact import Model
from ..curves import CalibrationTable, read
from ..errors import Error, InvalidValue
from ..fit import FitResult, TipLike, fit_curve
from .journal import Journal
from .sidecar import Decision, Sidecar

SHOWN = 120  # points of a curve that are kept for its small picture
_PLAIN = {
    "pull_off_force": "N", "residual_rms": "N", "misfit": "", "contact_radius": "m", "contact_stiffness": "N/m",
    "radius": "m", "spring_constant": "N/m",
}  # fmt: skip
_READ_OFF = {"pull_off_force": "N", "snap_in_force": "N", "adhesion_work": "J", "contact_slope": "N/m"}

Row = dict[str, Any]


@dataclass(frozen=True)
class Summary:
    """What came of a run.

    Attributes
    ----------
    rows : list of dict
        As in the CSV file; ``row["status"]`` is ``"ok"``, ``"excluded"`` or ``"failed"``.
    pictures : list of dict
        For each fitted curve its name and some of its points, for :func:`nanotouch.batch.sheet.draw`.
    reused : int
        Files whose results an earlier run had left.
    unused : list of str
        Names in sidecar and calibration table that are those of no file.
    """

    rows: list[Row]
    pictures: list[dict[str, Any]]
    reused: int
    unused: list[str]

    def count(self, status: str) -> int:
        """Rows of a status."""
        return sum(row["status"] == status for row in self.rows)

    def __str__(self) -> str:
        counts = ", ".join(f"{self.count(status)} {status}" for status in ("ok", "excluded", "failed"))
        reused = f"; {counted(self.reused, 'file')} from an earlier run" if self.reused else ""
        return f"{counted(len(self.rows), 'curve')}: {counts}{reused}"


def files_of(names: Iterable[str | os.PathLike[str]]) -> list[Path]:
    """The files of folders and patterns, sorted, each once; InvalidValue where a name stands for none."""
    found: dict[Path, None] = {}
    for name in (os.fspath(name) for name in names):
        path = Path(name)
        matches = path.iterdir() if path.is_dir() else [path] if path.exists() else glob.glob(name, recursive=True)
        here = [file for file in sorted(map(Path, matches)) if file.is_file() and not file.name.startswith(".")]
        if not here:
            raise InvalidValue(f"{name}: no file, no folder with files, no pattern of files")
        found |= dict.fromkeys(here)
    return list(found)


def fit_files(
    names: Iterable[str | os.PathLike[str]],
    out: str | os.PathLike[str],
    model: Model = "maugis",
    *,
    tip: TipLike | None = None,
    sidecar: str | os.PathLike[str] | None = None,
    reading: Mapping[str, Any] | None = None,
    progress: Callable[[float], None] | None = None,
    **settings: Any,
) -> Summary:
    """Fit every curve of every file, and write one row for each.

    Parameters
    ----------
    names : iterable of path
        Files, folders and patterns.
    out : path
        CSV file of the results. ``<out>.json`` beside it holds settings, versions, hashes of the files and what the
        sidecar said; ``<out>.journal`` what is finished. A later run with the same settings takes from there the files
        that have not changed (nor what the sidecar says of them); other settings are refused.
    model, tip, **settings
        As for :func:`nanotouch.fit.fit_curve`.
    sidecar : path, optional
        Exclusions, contact points and baselines by hand: :mod:`nanotouch.batch.sidecar`.
    reading : mapping, optional
        Arguments of :func:`nanotouch.curves.read`: ``spring_constant``, ``sensitivity``, ``calibration``, ...
    progress : callable, optional
        Called with the fraction done.
    """
    reading = dict(reading or {})
    out = Path(out)
    files = _without(files_of(names), (*_own(out), *_given(sidecar, reading)))
    if isinstance(reading.get("calibration"), str | os.PathLike):
        reading["calibration"] = CalibrationTable.from_csv(reading["calibration"])
    decided = Sidecar() if sidecar is None else Sidecar.from_toml(sidecar)
    made_of = {
        "version": nanotouch.__version__,
        "settings": {"model": model, "tip": None if tip is None else str(tip)} | settings,
        "reading": {key: _plain(value) for key, value in reading.items()},
    }
    journal = Journal(_beside(out, "journal"), made_of)
    reused = 0
    for number, file in enumerate(files):
        key = {"sha256": _digest(file), "decisions": _decisions(decided, file)}
        known = journal.entries.get(str(file))
        if known is not None and all(known[name] == json.loads(json.dumps(value)) for name, value in key.items()):
            reused += 1
        else:
            rows, pictures = _fitted(file, decided, reading, {"model": model, "tip": tip} | settings)
            journal.add({"file": str(file), **key, "rows": rows, "pictures": pictures})
        if progress:
            progress((number + 1) / len(files))
    entries = [journal.entries[str(file)] for file in files]
    rows = [row | {"sha256": entry["sha256"]} for entry in entries for row in entry["rows"]]
    _write_csv(out, rows)
    _write_json(_beside(out, "json"), made_of | {
        "numpy": np.__version__,
        "sidecar": {name: asdict(decision) for name, decision in decided.decisions.items()},
        "files": {entry["file"]: entry["sha256"] for entry in entries},
    })  # fmt: skip
    return Summary(
        rows,
        [p for entry in entries for p in entry["pictures"]],
        reused,
        decided.unused(files) + _unused(reading, files),
    )


def _without(files: list[Path], others: tuple[Path, ...]) -> list[Path]:
    """The curves among the files."""
    known = {path.resolve() for path in others}
    curves = [file for file in files if file.resolve() not in known]
    if not curves:
        raise InvalidValue(f"{', '.join(map(str, files))}: the run's own files, and no curve")
    return curves


def _own(out: Path) -> tuple[Path, ...]:
    """What a run leaves itself, which is no force curve."""
    sheets = out.parent.glob(f"{glob.escape(out.stem)}-[0-9][0-9].png")
    return (out, _beside(out, "json"), _beside(out, "journal"), *sheets)


def _given(sidecar: str | os.PathLike[str] | None, reading: Mapping[str, Any]) -> list[Path]:
    """Tables that a run is given, which may lie among the curves."""
    return [Path(file) for file in (sidecar, reading.get("calibration")) if isinstance(file, str | os.PathLike)]


def _unused(reading: Mapping[str, Any], files: list[Path]) -> list[str]:
    table = reading.get("calibration")
    return table.unused(files) if isinstance(table, CalibrationTable) else []


def _beside(out: Path, ending: str) -> Path:
    return out.with_name(f"{out.name}.{ending}")


def _plain(value: Any) -> Any:
    return value if value is None or isinstance(value, int | float | str) else str(value)


def _digest(file: Path) -> str:
    """Empty where the file cannot be read at all: its row says why."""
    try:
        return file_digest(file)
    except OSError:
        return ""


def _decisions(decided: Sidecar, file: Path) -> dict[str, Any]:
    """All that the sidecar says of a file and of its curves."""
    return {
        name: asdict(decision) for name, decision in decided.decisions.items()
        if not Sidecar({name: decision}).unused([file])
    }  # fmt: skip


def _fitted(
    file: Path, decided: Sidecar, reading: Mapping[str, Any], settings: Mapping[str, Any]
) -> tuple[list[Row], list[dict[str, Any]]]:
    """Rows and small pictures of the curves of a file; a file or curve that fails is a row that says why."""
    whole = decided.of(file, -1)
    if whole.exclude:
        return [_row_without(file, None, "excluded", whole.exclude)], []
    try:
        curves = read(file, **reading)
    except Exception as error:
        return [_row_without(file, None, "failed", _said(error))], []
    rows, pictures, name = [], [], printable(file.name)
    for index, curve in enumerate(curves):
        decision = decided.of(file, index)
        if decision.exclude:
            rows.append(_row_without(file, index, "excluded", decision.exclude))
            continue
        try:
            result = fit_curve(curve, **(dict(settings) | _by_hand(decision)))
        except Exception as error:
            rows.append(_row_without(file, index, "failed", _said(error)))
            continue
        rows.append(_row(file, index, result, decision))
        pictures.append(_picture(name if len(curves) == 1 else f"{name}#{index}", result))
    return rows, pictures


def _said(error: Exception) -> str:
    """Ours are sentences; of others the kind is named, as nobody expected them."""
    return str(error) if isinstance(error, Error) else f"{type(error).__name__}: {error}"


def _by_hand(decision: Decision) -> dict[str, Any]:
    given = {"contact_point": decision.contact_point, "baseline": decision.baseline}
    return {key: value for key, value in given.items() if value is not None}


def _row_without(file: Path, index: int | None, status: str, reason: str) -> Row:
    return {"file": str(file), "curve": "" if index is None else index, "status": status, "reason": reason}


def _row(file: Path, index: int, result: FitResult, decision: Decision) -> Row:
    row: Row = {"file": str(file), "curve": index, "status": "ok", "reason": ""}
    row |= {"model": result.model, "branch": result.branch, "points": int(result.z.size)}
    for name, value in result.values.items():
        unit = result.units[name]
        row |= {_headed(name, unit): value, _headed(f"{name} sigma", unit): result.sigma[name]}
        row[_headed(f"{name} sigma statistical", unit)] = result.sigma_statistical[name]
        row[_headed(f"{name} sigma calibration", unit)] = result.sigma_calibration[name]
        if name in result.identifiable:
            row[f"{name} determined"] = int(result.identifiable[name])
    for name, unit in _READ_OFF.items():
        row[_headed(f"measured {name}", unit)] = getattr(result.report, name)
        row[_headed(f"measured {name} sigma", unit)] = result.report.sigma[name]
    row |= {_headed(name, unit): getattr(result, name) for name, unit in _PLAIN.items()}
    row |= {"noise [N]": result.report.noise, "converged": int(result.converged)}
    by_hand = ", ".join(sorted(_by_hand(decision)))
    return row | {"by hand": by_hand, "notes": "; ".join(result.notes), "assumptions": "; ".join(result.assumptions)}


def _headed(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def _picture(name: str, result: FitResult) -> dict[str, Any]:
    part = np.unique(np.linspace(0, result.z.size - 1, SHOWN).astype(int))
    columns = {"z": result.z, "force": result.force, "fitted": result.fitted}
    shown = {key: [float(f"{value:.5g}") for value in values[part]] for key, values in columns.items()}
    good = all(result.identifiable.values())
    return {"name": name, "text": result.show("effective_modulus"), "good": good, **shown}


def _write_csv(path: Path, rows: list[Row]) -> None:
    names = list(dict.fromkeys(key for row in rows for key in row))
    # file names may hold bytes that are no UTF-8
    with replacing(path) as part, part.open("w", encoding="utf-8", errors="backslashreplace", newline="") as stream:
        writer = csv.DictWriter(stream, names, restval="")
        writer.writeheader()
        writer.writerows(rows)


def _write_json(path: Path, data: Mapping[str, Any]) -> None:
    with replacing(path) as part:
        part.write_text(json.dumps(data, indent=2, default=str) + "\n", encoding="utf-8")
