# SPDX-License-Identifier: BSD-3-Clause
"""What every reader needs: a file worth opening, and one kind of error whatever a foreign reader raises."""

from __future__ import annotations

import warnings
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path

from .errors import Error, ReadError, require

#: Largest file opened [byte]: the largest single AFM files (force maps) are a few hundred megabytes.
MAX_FILE_SIZE = 1 << 30
MAX_UNPACKED = 1 << 30  # of all that a container says it holds [byte]
_HDF5_ENDINGS = (".h5", ".hdf5", ".nc", ".nhf", ".h5-jpk")


def checked_path(path: str | PathLike[str]) -> Path:
    """The path of an existing, readable, non-empty file of reasonable size, or :class:`ReadError`."""
    file = Path(fspath(path))
    try:
        if file.is_dir():
            raise ReadError(f"{file}: this is a folder, not a file")
        if file.exists() and not file.is_file():  # a pipe would wait for ever
            raise ReadError(f"{file}: this is a device or a pipe, not a file")
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
    """Turn whatever a foreign reader raises into one :class:`ReadError` that names it; its warnings are not the user's.

    ``BaseException`` because afmformats derives its errors from it; a stop by the user passes through.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            yield
    except ReadError as error:
        error.reader = error.reader or reader
        raise
    except (Error, KeyboardInterrupt, SystemExit, GeneratorExit):
        raise
    except MemoryError as error:
        raise ReadError(f"{file}: {reader} asks for more memory than there is", reader) from error
    except BaseException as error:
        said = " ".join(str(error).split()) or type(error).__name__
        if isinstance(error, KeyError):  # which says no more than the key
            said = f"it lacks {said}"
        raise ReadError(f"{file}: {reader} cannot read it: {said[:200]}", reader) from error


def refuse_traps(file: Path, head: bytes) -> None:
    """Refuse containers that unpack to too much, or that make the reader open other files."""
    if head.startswith(b"PK\3\4"):
        with guarded(file, "zipfile"), zipfile.ZipFile(file) as archive:
            _check_unpacked(file, sum(item.file_size for item in archive.infolist()))
    elif head.startswith(b"\x89HDF") or file.suffix.lower() in _HDF5_ENDINGS:
        _refuse_hdf5_traps(file)


def _refuse_hdf5_traps(file: Path) -> None:
    """External links, external storage and virtual datasets read any file that the user may; sizes may be invented."""
    h5py = require("h5py", "images")
    with guarded(file, "h5py"):
        if not h5py.is_hdf5(file):
            return
        unpacked = 0
        with h5py.File(file, "r") as opened:
            groups, seen = [opened["/"]], set()
            while groups:
                group = groups.pop()
                place = h5py.h5o.get_info(group.id).addr
                if place in seen:  # hard links may go round
                    continue
                seen.add(place)
                for name in group:
                    if isinstance(group.get(name, getlink=True), h5py.ExternalLink):
                        raise ReadError(f"{file}: links to another file in {name!r}; such HDF5 files are refused")
                    node = group.get(name)
                    if isinstance(node, h5py.Group):
                        groups.append(node)
                    elif isinstance(node, h5py.Dataset):
                        if node.external or node.is_virtual:
                            raise ReadError(f"{file}: keeps {name!r} in another file; such HDF5 files are refused")
                        unpacked += int(node.nbytes) if node.shape else 0
        _check_unpacked(file, unpacked)


def _check_unpacked(file: Path, size: int) -> None:
    if size > MAX_UNPACKED:
        raise ReadError(f"{file}: unpacks to {size / 2**20:.0f} MiB; up to {MAX_UNPACKED >> 20} MiB are read")
