# SPDX-License-Identifier: BSD-3-Clause
"""Files that are written whole or not at all."""

from __future__ import annotations

import csv
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import Error

BLOCK_ROWS = 10_000
"""of a text table written at once"""


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """A temporary name in the same folder, renamed to ``path`` at the end, removed on an exception."""
    part = part_of(path)
    try:
        with naming(Path(path)):
            yield part
            os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def part_of(path: str | os.PathLike[str]) -> Path:
    """What a file is called until it is whole."""
    return Path(path).with_name(f"{Path(path).name}.{os.getpid()}.part")


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Turn the system's errors into one sentence that names the file."""
    try:
        yield
    except Error:
        raise
    except OSError as error:
        raise Error(f"cannot write {path}: {error.strerror or error}") from error


def write_csv(
    path: str | os.PathLike[str],
    columns: Mapping[str, Sequence[Any] | NDArray[Any]],
    comments: Mapping[str, str],
    progress: Callable[[float], None] | None = None,
) -> None:
    """Write ``# key: value`` lines, the headers and the rows; floats in the fewest digits that read back equal."""
    rows = min((len(values) for values in columns.values()), default=0)
    with replacing(path) as part, open(part, "w", encoding="utf-8", newline="\n") as file:
        file.writelines(f"# {key}: {value}\n" for key, value in comments.items())
        table = csv.writer(file, lineterminator="\n")  # quotes a name that has a comma
        table.writerow(columns)
        for start in range(0, rows, BLOCK_ROWS):
            block = [np.asarray(values[start : start + BLOCK_ROWS]).tolist() for values in columns.values()]
            table.writerows(zip(*block, strict=True))
            if progress:
                progress(min(1.0, (start + BLOCK_ROWS) / rows))
