# SPDX-License-Identifier: BSD-3-Clause
"""Spring constant and deflection sensitivity: what a file states, what is given in its place, and what follows.

The detector's volts u are what is measured: deflection = s u, force = k_c s u. A corrected s rescales both, a corrected
k_c the force alone, and with them what a file states as a force (the setpoint). z is the height of the base, which the
stage moves: neither changes it. The tip, at z + deflection, moves with s.

NT-MDT's detectors read amperes, so their s is in m/A. The ranges of both units have nothing in common, so that one
given for the wrong detector is refused.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from functools import partial
from os import PathLike
from pathlib import Path

from .._io.files import checked_path
from ..errors import InvalidValue, ReadError
from ..units import parse_quantity
from .curve import ForceCurve

SPRING_CONSTANT_RANGE = (1e-4, 1e4)  # [N/m]
SENSITIVITY_RANGE = (1e-10, 1e-4)  # [m/V]
SENSITIVITY_PER_AMPERE = (1e-1, 1e5)  # [m/A]: 0.1 nm to 100 um per nA
DETECTOR = "detector unit"  # of meta: what the sensitivity is per; V where it is not stated
#: What instruments write where nobody calibrated: 1 N/m, Bruker's 0.999 N/m; 1 m/V, 1 um/V, 1 nm/V, Asylum's 100 nm/V.
PLACEHOLDERS: Mapping[str, tuple[float, ...]] = {
    "spring constant": (0.999, 1.0),
    "sensitivity": (1.0, 1e-6, 1e-9, 1e-7),
}
_UNITS = {"spring constant": "N/m", "sensitivity": "m/V"}
_RANGES = {"spring constant": SPRING_CONSTANT_RANGE, "sensitivity": SENSITIVITY_RANGE}
_FORCES = ("setpoint",)  # of meta
_COLUMNS = ("file", "spring_constant", "sensitivity")


@dataclass(frozen=True)
class Calibration:
    """What is given in place of the file's own.

    Attributes
    ----------
    spring_constant : float, optional
        k_c [N/m], 1e-4 .. 1e4.
    sensitivity : float, optional
        Deflection sensitivity [m/V], 1e-10 .. 1e-4; of a detector that reads amperes [m/A], 0.1 .. 1e5.
    """

    spring_constant: float | None = None
    sensitivity: float | None = None

    def __post_init__(self) -> None:
        for key, value in self.given.items():
            (low, high), unit = _RANGES[key], _UNITS[key]
            if value is None or low <= value <= high or (key == "sensitivity" and _per_ampere(value)):
                continue
            name = key.replace(" ", "_")
            raise InvalidValue(f"{name}: {value!r} {unit}, expected {low:g} .. {high:g} {unit}")

    @property
    def given(self) -> dict[str, float | None]:
        """Under afmformats' keys."""
        return {"spring constant": self.spring_constant, "sensitivity": self.sensitivity}

    def over(self, other: Calibration) -> Calibration:
        """These values, and `other`'s where there is none."""
        return Calibration(
            other.spring_constant if self.spring_constant is None else self.spring_constant,
            other.sensitivity if self.sensitivity is None else self.sensitivity,
        )


@dataclass(frozen=True)
class CalibrationTable:
    """Calibrations of many files: pattern and values; the first pattern that matches a file counts.

    A pattern without ``/`` is compared with the file's name (``day1-*.ibw``), one with it with the end of its path.
    """

    rows: tuple[tuple[str, Calibration], ...]

    @classmethod
    def from_csv(cls, path: str | PathLike[str]) -> CalibrationTable:
        """Read a CSV file with the columns ``file``, ``spring_constant``, ``sensitivity``, values with their units.

        An empty field leaves what the file says: ``day1-*.ibw,0.12N/m,`` corrects the spring constant alone.
        """
        file = checked_path(path)
        try:
            lines = file.read_text(encoding="utf-8-sig").splitlines()
        except UnicodeDecodeError as error:
            raise ReadError(f"{file}: not a text file: {error.reason}") from None
        try:
            return cls(tuple(_rows(file, [line for line in lines if line.strip() and not line.startswith("#")])))
        except csv.Error as error:
            raise ReadError(f"{file}: not a table: {error}") from None

    def of(self, file: str | PathLike[str]) -> Calibration:
        """What the table gives for a file; nothing if no pattern matches."""
        return next((found for pattern, found in self.rows if _matches(pattern, Path(file))), Calibration())

    def unused(self, files: Iterable[Path]) -> list[str]:
        """Patterns that match no file: surely misspelt."""
        listed = list(files)
        return [pattern for pattern, _ in self.rows if not any(_matches(pattern, file) for file in listed)]


