# SPDX-License-Identifier: BSD-3-Clause
"""Results that survive a killed run: a manifest that says of what they are, and one file for each finished block.

Every file appears whole or not at all. A folder whose manifest differs from the run is refused, not mixed.
"""

from __future__ import annotations

import json
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._io.writing import replacing
from ..errors import Error, InvalidValue

Columns = dict[str, NDArray[Any]]
MANIFEST = "manifest.json"


class BlockStore:
    """A folder of finished blocks.

    Parameters
    ----------
    folder : path
        Made if need be.
    manifest : mapping
        What the results depend on, as JSON can hold it: settings, version, hash of the input, size of a block.

    Raises
    ------
    InvalidValue
        If the folder holds the results of another run; the message names what differs.
    """

    def __init__(self, folder: str | os.PathLike[str], manifest: Mapping[str, Any]) -> None:
        self.folder = Path(folder)
        wanted = json.loads(json.dumps(manifest))
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            found = json.loads((self.folder / MANIFEST).read_text(encoding="utf-8"))
        except FileNotFoundError:
            if any(self.folder.glob("block-*.npz")):
                raise InvalidValue(f"{self.folder}: holds blocks without {MANIFEST}, so nobody knows of what") from None
            with replacing(self.folder / MANIFEST) as part:
                part.write_text(json.dumps(wanted, indent=2) + "\n", encoding="utf-8")
            return
        except (OSError, ValueError) as error:
            raise Error(f"{self.folder / MANIFEST}: cannot be read: {error}") from error
        different = sorted(key for key in wanted.keys() | found.keys() if wanted.get(key) != found.get(key))
        if different:
            raise InvalidValue(
                f"{self.folder}: holds the results of another run, which differs in {_differences(found, wanted)}; "
                "give another folder, or delete this one"
            )

    def load(self, number: int) -> Columns | None:
        """A finished block; None if it is not, or its file is damaged (its checksums tell) and it is to be redone."""
        try:
            with self._file(number).open("rb") as stream, np.load(stream, allow_pickle=False) as file:
                return {key: file[key] for key in file.files}
        except (FileNotFoundError, ValueError, zipfile.BadZipFile, EOFError):
            return None

    def save(self, number: int, columns: Columns) -> None:
        """Keep a finished block, whole or not at all."""
        with replacing(self._file(number)) as part, part.open("wb") as stream:
            np.savez(stream, **columns)  # type: ignore[arg-type]
            stream.flush()
            os.fsync(stream.fileno())

    def _file(self, number: int) -> Path:
        return self.folder / f"block-{number:06d}.npz"


def _differences(found: Any, wanted: Any, path: str = "") -> str:
    """The leaves in which two manifests differ, with both values."""
    if isinstance(found, dict) and isinstance(wanted, dict):
        keys = sorted(key for key in found.keys() | wanted.keys() if found.get(key) != wanted.get(key))
        return ", ".join(_differences(found.get(key), wanted.get(key), f"{path}.{key}".lstrip(".")) for key in keys)
    return f"{path} ({str(found)[:40]} there, {str(wanted)[:40]} here)"


def finished(folder: str | os.PathLike[str]) -> int:
    """Curves in the blocks that a run has left there."""
    count = 0
    for file in Path(folder).glob("block-*.npz"):
        with np.load(file, allow_pickle=False) as block:
            count += int(block["status"].size)
    return count
