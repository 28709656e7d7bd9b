# SPDX-License-Identifier: BSD-3-Clause
"""NT-MDT force curves that Nova exported as text: three columns of numbers and nothing else.

They are the height [nm] and the detector's reading [nA] on the way in and out, as afmformats' author found out. So the
sensitivity is in metres per **ampere**. At the beginning of a column stand copies of its first number where the other
branch is longer.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import Floats
from .._io import text
from .._io.words import counted, printable
from ..errors import ReadError
from .calibration import DETECTOR, Calibration, check_detector
from .checks import MAX_POINTS, MIN_POINTS
from .curve import ForceCurve, Role, Segment

NAME = "nanotouch/nova-text"
_COLUMNS = 3
_NANO = 1e-9


def recognises(file: Path, head: bytes) -> bool:
    """Whether it begins with rows of three numbers."""
    if file.suffix.lower() != ".txt" or not text.is_text(head):
        return False
    try:
        lines = text.plain(text.decoded(head)).splitlines()[:-1]  # the last one may be cut
    except text.NotATable:
        return False
    return bool(lines) and all(_is_row(line) and len(line.split()) == _COLUMNS for line in lines)


def _is_row(line: str) -> bool:
    return text.is_row(line) or set(line.casefold().split()) == {"nan"}


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """The one curve; `calibration` gives what such files do not state."""
    missing = [key for key, value in calibration.given.items() if value is None]
    if missing:
        raise ReadError(f"{file}: states no {' and no '.join(missing)}; give it (the sensitivity in m/A, as 50nm/nA)")
    assert calibration.sensitivity is not None
    assert calibration.spring_constant is not None
    check_detector(calibration.sensitivity, "A", file)
    content = text.decoded(file.read_bytes())
    cut = text.ends_cut(content)
    try:
        lines = text.plain(content).splitlines()
        values = text.table(lines[: len(lines) - cut])
    except text.NotATable as error:
        raise ReadError(f"{file}: not the table of three columns that Nova exports: {error}") from None
    if values.shape[1] != _COLUMNS or not MIN_POINTS <= len(values) <= MAX_POINTS:
        raise ReadError(f"{file}: {len(values)} rows of {values.shape[1]} numbers, expected {MIN_POINTS} or more of 3")
    values *= _NANO
    heights = values[np.isfinite(values[:, 0]), 0]
    outwards = values if heights.size and heights[-1] >= heights[0] else values[::-1]
    branches: tuple[tuple[Role, Floats], ...] = (
        ("approach", outwards[:, :2]),
        ("retract", outwards[:, ::2]),
    )
    meta: dict[str, Any] = {
        "enum": 0, "imaging mode": "force-distance", "path": file, "format": "NT-MDT (exported by NT-MDT Nova)",
        "spring constant": calibration.spring_constant, "sensitivity": calibration.sensitivity, DETECTOR: "A",
    }  # fmt: skip
    segments = []
    notes = ["the last row is cut off and left out"] if cut else []
    for role, rows in branches:
        known = rows[np.isfinite(rows).all(axis=1)]
        if not len(known):
            raise ReadError(f"{file}: its {role} has no numbers")
        if len(known) < len(rows):
            notes.append(f"{counted(len(rows) - len(known), 'row')} of the {role} without a number left out")
        whole = _without_padding(known)
        if copies := len(known) - len(whole):
            notes.append(f"{counted(copies, 'row')} of the {role} that repeat its first reading left out: "
                         "Nova's padding, or a detector at the end of its range")  # fmt: skip
        branch = whole[:: -1 if role == "approach" else 1]
        bent = branch[:, 1] * calibration.sensitivity
        time = np.full(len(branch), np.nan)
        force = bent * calibration.spring_constant
        segments.append(Segment(role, time, branch[:, 0], "height (measured)", force, bent))
    if notes:
        meta["notes"] = tuple(notes)
    return [ForceCurve(tuple(segments), meta, printable(file.name))]


def _without_padding(branch: Floats) -> Floats:
    """Without the copies of the first reading at its beginning."""
    others = np.flatnonzero(branch[:, 1] != branch[0, 1])
    return branch[others[0] - 1 :] if others.size else branch
