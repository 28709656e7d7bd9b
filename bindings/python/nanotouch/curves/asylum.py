# SPDX-License-Identifier: BSD-3-Clause
"""Asylum force curves in one Igor binary wave: columns ``Raw``, ``Defl``, ``ZSnsr`` [m], and a note.

The travel of the base grows towards the sample, so z is its negative. The note says with ``Indexes`` where the
movements end and with ``Direction`` what they are: 1 towards the sample, 0 a dwell, -1 away. Where it does not, or z
contradicts it, the curve is cut at its deepest point, or where it rests there. Nothing in the note is needed to read
the curve but what turns deflections into forces.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._io.files import checked_path, refuse_traps
from .._io.readers import head_of
from .._io.words import counted, printable
from ..errors import ReadError, require
from ..units import UNITS
from .calibration import Calibration
from .checks import MAX_POINTS, MIN_POINTS
from .curve import ForceCurve, Role, Segment

NAME = "nanotouch/asylum"
HEIGHTS = (("ZSnsr", "height (measured)"), ("ZSensor", "height (measured)"), ("LVDT", "height (measured)"),
           ("Raw", "height (piezo)"), ("Height", "height (piezo)"))  # fmt: skip
_DEFLECTIONS = ("Defl", "Deflection")
_NUMBERS = {"NumPtsPerSec": ("rate approach", "rate retract"), "InputTime": ("duration",),
            "ApproachVelocity": ("speed approach",), "RetractVelocity": ("speed retract",)}  # fmt: skip
_TEXTS = {"MicroscopeModel": "instrument", "Version": "software version", "Date": "date", "Time": "time"}
_SHAPE = 64 + 68  # where a wave of version 5 says it [byte]
_REST = 0.1  # of the travel; a movement over less is a pause
_TURN = 0.01  # of the travel, where the base turns
_DWELL = 0.2  # of the points of the shorter way; more than so many there are a dwell
_ROLES: Mapping[int, Role] = {1: "approach", 0: "pause", -1: "retract"}


def read(file: Path, calibration: Calibration) -> list[ForceCurve]:
    """The one curve; ReadError for a wave that is no table of deflections and heights."""
    _refuse_pictures(file)
    wave, note = wave_of(file)
    columns = _labels(wave, file)
    deflection_name = next((name for name in _DEFLECTIONS if name in columns), None)
    height = next((one for one in HEIGHTS if one[0] in columns), None)
    if deflection_name is None or height is None:
        _refuse(file, note, columns)
    assert deflection_name is not None
    assert height is not None
    values = np.asarray(wave["wData"], np.float64) * unit_of(wave, file)
    if not MIN_POINTS <= len(values) <= MAX_POINTS:
        raise ReadError(f"{file}: a wave of {len(values)} points, expected at least {MIN_POINTS}")
    deflection, z = values[:, columns.index(deflection_name)], -values[:, columns.index(height[0])]
    meta = _meta(file, note, calibration)
    segments, notes = segments_of(note, z, deflection, height[1], meta.get("spring constant"))
    known = np.isfinite(z) & np.isfinite(deflection)
    if not known.any():
        raise ReadError(f"{file}: no sample has both {height[0]!r} and {deflection_name!r}")
    meta |= {"point count": int(known.sum()), "segment count": len(segments), "z range": float(np.ptp(z[known]))}
    if notes:
        meta["notes"] = notes
    return [ForceCurve(segments, meta, printable(file.name))]


def _refuse_pictures(file: Path) -> None:
    """By the header alone: a picture is not loaded to be refused."""
    head = head_of(file)
    if len(head) < _SHAPE + 16:
        return
    _, _, layers, more = struct.unpack_from(f"{'<' if head[0] else '>'}4i", head, _SHAPE)
    if layers > 0 or more > 0:
        raise ReadError(f"{file}: a stack of pictures, not a force curve; images.read reads it")


def _refuse(file: Path, note: str, columns: list[str]) -> NoReturn:
    """A picture, one half of a pair alone, or a table of something else."""
    if not text_of(note, "ImagingMode"):
        raise ReadError(
            f"{file}: its note lacks 'ImagingMode', which a force curve of Asylum Research states; of a pair of files, "
            "...Defl.ibw and ...ZSnsr.ibw, both must lie in one folder under their own names"
        )
    raise ReadError(f"{file}: lacks a height or a deflection; it has {', '.join(columns) or 'no columns'}")


def wave_of(file: Path) -> tuple[Any, str]:
    """A wave, and its note with ends of lines as here."""
    checked_path(file)
    refuse_traps(file, head_of(file))
    wave = require("igor2.binarywave", "curves").load(str(file))["wave"]
    if np.iscomplexobj(wave["wData"]):
        raise ReadError(f"{file}: a wave of complex numbers, expected real ones")
    return wave, bytes(wave["note"]).decode("latin-1").replace("\r", "\n")


def unit_of(wave: Any, file: Path) -> float:
    """What one of the wave's data is in metres, which are meant where it states no unit."""
    header = wave["wave_header"]
    unit = bytes(np.asarray(header.get("dataUnits", b"")).tobytes()).partition(b"\0")[0]
    name = unit.decode("latin-1").strip().replace("\xb5", "u").replace("\xc2", "") or "m"
    if name not in UNITS["m"]:
        raise ReadError(f"{file}: its data are in {name!r}, expected a length in m")
    return UNITS["m"][name]


