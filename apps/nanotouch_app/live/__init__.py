# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch live``. The command is loaded when it is needed: the window's process begins without it."""

from __future__ import annotations

import importlib
from typing import Any


def _command() -> Any:
    return importlib.import_module("nanotouch_app.live.command")


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    _command().add_parser(subparsers)


def run(args: Any) -> int:
    """Run the sub-command."""
    return int(_command().run(args))
