# SPDX-License-Identifier: BSD-3-Clause
"""A recording run again through the touch step, and the force-distance curve that one may hold."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch.curves import ForceCurve
from nanotouch.curves.curve import Role, Segment
from nanotouch.errors import InvalidValue
from nanotouch.scene import Rig, Settings
from nanotouch.touch._control import CONTROLS, ControlLaw
from nanotouch.touch._path import MODES, core_mode
from nanotouch.touch._recorder import REWINDS_BEFORE, ROWS, rewinds
from nanotouch.touch._recording_file import LOST_AFTER
from nanotouch.touch.columns import SIDEWAYS, TAPPING
from nanotouch.touch.record import Recording

MEASURED = (
    "age", "lateness", "master_position", "operator_force", "stage_position", "deflection", "x", "y", "flags",
)  # fmt: skip
REQUESTS = {
    "aim": 3, "arm": 1, "mode": 1, "clutch": 1, "rescale": 2, "setting": 2, "scene": 2, "stop": 1, "index": 1,
    "dent": 4, "dent_size": 4, "undent": 0, "lay": 3, "lay_rod": 3, "pushed": 5, "turned": 2,
}  # fmt: skip
"""what is done between two ticks, and how many numbers each has"""
Event = tuple[int, str, list[Any]]
"""tick, name, numbers"""
NAMED = ("mode", "setting", "scene")
"""whose first one is a name"""


def replay(recording: Recording, control: ControlLaw | None = None) -> Recording:
    """Settings, requests and samples are those recorded; motor force, stage command, state and reasons are new.

    Bit by bit the same on one machine and build. Elsewhere a compiler may round differently: then within 1e-9 of the
    range of a column, until a limit is met at another tick.
    """
    metadata = recording.metadata
    if "events" in metadata:
        recording = without_rewinds(recording)
        metadata = recording.metadata
    missing = [name for name in MEASURED if name not in recording]
    missing += [
        name for name in ("settings", "rig", "control", "events", "master_start", "path") if name not in metadata
    ]
    if missing:
        raise InvalidValue(f"the recording cannot be replayed: it lacks {', '.join(missing)}")
    settings, rig = Settings(**metadata["settings"]), Rig(**metadata["rig"])
    _check_ticks(recording, settings.gains.rate)
    start, name = _start(metadata), metadata["control"]
    _check_whole(recording, start["events"])
    if (name == "own") is not callable(control):
        law_is = "a law of one's own: give it as control" if name == "own" else f"control {name!r}: give no other law"
        raise InvalidValue(f"the recording was made with {law_is}")
    law: Any = control if name == "own" else _resolved(name, rig)
    columns = {
        column: recording.columns[column]
        for column in (*MEASURED, *SIDEWAYS, *TAPPING, "master_age")
        if column in recording
    }
    found = _core.replay(rig.core, settings.core, law, start, columns)
    return Recording(recording.columns | found, metadata)


def _check_ticks(recording: Recording, rate: float) -> None:
    """Every tick from the first on, or the touch step would go another way."""
    off = np.abs(recording.time * rate - np.arange(len(recording))) > 0.25
    if len(recording) and off[0]:
        raise InvalidValue(f"a replay begins at time 0 s; this recording begins at {recording.time[0]:.6g} s")
    if off.any():
        row = int(np.argmax(off))
        raise InvalidValue(
            f"a replay needs every tick; after {recording.time[row - 1]:.6g} s this recording goes on at "
            f"{recording.time[row]:.6g} s"
        )


def without_rewinds(recording: Recording) -> Recording:
    """The rows and events that a session went on from, however often it went back."""
    try:
        events = [(int(tick), str(name), list(numbers)) for tick, name, numbers in recording.metadata["events"]]
        before = int(recording.metadata.get(REWINDS_BEFORE, 0))
    except (TypeError, ValueError, LookupError) as error:
        raise InvalidValue(f"the recording's metadata cannot be read: {error}") from error
    if not rewinds(events):
        return recording
    if recording.metadata.get(LOST_AFTER):
        raise InvalidValue("the recording was rewound and has lost blocks: which of its rows hold is not known")
    ticks = np.rint(recording.time * recording.parameter("loop_rate"))
    rows, line = _line(events, ticks, before)
    found = recording[rows]
    found.metadata = {name: value for name, value in found.metadata.items() if name not in (REWINDS_BEFORE, ROWS)}
    found.metadata["events"] = [list(events[number]) for number in line]
    if recording.metadata.get(ROWS) == len(recording):
        found.metadata[ROWS] = len(found)
    return found


class _Moment(NamedTuple):
    """Of the tape, after some of its events."""

    line: tuple[int, ...]
    """events that hold, by number"""
    rows: NDArray[np.int64]
    """that hold, up to the last rewind"""
    begin: int
    """the row after that"""
    tick: int | None
    """of it; None: it is not on the tape"""


def _line(events: list[Event], ticks: NDArray[np.float64], before: int) -> tuple[NDArray[np.int64], tuple[int, ...]]:
    """Rows and events that hold, by number; so many of the rewinds came before the first row."""
    nothing = np.empty(0, dtype=np.int64)
    first = int(ticks[0]) if len(ticks) else 0
    moment = _Moment((), nothing, 0, None if before else first)
    kept_at = {int(numbers[1]) for _, name, numbers in events if name == "rewind" and _is_moment(numbers)}
    moments: dict[int, _Moment] = {}
    for number, (tick, name, numbers) in enumerate(events):
        if number in kept_at:
            moments[number] = moment
        if name != "rewind":
            moment = moment._replace(line=(*moment.line, number))
            continue
        back, kept = _checked_rewind(number, tick, numbers)
        old = moments[kept]
        rows = nothing if old.tick is None else np.concatenate([old.rows, _rows(old, back, ticks)])
        end = 0 if moment.tick is None else min(moment.begin + max(0, tick - moment.tick), len(ticks))
        before -= 1
        moment = _Moment(old.line, rows, end, None if before > 0 else back)
    return np.concatenate([moment.rows, np.arange(moment.begin, len(ticks))]), moment.line


def _rows(moment: _Moment, tick: int, ticks: NDArray[np.float64]) -> NDArray[np.int64]:
    """Those from a moment up to a tick."""
    assert moment.tick is not None
    return np.arange(moment.begin, min(moment.begin + max(0, tick - moment.tick), len(ticks)))


def _is_moment(numbers: list[Any]) -> bool:
    return len(numbers) == 2 and all(isinstance(number, int | float) and number >= 0 for number in numbers)


def _checked_rewind(number: int, tick: int, numbers: list[Any]) -> tuple[int, int]:
    """The tick that was gone back to, and how many events had been kept there."""
    if len(numbers) == 1:
        raise InvalidValue("the recording was rewound by an older version, which did not keep what held then: it "
                           "cannot be replayed")  # fmt: skip
    if len(numbers) == 2 and numbers[1] == -1:
        raise InvalidValue("the recording goes on from a snapshot of another session, whose past it does not hold: it "
                           "cannot be replayed")  # fmt: skip
    if not _is_moment(numbers) or numbers[1] > number:
        raise InvalidValue(f"the recording's metadata holds a rewind at tick {tick} to {numbers}: valid are a tick and "
                           f"a number of events, 0 .. {number}")  # fmt: skip
    return int(numbers[0]), int(numbers[1])


def _check_whole(recording: Recording, events: list[Any]) -> None:
    """A part of a recording may hold requests that come later; one that calls itself whole may not."""
    end, rows = len(recording), recording.metadata.get(ROWS)
    for tick, name, _ in events:
        if rows == end and tick > end:
            raise InvalidValue(
                f"the recording says that it is whole, with {end} rows, and holds a request ({name}) at tick {tick}, "
                "beyond its end: rows are missing"
            )


def _start(metadata: dict[str, Any]) -> dict[str, Any]:
    """Where the touch step begins, and what was asked of it."""
    try:
        x, y = metadata["path"][0]
        events = [
            (int(tick), str(name), list(numbers) if name in NAMED else [float(number) for number in numbers])
            for tick, name, numbers in metadata["events"]
        ]
        start = {"mode": core_mode(metadata["mode"]), "master": float(metadata["master_start"]), "x": x, "y": y}
        start["size"] = _size(metadata.get("surface_size", []))
    except (TypeError, ValueError, LookupError) as error:
        raise InvalidValue(f"the recording's metadata cannot be read: {error}") from error
    for tick, name, numbers in events:
        if tick < 0:
            raise InvalidValue(f"the recording's metadata holds a request at tick {tick}: valid is 0 or more")
        if name not in REQUESTS or len(numbers) != REQUESTS[name]:
            raise InvalidValue(f"the recording's metadata holds a request {name!r} with {len(numbers)} numbers")
        if name == "mode" and numbers[0] not in {core_mode(mode) for mode in MODES}:
            raise InvalidValue(f"the recording's metadata holds a request for a mode {numbers[0]!r}")
    for key, valid in (("mode", MODES), ("control", (*CONTROLS, "own"))):
        if metadata[key] not in valid:
            raise InvalidValue(f"the recording's metadata: {key} {metadata[key]!r}: valid are {', '.join(valid)}")
    return start | {"events": events}


def _size(of_surface: Any) -> list[float]:
    """Width and height [m]; none where there was no surface."""
    size = [float(length) for length in of_surface]
    if len(size) not in (0, 2):
        raise ValueError(f"surface_size {of_surface}: valid are two lengths [m]")
    return size


def _resolved(name: str, rig: Rig) -> str:
    """A rig without a gauge has another default."""
    return "impedance" if name == "default" and rig["master.gauge"] == 0.0 else name


def curve(recording: Recording) -> ForceCurve:
    """Approach and retract as recorded: piezo height [m], deflection [m], force [N], time [s]."""
    if recording.metadata.get("mode") != "curve":
        raise InvalidValue(f"only a recording in mode 'curve' is a force curve, not {recording.metadata.get('mode')!r}")
    z = recording.parameter("start_height") - recording.stage_position
    segments = []
    roles: tuple[tuple[int, Role], ...] = ((0, "approach"), (1, "retract"))
    for phase, role in roles:
        rows = np.flatnonzero(recording.phase == phase)
        if rows.size == 0:
            raise InvalidValue(f"the recording ends before its {role}")
        columns = recording.time[rows], z[rows], "height (measured)", recording.slave_force[rows]
        segments.append(Segment(role, *columns, recording.deflection[rows]))
    settings = recording.metadata.get("settings", {}).get("gains", {})
    meta = {"spring constant": recording.parameter("spring_constant"), "setpoint": settings.get("set_point")}
    return ForceCurve(tuple(segments), {key: value for key, value in meta.items() if value is not None}, "touch")
