# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch fit`` for folders, patterns and several files: one row for each curve, and contact sheets."""

from __future__ import annotations

import argparse
import glob
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nanotouch import batch
from nanotouch.awaiting import awaited
from nanotouch.batch import methods, sheet
from nanotouch.batch.journal import finished
from nanotouch.errors import InvalidValue

from nanotouch_app.common import output, stop
from nanotouch_app.common.quantity import parse_quantity


def is_meant(args: argparse.Namespace) -> bool:
    """Whether the names stand for more than one file, or a table is asked for."""
    name = args.curve[0]
    pattern = glob.has_magic(name) and not Path(name).exists()
    return len(args.curve) > 1 or Path(args.out or "").suffix == ".csv" or Path(name).is_dir() or pattern


def run(args: argparse.Namespace, reading: dict[str, Any], knowledge: dict[str, Any]) -> int:
    """Fit all, write table and sheets; the status is 1 where not a single curve was fitted. A table with a journal is
    gone on with (:func:`nanotouch.batch.fit_files`).

    `reading` and `knowledge` are the arguments of :func:`nanotouch.curves.read` and :func:`nanotouch.fit.fit_curve`.
    """
    if Path(args.out or "").suffix != ".csv":
        raise InvalidValue("for many curves --out names a table, as --out results.csv")
    if args.index:
        raise InvalidValue("--index picks a curve of one file; a table has them all")
    out = Path(args.out)
    if not out.with_name(f"{out.name}.journal").exists():
        output.check_free(out, args)
    with output.made(out.parent) as folder:
        summary = fitted("fit", out, out, lambda progress: batch.fit_files(
            args.curve, out, args.model, sidecar=args.sidecar, reading=reading, progress=progress,
            branch=args.branch, groups=args.groups, long=args.long, **knowledge,
        ))  # fmt: skip
        with stop.keeping("the table is kept", out):
            sheets = sheet.draw(summary.pictures, folder, out.stem)
            depths = _stabilities(args, summary, out, reading, knowledge) if args.stability else []
            depths += _pulls(args, summary, out, reading, knowledge)
    args.answer = {"table": str(out), "fitted": summary.count("ok"), "curves": summary.rows}
    print(summary)
    for found in summary.spreads:
        print(f"  {found}")
    print(f"  {methods.modulus_meant(knowledge)}")
    _tell_without(summary.rows)
    for name in summary.unused:
        print(f"  note: {name!r} of the sidecar or a table is no file or curve here, or an earlier line has it")
    drawn = len(sheets) * sheet.ACROSS * sheet.DOWN
    if drawn < len(summary.pictures):
        print(f"  note: the sheets show the first {drawn} of {len(summary.pictures)} fits")
    written = (out.name, f"{out.name}.json", *(path.name for path in (*depths, *sheets)))
    print(f"written to {folder}/: {', '.join(written)}")
    return 0 if summary.fitted else 1


def fitted(
    title: str, out: Path, place: Path, fit: Callable[[Callable[[float], None]], batch.Summary]
) -> batch.Summary:
    """The fits of a table, under a bar. A signal ends them; what is finished is in the journal, from which a run with
    this `place` for its results goes on."""
    try:
        with output.progress_bar(title) as progress:
            return fit(progress)  # in this thread: a fit takes milliseconds, and the guard forks at once
    except stop.Stopped as stopped:
        journal = out.with_name(f"{out.name}.journal")
        files = finished(journal)
        if not files:
            journal.unlink(missing_ok=True)
            raise stop.Stopped(stopped.number, "no file was finished: nothing is kept") from None
        kept = f"{files} {'file is' if files == 1 else 'files are'} kept in {journal}"
        raise stop.Stopped(stopped.number, f"{kept}: --out {place} goes on from there") from None


def _stabilities(
    args: argparse.Namespace, summary: batch.Summary, out: Path, reading: dict[str, Any], knowledge: dict[str, Any]
) -> list[Path]:
    """E(delta) of all fitted curves, as a table and a picture."""
    files = [out.with_name(f"{out.stem}-stability.{ending}") for ending in ("csv", "png")]
    with output.progress_bar("stability") as progress:
        found = awaited(lambda: batch.stabilities(
            summary, sidecar=args.sidecar, reading=reading, progress=progress, **knowledge
        ))  # fmt: skip
    found.to_csv(files[0])
    found.draw(save=files[1])
    print(found)
    if found.without:
        print(f"  {len(found.without)} without: {found.without[0][2]}")
    return files


def _pulls(
    args: argparse.Namespace, summary: batch.Summary, out: Path, reading: dict[str, Any], knowledge: dict[str, Any]
) -> list[Path]:
    """All ruptures, as a table and histograms, where a curve has several or a persistence length is given."""
    if args.persistence is None and not any(int(row.get("ruptures") or 0) > 1 for row in summary.rows):
        return []
    files = [out.with_name(f"{out.stem}-ruptures.{ending}") for ending in ("csv", "png")]
    with output.progress_bar("ruptures") as progress:
        found = awaited(lambda: batch.pulls(
            summary, segment_length=persistence(args), sidecar=args.sidecar, reading=reading, progress=progress,
            **knowledge,
        ))  # fmt: skip
    found.to_csv(files[0])
    found.draw(save=files[1])
    print(f"  {found}")
    if found.without:
        print(f"  {len(found.without)} without: {found.without[0][2]}")
    return files


def persistence(args: argparse.Namespace) -> Any:
    """Of the chains that ruptures end [m]; None: the usual one."""
    return args.persistence if args.persistence in (None, "free") else parse_quantity(args.persistence, "m")


def _tell_without(rows: list[dict[str, Any]], most: int = 20) -> None:
    """The curves without a result, and why."""
    without = [row for row in rows if row["status"] in batch.WITHOUT]
    for row in without[:most]:
        number = "" if row["curve"] == "" else f"#{row['curve']}"
        print(f"  {row['status']}: {row['file']}{number}: {row['reason'].removeprefix(row['file'] + ': ')}")
    if len(without) > most:
        print(f"  and {len(without) - most} more in the table")
