# SPDX-License-Identifier: BSD-3-Clause
"""The ``nanotouch`` command: one file per sub-command. Errors end with one sentence and exit status 2."""

from __future__ import annotations

import argparse
import importlib
import io
import os
import signal
import sys
from collections.abc import Sequence

import nanotouch as nt

from nanotouch_app import stop

COMMANDS = (
    "touch", "margins", "info", "plan", "curve", "image", "fit", "map", "export", "recover", "reproduce", "tradeoff",
    "bench", "doctor",
)  # fmt: skip


def build_parser() -> argparse.ArgumentParser:
    """The parser with every sub-command."""
    parser = argparse.ArgumentParser(
        prog="nanotouch", description="Touch nanoscale surfaces: feel, model and measure the forces at an AFM tip."
    )
    parser.add_argument("--version", action="version", version=f"nanotouch {nt.__version__}")
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command in COMMANDS:
        importlib.import_module(f"nanotouch_app.{command}").add_parser(subparsers)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit status."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # names of files may hold what the terminal's coding lacks
    args = build_parser().parse_args(arguments)
    try:
        with stop.on_signals():
            status = int(importlib.import_module(f"nanotouch_app.{args.command}").run(args))
            sys.stdout.flush()
            return status
    except nt.Error as error:
        print(f"nanotouch {args.command}: {error}", file=sys.stderr)
        return 2
    except BrokenPipeError:  # the reader has gone; nor may the flush at exit complain
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except KeyboardInterrupt as error:
        print(f"nanotouch {args.command}: {error or 'stopped'}", file=sys.stderr)
        return 128 + getattr(error, "number", signal.SIGINT)


if __name__ == "__main__":
    sys.exit(main())
