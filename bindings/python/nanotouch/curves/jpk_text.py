# SPDX-License-Identifier: BSD-3-Clause
"""JPK force curves exported as text by its data processing.

Blocks of ``# key: value`` lines, one for each segment, each before its rows. ``columns``, ``units`` and
``calibrationSlots`` name what stands in a row, ``springConstant`` and ``sensitivity`` how the deflection was
calibrated.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import Floats
from .._io import text
from .._io.words import counted, printable
from ..errors import ReadError
from .calibration import Calibration
from .checks import MAX_POINTS
from .curve import ForceCurve, Segment
from .jpk import HEIGHTS, ROLES

NAME = "nanotouch/jpk-text"
_ENDINGS = (".txt", ".out")
_MARKS = re.compile(r"^# (?:TEXT EXPORT|xPosition|approachID|segmentIndex|force-settings|data-description)\b", re.M)
_PREFIX = {"": 1.0, "m": 1e-3, "u": 1e-6, "µ": 1e-6, "n": 1e-9, "p": 1e-12}
_META = {"data-description.instrument": "instrument", "data-description.source-software": "software version",
         "approachID": "session id", "feedbackMode": "feedback mode", "date": "date"}  # fmt: skip
_CUT = "\0 cut"  # no key of the file's


@dataclass
class _Block:
    """One segment: what stands before its rows, and the rows."""

    facts: dict[str, str] = field(default_factory=dict)
    rows: list[str] = field(default_factory=list)


def recognises(file: Path, head: bytes) -> bool:
    """Whether it begins as such exports do."""
    return file.suffix.lower() in _ENDINGS and text.is_text(head) and bool(_MARKS.search(text.decoded(head)))


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """All curves with the file's own calibration; `calibration` only where the file states none."""
    content = text.decoded(file.read_bytes())
    blocks = list(_blocks(text.plain(content)))
    if not blocks:
        raise ReadError(f"{file}: a text export of JPK without a segment")
    if sum(len(block.rows) for block in blocks) > MAX_POINTS:
        raise ReadError(f"{file}: more than {MAX_POINTS} points in all")
    curves: list[list[_Block]] = []
    for block in blocks:
        begins = not curves or block.facts.get("segmentIndex", "") == "0"
        begins = begins or block.facts.get("index") != curves[-1][-1].facts.get("index")
        curves.extend([[]] if begins else [])
        curves[-1].append(block)
    if text.ends_cut(content):
        blocks[-1].rows.pop()
        blocks[-1].facts[_CUT] = "the last row is cut off and left out"
    return [_curve(file, number, one, calibration) for number, one in enumerate(curves)]


def _blocks(content: str) -> Iterator[_Block]:
    """Facts of a block are its own; those of the file's head count for all."""
    block = _Block()
    for line in content.splitlines():
        if line.startswith("#"):
            if block.rows:
                yield block
                block = _Block(dict(block.facts))
            key, colon, value = line[1:].partition(":")
            if colon:
                block.facts[key.strip()] = value.strip()
        elif line.strip():
            block.rows.append(line)
    if block.rows:
        yield block


def _curve(file: Path, number: int, blocks: list[_Block], given: Calibration) -> ForceCurve:
    meta: dict[str, Any] = {"enum": number, "path": file, "software": "JPK", "format": "JPK (text export)"}
    meta |= {name: value for key, name in _META.items() if (value := blocks[0].facts.get(key, ""))}
    for axis in "xy":
        meta |= _number(blocks[0], f"{axis}Position", f"position {axis}")
    left_out: Counter[str] = Counter()
    segments, start = [], 0.0
    for place, block in enumerate(blocks):
        style = block.facts.get("segment", "")
        if style not in ROLES:
            left_out[style] += 1
            continue
        segment, start = _segment(file, place, block, meta, given, start)
        segments.append(segment)
    if not segments:
        raise ReadError(
            f"{file}: curve {number} has no segments of style {', '.join(ROLES)}, only {', '.join(left_out)}"
        )
    notes = [f"{counted(n, 'segment')} of style {s!r} left out" for s, n in left_out.items()]
    notes += [block.facts[_CUT] for block in blocks if _CUT in block.facts]
    setpoint = _number(blocks[0], "force-settings.relative-setpoint", "setpoint")
    if "spring constant" not in meta and segments[0].force is None:
        notes.append("states no spring constant: deflections alone; give it for forces")
    if notes:
        meta["notes"] = tuple(notes)
    if setpoint and meta.get("spring constant") and meta.get("sensitivity"):
        meta["setpoint"] = setpoint["setpoint"] * meta["spring constant"] * meta["sensitivity"]
    return ForceCurve(tuple(segments), meta, printable(file.name))