def _matches(pattern: str, file: Path) -> bool:
    path = file.absolute()
    return fnmatchcase(path.as_posix(), f"*/{pattern}") if "/" in pattern else fnmatchcase(path.name, pattern)


def parse_sensitivity(text: str) -> float:
    """``"50nm/V"`` [m/V], or ``"50nm/nA"`` [m/A]."""
    try:
        return parse_quantity(text, "m/A")
    except InvalidValue:
        return parse_quantity(text, "m/V")


def _per_ampere(value: float) -> bool:
    return SENSITIVITY_PER_AMPERE[0] <= value <= SENSITIVITY_PER_AMPERE[1]


def check_detector(sensitivity: float, detector: str, file: Path) -> None:
    """Refuse a sensitivity that is given for a detector of the other unit."""
    low, high = SENSITIVITY_PER_AMPERE if detector == "A" else SENSITIVITY_RANGE
    if not low <= sensitivity <= high:
        example = "50nm/nA is 50 m/A" if detector == "A" else "50nm/V is 5e-8 m/V"
        raise InvalidValue(
            f"sensitivity: {sensitivity!r} m/{detector}, expected {low:g} .. {high:g} m/{detector}, as the detector of "
            f"{file} reads {detector} ({example})"
        )


def _rows(file: Path, lines: list[str]) -> Iterator[tuple[str, Calibration]]:
    reader = csv.DictReader(lines)
    names = [str(name).strip() for name in reader.fieldnames or ()]
    if "file" not in names or len(names) != len(set(names)) or not set(names) <= set(_COLUMNS):
        raise ReadError(f"{file}: columns {', '.join(names) or 'none'}; expected {', '.join(_COLUMNS)}")
    reader.fieldnames = names
    for number, row in enumerate(reader, 1):
        if None in row or not (row["file"] or "").strip():
            raise ReadError(f"{file}: row {number} has no file pattern, or more fields than columns")
        yield str(row["file"]).strip(), _row_values(file, number, row)


def _row_values(file: Path, number: int, row: Mapping[str, str | None]) -> Calibration:
    values: dict[str, float | None] = {}
    for key, unit in _UNITS.items():
        text = (row.get(key.replace(" ", "_")) or "").strip()
        try:
            parse = parse_sensitivity if key == "sensitivity" else partial(parse_quantity, unit=unit)
            values[key.replace(" ", "_")] = parse(text) if text else None
        except InvalidValue as error:
            raise ReadError(f"{file}: row {number}: {error}") from None
    try:
        return Calibration(**values)
    except InvalidValue as error:
        raise ReadError(f"{file}: row {number}: {error}") from None


def calibrated(curve: ForceCurve, calibration: Calibration, file: Path) -> ForceCurve:
    """The curve with what is given in place of what its file says, and a note of placeholders that remain."""
    meta = dict(curve.meta)
    scale = bend = 1.0  # of force, and of deflection
    for key, value in calibration.given.items():
        if value is None:
            continue
        if meta.get(key) is None and key == "sensitivity":
            raise ReadError(f"{file}: states no {key}, so its forces cannot be corrected for it")
        if meta.get(key):
            scale *= value / meta[key]
            bend *= value / meta[key] if key == "sensitivity" else 1.0
        meta[key] = value
    if calibration.sensitivity is not None:
        check_detector(calibration.sensitivity, str(meta.get(DETECTOR, "V")), file)
    for key in _FORCES:
        if scale != 1.0 and isinstance(meta.get(key), float):
            meta[key] *= scale
    left = tuple(k for k, known in PLACEHOLDERS.items() if calibration.given[k] is None and meta.get(k) in known)
    if left:
        meta["placeholders"] = left
    for key, (low, high) in _RANGES.items():
        stated = None if key == "sensitivity" and meta.get(DETECTOR) == "A" else meta.get(key)
        if stated is not None and key not in left and not low <= stated <= high:
            unit = _UNITS[key]
            raise ReadError(f"{file}: {key} {stated:g} {unit}, expected {low:g} .. {high:g} {unit}; give it")
    stiffness = meta.get("spring constant")
    segments = []
    for segment in curve.segments:
        force = segment.force if segment.force is None or scale == 1.0 else segment.force * scale
        deflection = segment.deflection
        if force is not None and stiffness is not None:
            deflection = force / stiffness
        elif deflection is not None and bend != 1.0:
            deflection = deflection * bend
        segments.append(replace(segment, force=force, deflection=deflection))
    return ForceCurve(tuple(segments), meta, curve.name)
