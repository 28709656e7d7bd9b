# SPDX-License-Identifier: BSD-3-Clause
"""JPK force curves and maps: ``.jpk-force``, ``.jpk-force-map``, ``.jpk-qi-data``, ``.jpk-qi-series``.

A zip archive of Java property files and big-endian numbers: integers, or floats where JPK's data processing saved it.
A single curve has its segments in ``segments/``, a map in ``index/N/segments/``. A segment's
``segment-header.properties`` says style and duration, and for each channel how its integers become volts (*encoder*)
and these what is meant, slot by slot (*conversion set*: volts, distance, force). What many segments share stands once
in ``shared-data/header.properties``: ``channel.height.lcd-info.*=0`` stands for all under ``lcd-info.0.``. Segments of
other styles than extend, pause and retract (modulation, ...) are left out, and named in ``meta["notes"]``.

afmformats reads these files too, and this reader is tested against it. But afmformats searches all names of the archive
again for every curve, so its time grows as the square of a map's. It does not keep a segment's style either.
"""

from __future__ import annotations

import math
import zipfile
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._io.files import check_archive
from .._io.words import counted, printable
from ..errors import ReadError
from .calibration import Calibration
from .checks import MAX_POINTS
from .curve import ForceCurve, Role, Segment
from .jpk_properties import FLOATS, TYPES, Facts, Properties, as_number, grouped, pairs_of, segments_of

NAME = "nanotouch/jpk"
ENDINGS = (".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series")
#: Channel in the archive, slot, and column under afmformats' name; a sensor before a voltage times a constant.
HEIGHTS = (
    ("measuredHeight", "nominal", "height (measured)"),
    ("capacitiveSensorHeight", "nominal", "height (measured)"),
    ("strainGaugeHeight", "nominal", "height (measured)"),
    ("height", "calibrated", "height (piezo)"),
    ("head-height", "calibrated", "height (piezo)"),
)
ROLES: dict[str, Role] = {"extend": "approach", "pause": "pause", "retract": "retract"}
_KINDS = ("force-scan-map", "force-scan-series", "quantitative-imaging-map", "quantitative-imaging-series")
_GRID = {"center x": "xcenter", "center y": "ycenter", "shape x": "ilength", "shape y": "jlength",
         "size x": "ulength", "size y": "vlength"}  # fmt: skip
_MAX_PROPERTIES = 1 << 24  # of one file of properties [byte]; those seen have 40 KiB
_SETTINGS = "force-segment-header.settings."


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """All curves with the file's own calibration; `calibration` only where the file states none."""
    with Archive(file, calibration) as archive:
        curves: list[ForceCurve] = []
        points, empty = 0, 0
        for number in range(len(archive)):
            try:
                curves.append(archive[number])
            except _Empty:
                empty += 1
                continue
            points += sum(len(segment) for segment in curves[-1].segments)
            if points > MAX_POINTS:
                raise ReadError(f"{file}: more than {MAX_POINTS} points in all; read it curve by curve (curves.stream)")
        if not curves:
            raise ReadError(f"{file}: none of its {counted(empty, 'curve')} has points")
        if empty:
            first = curves[0]
            told = f"{counted(empty, 'curve')} of {len(archive)} without points left out"
            curves[0] = ForceCurve(
                first.segments, {**first.meta, "notes": (*first.meta.get("notes", ()), told)}, first.name
            )
        return curves


class _Empty(ReadError):
    """A curve of a map that has a header and no points."""


