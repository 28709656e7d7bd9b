# SPDX-License-Identifier: BSD-3-Clause
"""What every reader needs: a file worth opening, and one kind of error whatever a foreign reader raises."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path

from .errors import Error, ReadError

#: Largest file opened [byte]: the largest single AFM files (force maps) are a few hundred megabytes.
MAX_FILE_SIZE = 1 << 30


def checked_path(path: str | PathLike[str]) -> Path:
    """The path of an existing, readable, non-empty file of reasonable size, or :class:`ReadError`."""
    file = Path(fspath(path))
    try:
        if file.is_dir():
            raise ReadError(f"{file}: this is a folder, not a file")
        size = file.stat().st_size
        with file.open("rb"):
            pass
    except FileNotFoundError:
        raise ReadError(f"{file}: no such file") from None
    except (OSError, ValueError) as error:
        if isinstance(error, ReadError):
            raise
        raise ReadError(f"{file}: cannot be opened: {getattr(error, 'strerror', None) or error}") from None
    if size == 0:
        raise ReadError(f"{file}: the file is empty")
    if size > MAX_FILE_SIZE:
        raise ReadError(f"{file}: {size / 2**20:.0f} MiB; files of up to {MAX_FILE_SIZE >> 20} MiB are read")
    return file


@contextmanager
def guarded(file: Path, reader: str) -> Iterator[None]:
    """Turn whatever a foreign reader raises into one :class:`ReadError`; its warnings are not the user's business.

    ``BaseException`` because afmformats derives its errors from it; a stop by the user passes through.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except (Error, KeyboardInterrupt, SystemExit, GeneratorExit):
        raise
    except BaseException as error:
        said = " ".join(str(error).split()) or type(error).__name__
        if isinstance(error, KeyError):  # which says no more than the key
            said = f"it lacks {said}"
        raise ReadError(f"{file}: {reader} cannot read it: {said[:200]}") from error
