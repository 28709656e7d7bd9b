# SPDX-License-Identifier: BSD-3-Clause
"""The end of `make demo`: the live view where somebody is there to touch, else how it is started. An unattended run
never waits for a window."""

from __future__ import annotations

import importlib.util
import sys

from nanotouch.errors import Error
from nanotouch.extras import advice

from nanotouch_app.live import display


def hindrance() -> str:
    """Why no window is opened here; "" where one is."""
    if not (sys.stdin.isatty() and sys.stdout.isatty()):
        return "not at a terminal"
    if importlib.util.find_spec("vtkmodules") is None:
        return f"vtk is missing: {advice('view')}"
    try:
        display.check()
    except Error as error:
        return str(error)
    return ""


def main(arguments: list[str]) -> int:
    """Touch what is named by hand, or say how."""
    command = " ".join(["nanotouch live", *(f'"{word}"' for word in arguments)])
    why = hindrance()
    if why:
        print(f"touch it with your own hand: {command}   ({why})")
        return 0
    print(f"now with your own hand: {command}   (H: help, Q: leave)", flush=True)
    from nanotouch_app.main import main as nanotouch  # all commands

    return nanotouch(["live", *arguments])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
