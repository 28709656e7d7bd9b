#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How many options each command has; those of all commands count once."""

from __future__ import annotations

import argparse

from nanotouch_app.main import COMMON, build_parser


def counted(parser: argparse.ArgumentParser, name: str) -> int:
    """Print and count the options of a command and of its jobs."""
    options, jobs = [], 0
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            jobs += sum(counted(job, f"{name} {word}") for word, job in action.choices.items())
        elif action.option_strings and action.dest != "help":
            options.append(action.option_strings[-1])
    print(f"{len(options):3} {name}: {' '.join(options)}")
    return len(options) + jobs


def main() -> None:
    """Print all counts."""
    print(f"{counted(build_parser(), 'nanotouch') + len(COMMON)} in all, with {' '.join(COMMON)}")


if __name__ == "__main__":
    main()
