# SPDX-License-Identifier: BSD-3-Clause
"""One line of JSON for each finished file, so that a killed run loses no more than the file it was at."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import Error, InvalidValue


class Journal:
    """Appended to; the first line says what the results depend on.

    Parameters
    ----------
    path : path
        Made if need be. A line that was cut off by a kill is dropped.
    manifest : mapping
        Settings and version, as JSON can hold them.

    Raises
    ------
    InvalidValue
        If the journal is that of other settings; the message says how to go on.
    """

    def __init__(self, path: Path, manifest: Mapping[str, Any]) -> None:
        self.path = path
        self.entries: dict[str, dict[str, Any]] = {}
        wanted = json.loads(json.dumps(manifest, default=str))
        lines = self._lines()
        if lines and lines[0] != wanted:
            different = ", ".join(
                sorted(k for k in wanted.keys() | lines[0].keys() if wanted.get(k) != lines[0].get(k))
            )
            raise InvalidValue(
                f"{path}: is the journal of a run with other {different}; name other results, or delete it"
            )
        self.entries = {entry["file"]: entry for entry in lines[1:]}
        if not lines:
            self._write(wanted, "w")

    def add(self, entry: Mapping[str, Any]) -> None:
        """Keep what came of ``entry["file"]``."""
        self.entries[entry["file"]] = dict(entry)
        self._write(entry, "a")

    def _lines(self) -> list[dict[str, Any]]:
        try:
            text = self.path.read_bytes()
        except FileNotFoundError:
            return []
        whole = text[: text.rfind(b"\n") + 1]
        try:
            lines = [json.loads(line) for line in whole.splitlines()]
            if len(whole) < len(text):
                os.truncate(self.path, len(whole))
        except (ValueError, OSError) as error:
            raise Error(f"{self.path}: not a journal of this program ({error}); delete it") from error
        return lines

    def _write(self, entry: Mapping[str, Any], mode: str) -> None:
        try:
            with self.path.open(mode, encoding="utf-8") as stream:
                stream.write(json.dumps(entry) + "\n")
                stream.flush()
                os.fsync(stream.fileno())
        except OSError as error:
            raise Error(f"cannot write {self.path}: {error.strerror}") from error


def finished(path: Path) -> int:
    """Files that the journal of a run has the results of."""
    try:
        return max(path.read_bytes().count(b"\n") - 1, 0)
    except FileNotFoundError:
        return 0
