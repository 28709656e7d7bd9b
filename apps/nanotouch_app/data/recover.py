# SPDX-License-Identifier: BSD-3-Clause
"""Give back every whole block of a recording that a killed process left, or that is damaged, marked as incomplete with
what is lost. FILE stays as it is."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from nanotouch import record

from nanotouch_app.common import output


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("recover", description=__doc__)
    parser.add_argument("file", type=Path, metavar="FILE", help="recording.mcap.NUMBER.part, or a damaged recording")
    parser.add_argument("--out", type=Path, metavar="FILE.mcap", help="a new file (default: FILE without .NUMBER.part)")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    with output.busy("reading"):
        out, recording = record.recover(args.file, args.out)
    until = float(recording.time[-1]) if len(recording) else None
    args.answer = {"file": str(out), "rows": len(recording), "until_s": until, "incomplete": recording.incomplete}
    upto = "" if until is None else f" up to {until:.6g} s"
    print(f"{out}: {len(recording)} rows{upto}, incomplete: {recording.incomplete}")
    return 0