def _labels(wave: Any, file: Path) -> list[str]:
    """Names of the columns; empty for a wave that is no table."""
    values = wave["wData"]
    if np.ndim(values) != 2:
        return []
    names = [bytes(name).decode("latin-1") for axis in wave["labels"] for name in axis if name]
    if names and len(names) != values.shape[1]:
        raise ReadError(f"{file}: {values.shape[1]} columns, but {len(names)} names: {', '.join(names)}")
    return names


def _meta(file: Path, note: str, calibration: Calibration) -> dict[str, Any]:
    """What the note says, under afmformats' keys."""
    stiffness = stated(note, "SpringConstant") or calibration.spring_constant
    numbers = {"spring constant": stiffness, "sensitivity": stated(note, "InvOLS")}
    if text_of(note, "TriggerChannel") == "Force":
        numbers["setpoint"] = stated(note, "TriggerPoint")
    for key, names in _NUMBERS.items():
        numbers |= dict.fromkeys(names, stated(note, key))
    texts = {name: text_of(note, key) for key, name in _TEXTS.items()}
    texts["feedback mode"] = text_of(note, "ImagingMode").lower()
    meta: dict[str, Any] = {"imaging mode": "force-distance", "software": "Asylum Research", "path": file, "enum": 0}
    meta |= {key: value for key, value in numbers.items() if value is not None}
    meta |= {key: value for key, value in texts.items() if value}
    return meta | {"format": "Asylum Research (binarywave)"}


def text_of(note: str, key: str) -> str:
    """What the note says of a key; empty where nothing."""
    match = re.search(rf"(?m)^{key}:[ \t]*(.*?)[ \t]*$", note)
    return match[1] if match else ""


def stated(note: str, key: str) -> float | None:
    """A positive number of the note."""
    try:
        value = float(text_of(note, key).replace(",", "."))
    except ValueError:
        return None
    return value if 0.0 < value < np.inf else None


def segments_of(
    note: str, z: Floats, deflection: Floats, channel: str, stiffness: float | None
) -> tuple[tuple[Segment, ...], tuple[str, ...]]:
    """The movements, and what was left out or is missing."""
    known = np.isfinite(z) & np.isfinite(deflection)
    notes = _of_stiffness(note, stiffness)
    if not known.all():
        notes.append(f"{counted(int(np.count_nonzero(~known)), 'sample')} without a number left out")
    if empty := _empty_end(z, deflection):
        known[-empty:] = False
        notes.append(f"{counted(empty, 'sample')} of 0 in z and deflection at the end, never taken, left out")
    segments = []
    travel = float(np.ptp(z[known])) if known.any() else 0.0
    for part, direction in _parts(note, z, known, notes):
        inside = np.flatnonzero(known[part]) + part.start
        way, bent = z[inside], deflection[inside]
        time = np.full(inside.size, np.nan)  # the wave's step is not that of stored points
        force = None if stiffness is None else bent * stiffness
        segments.append(Segment(_role(way, travel, direction), time, way, channel, force, bent))
    return tuple(segments), tuple(notes)


def _of_stiffness(note: str, stiffness: float | None) -> list[str]:
    """What has to be told of the spring constant."""
    words = list(dict.fromkeys(re.findall(r"(?m)^SpringConstant:[ \t]*(.*?)[ \t]*$", note)))
    if len(words) > 1:
        return [f"states its spring constant as {' and as '.join(words)}: the first is taken"]
    if words and words[0] and stated(note, "SpringConstant") is None:
        return [f"the spring constant {words[0]!r} is no number in N/m" + ("" if stiffness else ": give it for forces")]
    return [] if stiffness is not None else ["states no spring constant: deflections alone; give it for forces"]


