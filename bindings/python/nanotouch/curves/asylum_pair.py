# SPDX-License-Identifier: BSD-3-Clause
"""Asylum force curves in two files, one wave each: ``...Defl.ibw`` and ``...ZSnsr.ibw`` (or ``...Raw.ibw``) beside it.

So a map is stored, ``Line0000Point0000Defl.ibw``. Both waves are in metres; the sensor's voltage grows towards the
sample, so z is its negative. The note says with ``Indexes`` where the movements end. Where it states no spring constant
and none is given the curve has deflections alone.
"""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import Floats
from .._io.files import checked_path, refuse_traps
from .._io.readers import head_of
from .._io.words import printable
from ..errors import ReadError, require
from .calibration import Calibration
from .checks import MAX_POINTS, MIN_POINTS
from .curve import ForceCurve, Role, Segment

NAME = "nanotouch/asylum-pair"
_DEFLECTION = "Defl"
_HEIGHTS = (("ZSnsr", "height (measured)"), ("LVDT", "height (measured)"), ("Raw", "height (piezo)"))
_PLACE = re.compile(r"Line(\d+)Point(\d+)")
_REST = 0.1  # of the travel; a movement over less is a pause


def recognises(file: Path) -> bool:
    """Whether its name is that of one half of a pair, and the other half lies beside it."""
    return file.suffix.lower() == ".ibw" and _half(file) is not None


def holds_heights(file: Path) -> bool:
    """Whether it is the half of a pair that is read with the other."""
    half = _half(file) if file.suffix.lower() == ".ibw" else None
    return half is not None and file == half[1]


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """The one curve; ReadError for the half that holds the heights, which would make every curve count twice."""
    half = _half(file)
    if half is None:
        raise ReadError(f"{file}: no second half of the pair beside it")
    deflection_file, height_file, channel = half
    if file == height_file:
        raise ReadError(f"{file}: holds the heights of {deflection_file.name}; read that")
    deflection, note = _wave(deflection_file)
    height, _ = _wave(height_file)
    if deflection.size != height.size:
        raise ReadError(f"{file}: {deflection.size} deflections, but {height.size} heights in {height_file.name}")
    known = np.isfinite(deflection) & np.isfinite(height)
    meta: dict[str, Any] = {"format": "Asylum Research (pair of binary waves)", "path": file, "enum": 0}
    stated = {
        "spring constant": _stated(note, "SpringConstant") or calibration.spring_constant,
        "sensitivity": _stated(note, "InvOLS"),
    }
    meta |= {key: value for key, value in stated.items() if value is not None}
    place = _PLACE.search(file.name)
    if place:
        meta |= {"grid index y": int(place[1]), "grid index x": int(place[2])}
    notes = [f"heights from {height_file.name}"]
    if "spring constant" not in meta:
        notes.append("states no spring constant: deflections alone; give it for forces")
    if not known.all():
        notes.append(f"{int(np.count_nonzero(~known))} samples without a number left out")
    meta["notes"] = tuple(notes)
    segments = []
    for part in _parts(note, -height, known):
        inside = np.flatnonzero(known[part]) + part.start
        z, bent = -height[inside], deflection[inside]
        force = None if "spring constant" not in meta else bent * meta["spring constant"]
        time = np.full(inside.size, np.nan)  # the wave's step is not that of stored points
        segments.append(Segment(_role(z, float(np.ptp(-height[known]))), time, z, channel, force, bent))
    return [ForceCurve(tuple(segments), meta, printable(file.name))]


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


def _wave(file: Path) -> tuple[Floats, str]:
    """Values [m] and note of a one-dimensional wave."""
    checked_path(file)
    refuse_traps(file, head_of(file))
    wave = require("igor2.binarywave", "curves").load(str(file))["wave"]
    values = np.asarray(wave["wData"], np.float64)
    if values.ndim != 1 or not MIN_POINTS <= values.size <= MAX_POINTS:
        raise ReadError(f"{file}: a wave of shape {values.shape}, expected one of at least {MIN_POINTS} points")
    return values, bytes(wave["note"]).decode("latin-1")


def _stated(note: str, key: str) -> float | None:
    """A positive number of the note."""
    match = re.search(rf"(?m)^{key}:\s*([-+0-9.eE]+)\s*$", note.replace("\r", "\n"))
    try:
        value = float(match[1]) if match else 0.0
    except ValueError:
        return None
    return value if 0.0 < value < np.inf else None


def _parts(note: str, z: Floats, known: np.ndarray[Any, np.dtype[np.bool_]]) -> list[slice]:
    """Runs of points between the indexes of the note; without any, up to the deepest point and from there on."""
    match = re.search(r"Indexes:\s*([0-9, ]+)", note)
    ends = [int(word) for word in re.findall(r"\d+", match[1])] if match else []
    edges = sorted({min(end + (number > 0), z.size) for number, end in enumerate(ends)} | {0, z.size})
    if len(edges) == 2:
        edges = [0, int(np.argmin(np.where(known, z, np.inf))) + 1, z.size]
    return [slice(a, b) for a, b in pairwise(edges) if known[a:b].any()]


def _role(z: Floats, travel: float) -> Role:
    rise = float(z[-1] - z[0])
    if abs(rise) < _REST * travel:
        return "pause"
    return "approach" if rise < 0.0 else "retract"
