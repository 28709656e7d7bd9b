# SPDX-License-Identifier: BSD-3-Clause
"""Readers of others, which register under their own licence through the entry point ``nanotouch.readers``.

A reader is a module (or any object) with ``kind`` ("images" or "curves"), ``recognises(file, head) -> bool`` (`head`:
the first bytes) and, for images, ``channels(file) -> list[Channel]`` and ``read(file, channel) -> Plane``, for curves
``read(file) -> list[ForceCurve]``. It is asked before the built-in readers; what it returns is checked as theirs is.
"""

from __future__ import annotations

from functools import lru_cache
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

from nanotouch._io.files import guarded
from nanotouch.errors import Error
from nanotouch.formats import HEAD, Kind

GROUP = "nanotouch.readers"


def head_of(file: Path) -> bytes:
    """The first bytes of a file, by which readers recognise it."""
    with file.open("rb") as stream:
        return stream.read(HEAD)


def registered_for(file: Path, head: bytes, kind: Kind) -> tuple[str, Any] | None:
    """Name and object of the registered reader that recognises this file, the first in the order of names."""
    for name, reader in _registered():
        with guarded(file, name):
            if reader.kind == kind and reader.recognises(file, head):
                return name, reader
    return None


@lru_cache(maxsize=1)
def _registered() -> tuple[tuple[str, Any], ...]:
    found = []
    for entry in sorted(entry_points(group=GROUP), key=lambda e: e.name):
        try:
            found.append((entry.name, entry.load()))
        except Exception as error:
            raise Error(f"the registered reader {entry.name!r} ({entry.value}) cannot be loaded: {error}") from error
    return tuple(found)
