# SPDX-License-Identifier: BSD-3-Clause
"""Force curves as afmformats and :func:`nanotouch.curves.write` store them, ``.h5``: a group for each curve, its
columns as datasets, its facts as attributes. The file is opened once, whatever it holds.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ReadError, require
from ..formats import HDF5

NAME = "nanotouch/hdf5-curves"
ENDINGS = (".h5", ".hdf5")
_MODALITIES = ("force-distance", "creep-compliance", "stress-relaxation")


@dataclass(frozen=True)
class Group:
    """One curve of an open file."""

    group: Any
    enum: int
    metadata: Mapping[str, Any]
    columns: tuple[str, ...]

    def __getitem__(self, name: str) -> Any:
        return self.group[name][()]


def recognises(file: Path, head: bytes) -> bool:
    """Whether it holds such curves."""
    if file.suffix.lower() not in ENDINGS or not head.startswith(HDF5):
        return False
    h5py = require("h5py", "curves")
    try:
        with h5py.File(file, "r") as opened:
            return _holds_curves(opened)
    except OSError:  # damaged; the reader that takes it says so
        return False


@contextmanager
def opened(file: Path) -> Iterator[list[Group]]:
    """Its curves in the order of their numbers."""
    h5py = require("h5py", "curves")
    with h5py.File(file, "r") as stored:
        if not _holds_curves(stored):
            raise ReadError(f"{file}: its content is not that of a {file.suffix} force curve file")
        numbers = sorted(int(name) for name in stored if name.isdecimal())
        groups = ((number, stored[str(number)]) for number in numbers)
        yield [Group(group, number, _facts(file, group, number), tuple(sorted(group))) for number, group in groups]


def _holds_curves(stored: Any) -> bool:
    if not {"software", "software version"} <= set(stored.attrs) or "0" not in stored:
        return False
    return _text(stored["0"].attrs.get("imaging mode", "")) in _MODALITIES


def _text(value: Any) -> str:
    return value.decode("utf-8", "replace") if isinstance(value, bytes) else str(value)


def _facts(file: Path, group: Any, number: int) -> dict[str, Any]:
    facts: dict[str, Any] = {"path": file, "enum": number}
    for key, value in group.attrs.items():
        plain = value.item() if isinstance(value, np.generic) else value
        if isinstance(plain, float) and math.isnan(plain):
            continue
        facts.setdefault(key, plain if isinstance(plain, (int, float)) else _text(plain))
    for axis in "xy":
        facts |= _place(facts, axis)
    return facts


def _place(facts: Mapping[str, Any], axis: str) -> dict[str, int]:
    """The place in a map, where a file states the position alone."""
    keys = [f"{name} {axis}" for name in ("position", "grid center", "grid size", "grid shape")]
    if f"grid index {axis}" in facts or not all(isinstance(facts.get(key), (int, float)) for key in keys):
        return {}
    position, center, size, shape = (float(facts[key]) for key in keys)
    if not (size > 0.0 and shape >= 1.0):
        return {}
    index = math.floor((position - center + 0.5 * size) / size * shape)
    return {f"grid index {axis}": min(max(index, 0), int(shape) - 1)}
