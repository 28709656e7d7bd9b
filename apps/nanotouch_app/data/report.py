# SPDX-License-Identifier: BSD-3-Clause
"""Fit every curve under folders; write one HTML page of the results, and the table beside it."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from nanotouch import batch
from nanotouch.batch import methods, sheet
from nanotouch.errors import InvalidValue

from nanotouch_app.common import output, stop
from nanotouch_app.data import fit, fit_many

FILES = ("report.html", "results.csv", "results.csv.json")
JOURNAL = "results.csv.journal"


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser = subparsers.add_parser("report", description=__doc__)
    parser.add_argument(
        "folder", nargs="+", metavar="FOLDER", help="force curves; folders, and folders in them, are groups"
    )
    fit.add_knowledge(parser, auto=True)
    fit.add_table(parser)
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command; the status is 1 where not a single curve was fitted."""
    named = [Path(name) for name in dict.fromkeys(args.folder)]
    for folder in named:
        if not folder.is_dir():
            raise InvalidValue(f"{folder}: is no folder; nanotouch fit looks at single files")
    reading, known = fit.reading(args), fit.knowledge(args)
    with output.folder(args, FILES) as out:
        if args.overwrite:  # a journal of other settings too
            (out / JOURNAL).unlink(missing_ok=True)
        folders = list(dict.fromkeys(found for folder in named for found in _folders(folder, out)))
        groups = args.groups or (batch.FOLDER if len(folders) > 1 else None)
        table = out / "results.csv"
        summary = fit_many.fitted("report", table, out, lambda progress: batch.fit_files(
            folders, table, args.model, sidecar=args.sidecar, reading=reading, progress=progress,
            groups=groups, long=args.long, branch=args.branch, **known,
        ))  # fmt: skip
        with stop.keeping("the table is kept", table):
            sheets = sheet.draw(summary.pictures, out, "results", most=10)
        settings = {"model": args.model, "branch": args.branch} | known
        title = f"Force curves of {', '.join(folder.resolve().name for folder in named)}"
        batch.write_report(out / "report.html", summary, title=title, settings=settings, reading=reading, sheets=sheets)
        print(summary)
        for found in summary.spreads:
            print(f"  {found}")
        print(f"  {methods.modulus_meant(known)}")
        for name in summary.unused:
            print(f"  note: {name!r} of the sidecar or a table is no file or curve here, or an earlier line has it")
        args.answer = {"folder": str(out), "files": list(FILES), "curves": summary.rows}
        print(f"written to {out}/: report.html, results.csv, results.csv.json")
    return 0 if summary.fitted else 1


def _folders(folder: Path, out: Path) -> list[Path]:
    """The folder and those in it that hold files; not the results'."""
    every = [folder, *sorted(path for path in folder.rglob("*") if path.is_dir())]
    mine = out.resolve()
    kept = [
        path for path in every
        if not any(part.startswith(".") for part in path.relative_to(folder).parts)
        and mine not in (path.resolve(), *path.resolve().parents)
        and any(file.is_file() and not file.name.startswith(".") for file in path.iterdir())
    ]  # fmt: skip
    if not kept:
        raise InvalidValue(f"{folder}: holds no file")
    return kept
