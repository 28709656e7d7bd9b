# SPDX-License-Identifier: BSD-3-Clause
"""Asylum force curves in two files, one wave each: ``...Defl.ibw`` and ``...ZSnsr.ibw`` (or ``...Raw.ibw``) beside it.

So a map is stored, ``Line0000Point0000Defl.ibw``. Both waves are in metres; the sensor's voltage grows towards the
sample, so z is its negative. The note says with ``Indexes`` where the movements end. Where it states no spring constant
and none is given the curve has deflections alone.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import Floats
from .._io.words import printable
from ..errors import ReadError
from .asylum import HEIGHTS, segments_of, stated, unit_of, wave_of
from .calibration import Calibration
from .checks import MAX_POINTS, MIN_POINTS
from .curve import ForceCurve

NAME = "nanotouch/asylum-pair"
_DEFLECTION = "Defl"
_HEIGHTS = tuple(one for one in HEIGHTS if one[0] in ("ZSnsr", "LVDT", "Raw"))
_PLACE = re.compile(r"Line(\d+)Point(\d+)")


def recognises(file: Path) -> bool:
    """Whether its name is that of one half of a pair, and the other half lies beside it."""
    return file.suffix.lower() == ".ibw" and _half(file) is not None


def holds_heights(file: Path) -> bool:
    """Whether it is the half of a pair that is read with the other."""
    half = _half(file) if file.suffix.lower() == ".ibw" else None
    return half is not None and file == half[1]


def files_of(file: Path) -> list[Path]:
    """Both halves, if it is one of a pair."""
    half = _half(file) if file.suffix.lower() == ".ibw" else None
    return [] if half is None else [half[0], half[1]]


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """The one curve; ReadError for the half that holds the heights, which would make every curve count twice."""
    half = _half(file)
    if half is None:
        raise ReadError(f"{file}: no second half of the pair beside it")
    deflection_file, height_file, channel = half
    if file == height_file:
        raise ReadError(f"{file}: holds the heights of {deflection_file.name}; read that")
    deflection, note = _values(deflection_file)
    height, _ = _values(height_file)
    if deflection.size != height.size:
        raise ReadError(f"{file}: {deflection.size} deflections, but {height.size} heights in {height_file.name}")
    meta: dict[str, Any] = {"format": "Asylum Research (pair of binary waves)", "path": file, "enum": 0}
    numbers = {
        "spring constant": stated(note, "SpringConstant") or calibration.spring_constant,
        "sensitivity": stated(note, "InvOLS"),
    }
    meta |= {key: value for key, value in numbers.items() if value is not None}
    place = _PLACE.search(file.name)
    if place:
        meta |= {"grid index y": int(place[1]), "grid index x": int(place[2])}
    segments, notes = segments_of(note, -height, deflection, channel, meta.get("spring constant"))
    meta["notes"] = (f"heights from {height_file.name}", *notes)
    return [ForceCurve(segments, meta, printable(file.name))]


def _half(file: Path) -> tuple[Path, Path, str] | None:
    """Files of deflection and height, and the column z comes from."""
    stem = file.stem
    endings = [_DEFLECTION, *(name for name, _ in _HEIGHTS)]
    ending = next((e for e in endings if stem.casefold().endswith(e.casefold())), None)
    if ending is None:
        return None
    common = stem[: -len(ending)]
    deflection = _beside(file, common + _DEFLECTION)
    for name, channel in _HEIGHTS:
        height = _beside(file, common + name)
        if height and deflection:
            return deflection, height, channel
    return None


def _beside(file: Path, stem: str) -> Path | None:
    """The file of this stem, in whatever case."""
    for suffix in (file.suffix, ".ibw", ".IBW"):
        for name in (stem, stem.lower(), stem.upper()):
            if file.with_name(name + suffix).exists():
                return file.with_name(name + suffix)
    return None


def _values(file: Path) -> tuple[Floats, str]:
    """Values [m] and note of a one-dimensional wave."""
    wave, note = wave_of(file)
    values = np.asarray(wave["wData"], np.float64) * unit_of(wave, file)
    if values.ndim != 1 or not MIN_POINTS <= values.size <= MAX_POINTS:
        raise ReadError(f"{file}: a wave of shape {values.shape}, expected one of at least {MIN_POINTS} points")
    return values, note
