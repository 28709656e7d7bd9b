# SPDX-License-Identifier: BSD-3-Clause
# PYTHON_ARGCOMPLETE_OK
"""The ``nanotouch`` command: one file per sub-command. Errors end with one line and exit status 2."""

from __future__ import annotations

import argparse
import difflib
import importlib
import io
import json
import os
import re
import sys
from collections.abc import Sequence
from contextlib import redirect_stdout, suppress
from types import ModuleType
from typing import Any, NoReturn

import nanotouch as nt
from nanotouch import guard
from nanotouch.errors import InvalidValue

from nanotouch_app import examples
from nanotouch_app.common import removed, stop
from nanotouch_app.common.guard import REFUSED, guarded, one_line
from nanotouch_app.common.output import as_json

GROUPS = {
    "touch": (
        "touching",
        {
            "live": "touch with your own hand, in a window",
            "touch": "touch a surface on the simulated rig",
            "scan": "image a surface on the simulated rig",
            "push": "push a particle to a place, under drift and noise",
            "indent": "indent a sample that yields, and draw the dent",
            "margins": "how far a loop is from its stability limit",
        },
    ),
    "measured data": (
        "data",
        {
            "info": "what a file holds: channels, size, units; segments, points, spring constant",
            "image": "level, repair and measure an AFM image",
            "fit": "fit a contact model to a measured force curve",
            "map": "fit every curve of a force map",
            "report": "one page about folders of force curves: results, rejects, Methods",
            "review": "force curves one by one: keep, reject, contact point and baseline by hand",
            "recalibrate": "sensitivities of many files by a lever of known stiffness (SNAP)",
            "export": "a recording, curves, an image or a map in formats that others open",
            "recover": "finish what a killed process left of a recording",
            "samples": "write an image, a force curve, a map and a scene to try",
        },
    ),
    "rig": (
        "rigs",
        {
            "rig": "check a rig file, probe its machine, calibrate it, allow its code",
            "latency": "how late this machine wakes a real-time loop up",
            "doctor": "what is installed and works here, and what to install for the rest",
        },
    ),
    "studies": (
        "studies",
        {
            "plan": "say what has to be computed for a scene, and why",
            "curve": "compute a force-distance curve",
            "tradeoff": "measure speed and accuracy of every contact model and tier",
            "bench": "measure the cost of every law in ns and in Hertz",
            "reproduce": "compute the paper's figures and judge its statements",
            "workflow": "scan, touch, push, scan again: the paper's work as one film",
        },
    ),
}
"""what ``--help`` shows, which loads none of them: title; the package that holds the commands; what each does"""
COMMANDS = tuple(command for _, commands in GROUPS.values() for command in commands)
COMMON = {
    "--verbose": "print all that was found, not only what most people need",
    "--json": "print the results as JSON, SI; null: not known",
    "--overwrite": "replace the results that --out holds already",
    "--trusted": "read files in this process, without its guard (docs/security.md)",
}
"""options of all commands, taken wherever they stand"""
EPILOG = """exit status:
  0    done
  1    done, and the answer is no (margins: refused; rig probe: too slow; fit: no curve), or nobody read it
  2    refused, with the reason
  70   a bug of nanotouch; NANOTOUCH_DEBUG=1 shows its traceback
  130  stopped by Ctrl-C (128 and the number of the signal)

tab completion, with the package argcomplete: eval "$(register-python-argcomplete nanotouch)\""""


class Formatter(argparse.HelpFormatter):
    """Keeps the lines of examples as they are."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        return text if text.startswith("examples:") else super()._fill_text(text, width, indent)


class Parser(argparse.ArgumentParser):
    """Takes ``-10kHz`` for a value, and ends a wrong command line with one line."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self._negative_number_matcher = re.compile(r"-(\.?\d|inf|nan)")  # no option begins like this

    def _print_message(self, message: str, file: Any = None) -> None:
        (file or sys.stderr).write(message)  # argparse's own passes over errors

    def _check_value(self, action: argparse.Action, value: Any) -> None:
        if action.choices is not None and value not in action.choices:
            known = [str(choice) for choice in action.choices]
            near = meant(str(value), known) or ":"
            raise argparse.ArgumentError(action, f"{value!r}{near} valid are {', '.join(known)}")

    def unknown(self, words: list[str]) -> NoReturn:
        """Tell of what is no option or argument of this command."""
        option = words[0].partition("=")[0]
        if option in removed.OPTIONS:
            self.error(f"{option} is no option any more: {removed.OPTIONS[option]}")
        near = meant(option, [*self._option_string_actions, *COMMON])
        self.error(f"unrecognized arguments: {' '.join(words)}{near}")

    def error(self, message: str) -> NoReturn:
        """Tell what is wrong, without the usage."""
        self.exit(REFUSED, one_line(f"{self.prog}: error: {message} (see {self.prog} --help)") + "\n")


class GroupedParser(Parser):
    """Shows the commands by group, the ones that most people need first."""

    def format_help(self) -> str:
        """The help, with the commands where argparse would put one long list."""
        parts = [self.description or "", self.format_usage().strip()]
        parts.append(f"start with:\n{examples.table(examples.FIRST)}")
        for title, (_, commands) in GROUPS.items():
            rows = (f"  {name:13}{does}" for name, does in commands.items())
            parts.append("\n".join((f"{title}:", *rows)))
        rows = (f"  {name:13}{words}" for name, words in COMMON.items())
        parts.append("\n".join(("options of all commands:", *rows)))
        return "\n\n".join((*parts, f"nanotouch COMMAND --help shows options and examples.\n\n{EPILOG}\n"))


