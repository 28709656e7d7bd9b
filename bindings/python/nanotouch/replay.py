# SPDX-License-Identifier: BSD-3-Clause
"""A recording run again through the touch step, and the force-distance curve that one may hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from nanotouch import _core
from nanotouch._control import CONTROLS, Law
from nanotouch._path import MODES, core_mode
from nanotouch.columns import SIDEWAYS
from nanotouch.curves import ForceCurve
from nanotouch.curves.curve import Role, Segment
from nanotouch.errors import InvalidValue
from nanotouch.record import Recording
from nanotouch.scene import Rig, Settings

MEASURED = (
    "age", "lateness", "master_position", "operator_force", "stage_position", "deflection", "x", "y", "flags",
)  # fmt: skip
REQUESTS = {"aim": 3, "arm": 1, "mode": 1, "clutch": 1, "rescale": 2, "setting": 2, "scene": 2, "stop": 1}
"""that a session may be asked for between two ticks, and how many numbers each has"""
NAMED = ("mode", "setting", "scene")
"""whose first one is a name"""


def replay(recording: Recording, control: Law | None = None) -> Recording:
    """Settings, requests and samples are those recorded; motor force, stage command, state and reasons are new.

    Bit by bit the same on one machine and build. Elsewhere a compiler may round differently: then within 1e-9 of the
    range of a column, until a limit is met at another tick.
    """
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
    if (name == "own") is not callable(control):
        law_is = "a law of one's own: give it as control" if name == "own" else f"control {name!r}: give no other law"
        raise InvalidValue(f"the recording was made with {law_is}")
    law: Any = control if name == "own" else _resolved(name, rig)
    columns = {
        column: recording.columns[column] for column in (*MEASURED, *SIDEWAYS, "master_age") if column in recording
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


def _start(metadata: dict[str, Any]) -> dict[str, Any]:
    """Where the touch step begins, and what was asked of it."""
    try:
        x, y = metadata["path"][0]
        events = [
            (int(tick), str(name), list(numbers) if name in NAMED else [float(number) for number in numbers])
            for tick, name, numbers in metadata["events"]
        ]
        start = {"mode": core_mode(metadata["mode"]), "master": float(metadata["master_start"]), "x": x, "y": y}
    except (TypeError, ValueError, LookupError) as error:
        raise InvalidValue(f"the recording's metadata cannot be read: {error}") from error
    for tick, name, numbers in events:
        if tick < 0:
            raise InvalidValue(f"the recording's metadata holds a request at tick {tick}: valid is 0 or more")
        if name == "rewind":
            raise InvalidValue("the recording was rewound: it cannot be replayed")
        if name not in REQUESTS or len(numbers) != REQUESTS[name]:
            raise InvalidValue(f"the recording's metadata holds a request {name!r} with {len(numbers)} numbers")
        if name == "mode" and numbers[0] not in {core_mode(mode) for mode in MODES}:
            raise InvalidValue(f"the recording's metadata holds a request for a mode {numbers[0]!r}")
    for key, valid in (("mode", MODES), ("control", (*CONTROLS, "own"))):
        if metadata[key] not in valid:
            raise InvalidValue(f"the recording's metadata: {key} {metadata[key]!r}: valid are {', '.join(valid)}")
    return start | {"events": events}


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
