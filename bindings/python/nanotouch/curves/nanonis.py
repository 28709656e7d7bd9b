# SPDX-License-Identifier: BSD-3-Clause
"""Nanonis spectroscopy over z, ``.dat``: lines ``key<tab>value``, then ``[DATA]``, names of columns and numbers.

Names carry the unit, and what was measured on the way back: ``Deflection [bwd] (m)``. Columns of the way back stand at
the same z as those of the way there, against the order of time. A force curve needs a column of a force [N], or of a
deflection in m or V; spectra over the bias, or of currents and frequency shifts alone, are refused.
"""

from __future__ import annotations

import codecs
import re
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .._arrays import Floats
from .._io import text
from .._io.words import counted, printable
from ..errors import ReadError
from ..units import UNITS
from .calibration import Calibration
from .checks import MAX_POINTS, MIN_POINTS
from .curve import ForceCurve, Role, Segment

NAME = "nanotouch/nanonis-spectroscopy"
_DATA = re.compile(r"^\[DATA\][ \t]*\r?$", re.MULTILINE)
_COLUMN = re.compile(r"(?P<name>.*?)(?P<back> \[bwd\])?(?P<other> \[[^\]]*\])* \((?P<unit>[^()]*)\)")
_Z = ("Z", "Z rel")  # absolute before relative
_AGREE = 0.05  # of the travel, by which these two may differ


def recognises(file: Path, head: bytes) -> bool:
    """Whether it begins as Nanonis' spectra do."""
    return file.suffix.lower() == ".dat" and head.removeprefix(codecs.BOM_UTF8).startswith(b"Experiment\t")


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """The one curve; `calibration` gives what such files do not state."""
    header, *bodies = _DATA.split(file.read_bytes().decode("utf-8-sig", "replace"), maxsplit=1)
    if not bodies:
        raise ReadError(f"{file}: lacks a line [DATA]")
    facts = dict(line.split("\t")[:2] for line in header.splitlines() if "\t" in line)
    names, every, cut = _table(file, bodies[0])
    values, unmeasured = _measured(every)
    columns = [column for name, row in zip(names, values, strict=True) if (column := _column(name, row))]
    heights = [found for name in _Z for found in columns if found.is_height(name)]
    signal = _signal(columns)
    if not heights or signal is None:
        what = facts.get("Experiment", "spectroscopy")
        raise ReadError(
            f"{file}: {what} without a z and a deflection or force in m, N or V; it holds {', '.join(names)}"
        )
    there, back = signal
    meta: dict[str, Any] = {"format": "Nanonis", "instrument": "Nanonis", "path": file, "enum": 0}
    meta |= {"date": facts.get("Saved Date", "")}
    factor, notes = _factor(file, there.unit, calibration, meta)
    notes += (*unmeasured, *cut, *_disagreement(heights))
    if notes:
        meta["notes"] = notes
    z = heights[0].values
    segments = [_segment(z, there.values, there.unit, factor, meta)]
    if back is not None:
        segments.append(_segment(z[::-1], back.values[::-1], there.unit, factor, meta))
    return [ForceCurve(tuple(segments), meta, printable(file.name))]


class _Column(NamedTuple):
    """A column of the table in SI."""

    name: str
    unit: str
    """m, N or V"""
    back: bool
    other: bool
    """of an average or a repetition"""
    values: Floats

    def is_height(self, name: str) -> bool:
        plain = not (self.back or self.other) and self.unit == "m"
        return plain and self.name == name and float(np.ptp(self.values)) > 0.0


def _column(name: str, values: Floats) -> _Column | None:
    """None for a unit that is none of a length, a force or a voltage."""
    match = _COLUMN.fullmatch(name)
    stated = match["unit"].strip().replace("\xb5", "u").replace("\u03bc", "u") if match else ""
    for unit in ("m", "N", "V"):
        factor = 1e-10 if (unit, stated) in (("m", "\xc5"), ("m", "\u212b")) else UNITS[unit].get(stated)
        if match and factor is not None:
            return _Column(match["name"], unit, bool(match["back"]), bool(match["other"]), values * factor)
    return None


