# SPDX-License-Identifier: BSD-3-Clause
"""A ``.zip`` of force curve files, such as colleagues send: each is unpacked beside the others and read as a file."""

from __future__ import annotations

import tempfile
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from .._io.files import check_archive
from .._io.words import printable
from ..errors import ReadError
from .curve import ForceCurve

NAME = "nanotouch/archive"
_MOST = 4096  # files
_OF_MAPS = ".csv"  # a map of AFM Workshop is a .zip of these, which afmformats reads as one


def recognises(file: Path, head: bytes) -> bool:
    """Whether it is an archive of files, and not a format that is kept in one."""
    if file.suffix.lower() != ".zip" or not head.startswith(b"PK\3\4"):
        return False
    with zipfile.ZipFile(file) as archive:
        names = _names(archive)
    return bool(names) and not all(name.lower().endswith(_OF_MAPS) for name in names)


def read(file: Path, read_one: Callable[[Path], list[ForceCurve]]) -> list[ForceCurve]:
    """The curves of all its files, in the order of their names; ReadError if one of them is none."""
    found: list[ForceCurve] = []
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(file) as archive:
        check_archive(file, archive)
        names = _names(archive)
        if len(names) > _MOST:
            raise ReadError(f"{file}: {len(names)} files; archives of up to {_MOST} are read")
        places = [Path(folder, str(number), Path(name).name) for number, name in enumerate(names)]
        for name, place in zip(names, places, strict=True):  # the names inside decide nothing about where they go
            if name.lower().endswith(".zip"):
                raise ReadError(f"{file}: {printable(place.name)} in it is an archive: unpack it first")
            place.parent.mkdir()
            place.write_bytes(archive.read(name))
        for place in places:
            try:
                curves = read_one(place)
            except ReadError as error:
                said = str(error).removeprefix(f"{place}: ")
                raise ReadError(f"{file}: {place.name} in it: {said}", error.reader) from None
            found += [
                replace(curve, meta=dict(curve.meta) | {"path": file, "enum": len(found) + number})
                for number, curve in enumerate(curves)
            ]
            place.unlink()
    return found


def _names(archive: zipfile.ZipFile) -> list[str]:
    """Its files, without folders and what systems leave."""
    names = (item.filename for item in archive.infolist() if not item.is_dir())
    return sorted(name for name in names if not name.startswith("__MACOSX") and not Path(name).name.startswith("."))
