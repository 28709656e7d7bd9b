# SPDX-License-Identifier: BSD-3-Clause
"""Bruker NanoScope force files: single ramps and force volumes, deflection over the piezo's ramp.

A text header of sections ``\\*Name`` and lines ``\\Key: value``; a value with a scale is written
``\\@4:Z scale: V [Sens. DeflSens] (0.000375 V/LSB) 2.5 V``: the integers times the number in brackets times the named
sensitivity (``\\@Sens. DeflSens: V 41.1 nm/V``, in another section). The data of a force image are int16, from version
9.2 on int32, times the same number: for each curve the approach and then the retraction, both from the deepest point
outwards. The samples of a ramp of n points are 1/n of its size apart: ``Effective BW`` is n over the time that its size
takes at its velocity.
"""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from .._words import printable
from ..errors import ReadError
from .checks import MAX_POINTS
from .curve import ForceCurve, Segment

NAME = "nanotouch/nanoscope"
SIGNATURES = (b"\\*File list", b"\\*Force file list", b"\\*Ciao")  # how Bruker's headers begin
_VERSION_32BIT = 0x09200000  # from here on integers take 4 bytes, whatever "Bytes/pixel" says of their scale
_HEADER_LIMIT = 1 << 20  # byte; those seen have 40 KiB
_DEFLECTION = ("DeflectionError", "Deflection")
_UNITS = {"V": 1.0, "mV": 1e-3, "nm/V": 1e-9, "um/V": 1e-6, "~m/V": 1e-6, "pm/V": 1e-12, "mm/V": 1e-3}
_NUMBER = r"([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)"
_SCALED = re.compile(rf"V \[Sens\. ([^\]]+)\] \({_NUMBER} (m?V)/LSB\) {_NUMBER} (m?V)")
_SENSITIVITY = re.compile(rf"V {_NUMBER} (\S+)")


class _Section(dict[str, str]):
    """One section of the header."""

    def __init__(self, file: Path, name: str) -> None:
        super().__init__()
        self.file, self.name = file, name

    def text(self, key: str) -> str:
        if key not in self:
            raise ReadError(f"{self.file}: its header lacks {key!r} in {self.name!r}")
        return self[key]

    def counts(self, key: str) -> list[int]:
        words = self.text(key).split()
        if not words or not all(re.fullmatch("[0-9]{1,12}", word) for word in words):
            raise ReadError(f"{self.file}: {key!r} is {self[key]!r}, expected whole numbers")
        return [int(word) for word in words]

    def positive(self, key: str) -> float:
        try:
            value = float(self.text(key).split()[0])
        except (ValueError, IndexError):
            value = math.nan
        if not 0.0 < value < math.inf:
            raise ReadError(f"{self.file}: {key!r} is {self[key]!r}, expected a positive number")
        return value

    def scaled(self, ending: str) -> tuple[str, float, float]:
        """Of the value whose key ends so: name of its sensitivity, V per LSB, V."""
        for key, value in self.items():
            match = _SCALED.match(value)
            if key.startswith("@") and key.endswith(ending) and match:
                name, per_lsb, lsb_unit, volts, unit = match.groups()
                return name, float(per_lsb) * _UNITS[lsb_unit], float(volts) * _UNITS[unit]
        raise ReadError(f"{self.file}: its header lacks {ending!r} with a scale in {self.name!r}")


def read(file: Path) -> list[ForceCurve]:
    """All ramps of a NanoScope force file; ReadError if it is none, damaged, or of a kind not read."""
    sections = _sections(file)
    image = _deflection_image(file, sections)
    ramp_list = next((s for s in sections if s.name == "Ciao force list"), None)
    if ramp_list is None:
        raise ReadError(f"{file}: its header lacks the section 'Ciao force list'")
    raw = _raw(file, image, _version(sections[0]))
    sensor, volts_per_lsb, _ = image.scaled(":Z scale")
    piezo, _, ramp_volts = image.scaled(":Ramp size")
    size = ramp_volts * _sensitivity(file, sections, piezo)
    meta = _meta(file, sections, image) | {"sensitivity": _sensitivity(file, sections, sensor)}
    points = image.counts("Samps/line")
    z, time, speeds = _ramp(ramp_list, points, size, ramp_volts)
    meta |= speeds
    deflection = raw * (volts_per_lsb * meta["sensitivity"])
    deflection[:, : points[0]] = deflection[:, points[0] - 1 :: -1]  # into the order of time
    force = deflection * meta["spring constant"]
    line = ramp_list.counts("force/line")[0] if len(raw) > 1 else 1
    parts: tuple[tuple[Literal["approach", "retract"], slice], ...] = (
        ("approach", slice(0, points[0])),
        ("retract", slice(points[0], sum(points))),
    )
    return [
        ForceCurve(
            tuple(
                Segment(role, time[part], z[part], "height (piezo)", force[number, part], deflection[number, part])
                for role, part in parts
            ),
            meta | _place(number, line, len(raw)),
            printable(file.name),
        )
        for number in range(len(raw))
    ]