def _empty_end(z: Floats, deflection: Floats) -> int:
    """Samples at the end where both are exactly 0; two or fewer may be measured."""
    taken = np.flatnonzero((z != 0.0) | (deflection != 0.0))
    count = z.size - (int(taken[-1]) + 1 if taken.size else 0)
    return count if 2 < count < z.size else 0


def _parts(note: str, z: Floats, known: NDArray[np.bool_], notes: list[str]) -> list[tuple[slice, int | None]]:
    """Runs of points between the indexes of the note, and their direction; without any, up to the deepest point and
    from there on."""
    ends = [int(word) for word in re.findall(r"\d+", text_of(note, "Indexes"))]
    words = [word.strip() for word in text_of(note, "Direction").split(",") if word.strip()][1:]
    directions = [int(float(word)) if re.fullmatch(r"[-+]?[01](\.0*)?", word) else None for word in words]
    if any(b < a for a, b in pairwise(ends)) or (ends and ends[-1] > z.size):
        notes.append(f"the note's Indexes ({text_of(note, 'Indexes')}) do not fit {z.size} points: cut at the deepest")
        ends = []
    edges = sorted({min(end + (number > 0), z.size) for number, end in enumerate(ends)} | {0, z.size})
    runs = [slice(a, b) for a, b in pairwise(edges)]
    if len(runs) > 1 and _contradicts(runs, z, known):
        notes.append(f"the note's Indexes ({text_of(note, 'Indexes')}) contradict z: cut at the deepest")
        runs = [slice(0, z.size)]
    if len(runs) == 1:
        cuts = _dwell_of(z, known) or (int(np.argmin(np.where(known, z, np.inf))) + 1,)
        edges = [0, *cuts, z.size] if cuts[0] >= MIN_POINTS and cuts[-1] <= z.size - MIN_POINTS else [0, z.size]
        return [(slice(a, b), None) for a, b in pairwise(edges) if known[a:b].any()]
    told = directions if len(directions) == len(runs) else [None] * len(runs)
    return [(run, way) for run, way in zip(runs, told, strict=True) if known[run].any()]


def _contradicts(runs: list[slice], z: Floats, known: NDArray[np.bool_]) -> bool:
    """Whether one run goes in and out again, or a dwell is part of a movement in and out."""
    travel = float(np.ptp(z[known])) if known.any() else 0.0
    for run in runs:
        way = z[run][known[run]]
        if way.size and min(float(way[0]), float(way[-1])) - float(way.min()) > _REST * travel:
            return True
    dwell = _dwell_of(z, known)
    if dwell is None:
        return False
    inside = max(runs, key=lambda run: min(run.stop, dwell[1]) - max(run.start, dwell[0]))
    return float(np.ptp(z[inside][known[inside]])) > _REST * travel


def _dwell_of(z: Floats, known: NDArray[np.bool_]) -> tuple[int, int] | None:
    """Where a dwell at the deepest place begins and ends; None where there is none. A ramp passes the lowest hundredth
    of the travel in a hundredth of its points, one that turns as a sine in six of them: a dwell has many more."""
    if not known.any():
        return None
    depth = np.where(known, z, np.inf)
    low = float(depth.min())
    near = depth <= low + _TURN * float(np.ptp(z[known]))
    deepest = int(np.argmin(depth))
    far = np.flatnonzero(~near)
    first = int(far[far < deepest][-1]) + 1 if (far < deepest).any() else 0
    last = int(far[far > deepest][0]) if (far > deepest).any() else z.size
    ways = first, z.size - last
    if min(ways) < MIN_POINTS or last - first < _DWELL * min(ways):
        return None
    turns = [round(_TURN / (1.0 - _TURN) * points) for points in ways]
    return first + turns[0], last - turns[1]


def _role(z: Floats, travel: float, direction: int | None) -> Role:
    """As the note says; by the movement where it says nothing."""
    if direction is not None:
        return _ROLES[direction]
    rise = float(z[-1] - z[0])
    if abs(rise) < _REST * travel:
        return "pause"
    return "approach" if rise < 0.0 else "retract"
