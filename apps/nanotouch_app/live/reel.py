# SPDX-License-Identifier: BSD-3-Clause
"""A recording that is played: it gives frames as an observer of a running session does, at the pace of the clock."""

from __future__ import annotations

import time
import warnings
from collections.abc import Mapping
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch.errors import Error, InvalidValue
from nanotouch.manipulation import Recorded
from nanotouch.plasticity import Dent, dents_of
from nanotouch.touch.record import Recording
from nanotouch.touch.replay import without_rewinds

STEP = 1e-3  # of a single step [s]
PIXELS = 256  # of the surface that is drawn, each way
SPEEDS = (0.01, 0.03, 0.1, 0.25, 0.5, 1.0, 2.0, 4.0)


def frames_of(recording: Recording) -> Any:
    """The rows of a recording as frames; NaN for what it does not hold."""
    frames = np.zeros(len(recording), dtype=nt.frames.FRAME)
    for name in frames.dtype.names or ():
        if np.issubdtype(frames.dtype[name].base, np.floating):
            frames[name] = np.nan
    frames["time"] = recording.time
    frames["sequence"] = np.arange(len(recording))
    for axis, name in enumerate(("x", "y")):
        frames["tip_position"][:, axis] = recording.columns[name] if name in recording else 0.0
    frames["tip_position"][:, 2] = recording.tip_height
    frames["base_height"] = recording.tip_height - recording.deflection
    frames["deflection"] = recording.deflection
    frames["tip_force"][:, 2] = recording.columns["tip_force"] if "tip_force" in recording else recording.slave_force
    for name in ("gap", "contact_radius", "state", "reasons"):
        if name in recording:
            frames[name] = recording.columns[name]
    return frames


def measured(frames: Any, world: Mapping[str, Any]) -> Any:
    """What a real slave does not say is what its lever and stage measure; gap and contact stay unknown."""
    unknown = ~np.isfinite(frames["tip_force"][:, 2])
    if not (world and unknown.any()):
        return frames
    made, rows = frames.copy(), np.flatnonzero(unknown)
    lever = float(world["rig"]["probe"]["spring_constant"])
    made["tip_force"][rows, 2] = lever * made["deflection"][rows]
    stands = (*world.get("start", (0.0, 0.0)), 0.0)
    heights = made["base_height"] + made["deflection"]
    for axis in range(3):
        lost = rows[~np.isfinite(made["tip_position"][rows, axis])]
        made["tip_position"][lost, axis] = np.nan_to_num(heights[lost]) if axis == 2 else stands[axis]
    return made


class Reel:
    """Frames of a recording between the last look and now."""

    missed = 0

    def __init__(self, recording: Recording) -> None:
        check_played(recording)
        self.recording = recording = played(recording)
        self.frames = frames_of(recording)
        self.particles = particles_of(recording)
        self.dents: tuple[Dent, ...] = ()
        self.keeps = nt.Scene(**recording.metadata["scene"]).sample.dents == "yes"
        self.length = float(self.frames["time"][-1] - self.frames["time"][0])
        self.at, self.speed, self.paused = 0.0, 1.0, False
        self.looked = time.monotonic()
        self.shown = 0
        self._extremes: tuple[Any, Any] | None = None

    def read(self, count: int = 0) -> Any:
        """The next frames; all that lie between, whatever the speed."""
        now = time.monotonic()
        if not self.paused:
            self.at = min(self.at + self.speed * (now - self.looked), self.length)
        self.looked = now
        end = int(np.searchsorted(self.frames["time"], self.frames["time"][0] + self.at, side="right"))
        start, self.shown = min(self.shown, end), end
        return self.frames[start:end]

    def extremes(self, count: int) -> tuple[Any, Any]:
        """Least and largest force of each of so many parts [N]."""
        if self._extremes is None or len(self._extremes[0]) != count:
            force = np.nan_to_num(self.frames["tip_force"][:, 2])
            starts = np.linspace(0, len(force) - 1, count + 1)[:-1].astype(int)
            self._extremes = (np.minimum.reduceat(force, starts), np.maximum.reduceat(force, starts))
        return self._extremes

    def jump(self, at: float) -> None:
        """To a time from the beginning [s]; the two seconds before it are shown, too."""
        self.at = min(max(at, 0.0), self.length)
        self.shown = int(np.searchsorted(self.frames["time"], self.frames["time"][0] + self.at - 2.0))

    def answer(self, message: dict[str, Any]) -> None:
        """Pause, step, speed, rewind."""
        match message["do"]:
            case "pause":
                self.paused = not self.paused
            case "step":
                self.paused, self.at = True, min(self.at + STEP, self.length)
            case "rewind":
                self.jump(self.at - 5.0)
            case "slower" | "faster" as way:
                place = SPEEDS.index(self.speed) + (1 if way == "faster" else -1)
                self.speed = SPEEDS[min(max(place, 0), len(SPEEDS) - 1)]

    def told(self) -> list[dict[str, Any]]:
        """What a host would tell now: the clock, particles, other dents than before."""
        clock = {"tell": "clock", "speed": self.speed, "paused": self.paused or self.at >= self.length,
                 "slowdown": 1.0, "recorded": False}  # fmt: skip
        return [clock, *self._told_particles(), *self._told_dents()]

    def _told_particles(self) -> list[dict[str, Any]]:
        if self.particles is None or not self.shown:
            return []
        near = [pose for pose in self.particles.poses(self.shown - 1).tolist() if _lies(self.recording, pose)]
        told = {"tell": "particles", "radius": self.particles.radius, "places": [pose[:3] for pose in near],
                "length": self.particles.length, "angles": [pose[3] for pose in near]}  # fmt: skip
        return [told | {"targets": [], "events": []}]

    def _told_dents(self) -> list[dict[str, Any]]:
        if not self.keeps:
            return []
        tick = (self.frames["time"][0] + self.at) * self.recording.parameter("loop_rate")
        dents = dents_of([event for event in self.recording.metadata["events"] if event[0] <= tick])
        changed, self.dents = dents != self.dents, dents
        rows = [[*dent.imprint, dent.load, -1 if dent.before is None else dent.before] for dent in dents]
        return [{"tell": "dents", "dents": rows}] if changed else []


