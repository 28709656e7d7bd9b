# SPDX-License-Identifier: BSD-3-Clause
"""Bruker NanoScope ramps exported as text: the header, each line in quotes, then a table.

Names of columns say what, in which unit and on which way: ``Defl_pN_Ex``, ``Calc_Ramp_Rt_nm``, ``PF_Z_Sensor_nm_Ex``.
``Ex`` is the extension of the piezo, the approach, and ``Rt`` the retraction; both stand in the order of time. A column
whose numbers grow during the approach is a travel towards the sample, and z is its negative.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import Floats
from .._io import nanoscope_header as header
from .._io import text
from .._io.words import printable
from ..errors import ReadError
from .calibration import Calibration
from .checks import MAX_POINTS, MIN_POINTS
from .curve import ForceCurve, Role, Segment

NAME = "nanotouch/nanoscope-text"
_UNITS = {"nm": 1e-9, "um": 1e-6, "pm": 1e-12, "pN": 1e-12, "nN": 1e-9, "uN": 1e-6, "V": 1.0, "mV": 1e-3, "s": 1.0}
_DIMENSION = {"m": ("nm", "um", "pm"), "N": ("pN", "nN", "uN"), "V": ("V", "mV"), "s": ("s",)}
_WAYS = {"ex": "approach", "rt": "retract"}
_HEIGHTS = (("z_sensor", "height (measured)"), ("height_sensor", "height (measured)"), ("zsensor", "height (measured)"),
            ("ramp", "height (piezo)"), ("height", "height (piezo)"), ("z", "height (piezo)"))  # fmt: skip


@dataclass(frozen=True)
class _Column:
    """One of the table, in SI; NaN where a shorter branch has ended."""

    name: str  # lower case, without unit and way
    unit: str  # SI
    values: Floats


def recognises(file: Path, head: bytes) -> bool:
    """Whether it begins with a header in quotes."""
    return text.is_text(head) and re.match(r'"\\[?*]?(?:Force file|File) list"', text.decoded(head)) is not None


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """The one curve; `calibration` only where the header states none."""
    lines = text.decoded(file.read_bytes()).splitlines()
    ends = [number for number, line in enumerate(lines) if re.match(r'"?\\\*(?:Force file|File) list end', line)]
    if not ends or len(lines) < ends[-1] + 2 + MIN_POINTS:
        raise ReadError(f"{file}: a text export of NanoScope without a table")
    sections = header.parsed(file, [line.strip().removeprefix('"').removesuffix('"') for line in lines[: ends[-1]]])
    columns = _table(file, [line for line in lines[ends[-1] + 1 :] if line.strip()])
    stiffness, sensitivity = _stated(sections, calibration)
    segments, notes = [], []
    z_way, channel = _height(file, columns)
    for way, role in _WAYS.items():
        if way not in z_way:
            continue
        segment, remark = _segment(file, role, columns[way], z_way[way], channel, (stiffness, sensitivity))  # type: ignore[arg-type]
        segments.append(segment)
        notes += [remark] if remark and remark not in notes else []
    first = sections[0] if sections else header.Section(file, "")
    meta: dict[str, Any] = {
        "format": "Bruker NanoScope (text export)", "instrument": "Bruker NanoScope", "enum": 0, "path": file,
        "software version": first.get("version", ""), "date": first.get("date", ""),
    }  # fmt: skip
    meta |= {key: value for key, value in (("spring constant", stiffness), ("sensitivity", sensitivity)) if value}
    if stiffness is None:
        notes.append("states no spring constant: deflections alone; give it for forces")
    return [ForceCurve(tuple(segments), meta | ({"notes": tuple(notes)} if notes else {}), printable(file.name))]


def _stated(sections: list[header.Section], given: Calibration) -> tuple[float | None, float | None]:
    """Spring constant and sensitivity: of the header, else what is given."""
    stiffness = next((one.spring_constant() for one in sections if "spring constant" in one), None)
    known = header.sensitivity(sections, "DeflSens") if sections else None
    return stiffness or given.spring_constant, known[0] if known else given.sensitivity


def _table(file: Path, lines: list[str]) -> dict[str, list[_Column]]:
    """The columns of each way."""
    names = [name.strip() for name in re.split(r"[\t;]", lines[0].strip().rstrip(";"))]
    content = text.plain("\n".join(lines[1:])).splitlines()
    rows = [line.split("\t") for line in content]
    longest = max((len(row) for row in rows), default=0)
    if not MIN_POINTS <= len(rows) <= MAX_POINTS or longest != len(names):
        raise ReadError(f"{file}: {len(rows)} rows of up to {longest} numbers, but it names {len(names)} columns")
    try:
        values = np.array([row + ["nan"] * (longest - len(row)) for row in rows], np.float64)
    except ValueError as error:
        raise ReadError(f"{file}: its table holds what is no number: {error}") from None
    found: dict[str, list[_Column]] = {way: [] for way in _WAYS}
    for number, name in enumerate(names):
        parts = header.plain_unit(name).split("_")
        way = next((part.lower() for part in parts if part.lower() in _WAYS), "")
        unit = next((part for part in reversed(parts) if part in _UNITS), "")
        if not way or not unit:
            continue
        kept = "_".join(part for part in parts if part.lower() != way and part != unit).lower()
        dimension = next(key for key, members in _DIMENSION.items() if unit in members)
        found[way].append(_Column(kept, dimension, values[:, number] * _UNITS[unit]))
    return found


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
    file: Path, role: Role, columns: list[_Column], z: Floats, channel: str, known: tuple[float | None, float | None]
) -> tuple[Segment, str]:
    stiffness, sensitivity = known
    signals = {one.unit: one.values for one in reversed(columns) if "defl" in one.name or one.name == "force"}
    remark = ""
    if "N" in signals:
        force: Floats | None = signals["N"]
        bent = None if stiffness is None else signals["N"] / stiffness
        if stiffness is not None and "m" in signals:
            remark = _contradiction(signals["N"], signals["m"], stiffness)
    elif "m" in signals or ("V" in signals and sensitivity is not None):
        bent = signals["m"] if "m" in signals else signals["V"] * float(sensitivity or 0.0)
        force = None if stiffness is None else bent * stiffness
    else:
        told = "a deflection in V, and no sensitivity is stated; give it" if "V" in signals else "no deflection"
        raise ReadError(f"{file}: the {role} has {told}")
    signal = force if force is not None else bent
    assert signal is not None
    keep = np.isfinite(z) & np.isfinite(signal)
    if not keep.any():
        raise ReadError(f"{file}: the {role} has no sample with height and deflection")
    clock = next((one.values for one in columns if one.name == "time"), np.full(z.size, np.nan))
    segment = Segment(
        role, clock[keep], z[keep], channel,
        None if force is None else force[keep], None if bent is None else bent[keep],
    )  # fmt: skip
    return segment, remark


def _contradiction(force: Floats, bent: Floats, stiffness: float) -> str:
    """Where the columns of force and deflection do not differ by the spring constant."""
    span = float(np.nanmax(bent) - np.nanmin(bent))
    if not span > 0.0:
        return ""
    slope = float(np.nanmax(force) - np.nanmin(force)) / span
    if abs(slope - stiffness) <= 0.02 * stiffness:
        return ""
    return f"its columns of force and deflection differ by {slope:.4g} N/m, but its header states {stiffness:.4g} N/m"