def meant(word: str, known: Sequence[str]) -> str:
    """The question whether something known was meant; nothing where none is like it."""
    bare = {name.lstrip("-"): name for name in known}
    near = difflib.get_close_matches(word.lstrip("-"), bare, 1, 0.7)
    return f": did you mean {bare[near[0]]}?" if near else ""


def build_parser(commands: Sequence[str] = COMMANDS) -> Parser:
    """The parser of all sub-commands; the options of these, each of which has to be loaded."""
    parser = GroupedParser(
        prog="nanotouch",
        description="Touch nanoscale surfaces: feel, model and measure the forces at an AFM tip.",
    )
    parser.add_argument("--version", action="version", version=f"nanotouch {nt.__version__}")
    subparsers = parser.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=Parser)
    for command in COMMANDS:
        if command in commands:
            _module(command).add_parser(subparsers)
            _complete(subparsers.choices[command], command)
        elif not commands:  # only named, in the help or in a refusal
            subparsers.add_parser(command)
    return parser


def _module(command: str) -> ModuleType:
    """Where a command is."""
    package = next(package for package, commands in GROUPS.values() if command in commands)
    return importlib.import_module("nanotouch_app.live" if command == "live" else f"nanotouch_app.{package}.{command}")


def _complete(parser: argparse.ArgumentParser, command: str) -> None:
    """What all commands have: examples, and where the options of all of them are."""
    parts = [parser.epilog] if parser.epilog else []
    if not (parser.epilog or "").startswith("examples:"):
        parts.insert(0, f"examples:\n{examples.table(examples.EXAMPLES[command])}")
    _usual_first(parser, examples.USUAL.get(command, ()))
    parser.epilog = "\n\n".join((*parts, f"options of all commands (nanotouch --help): {', '.join(COMMON)}"))
    parser.formatter_class = Formatter


def _usual_first(parser: argparse.ArgumentParser, names: Sequence[str]) -> None:
    """What most people need, in a group of its own before the other options."""
    if not names:
        return
    groups = parser._action_groups
    usual = parser.add_argument_group("common options")
    groups.insert(1, groups.pop())
    for group in groups[2:]:
        usual._group_actions += [one for one in group._group_actions if one.dest in names]
        group._group_actions = [one for one in group._group_actions if one.dest not in names]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; returns the exit status."""
    given = sys.argv[1:] if arguments is None else list(arguments)
    named = [command for command in COMMANDS if given[:1] == [command]]
    return guarded(" ".join(["nanotouch", *named]), lambda: _run(given))


def _run(arguments: list[str]) -> int:
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")  # names of files may hold what the terminal's coding lacks
    if not arguments and "_ARGCOMPLETE" not in os.environ:
        print(f"Touch nanoscale surfaces. Try:\n{examples.table((*examples.FIRST, examples.ALL))}")
        return 0
    args = _parsed(arguments)
    for name, value in vars(args).items():
        if "" in (value if isinstance(value, list) else [value]):
            raise InvalidValue(f"{name.replace('_', '-')} is empty: is it a variable of the shell that is not set?")
    work = _module(args.command).run
    with stop.on_signals(), guard.by_default(not args.trusted):
        try:
            if not args.json:
                return int(work(args))
            with redirect_stdout(io.StringIO()):
                status = int(work(args))
        except InvalidValue as failure:
            raise InvalidValue(_of_option(str(failure), args)) from failure
        print(json.dumps(as_json(args.answer), indent=2, allow_nan=False))
        return status


def _of_option(message: str, args: argparse.Namespace) -> str:
    """The message, with the option before it whose value it quotes: ``--rate: '10' has no unit; ...``."""
    quoted = re.match("'([^']*)' (has|is not) ", message)
    for name, value in vars(args).items() if quoted else ():
        if isinstance(value, str) and quoted and quoted[1] in (value, *value.split(",")):
            return f"--{name.replace('_', '-')}: {message}"
    return message


def _parsed(arguments: list[str]) -> argparse.Namespace:
    """The arguments; for a shell that asks what may come next, the answer instead."""
    end = arguments.index("--") if "--" in arguments else len(arguments)
    common = {name for name in COMMON if name in arguments[:end]}
    words = [word for word in arguments[:end] if word not in COMMON] + arguments[end:]
    asked = os.environ.get("COMP_LINE", "").split()[1:2] if "_ARGCOMPLETE" in os.environ else words[:1]
    parser = build_parser([command for command in COMMANDS if asked == [command]])
    if "_ARGCOMPLETE" in os.environ:
        with suppress(ImportError):
            importlib.import_module("argcomplete").autocomplete(parser)
    args, unknown = parser.parse_known_args(words)
    if unknown:
        commands: Any = next(action for action in parser._actions if isinstance(action, argparse._SubParsersAction))
        commands.choices[args.command].unknown(unknown)
    if "--overwrite" in common and "overwrite" not in args:
        raise InvalidValue(f"--overwrite: nanotouch {args.command} writes no results")
    if "--json" in common and args.command == "live":
        raise InvalidValue("--json: a window has no results")
    for name in COMMON:
        setattr(args, name[2:], name in common)
    return args


if __name__ == "__main__":
    sys.exit(main())
