# SPDX-License-Identifier: BSD-3-Clause
"""Bruker NanoScope ramps exported as text: the header, each line in quotes, then a table; or the table alone.

Names of columns say what, in which unit and on which way: ``Defl_pN_Ex``, ``Calc_Ramp_Rt_nm``, ``PF_Z_Sensor_nm_Ex``.
``Ex`` is the extension of the piezo, the approach, and ``Rt`` the retraction; both stand in the order of time. A column
whose numbers grow during the approach is a travel towards the sample, and z is its negative. A curve that was marked
and copied has two columns, named by their units alone: which way it is, its readings say. Samples that were never taken
are the lowest integer.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._io import nanoscope_header as header
from .._io import text
from .._io.words import counted, printable
from ..errors import ReadError
from .calibration import Calibration
from .checks import MAX_POINTS, MIN_POINTS
from .curve import ForceCurve, Role, Segment

NAME = "nanotouch/nanoscope-text"
_UNITS = {"nm": 1e-9, "um": 1e-6, "pm": 1e-12, "pN": 1e-12, "nN": 1e-9, "uN": 1e-6, "V": 1.0, "mV": 1e-3, "s": 1.0}
_DIMENSION = {"m": ("nm", "um", "pm"), "N": ("pN", "nN", "uN"), "V": ("V", "mV"), "s": ("s",)}
_WAYS: dict[str, Role] = {"ex": "approach", "rt": "retract"}
_LIST_END = re.compile(r'"?\\\*(?:Force file|File) list end')
_NAME = re.compile(r"[A-Za-z]\w*_(?:(?:Ex|Rt)(?:_\w+)?|\w+_(?:Ex|Rt))")
_PAIR = re.compile(r'"?([num~\xb5\u03bc]m)"?[\s;,]+"?([pnu~\xb5\u03bc]N|[num]m|m?V)"?')
_END = 0.05  # of a way, whose readings tell where it ended
_STANDS_OUT = 5.0  # of the scatter between neighbours; medians of a few of them differ by one
_HEIGHTS = (("z_sensor", "height (measured)"), ("height_sensor", "height (measured)"), ("zsensor", "height (measured)"),
            ("ramp", "height (piezo)"), ("height", "height (piezo)"), ("z", "height (piezo)"))  # fmt: skip


@dataclass(frozen=True)
class _Column:
    """One of the table, in SI; NaN where a shorter branch has ended."""

    name: str  # lower case, without unit and way
    unit: str  # SI
    values: Floats


def recognises(file: Path, head: bytes) -> bool:
    """Whether it begins with a header in quotes, or with names of columns as they have."""
    if not text.is_text(head):
        return False
    content = text.decoded(head)
    first = content.partition("\n")[0].strip()
    if re.match(r'"\\[?*]?(?:Force file|File) list"', content) or _PAIR.fullmatch(first):
        return True
    names = _names(first)
    return len(names) > 1 and all(_NAME.fullmatch(name) or name.lower().startswith("time") for name in names)


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """The one curve; `calibration` only where the header states none."""
    content = text.decoded(file.read_bytes())
    lines = content.splitlines()
    cut = text.ends_cut(content)
    ends = [number for number, line in enumerate(lines) if _LIST_END.match(line)]
    begin = ends[-1] + 1 if ends else 0
    if (not ends and lines[0].startswith('"\\')) or len(lines) < begin + 1 + MIN_POINTS:
        raise ReadError(f"{file}: a text export of NanoScope without a table")
    sections = header.parsed(file, [line.strip().removeprefix('"').removesuffix('"') for line in lines[:begin]])
    columns, notes = _table(file, [line for line in lines[begin : len(lines) - cut] if line.strip()])
    notes += ["the last row is cut off and left out"] if cut else []
    stiffness, sensitivity = _stated(sections, calibration)
    lowest = _lowest(sections)
    segments = []
    z_way, channel = _height(file, columns)
    for way, role in _WAYS.items():
        if way not in z_way:
            continue
        segment, told = _segment(file, role, columns[way], z_way[way], channel, _Known(stiffness, sensitivity, lowest))
        segments.append(segment)
        notes += [one for one in told if one not in notes]
    first = sections[0] if sections else header.Section(file, "")
    meta: dict[str, Any] = {
        "format": "Bruker NanoScope (text export)", "instrument": "Bruker NanoScope", "enum": 0, "path": file,
        "software version": first.get("version", ""), "date": first.get("date", ""),
    }  # fmt: skip
    meta |= {key: value for key, value in (("spring constant", stiffness), ("sensitivity", sensitivity)) if value}
    if stiffness is None and segments[0].force is None:
        notes.append("states no spring constant: deflections alone; give it for forces")
    return [ForceCurve(tuple(segments), meta | ({"notes": tuple(notes)} if notes else {}), printable(file.name))]


@dataclass(frozen=True)
class _Known:
    """Of the lever; lowest: what the smallest integer is in V, where the header states a scale."""

    stiffness: float | None
    sensitivity: float | None
    lowest: float | None


def _lowest(sections: list[header.Section]) -> float | None:
    for one in sections:
        scale = one.scaled(":Z scale") if "[Deflection" in one.channel else None
        if scale is not None:
            return -32768.0 * scale[1]
    return None


def _names(line: str) -> list[str]:
    return [name.strip().strip('"') for name in re.split(r"[\t;,]", line.strip().rstrip(";,"))]


def _stated(sections: list[header.Section], given: Calibration) -> tuple[float | None, float | None]:
    """Spring constant and sensitivity: of the header, else what is given."""
    stiffness = next((one.spring_constant() for one in sections if "spring constant" in one), None)
    known = header.sensitivity(sections, "DeflSens") if sections else None
    return stiffness or given.spring_constant, known[0] if known else given.sensitivity


def _table(file: Path, lines: list[str]) -> tuple[dict[str, list[_Column]], list[str]]:
    """The columns of each way, and what has to be told of them."""
    pair = _PAIR.fullmatch(lines[0].strip())
    names = [pair[1], pair[2]] if pair else _names(lines[0])
    content = text.plain("\n".join(lines[1:])).splitlines()
    rows = [line.split("\t") for line in content]
    longest = max((len(row) for row in rows), default=0)
    if not MIN_POINTS <= len(rows) <= MAX_POINTS or longest != len(names):
        raise ReadError(f"{file}: {len(rows)} rows of up to {longest} numbers, but it names {len(names)} columns")
    try:
        values = np.array([row + ["nan"] * (longest - len(row)) for row in rows], np.float64)
    except ValueError as error:
        raise ReadError(f"{file}: its table holds what is no number: {error}") from None
    if pair:
        return _of_pair(file, names, values)
    found: dict[str, list[_Column]] = {way: [] for way in _WAYS}
    for number, name in enumerate(names):
        parts = header.plain_unit(name).split("_")
        way = next((part.lower() for part in parts if part.lower() in _WAYS), "")
        unit = next((part for part in reversed(parts) if part in _UNITS), "")
        if not way or not unit:
            continue
        kept = "_".join(part for part in parts if part.lower() != way and part != unit).lower()
        found[way].append(_column(kept, unit, values[:, number]))
    return found, []


def _column(name: str, unit: str, values: Floats) -> _Column:
    dimension = next(key for key, members in _DIMENSION.items() if unit in members)
    return _Column(name, dimension, values * _UNITS[unit])


def _of_pair(file: Path, units: list[str], values: Floats) -> tuple[dict[str, list[_Column]], list[str]]:
    """One way, as its readings say: they are largest where the base was nearest."""
    z, signal = (_column(name, header.plain_unit(unit), column)
                 for name, unit, column in zip(("ramp", "defl"), units, values.T, strict=True))  # fmt: skip
    count = max(int(_END * len(values)), MIN_POINTS // 4)
    first, last = signal.values[:count], signal.values[-count:]
    scatter = float(np.median(np.abs(np.diff(signal.values))))
    rise = float(np.median(last) - np.median(first))
    if not abs(rise) > _STANDS_OUT * scatter:
        raise ReadError(
            f"{file}: two columns, {units[0]} and {units[1]}, that do not say whether they are an approach or a "
            "retraction: its readings end as they begin; export both ways with names of columns"
        )
    way = "ex" if rise > 0.0 else "rt"
    told = f"its columns do not say which way it is: taken as {_WAYS[way]}, as its readings are largest at its "
    return {"ex": [], "rt": []} | {way: [z, signal]}, [told + ("end" if way == "ex" else "beginning")]


def _height(file: Path, columns: dict[str, list[_Column]]) -> tuple[dict[str, Floats], str]:
    """z of each way, and the column that it comes from."""
    for part, channel in _HEIGHTS:
        found = {
            way: next((one.values for one in listed if part in one.name and one.unit == "m"), None)
            for way, listed in columns.items()
        }
        there = {way: values for way, values in found.items() if values is not None}
        if not there:
            continue
        rises = {way: _rise(values) for way, values in there.items()}
        towards = rises["ex"] > 0.0 if "ex" in rises else rises["rt"] < 0.0
        if "ex" in rises and "rt" in rises and rises["ex"] * rises["rt"] > 0.0:
            raise ReadError(
                f"{file}: {part!r} changes in one direction on both ways: they are not approach and retraction"
            )
        return {way: -values if towards else values for way, values in there.items()}, channel
    names = ", ".join(f"{one.name} [{one.unit}]" for listed in columns.values() for one in listed)
    raise ReadError(f"{file}: no ramp and no height sensor among its columns ({names or 'none with unit and way'})")


def _rise(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(known[-1] - known[0]) if known.size else 0.0


def _segment(
    file: Path, role: Role, columns: list[_Column], z: Floats, channel: str, known: _Known
) -> tuple[Segment, list[str]]:
    stiffness, sensitivity = known.stiffness, known.sensitivity
    signals = {one.unit: one.values for one in reversed(columns) if "defl" in one.name or one.name == "force"}
    told = []
    if "N" in signals:
        force: Floats | None = signals["N"]
        bent = None if stiffness is None else signals["N"] / stiffness
        if stiffness is not None and "m" in signals:
            told += _contradiction(signals["N"], signals["m"], stiffness)
    elif "m" in signals or ("V" in signals and sensitivity is not None):
        bent = signals["m"] if "m" in signals else signals["V"] * float(sensitivity or 0.0)
        force = None if stiffness is None else bent * stiffness
    else:
        lacks = "a deflection in V, and no sensitivity is stated; give it" if "V" in signals else "no deflection"
        raise ReadError(f"{file}: the {role} has {lacks}")
    signal = force if force is not None else bent
    assert signal is not None
    keep = np.isfinite(z) & np.isfinite(signal)
    filler = _fillers(signal, signals.get("V"), known.lowest)
    if filler.any():
        told.append(
            f"{counted(int(filler.sum()), 'sample')} at the ends of the {role} left out: lowest integers, never taken"
        )
    keep &= ~filler
    if not keep.any():
        raise ReadError(f"{file}: the {role} has no sample with height and deflection")
    clock = next((one.values for one in columns if one.name == "time"), np.full(z.size, np.nan))
    segment = Segment(
        role, clock[keep], z[keep], channel,
        None if force is None else force[keep], None if bent is None else bent[keep],
    )  # fmt: skip
    return segment, told


def _fillers(signal: Floats, volts: Floats | None, lowest: float | None) -> NDArray[np.bool_]:
    """Runs of the lowest value at the ends: of the lowest integer, or of a value further from all others than these are
    from each other."""
    known = np.isfinite(signal)
    least = known & (signal == np.min(signal[known], initial=np.inf))
    before, after = np.logical_and.accumulate(least | ~known), np.logical_and.accumulate((least | ~known)[::-1])[::-1]
    run = (before | after) & least
    others = signal[known & ~least]
    if not run.any() or not others.size:
        return np.zeros(signal.size, bool)
    if volts is not None and lowest is not None and np.isclose(volts[run][0], lowest, rtol=1e-4):
        return np.asarray(run)
    apart = float(others.min()) - float(signal[run][0])
    return np.asarray(run & (run.sum() > 1 and apart > float(np.ptp(others))))


def _contradiction(force: Floats, bent: Floats, stiffness: float) -> list[str]:
    """Where the columns of force and deflection do not differ by the spring constant."""
    span = float(np.nanmax(bent) - np.nanmin(bent))
    if not span > 0.0:
        return []
    slope = float(np.nanmax(force) - np.nanmin(force)) / span
    if abs(slope - stiffness) <= 0.02 * stiffness:
        return []
    return [f"its columns of force and deflection differ by {slope:.4g} N/m, but its header states {stiffness:.4g} N/m"]