class Archive:
    """An open file, from which single curves are read: ``archive[number]``, ``len(archive)``.

    Parameters
    ----------
    file : Path
        The archive.
    calibration : Calibration
        Used where the file states none.
    """

    def __init__(self, file: Path, calibration: Calibration | None = None) -> None:
        self.file = file
        self._given = (calibration or Calibration()).given
        self._zip = zipfile.ZipFile(file)
        try:
            check_archive(file, self._zip)
            self._names = set(self._zip.namelist())
            self._general = self._properties("header.properties")
            shared = "shared-data/header.properties"
            self._shared = grouped(self._properties(shared) if shared in self._names else {})
            self._folders = self._find_folders()
            self._segments = segments_of(self._names)
        except BaseException:
            self._zip.close()
            raise

    def __enter__(self) -> Archive:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._zip.close()

    def __len__(self) -> int:
        return len(self._folders)

    def __getitem__(self, number: int) -> ForceCurve:
        enum, folder = self._folders[number]
        own = self._properties(f"{folder}header.properties")
        segments: list[Segment] = []
        meta: dict[str, Any] = {
            "enum": enum,
            "path": self.file,
            "software": "JPK",
            "format": f"JPK ({self.file.suffix.lower()})",
        }
        start = 0.0
        left_out: Counter[str] = Counter()
        numbers = self._segments.get(folder, [])
        for n in numbers:
            place = f"{folder}segments/{n}/"
            facts = Facts(self.file, place, own | self._expanded(place) | self._general)
            style, duration = facts.text(f"{_SETTINGS}style"), facts.number("force-segment-header.duration")
            if style in ROLES:
                segments.append(self._segment(facts, place, start, meta))
            else:
                left_out[style] += 1
            start += duration
        if not segments:
            styles = f" of style {', '.join(ROLES)}, only {', '.join(left_out)}" if left_out else ""
            raise ReadError(f"{self.file}: curve {enum} has no segments{styles}")
        told = [f"{counted(n, 'segment')} of style {s!r} left out" for s, n in left_out.items()]
        told += [f"segment {n} is not in the archive" for n in range(max(numbers)) if n not in numbers]
        if number == 0 and (lost := self._folders[-1][0] + 1 - len(self)):
            told.append(f"{counted(lost, 'curve')} of {lost + len(self)} not in the archive")
        meta["notes"] = (*meta.get("notes", ()), *told)
        if not meta["notes"]:
            del meta["notes"]
        meta |= {"duration": start, "segment count": len(segments), "point count": sum(len(s) for s in segments)}
        return ForceCurve(tuple(segments), meta, printable(self.file.name))

    def place(self, number: int) -> dict[str, Any]:
        """What a curve's ``meta`` says of grid and position, from its header alone."""
        told = self._properties(f"{self._folders[number][1]}header.properties") | self._general
        meta: dict[str, Any] = {}
        for kind in _KINDS:
            _note_place(meta, told, kind)
        return meta

    def _find_folders(self) -> list[tuple[int, str]]:
        """Number and folder of each curve; numbers may be missing."""
        if any(name.startswith("segments/") for name in self._names):
            return [(0, "")]
        words = (name.split("/") for name in self._names if name.startswith("index/"))
        found = sorted({int(word[1]) for word in words if len(word) > 2 and word[1].isdecimal()})
        return [(number, f"index/{number}/") for number in found]

    def _properties(self, name: str) -> Properties:
        if name not in self._names:
            raise ReadError(f"{self.file}: the archive lacks {name}")
        if self._zip.getinfo(name).file_size > _MAX_PROPERTIES:
            raise ReadError(f"{self.file}: {name} is longer than {_MAX_PROPERTIES >> 20} MiB")
        found: Properties = {}
        for key, value in pairs_of(self._zip.read(name).decode("latin-1")):
            if found.setdefault(key, value) != value:
                raise ReadError(f"{self.file}: {name} states {key!r} as {found[key]!r} and as {value!r}")
        return found

    def _expanded(self, place: str) -> Properties:
        """A segment's properties, with those that it refers to."""
        found = self._properties(f"{place}segment-header.properties")
        for key in [key for key in found if key.endswith(".*")]:
            head, _, kind = key[:-2].rpartition(".")
            for rest, value in self._shared.get((kind, found[key]), {}).items():
                found.setdefault(f"{head}.{rest}", value)
        return found

    def _segment(self, facts: Facts, place: str, start: float, meta: dict[str, Any]) -> Segment:
        role = ROLES[facts.text(f"{_SETTINGS}style")]
        duration = facts.number("force-segment-header.duration")
        channel, slot, column = self._height(facts)
        z = facts.converted(channel, slot, self._raw(facts, channel), "m")
        volts = facts.converted("vDeflection", "volts", self._raw(facts, "vDeflection"), "V")
        deflection, stiffness = self._calibrated(facts, volts, meta)
        key = "force-segment-header.num-points"
        stated = facts.number(key) if key in facts.properties else z.size
        if z.size == volts.size == 0 and len(self) > 1:
            raise _Empty(f"{self.file}: {place} has no points")
        if not z.size == volts.size == stated:
            raise ReadError(f"{self.file}: {place} has {z.size} heights, {volts.size} forces, but states {stated:g}")
        _note(meta, facts, role, z.size)
        time = np.asarray(start + np.arange(z.size) * (duration / max(z.size, 1)), np.float64)
        force = np.asarray(deflection * stiffness, np.float64)
        if stated_offset := facts.offset("force", "N"):
            told = (
                f"an offset of the force of {1e9 * stated_offset:.4g} nN is left out: a force is k times the deflection"
            )
            meta["notes"] = tuple(dict.fromkeys((*meta.get("notes", ()), told)))
        return Segment(role, time, z, column, force, deflection)

    def _calibrated(
        self, facts: Facts, volts: NDArray[np.float64], meta: dict[str, Any]
    ) -> tuple[NDArray[np.float64], float]:
        """Deflection and spring constant, by what the file states or by what is given in its place."""
        stated = {
            "spring constant": facts.multiplier("force", "N", "distance", "m"),
            "sensitivity": facts.multiplier("distance", "m", "volts", "V"),
        }
        missing = [key for key, value in stated.items() if value is None and self._given[key] is None]
        if missing:
            raise ReadError(f"{self.file}: states no {' and no '.join(missing)}; give it")
        for key, value in stated.items():
            value = self._given[key] if value is None else value
            if meta.setdefault(key, value) != value:
                raise ReadError(f"{self.file}: states two values of its {key}, {meta[key]:g} and {value:g}")
        offset = 0.0 if stated["sensitivity"] is None else facts.offset("distance", "m")
        return volts * meta["sensitivity"] + offset, float(meta["spring constant"])

    def _height(self, facts: Facts) -> tuple[str, str, str]:
        for channel, slot, column in HEIGHTS:
            if facts.data_file(channel) in self._names:
                return channel, slot, column
        raise ReadError(f"{self.file}: {facts.place} has no height")

    def _raw(self, facts: Facts, channel: str) -> NDArray[Any]:
        name = facts.data_file(channel)
        kind = facts.number_type(channel)
        if name not in self._names or kind not in TYPES | FLOATS:
            raise ReadError(f"{self.file}: {name} is missing, or of the type {kind!r}, which is not read")
        raw = self._zip.read(name)
        dtype = np.dtype((TYPES | FLOATS)[kind])
        if len(raw) % dtype.itemsize:
            raise ReadError(f"{self.file}: {name} has {len(raw)} bytes, no whole number of {kind!r}")
        return np.frombuffer(raw, dtype)


