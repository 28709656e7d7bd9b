# SPDX-License-Identifier: BSD-3-Clause
"""What every reader needs: a file worth opening, and one kind of error whatever a foreign reader raises."""

from __future__ import annotations

import logging
import re
import struct
import tomllib
import warnings
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, fspath
from pathlib import Path
from typing import Any

from nanotouch._io.words import printable
from nanotouch.errors import Error, ReadError, require

#: Largest file opened [byte]: the largest single AFM files (force maps) are some gigabytes.
MAX_FILE_SIZE = 1 << 34
MAX_TOML_SIZE = 1 << 20  # some 20 000 lines [byte]
MAX_UNPACKED = 1 << 31  # of all that an HDF5 file says it holds, or twice its size [byte]
MAX_MEMBER = 1 << 30  # of a member of a zip archive, unpacked [byte]
FREE, RATIO = (
    1 << 26,
    50,
)  # all its members: so many bytes [byte], and so many for each packed one; real ones have 2 .. 5
# they log what they raise as well
_TALKATIVE = ("tifffile", "afmformats.formats", "igor2.binarywave", "igor2.packed", "igor2.struct")
_HDF5_ENDINGS = (".h5", ".hdf5", ".nc", ".nhf", ".h5-jpk", ".topostats")


def refuse_pipe(file: Path) -> None:
    """Before anything opens it: a pipe would wait for ever."""
    if file.exists() and not (file.is_file() or file.is_dir()):
        raise ReadError(f"{file}: this is a device or a pipe, not a file")


def checked_path(path: str | PathLike[str]) -> Path:
    """The path of an existing, readable, non-empty file of reasonable size, or :class:`ReadError`."""
    file = Path(fspath(path))
    try:
        if file.is_dir():
            raise ReadError(f"{file}: this is a folder, not a file")
        refuse_pipe(file)
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


def toml_tables(path: str | PathLike[str]) -> dict[str, Any]:
    """The tables of a TOML file, with or without a byte-order mark."""
    file = checked_path(path)
    size = file.stat().st_size
    if size > MAX_TOML_SIZE:
        raise ReadError(f"{file}: {size >> 10} KiB; TOML files of up to {MAX_TOML_SIZE >> 10} KiB are read: is it one?")
    try:
        return tomllib.loads(file.read_text(encoding="utf-8-sig"))
    except UnicodeDecodeError as error:
        raise ReadError(f"{file} is not a TOML file: it is not text in UTF-8") from error
    except tomllib.TOMLDecodeError as error:
        raise ReadError(f"{file} is not a TOML file: {error}") from error
    except ValueError as error:
        raise ReadError(f"{file}: a whole number of more digits than can be read") from error
    except RecursionError as error:
        raise ReadError(f"{file}: lists or tables are nested too deep to be read") from error


@contextmanager
def _quiet() -> Iterator[None]:
    loggers = [logging.getLogger(name) for name in _TALKATIVE]
    before = [logger.disabled for logger in loggers]
    try:
        for logger in loggers:
            logger.disabled = True
        yield
    finally:
        for logger, disabled in zip(loggers, before, strict=True):
            logger.disabled = disabled


@contextmanager
def guarded(file: Path, reader: str) -> Iterator[None]:
    """Turn whatever a foreign reader raises into one :class:`ReadError` that names it.

    Its warnings, and what is logged of the same, are not the user's. ``BaseException`` because afmformats derives its
    errors from it; a stop by the user passes through.
    """
    try:
        with warnings.catch_warnings(), _quiet():
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
        cut = re.search(r"truncated file: eof = (\d+).* stored_eof = (\d+)", said)
        if cut:  # HDF5's words for it
            raise ReadError(f"{file}: cut short: {cut[1]} bytes of {cut[2]} are there", reader) from error
        raise ReadError(f"{file}: {reader} cannot read it: {said[:200]}", reader) from error


def refuse_traps(file: Path, head: bytes) -> None:
    """Refuse containers that unpack to too much, or make the reader open other files, or loop."""
    if head.startswith(b"PK\3\4"):
        with guarded(file, "zipfile"), zipfile.ZipFile(file) as archive:
            check_archive(file, archive)
    elif head[:2] in (b"\5\0", b"\0\5"):
        _check_igor(file, head)
    elif head.startswith(b"\x89HDF") or file.suffix.lower() in _HDF5_ENDINGS:
        _refuse_hdf5_traps(file)


def _check_igor(file: Path, head: bytes) -> None:
    """Igor binary waves of version 5: igor2 looks neither at the check sum nor at the sizes, and loops on some."""
    order = "<" if head[0] else ">"
    shorts = struct.unpack(f"{order}{min(len(head), 384) // 2}h", head[: min(len(head), 384) // 2 * 2])
    if len(head) < 384 or sum(shorts) & 0xFFFF:
        raise ReadError(f"{file}: the check sum of its header is wrong: it is damaged, or no Igor binary wave")
    parts = struct.unpack(f"{order}13i", head[4:56])  # wave, formula, note, units and labels of 4 dimensions, strings
    if min(parts) < 0 or 64 + sum(parts) > file.stat().st_size:
        raise ReadError(f"{file}: {file.stat().st_size} bytes long, but its header states {64 + sum(parts)}")


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
        _check_unpacked(file, unpacked, max(MAX_UNPACKED, 2 * file.stat().st_size))


def check_archive(file: Path, archive: zipfile.ZipFile) -> None:
    """Refuse an archive whose members, or one of them, unpack to more than is read. None can be read further than it
    says here."""
    members = archive.infolist()
    _check_unpacked(file, sum(item.file_size for item in members), FREE + RATIO * file.stat().st_size)
    for item in members:
        allowed = min(MAX_MEMBER, FREE + RATIO * item.compress_size)
        if not 0 <= item.file_size <= allowed:
            what = f"{printable(item.filename)[:80]!r} in it unpacks to {item.file_size / 2**20:.0f} MiB"
            raise ReadError(f"{file}: {what}; up to {allowed >> 20} MiB are read")


def _check_unpacked(file: Path, size: int, allowed: int) -> None:
    if size > allowed:
        raise ReadError(f"{file}: unpacks to {size / 2**20:.0f} MiB; up to {allowed >> 20} MiB are read")