def _number(block: _Block, key: str, name: str) -> dict[str, float]:
    try:
        return {name: float(block.facts[key])}
    except (KeyError, ValueError):
        return {}


def _segment(
    file: Path, place: int, block: _Block, meta: dict[str, Any], given: Calibration, start: float
) -> tuple[Segment, float]:
    """The segment, and when it ends."""
    where = f"{file}: segment {place}"
    try:
        values = text.table(block.rows)
    except text.NotATable as error:
        raise ReadError(f"{where}: {error}") from None
    names = block.facts.get("columns", "").split()
    if len(names) != values.shape[1]:
        raise ReadError(f"{where} has rows of {values.shape[1]} numbers, but names {len(names)} columns")
    columns = _Columns(where, names, block.facts.get("units", "").split(), values)
    channel = next((one for one in HEIGHTS if one[0] in names), None)
    if channel is None or "vDeflection" not in names:
        raise ReadError(f"{where} has no height or no vDeflection; it has {', '.join(names)}")
    z = columns.si(channel[0], "m")
    force, deflection = _calibrated(columns, block, meta, given)
    clock = columns.si("time", "s") if "time" in names else np.full(z.size, np.nan)
    time = clock + start
    end = float(time[-1] + np.median(np.diff(time))) if z.size > 1 and np.isfinite(time).all() else start
    return Segment(ROLES[block.facts["segment"]], time, z, channel[2], force, deflection), end


@dataclass(frozen=True)
class _Columns:
    where: str
    names: list[str]
    units: list[str]
    values: Floats

    def unit(self, name: str) -> str:
        number = self.names.index(name)
        return self.units[number] if number < len(self.units) else ""

    def si(self, name: str, unit: str) -> Floats:
        """A column in this unit."""
        stated = self.unit(name)
        factor = _PREFIX.get(stated.removesuffix(unit)) if stated.endswith(unit) else None
        if factor is None:
            raise ReadError(f"{self.where}: {name!r} is in {stated!r}, expected {unit}")
        return self.values[:, self.names.index(name)] * factor


def _calibrated(
    columns: _Columns, block: _Block, meta: dict[str, Any], given: Calibration
) -> tuple[Floats | None, Floats | None]:
    """Force and deflection, whichever of force, deflection and volts stands in the rows; None for what is not known."""
    unit = columns.unit("vDeflection")[-1:]
    needed: tuple[str, ...] | None = {"N": (), "m": (), "V": ("sensitivity",)}.get(unit)
    if needed is None:
        raise ReadError(f"{columns.where}: 'vDeflection' is in {columns.unit('vDeflection')!r}, expected N, m or V")
    stated = _number(block, "springConstant", "spring constant") | _number(block, "sensitivity", "sensitivity")
    for key in ("spring constant", "sensitivity"):
        value = stated.get(key) or given.given[key]
        if value is None and key in needed:
            raise ReadError(f"{columns.where}: states no {key}; give it")
        if value is not None and meta.setdefault(key, value) != value:
            raise ReadError(f"{columns.where}: states two values of its {key}, {meta[key]:g} and {value:g}")
    signal, stiffness = columns.si("vDeflection", unit), meta.get("spring constant")
    if unit == "N":
        return signal, None if stiffness is None else signal / float(stiffness)
    deflection = signal if unit == "m" else signal * float(meta["sensitivity"])
    return None if stiffness is None else deflection * float(stiffness), deflection