def check_played(recording: Recording) -> None:
    """Refuse what shows nothing."""
    if not len(recording):
        raise InvalidValue("the recording has no row")
    missing = [name for name in ("scene", "events") if name not in recording.metadata]
    if missing or "radius" not in recording.metadata["scene"].get("tip", {}):
        what = f"metadata lack {missing[0]!r}" if missing else "scene has no tip radius"
        raise InvalidValue(f"the recording's {what}: it was not made by a session")


def played(recording: Recording) -> Recording:
    """Without what a rewind took back; as it is, with a warning, where that cannot be told."""
    try:
        return without_rewinds(recording)
    except Error as error:
        warnings.warn(f"{error}; what a rewind took back is shown, too", stacklevel=2)
        return recording


def particles_of(recording: Recording) -> Recorded | None:
    """Of a recording that holds them."""
    return Recorded(recording) if {"particles", "rod"} & recording.metadata.keys() else None


def _lies(recording: Recording, place: Any) -> bool:
    """On the surface; a host puts aside what it does not need."""
    width, height = recording.metadata.get("surface_size") or (np.inf, np.inf)
    least = 0.0 if np.isfinite(width) else -np.inf
    return bool(least <= place[0] <= width and least <= place[1] <= height)


def surface_of(recording: Recording) -> tuple[nt.Topography, tuple[float, float]]:
    """What is known of the surface, around the path: the heights that the tip has met, along x; a flat where it met
    none. And its lower left corner [m]."""
    check_played(recording)
    x, y = (recording.columns[name] if name in recording else np.zeros(len(recording)) for name in ("x", "y"))
    height = recording.columns.get("surface_height", np.zeros(len(recording)))
    wide = np.concatenate([np.column_stack([x, y]), _around_particles(recording)])
    least, most = wide.min(axis=0), wide.max(axis=0)
    size = 1.2 * max(*map(float, most - least), 25.0 * float(recording.metadata["scene"]["tip"]["radius"]))
    left, low = (float(middle) - 0.5 * size for middle in 0.5 * (least + most))
    line = np.interp(left + (np.arange(PIXELS) + 0.5) * size / PIXELS, *_sorted(x, height))
    pixel_size = (size / PIXELS, size / PIXELS)
    return nt.Topography(np.tile(line, (PIXELS, 1)), pixel_size, name="what was met"), (left, low)


def _around_particles(recording: Recording) -> Any:
    """Corners around all that were laid on the surface [m]."""
    particles = particles_of(recording)
    places = [] if particles is None else [pose[:2] for _, _, pose in particles.laid if _lies(recording, pose)]
    around = np.reshape(np.array(places, dtype=float), (-1, 2))
    reach = 0.0 if particles is None else particles.radius + 0.5 * particles.length
    return np.concatenate([around - reach, around + reach])


def _sorted(x: Any, height: Any) -> tuple[Any, Any]:
    good = np.isfinite(height)
    if not good.any():
        return np.zeros(1), np.zeros(1)
    places, first = np.unique(x[good], return_index=True)
    return places, height[good][first]


def world_of(about: Mapping[str, Any], name: str, source: str) -> dict[str, Any]:
    """As a host tells it: scene, rig and settings of a session's metadata, or of what it says of itself now."""
    scene = nt.Scene(**about["scene"])
    accuracy = float(about.get("relative_accuracy", 0.01))
    plan = scene.plan(relative_accuracy=accuracy, bound=about.get("bound", "kept"))
    gains, lever = about["settings"]["gains"], float(about["spring_constant"])
    spring = float(gains.get("coupling_stiffness", 0.0) / (gains["alpha_p"] * gains["alpha_f"]))
    return {
        "tell": "world", "title": name, "source": source, "felt": "", "hint": "", "leads": "",
        "scene": scene.to_dict(), "rig": about["rig"], "settings": about["settings"], "bound": plan.bound,
        "stiffness": spring * lever / (spring + lever) if spring > 0.0 else lever, "relative_accuracy": accuracy,
        "margin": about.get("stability_margin") or np.inf, "undo": 0, "redo": 0,
        "force": about.get("guaranteed_force") or about["settings"]["limits"]["force"],
        "law": plan.contact_law, "warnings": [], "start": list(about.get("path", [(0.0, 0.0)])[0]),
        "clearance": float(about.get("clearance", 0.0)), "size": about.get("surface_size"),
    }  # fmt: skip


def demand_of(world: Mapping[str, Any], laxer: float = 1.0) -> nt.Demand:
    """What a plan of the same world, made here anew, keeps: its bound, or any where none is known."""
    accuracy, bound = float(world["relative_accuracy"]), float(world["bound"])
    if np.isinf(bound):
        return nt.Demand(demand={"relative_accuracy": accuracy, "bound": "any"})
    return nt.Demand(demand={"relative_accuracy": max(accuracy, laxer * bound)})
