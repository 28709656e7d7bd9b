# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch recalibrate FOLDER --lever 0.04N/m --lever-known-to 4 --thermal-known-to 3 --out calibration.csv``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import batch, curves
from nanotouch.errors import InvalidValue

from nanotouch_app.common import output
from nanotouch_app.common.quantity import number, parse_quantity


def add_parser(subparsers: Any) -> None:
    """Add ``recalibrate`` to the command's sub-commands."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "recalibrate",
        description="Correct the deflection sensitivity of each file so that the spring constant it states, from "
        "thermal noise, becomes that of the lever. Writes a table for --calibration of fit, map and report.",
    )
    parser.add_argument("file", type=Path, nargs="+", metavar="FILE", help="force curve files, or folders of them")
    parser.add_argument("--lever", required=True, metavar="STIFFNESS", help="as its vendor measured it, as 0.04N/m")
    for name, what in (("lever", "the lever's stiffness"), ("thermal", "the files' thermal tunes, as they repeat")):
        parser.add_argument(
            f"--{name}-known-to", required=True, type=number(0.0, 99.0), metavar="PERCENT",
            help=f"standard uncertainty of {what}",
        )  # fmt: skip
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="the table, a .csv")
    output.takes_overwrite(parser)
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Write the table; print what changed, and what the new calibration is known to."""
    if args.out.suffix.lower() != ".csv":
        raise InvalidValue(f"--out {args.out}: the ending must be .csv")
    output.check_free(args.out, args)
    stiffness = parse_quantity(args.lever, "N/m")
    lever = curves.Lever(stiffness, args.lever_known_to / 100.0, args.thermal_known_to / 100.0)
    own = args.out.resolve()
    files = [file for file in batch.files_of(args.file) if file.resolve() != own]
    if not files:
        raise InvalidValue(f"{args.out}: the only file there is, and no force curve")
    found = curves.recalibrate(files, lever)
    curves.write_table(args.out, found, lever)
    change = np.array([one.sensitivity / one.stated for one in found])
    options = " ".join(f"--known-to {name}={100 * value:.3g}" for name, value in lever.known_to.items())
    args.answer = {
        "file": str(args.out),
        "known_to": lever.known_to,
        "files": {str(one.file): {"stated": one.stated, "sensitivity": one.sensitivity} for one in found},
    }
    print(f"{len(found)} files: sensitivity changed by {100 * (np.median(change) - 1):+.2g} % (median), "
          f"{100 * (change.min() - 1):+.2g} to {100 * (change.max() - 1):+.2g} %")  # fmt: skip
    print(f"use it with: --calibration {args.out} {options}")
    return 0
