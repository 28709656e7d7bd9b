# SPDX-License-Identifier: BSD-3-Clause
"""A recording run again through the touch step, and the force-distance curve that one may hold."""

from __future__ import annotations

from typing import Any

import numpy as np

from nanotouch import _core
from nanotouch._control import Law
from nanotouch._path import core_mode
from nanotouch.curves import ForceCurve
from nanotouch.curves.curve import Role, Segment
from nanotouch.errors import InvalidValue
from nanotouch.record import Recording
from nanotouch.scene import Rig, Settings

MEASURED = (
    "age", "lateness", "master_position", "operator_force", "stage_position", "deflection", "x", "y", "flags",
)  # fmt: skip


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
    if len(recording) and recording.time[0] != 0.0:
        raise InvalidValue(f"a replay begins at time 0 s; this recording begins at {recording.time[0]:.6g} s")
    name = metadata["control"]
    if name == "own" and control is None:
        raise InvalidValue("the recording was made with a law of one's own: give it as control")
    settings, rig = Settings(**metadata["settings"]), Rig(**metadata["rig"])
    law: Any = control if name == "own" else _resolved(name, rig)
    x, y = metadata["path"][0]
    start = {
        "mode": core_mode(metadata["mode"]), "master": metadata["master_start"], "x": x, "y": y,
        "events": metadata["events"],
    }  # fmt: skip
    columns = {column: recording.columns[column] for column in MEASURED}
    found = _core.replay(rig.core, settings.core, law, start, columns)
    return Recording(recording.columns | found, metadata)


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