def _sections(file: Path) -> list[_Section]:
    with file.open("rb") as stream:
        text = stream.read(_HEADER_LIMIT).split(b"\x1a")[0].decode("latin-1")
    if "\\*File list end" not in text:
        raise ReadError(f"{file}: its header does not end")
    sections: list[_Section] = []
    for line in text.split("\\*File list end")[0].splitlines():
        if line.startswith("\\*"):
            sections.append(_Section(file, line[2:].strip()))
        elif line.startswith("\\") and sections:
            # A colon also stands in the name of a parameter: "@4:Z scale: V ..."
            key, _, value = line[1:].partition(": ")
            sections[-1].setdefault(key.strip().rstrip(":"), value.strip())
    return sections


def _deflection_image(file: Path, sections: list[_Section]) -> _Section:
    images = [s for s in sections if s.name == "Ciao force image list"]
    if not images:
        raise ReadError(f"{file}: a Bruker NanoScope file without force curves; images.read reads pictures")
    shown = []
    for image in images:
        names = [value for key, value in image.items() if key.startswith("@") and key.endswith(":Image Data")]
        shown += names
        if any(f"[{kind}]" in name for name in names for kind in _DEFLECTION):
            return image
    raise ReadError(f"{file}: no deflection among its channels ({', '.join(shown)})")


def _raw(file: Path, image: _Section, version: int) -> NDArray[np.signedinteger[Any]]:
    """The integers, shape (curves, approach + retraction)."""
    width = 4 if version >= _VERSION_32BIT else image.counts("Bytes/pixel")[0]
    if width not in (2, 4):
        raise ReadError(f"{file}: {width} bytes per value; NanoScope force files of 2 or 4 are read, export it as text")
    points = image.counts("Samps/line")
    if len(points) != 2 or min(points) == 0:
        raise ReadError(f"{file}: 'Samps/line' is {image['Samps/line']!r}, expected the points of both directions")
    offset, length = image.counts("Data offset")[0], image.counts("Data length")[0]
    held = file.stat().st_size
    if offset + length > held:
        raise ReadError(f"{file}: {held} bytes long, but its data end at {offset + length}: it is cut off")
    if length == 0 or length % (width * sum(points)):
        raise ReadError(f"{file}: {length} bytes of data are no whole number of curves of {sum(points)} points")
    if length // width > MAX_POINTS:
        raise ReadError(f"{file}: {length // width} points in all; up to {MAX_POINTS} are read")
    return np.fromfile(file, f"<i{width}", length // width, offset=offset).reshape(-1, sum(points))


def _version(first: _Section) -> int:
    return int(first["Version"], 16) if re.fullmatch("0x[0-9A-Fa-f]{8}", first.get("Version", "")) else 0


def _sensitivity(file: Path, sections: list[_Section], name: str) -> float:
    """In m/V."""
    for section in sections:
        match = _SENSITIVITY.match(section.get(f"@Sens. {name}", ""))
        if match and match[2] in _UNITS and match[2].endswith("/V"):
            return float(match[1]) * _UNITS[match[2]]
    raise ReadError(f"{file}: its header states no sensitivity {name!r} in metres per volt")


def _meta(file: Path, sections: list[_Section], image: _Section) -> dict[str, Any]:
    first = sections[0]
    return {
        "format": "Bruker NanoScope",
        "spring constant": image.positive("Spring Constant"),
        "instrument": "Bruker NanoScope",
        "software version": first.get("Version", ""),
        "date": first.get("Date", ""),
        "path": file,
    }


def _place(number: int, line: int, count: int) -> dict[str, Any]:
    place: dict[str, Any] = {"enum": number}
    if line > 0 and count > 1 and count % line == 0:
        place |= {"grid index x": number % line, "grid index y": number // line}
        place |= {"grid shape x": line, "grid shape y": count // line}
    return place


def _ramp(
    ramp_list: _Section, points: list[int], size: float, volts: float
) -> tuple[NDArray[np.float64], NDArray[np.float64], dict[str, float]]:
    """z [m] and time [s] of a ramp of this size in m and in V, in which its velocities are given; and its speeds.

    Of a ramp that rests without recording, the time is NaN.
    """
    near, far = points
    z = np.concatenate([np.arange(near)[::-1] * (size / near), np.arange(far) * (size / far)])
    durations = [volts / ramp_list.positive(key) for key in ("Forward vel.", "Reverse vel.")]
    time = np.concatenate([np.arange(near) * durations[0] / near, durations[0] + np.arange(far) * durations[1] / far])
    if any(float(ramp_list.get(key, "0") or 0) for key in ("Ramp delay", "Reverse delay")):
        time = np.full(time.size, np.nan)
    return z, time, {"speed approach": size / durations[0], "speed retract": size / durations[1]}
