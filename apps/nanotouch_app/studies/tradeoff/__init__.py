# SPDX-License-Identifier: BSD-3-Clause
"""Measure accuracy against processor time on this machine: of the force at the hand over a whole touch (contact law,
tier, probe model, substep, loop rate, noise, calibration), of every contact model and tier over lambda and load, and of
the plans of every preset over the accuracy demanded."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from nanotouch.errors import InvalidValue, require
from nanotouch.plots import saved
from nanotouch.touch.record import write_csv

from nanotouch_app.common import output
from nanotouch_app.studies.tradeoff import answer, drawing, errors, laws, measure, page, plans, touch

FILES = (
    "tradeoff.png", "tradeoff.csv", "laws.png", "laws.csv", "calls.csv", "errormap.csv", "errormap.png", "plans.csv",
    "plans.png",
)  # fmt: skip


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("tradeoff", description=__doc__)
    output.add_options(parser)
    parser.add_argument("--quick", action="store_true", help="few lambdas, few loads, rough timings: seconds")
    parser.add_argument("--doc", type=Path, metavar="FILE.md", help="also write the page on accuracy")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.doc and args.quick:
        raise InvalidValue("--doc with --quick: the page is made of the full measurement only")
    if args.doc:
        page.check(args.doc)
    require("matplotlib", "app")
    with output.folder(args, FILES) as out:
        with output.progress_bar("error maps") as progress:
            maps = measure.maps(args.quick, progress)
        with output.progress_bar("timing") as progress:
            rows = measure.trade(args.quick, progress)
        with output.progress_bar("plans") as progress:
            planned = plans.trade(args.quick, progress)
        with output.progress_bar("whole touch") as progress:
            touched = touch.trade(args.quick, progress)
        points = laws.points(rows, 3 if args.quick else 200)
        found = page.Measured(maps, rows, planned, touched, points, laws.extremes())
        _write(out, "nanotouch tradeoff" + (" --quick" if args.quick else ""), found)
        if args.doc:
            page.write(args.doc, found)
        args.answer = {"touch": touch.columns(touched), "folder": str(out), "files": list(FILES)}
        print(answer.sentences(touched))
        print(page.summary(rows))
        print(plans.summary(planned))
        print(f"written to {out}/: {', '.join(FILES)}" + (f"; {args.doc}" if args.doc else ""))
    return 0


def _write(out: Path, how: str, found: page.Measured) -> None:
    """All tables and pictures."""
    command = {"command": how}
    loads = {f"loads, {name}": words for name, words in errors.WORDS.items()}
    write_csv(out / "tradeoff.csv", touch.columns(found.touch), command | {"against": "the finest of everything"})
    write_csv(out / "laws.csv", measure.trade_columns(found.rows), command | loads)
    write_csv(out / "calls.csv", laws.columns(found.points), command)
    write_csv(out / "errormap.csv", measure.map_columns(found.maps), command | {"against": "exact Maugis-Dugdale"})
    write_csv(out / "plans.csv", plans.columns(found.planned), command | {"against": "nanotouch.reference"})
    saved(answer.draw(found.touch), out / "tradeoff.png", dpi=140)
    saved(laws.draw(found.points, found.extremes), out / "laws.png", dpi=140)
    saved(drawing.maps(found.maps), out / "errormap.png", dpi=140)
    saved(plans.draw(found.planned), out / "plans.png", dpi=140)
