# SPDX-License-Identifier: BSD-3-Clause
"""Fit every curve of many files: see :func:`fit_files`."""

from __future__ import annotations

import glob
import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import nanotouch

from .._io import series
from .._io.digest import file_digest
from .._io.words import counted, printable
from .._io.writing import replacing
from ..curves import CalibrationTable, asylum_pair, read
from ..errors import Error, InvalidValue
from ..fit import FitResult, TipLike, fit_curve
from .groups import Spread, label_by, spreads, without_files
from .journal import Journal
from .sidecar import Sidecar
from .table import Row, by_hand, row_of, row_without
from .table import write as write_table

STATUSES = ("ok", "undetermined", "misfit", "not converged", "excluded", "failed")
WITHOUT = ("excluded", "failed")
SHOWN = 120  # points of a curve that are kept for its small picture


@dataclass(frozen=True)
class Summary:
    """What came of a run.

    Attributes
    ----------
    rows : list of dict
        All columns; ``row["status"]`` is that of the fit (``"ok"``, ``"undetermined"``, ``"misfit"``, ``"not
        converged"``), ``"excluded"`` or ``"failed"``.
    pictures : list of dict
        For each fitted curve its name and some of its points, for :func:`nanotouch.batch.sheet.draw`.
    reused : int
        Files whose results an earlier run had left.
    unused : list of str
        Names in sidecar, calibration table and table of groups that are those of no file.
    """

    rows: list[Row]
    pictures: list[dict[str, Any]]
    reused: int
    unused: list[str]

    @property
    def spreads(self) -> list[Spread]:
        """What the values of each group come to."""
        return spreads(self.rows)

    @property
    def fitted(self) -> int:
        """Curves that have a fit."""
        return sum(row["status"] not in WITHOUT for row in self.rows)

    def count(self, status: str) -> int:
        """Rows of a status."""
        return sum(row["status"] == status for row in self.rows)

    def __str__(self) -> str:
        found = {status: self.count(status) for status in STATUSES}
        counts = ", ".join(f"{number} {status}" for status, number in found.items() if number or status == "ok")
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
    model: str = "auto",
    *,
    tip: TipLike | None = None,
    sidecar: str | os.PathLike[str] | None = None,
    reading: Mapping[str, Any] | None = None,
    progress: Callable[[float], None] | None = None,
    groups: str | os.PathLike[str] | None = None,
    long: bool = False,
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
    groups : "folder" or path, optional
        Which curves belong together: those of a folder, or a CSV table ``file,group`` of patterns.
    long : bool
        All columns, in place of the fifteen that answer (:data:`nanotouch.batch.table.SHORT`).
    """
    reading = dict(reading or {})
    out = Path(out)
    files = _without(files_of(names), (*_own(out), *_given(sidecar, groups, reading)))
    label = label_by(groups, files)
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
    with series.of(files):
        for number, file in enumerate(files):
            sha256 = _digest(file)
            key = {"sha256": sha256, "decisions": _decisions(decided, file)}
            known = journal.entries.get(str(file))
            if known is not None and all(known[name] == json.loads(json.dumps(value)) for name, value in key.items()):
                reused += 1
            else:
                rows, pictures = _fitted((file, sha256), decided, reading, {"model": model, "tip": tip} | settings)
                journal.add({"file": str(file), **key, "rows": rows, "pictures": pictures})
            if progress:
                progress((number + 1) / len(files))
    entries = [journal.entries[str(file)] for file in files]
    rows = [
        row | {"group": label(Path(row["file"])), "sha256": entry["sha256"]}
        for entry in entries
        for row in entry["rows"]
    ]
    write_table(out, rows, long=long)
    _write_json(_beside(out, "json"), made_of | {
        "numpy": np.__version__,
        "sidecar": {name: asdict(decision) for name, decision in decided.decisions.items()},
        "files": {entry["file"]: entry["sha256"] for entry in entries},
    })  # fmt: skip
    return Summary(
        rows,
        [p for entry in entries for p in entry["pictures"]],
        reused,
        _undone(decided, files, rows) + _unused(reading, files) + without_files(groups, files),
    )


def _without(files: list[Path], others: tuple[Path, ...]) -> list[Path]:
    """The curves among the files; of a pair of files the one that stands for both."""
    known = {path.resolve() for path in others}
    curves = [file for file in files if file.resolve() not in known and not asylum_pair.holds_heights(file)]
    if not curves:
        raise InvalidValue(f"{', '.join(map(str, files))}: the run's own files, and no curve")
    return curves


def _own(out: Path) -> tuple[Path, ...]:
    """What a run leaves itself, which is no force curve."""
    sheets = out.parent.glob(f"{glob.escape(out.stem)}-[0-9][0-9].png")
    more = (out.with_name(f"{out.stem}-{of}.{end}") for of in ("stability", "ruptures") for end in ("csv", "png"))
    return (out, _beside(out, "json"), _beside(out, "journal"), *more, *sheets)


def _given(
    sidecar: str | os.PathLike[str] | None, groups: str | os.PathLike[str] | None, reading: Mapping[str, Any]
) -> list[Path]:
    """Tables that a run is given, which may lie among the curves."""
    return [Path(file) for file in (sidecar, groups, reading.get("calibration")) if isinstance(file, str | os.PathLike)]


def _undone(decided: Sidecar, files: list[Path], rows: Sequence[Row]) -> list[str]:
    """Names in the sidecar of no file, or of no curve that its file holds."""
    unknown = decided.unused(files)
    curves = {decided.named(Path(row["file"]), row["curve"])[0] for row in rows if row["curve"] != ""}
    read_files = [Path(row["file"]) for row in rows if row["curve"] != ""]
    return unknown + [
        name for name, decision in decided.decisions.items()
        if name not in unknown and name not in curves and name.rpartition("#")[2].isdigit()
        and not Sidecar({name: decision}).unused(read_files)
    ]  # fmt: skip


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
    found: tuple[Path, str], decided: Sidecar, reading: Mapping[str, Any], settings: Mapping[str, Any]
) -> tuple[list[Row], list[dict[str, Any]]]:
    """Rows and small pictures of the curves of a file and hash; a file or curve that fails is a row that says why."""
    file, sha256 = found
    whole = decided.of(file, -1)
    if whole.exclude and not whole.outdated(sha256):
        return [row_without(file, None, "excluded", whole.exclude)], []
    try:
        curves = read(file, **reading)
    except Exception as error:
        return [row_without(file, None, "failed", _said(error))], []
    rows, pictures, name = [], [], printable(file.name)
    for index, curve in enumerate(curves):
        decision = decided.of(file, index)
        if outdated := decision.outdated(sha256):
            rows.append(row_without(file, index, "failed", outdated))
            continue
        if decision.exclude:
            rows.append(row_without(file, index, "excluded", decision.exclude))
            continue
        try:
            result = fit_curve(curve, **(dict(settings) | by_hand(decision)))
        except Exception as error:
            rows.append(row_without(file, index, "failed", _said(error)))
            continue
        rows.append(row_of(file, index, result, decision))
        pictures.append(_picture(name if len(curves) == 1 else f"{name}#{index}", result))
    return rows, pictures


def _said(error: Exception) -> str:
    """Ours are sentences; of others the kind is named, as nobody expected them."""
    return str(error) if isinstance(error, Error) else f"{type(error).__name__}: {error}"


def _picture(name: str, result: FitResult) -> dict[str, Any]:
    part = np.unique(np.linspace(0, result.z.size - 1, SHOWN).astype(int))
    columns = {"z": result.z, "force": result.force, "fitted": result.fitted}
    shown = {key: [float(f"{value:.5g}") for value in values[part]] for key, values in columns.items()}
    text = result.show("effective_modulus")
    if result.status in ("misfit", "not converged"):
        text = f"{result.status}: {text}"
    return {"name": name, "text": text, "good": result.status == "ok", **shown}


def _write_json(path: Path, data: Mapping[str, Any]) -> None:
    with replacing(path) as part:
        part.write_text(json.dumps(data, indent=2, default=str) + "\n", encoding="utf-8")