def _note(meta: dict[str, Any], facts: Facts, role: Role, points: int) -> None:
    """What a segment says of itself and of the curve, under afmformats' keys."""
    told = facts.properties
    for key, name in (("feedback mode", f"{_SETTINGS}feedback-mode.name"),
                      ("session id", "force-segment-header.approach-id")):  # fmt: skip
        if name in told:
            meta.setdefault(key, told[name])
    stamp = told.get("force-segment-header.time-stamp", "").split()
    if role == "approach" and len(stamp) > 1:
        meta.setdefault("date", stamp[0])
        meta.setdefault("time", stamp[1])
    numbers = {key: as_number(told.get(f"{_SETTINGS}segment-settings.{key}", "")) for key in
               ("duration", "z-start", "z-end", "setpoint")}  # fmt: skip
    duration = numbers["duration"]
    if duration:
        meta[f"duration {'intermediate' if role == 'pause' else role}"] = duration
        if role != "pause":
            meta[f"rate {role}"] = points / duration
            if numbers["z-start"] is not None and numbers["z-end"] is not None:
                meta[f"speed {role}"] = abs(numbers["z-start"] - numbers["z-end"]) / duration
    if numbers["setpoint"] is not None:
        meta["setpoint"] = numbers["setpoint"] * meta["spring constant"] * meta["sensitivity"]
    for kind in _KINDS:
        _note_place(meta, told, kind)


def _note_place(meta: dict[str, Any], told: Mapping[str, str], kind: str) -> None:
    for key, name in (("instrument", "instrument"), ("software version", "source-software")):
        if f"{kind}.description.{name}" in told:
            meta.setdefault(key, told[f"{kind}.description.{name}"])
    for key, name in _GRID.items():
        value = as_number(told.get(f"{kind}.position-pattern.grid.{name}", ""))
        if value is not None:
            meta.setdefault(f"grid {key}", round(value) if key.startswith("shape") else value)
    for axis in "xy":
        value = as_number(told.get(f"{kind}.header.position.{axis}", ""))
        if value is not None:
            meta.setdefault(f"position {axis}", value)
        size, shape = meta.get(f"grid size {axis}", 0.0), meta.get(f"grid shape {axis}", 0)
        if size and shape and f"position {axis}" in meta:
            left = meta[f"grid center {axis}"] - 0.5 * size
            meta[f"grid index {axis}"] = math.floor((meta[f"position {axis}"] - left) / size * shape)