def _disagreement(heights: list[_Column]) -> tuple[str, ...]:
    travels = [float(np.ptp(found.values)) for found in heights]
    if abs(travels[-1] - travels[0]) <= _AGREE * travels[0]:
        return ()
    words = " and ".join(
        f"{found.name} over {1e9 * travel:.4g} nm" for found, travel in zip(heights, travels, strict=True)
    )
    return (f"{words} disagree: {heights[0].name} is taken",)


def _table(file: Path, body: str) -> tuple[list[str], Floats, tuple[str, ...]]:
    """Names, columns, and a note of a last row that is cut off."""
    first, _, rest = body.strip("\r\n").partition("\n")
    names = [name.strip() for name in first.split("\t")] if first else []
    try:
        lines = text.plain(rest).splitlines()
    except text.NotATable as error:
        raise ReadError(f"{file}: {error}") from None
    rows = [line.split("\t") for line in lines if line.strip()]
    cut = bool(rows) and (len(rows[-1]) < len(names) or text.ends_cut(body))
    rows = rows[:-1] if cut else rows
    if not MIN_POINTS <= len(rows) <= MAX_POINTS or any(len(row) != len(names) for row in rows):
        raise ReadError(f"{file}: {len(rows)} rows, or rows of another length than its {len(names)} columns")
    told = ("the last row is cut off and left out",) if cut else ()
    return names, np.array(rows, np.float64).T, told


def _measured(values: Floats) -> tuple[Floats, tuple[str, ...]]:
    """Without the last rows, all NaN, of a spectrum that was stopped; and a note of them."""
    seen = np.flatnonzero(~np.isnan(values).all(axis=0))
    last = int(seen[-1]) + 1 if seen.size else 0
    left = values.shape[1] - last
    if last < MIN_POINTS:
        raise ReadError(f"{last} rows of numbers before those of NaN; {MIN_POINTS} or more are read")
    return values[:, :last], (f"{counted(left, 'row')} of NaN at the end left out",) if left else ()


def _signal(columns: list[_Column]) -> tuple[_Column, _Column | None] | None:
    """Columns of the way there and back: a force before a deflection in m, that before one in V."""
    for word, unit in (("force", "N"), ("deflection", "m"), ("deflection", "V")):
        fits = [one for one in columns if word in one.name.casefold() and one.unit == unit and not one.other]
        there = next((one for one in fits if not one.back), None)
        if there is not None:
            return there, next((one for one in fits if one.back and one.name == there.name), None)
    return None


def _factor(file: Path, unit: str, given: Calibration, meta: dict[str, Any]) -> tuple[float, tuple[str, ...]]:
    """From the column to the deflection (from m, V) or to the force (from N), and what has to be told."""
    if given.spring_constant is not None:
        meta["spring constant"] = given.spring_constant
    if unit == "V":
        if given.sensitivity is None:
            raise ReadError(f"{file}: its deflection is in V, and it states no sensitivity; give it")
        meta["sensitivity"] = given.sensitivity
        return given.sensitivity, ()
    if unit == "m" and given.spring_constant is None:
        return 1.0, ("states no spring constant: deflections alone; give it for forces",)
    return 1.0, ()


def _segment(z: Floats, signal: Floats, unit: str, factor: float, meta: dict[str, Any]) -> Segment:
    role: Role = "approach" if z[-1] < z[0] else "retract"
    stiffness: float | None = meta.get("spring constant")
    values, per_metre = signal * factor, 1.0 if stiffness is None else stiffness
    force = values if unit == "N" else values * per_metre
    deflection = values / per_metre if unit == "N" else values
    return Segment(
        role,
        np.full(z.size, np.nan),
        z,
        "height (measured)",
        None if unit != "N" and stiffness is None else force,
        None if unit == "N" and stiffness is None else deflection,
    )
