# SPDX-License-Identifier: BSD-3-Clause
"""Measure speed and accuracy on this machine. Measured are every contact model and tier over lambda and load; the
plans of every preset over the accuracy demanded, alone and in the loop; and the simulated rig over loop rate, model
and sub-step."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from nanotouch.errors import InvalidValue, require
from nanotouch.plots import saved
from nanotouch.touch.record import write_csv

from nanotouch_app import output
from nanotouch_app.studies.tradeoff import answer, drawing, errors, measure, page, plans, plant

FILES = (
    "tradeoff.png", "tradeoff.csv", "laws.csv", "loop.csv", "errormap.csv", "errormap.png", "plans.csv", "plans.png",
    "plant.csv",
)  # fmt: skip


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "tradeoff", help="measure speed and accuracy of every contact model and tier", description=__doc__
    )
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
        with output.progress_bar("plans in the loop") as progress:
            felt = plant.plans(args.quick, progress)
        with output.progress_bar("simulated rig") as progress:
            ways = plant.trade(args.quick, progress)
        points = answer.points(rows, felt, 3 if args.quick else 200)
        _write(out, "nanotouch tradeoff" + (" --quick" if args.quick else ""), maps, rows, planned, felt, ways, points)
        if args.doc:
            page.write(args.doc, maps, rows, planned, felt, ways, points)
        args.answer = {"points": answer.columns(points), "folder": str(out), "files": list(FILES)}
        print(answer.sentences(points))
        print(page.summary(rows))
        print(plans.summary(planned))
        print(plant.summary(ways))
        print(f"written to {out}/: {', '.join(FILES)}" + (f"; {args.doc}" if args.doc else ""))
    return 0


def _write(
    out: Path,
    how: str,
    maps: measure.Maps,
    rows: list[measure.Row],
    planned: list[plans.Row],
    felt: list[plant.Planned],
    ways: list[plant.Row],
    points: list[answer.Point],
) -> None:
    """All tables and pictures."""
    command = {"command": how}
    loads = {f"loads, {name}": words for name, words in errors.WORDS.items()}
    write_csv(out / "laws.csv", measure.trade_columns(rows), command | loads)
    write_csv(out / "tradeoff.csv", answer.columns(points), command)
    write_csv(out / "loop.csv", plant.plan_columns(felt), command | {"against": "everything exact"})
    write_csv(out / "errormap.csv", measure.map_columns(maps), command | {"against": "exact Maugis-Dugdale"})
    write_csv(out / "plans.csv", plans.columns(planned), command | {"against": "nanotouch.reference"})
    write_csv(out / "plant.csv", plant.columns(ways), command | {"against": "the dynamic probe, finest sub-step"})
    saved(answer.draw(points), out / "tradeoff.png", dpi=140)
    saved(drawing.maps(maps), out / "errormap.png", dpi=140)
    saved(plans.draw(planned), out / "plans.png", dpi=140)
