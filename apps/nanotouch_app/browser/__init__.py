# SPDX-License-Identifier: BSD-3-Clause
"""A running session in browsers: the page over a small server (aiohttp), or in a notebook over the widget's channel."""

from __future__ import annotations

from pathlib import Path

from nanotouch.errors import Error

NAME = "nanotouch-touch.html"


def page(path: str | Path | None = None) -> bytes:
    """The page: the file that is named, or the one that `make page` has put beside this package."""
    found = Path(__file__).with_name(NAME) if path is None else Path(path)
    if not found.is_file():
        wanted = f"{found}: no such file; " if path is not None else ""
        raise Error(
            f"{wanted}the page is not in this package: wheels from PyPI have it, `make page` in the sources of "
            "nanotouch builds it, --page names a file"
        )
    return found.read_bytes()
