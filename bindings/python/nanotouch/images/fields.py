# SPDX-License-Identifier: BSD-3-Clause
"""Several channels in one file of Gwyddion's own format, or one as its Simple Field, with units and masks."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .. import guard
from .._io import worker
from .._io.files import checked_path, guarded
from .._io.writing import replacing
from ..errors import InvalidValue, ReadError, require
from . import gsf
from .channel import Plane, written_unit
from .checks import LENGTHS
from .reading import reader_of


def planes(path: str | os.PathLike[str], *, untrusted: bool | None = None) -> tuple[list[Plane], list[str]]:
    """Every channel of an image file as it is stored, and why others are left out. ``untrusted``: as in
    :func:`nanotouch.images.read`."""
    file = checked_path(path)
    if guard.wanted(untrusted):
        return _rechecked(file, worker.ask("images.planes", file, {}, tuple, [Plane]))
    name, reader = reader_of(file)
    found, left_out = [], []
    with guarded(file, name):
        listed = reader.channels(file)
    for channel in listed:
        try:
            with guarded(file, name):
                found.append(reader.read(file, channel.name))
        except ReadError as error:
            left_out.append(f"{channel.name}: {str(error).removeprefix(f'{file}: ')}")
    if not found:
        raise ReadError(f"{file}: no channel that can be read ({'; '.join(left_out)})")
    return found, left_out


def _rechecked(file: Path, answer: tuple[Any, ...]) -> tuple[list[Plane], list[str]]:
    found, left_out = answer if len(answer) == 2 else ([], [])
    if not found or not all(isinstance(plane, Plane) and isinstance(plane.values, np.ndarray) for plane in found):
        raise ReadError(f"{file}: the worker's answer is not what was asked for", "worker")
    return list(found), [str(text) for text in left_out]


def write_planes(path: str | os.PathLike[str], fields: Sequence[Plane]) -> Path:
    """Write channels as ``.gwy``, or one as ``.gsf``; lengths in metres, other units as they are. Where a value is not
    finite it is masked, and the median stands there; in a ``.gsf``, which has no mask, it stays NaN.

    Raises
    ------
    InvalidValue
        If there is no channel, the ending is another, or a channel has no finite value.
    """
    file = Path(path)
    if not fields:
        raise InvalidValue(f"{file}: no channel to write")
    if file.suffix.lower() == ".gsf" and len(fields) == 1:
        with replacing(file) as part:
            gsf.write(part, fields[0])
        return file
    if file.suffix.lower() != ".gwy":
        raise InvalidValue(f"{file}: several channels are written as .gwy, one as .gwy or .gsf")
    gwyfile = require("gwyfile", "images").objects
    container = gwyfile.GwyContainer()
    for number, field in enumerate(fields):
        known = np.isfinite(field.values)
        if not known.any():
            raise InvalidValue(f"{file}: {field.name} has no finite value")
        factor = LENGTHS.get(field.unit or "", 1.0)
        unit = written_unit(field.unit)
        values = np.where(known, field.values, np.median(field.values[known])) * factor
        ny, nx = values.shape
        pixel = field.pixel_size or (1.0, 1.0)
        frame = {"xreal": nx * pixel[1], "yreal": ny * pixel[0], "si_unit_xy": "m" if field.pixel_size else ""}
        # Gwyddion's first row is the top
        container[f"/{number}/data"] = gwyfile.GwyDataField(np.ascontiguousarray(values[::-1]), si_unit_z=unit, **frame)
        container[f"/{number}/data/title"] = field.name
        container[f"/{number}/data/visible"] = number == 0
        if not known.all():
            mask = (~known)[::-1].astype(np.float64)
            container[f"/{number}/mask"] = gwyfile.GwyDataField(mask, si_unit_z="", **frame)
    with replacing(file) as part, part.open("wb") as stream:
        container.tofile(stream)
    return file
