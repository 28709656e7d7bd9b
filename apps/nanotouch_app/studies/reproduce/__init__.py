# SPDX-License-Identifier: BSD-3-Clause
"""Compute the figures of the paper (5, 6, 9 to 11, 15 to 19): a picture, a table, and which of its statements hold."""

from __future__ import annotations

import argparse
import importlib
from collections.abc import Sequence
from typing import Any

from nanotouch.errors import InvalidValue
from nanotouch.touch.record import write_csv

from nanotouch_app.common import output
from nanotouch_app.studies.reproduce import drawing
from nanotouch_app.studies.reproduce.statement import Reproduction

FIGURES = (5, 6, 9, 10, 11, 15, 16, 17, 18, 19)


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("reproduce", description=__doc__)
    parser.add_argument(
        "--figure",
        nargs="+",
        type=int,
        default=FIGURES,
        metavar="N",
        help="which of 5, 6, 9 .. 11, 15 .. 19 (default: all)",
    )
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    found = []
    for number in _checked(args.figure):
        with output.busy(f"figure {number}"):
            found.append(reproduction(number))
    files = [*(f"fig{figure.number}.{kind}" for figure in found for kind in ("png", "csv")), "statements.json"]
    with output.folder(args, files) as out:
        for figure in found:
            name = f"fig{figure.number}"
            comments = {entry.name: f"{entry.value:g} {entry.unit}".rstrip() for entry in figure.parameters}
            write_csv(out / f"{name}.csv", figure.columns, {"figure": f"{figure.number}, {figure.title}", **comments})
            drawing.save(figure.draw, out / f"{name}.png")
        args.answer = {f"fig{figure.number}": figure.as_dict() for figure in found}
        output.write_json(out / "statements.json", args.answer)
        print("\n\n".join(words(figure) for figure in found))
        print(f"\nwritten to {out}/: {', '.join(files)}")
    return 0


def reproduction(number: int) -> Reproduction:
    """Compute a figure of the paper."""
    made: Reproduction = importlib.import_module(f"{__name__}.figure{number}").reproduce()
    return made


def words(figure: Reproduction) -> str:
    """The figure's statements for a reader."""
    return "\n".join([f"Fig. {figure.number}: {figure.title}", *map(str, figure.statements)])


def _checked(numbers: Sequence[int]) -> list[int]:
    unknown = [number for number in numbers if number not in FIGURES]
    if unknown:
        raise InvalidValue(f"--figure {unknown[0]}: reproduced are {', '.join(map(str, FIGURES))}")
    return sorted(set(numbers))
