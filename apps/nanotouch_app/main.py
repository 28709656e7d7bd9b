# SPDX-License-Identifier: BSD-3-Clause
"""The ``nanotouch`` command: one file per sub-command. Errors end with one line and exit status 2."""

from __future__ import annotations

import argparse
import importlib
import io
import re
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

import nanotouch as nt
from nanotouch.errors import InvalidValue

from nanotouch_app import stop
from nanotouch_app.guard import REFUSED, guarded, one_line

COMMANDS = (
    "touch", "live", "margins", "info", "plan", "curve", "image", "fit", "map", "export", "recover", "reproduce",
    "tradeoff", "bench", "doctor",
)  # fmt: skip
EPILOG = """exit status: 0 done; 1 done, and the answer is no, or nobody read it; 2 refused, with the reason; 70 a bug
of nanotouch, whose traceback NANOTOUCH_DEBUG=1 shows; 130 stopped by Ctrl-C"""


class Parser(argparse.ArgumentParser):
    """Takes ``-10kHz`` for a value, and ends a wrong command line with one line."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._negative_number_matcher = re.compile(r"-(\.?\d|inf|nan)")  # no option begins like this

    def _print_message(self, message: str, file: Any = None) -> None:
        (file or sys.stderr).write(message)  # argparse's own passes over errors

    def error(self, message: str) -> NoReturn:
        """Tell what is wrong, without the usage."""
        self.exit(REFUSED, one_line(f"{self.prog}: error: {message} ({self.prog} --help tells more)") + "\n")


def build_parser() -> Parser:
    """The parser with every sub-command."""
    parser = Parser(
        prog="nanotouch",
        description="Touch nanoscale surfaces: feel, model and measure the forces at an AFM tip.",
        epilog=EPILOG,
    )
    parser.add_argument("--version", action="version", version=f"nanotouch {nt.__version__}")
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND")
    for command in COMMANDS:
        importlib.import_module(f"nanotouch_app.{command}").add_parser(subparsers)
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit status."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    named = [command for command in COMMANDS if given[:1] == [command]]
    return guarded(" ".join(["nanotouch", *named]), lambda: _run(given))


def _run(arguments: list[str]) -> int:
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # names of files may hold what the terminal's coding lacks
    args = build_parser().parse_args(arguments)
    for name, value in vars(args).items():
        if "" in (value if isinstance(value, list) else [value]):
            raise InvalidValue(f"{name.replace('_', '-')} is empty: is it a variable of the shell that is not set?")
    with stop.on_signals():
        return int(importlib.import_module(f"nanotouch_app.{args.command}").run(args))


if __name__ == "__main__":
    sys.exit(main())
