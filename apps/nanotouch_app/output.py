# SPDX-License-Identifier: BSD-3-Clause
"""Where a command leaves its files, and the bar that shows how far it is."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from nanotouch.errors import Error, require


def folder(path: str | os.PathLike[str]) -> Path:
    """The folder, made if need be and known to be writable."""
    made = Path(path)
    try:
        made.mkdir(parents=True, exist_ok=True)
        probe = made / f".nanotouch-{os.getpid()}"
        probe.touch()
        probe.unlink()
    except OSError as error:
        raise Error(f"cannot write into {made}: {error.strerror}") from error
    return made


def clear(folder: Path, names: Iterable[str]) -> None:
    """Remove what an earlier run left under these names, so that no old result stands beside new ones."""
    for name in names:
        try:
            (folder / name).unlink(missing_ok=True)
        except OSError as error:
            raise Error(f"cannot replace {folder / name}: {error.strerror}") from error


def write_json(path: Path, data: Mapping[str, Any]) -> None:
    """Write JSON, whole or not at all."""
    part = path.with_name(f".{path.name}.part")
    try:
        part.write_text(json.dumps(data, indent=2) + "\n", encoding="utf-8")
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise Error(f"cannot write {path}: {error.strerror}") from error


@contextmanager
def progress_bar(title: str) -> Iterator[Callable[[float], None]]:
    """A bar on the terminal, for what takes longer than a second; called with the fraction done. None in a log."""
    tqdm = require("tqdm", "app").tqdm
    layout = "{l_bar}{bar}| {elapsed}<{remaining}"
    options = {"desc": title, "delay": 1.0, "bar_format": layout, "leave": False, "file": sys.stderr}
    with tqdm(total=1.0, disable=not sys.stderr.isatty(), **options) as bar:
        yield lambda fraction: bar.update(fraction - bar.n)
