# SPDX-License-Identifier: BSD-3-Clause
"""A whole touch on the simulated rig: simulated time, deterministic for a seed, driven block by block."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal, NamedTuple, get_args

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch.errors import InvalidValue
from nanotouch.operator import Input, script_for
from nanotouch.record import Recording, Writer
from nanotouch.scene import Plan, Rig, Scene, Settings
from nanotouch.surface import Surface

Mode = Literal["point", "scan", "topography"]
MODES: tuple[Mode, ...] = get_args(Mode)
BLOCK_TICKS = 5000
INDENTATION_RANGE = 0.3e-6  # delta_max of Eq. 21 [m]
ATTRACTION_RANGE = 0.6e-6  # the paper's largest attraction [N]

Columns = dict[str, NDArray[Any]]


class Margins(NamedTuple):
    """How far the loop is from its stability limit (rules R1, R4, R5 of docs/control.md)."""

    loop_stiffness: float
    """(1 + K_f) alpha_f alpha_p k_eff at the stiffest contact [N/m]"""
    loop_delay: float
    """two hops of hold and delay, and the stage's lag [s]"""
    stability_limit: float
    """b_m over the loop delay [N/m]"""
    margin: float
    """limit over stiffness; 1 is the limit"""
    quantisation_step: float
    """motor force of one step of stage or scaled master [N]"""
    force_noise: float
    """motor noise that the sensors make, RMS [N]"""


def settings_for_path(rig: Rig, relief: float = 0.0, clearance: float = 0.1e-6) -> Settings:
    """Settings whose scaling follows the paper's heuristic rule (Eq. 19, 21) for a path with this relief [m]."""
    settings = Settings.for_rig(rig)
    slave_path = clearance + INDENTATION_RANGE + relief
    settings.gains.alpha_p, settings.gains.alpha_f = _core.scaling_heuristic(rig.core, slave_path, ATTRACTION_RANGE)
    return settings


class Session:
    """Hand, master, controller, stage, probe and surface, composed once.

    Parameters
    ----------
    scene, rig : Scene, Rig
        What is touched, and with what; the paper's by default.
    settings : Settings, optional
        Gains and limits; by default those of :func:`settings_for_path` for the relief along the path.
    surface : Surface, optional
        The (dilated) surface; without it a flat at z = 0.
    mode : {"point", "scan", "topography"}
        Touch at a point; touch along a path; follow the path at constant force and feel the height only.
    path : sequence of (x, y), optional
        Where the tip goes [m]: one point for ``"point"``, at least two otherwise. By default the middle of the surface,
        or a line across it at mid-height.
    clearance : float
        Height of the tip above the surface at the start [m].
    seed : int
        Of the sensors' noise.
    rtol : float
        Largest relative error of the planned force.
    minimum_margin : float
        Refuse to open closer to the stability limit than this.
    """

    def __init__(
        self,
        scene: Scene | None = None,
        rig: Rig | None = None,
        *,
        settings: Settings | None = None,
        surface: Surface | None = None,
        mode: Mode = "point",
        path: Sequence[tuple[float, float]] | None = None,
        clearance: float = 0.1e-6,
        seed: int = 1,
        rtol: float = 0.01,
        minimum_margin: float = 1.5,
    ) -> None:
        if mode not in MODES:
            raise InvalidValue(f"mode {mode!r}: valid are {', '.join(MODES)}")
        self.scene = scene or Scene()
        self.rig = rig or Rig()
        self.surface = surface
        self.mode: Mode = mode
        self.seed = seed
        self.clearance = clearance
        self.path = _checked_path(mode, path, surface)
        heights = self.path_heights()[1]
        self.relief = float(np.ptp(heights))
        self.settings = settings or settings_for_path(self.rig, self.relief, clearance)
        options = {
            "topography": mode == "topography", "x": self.path[0][0], "y": self.path[0][1], "clearance": clearance,
            "rise": float(heights.max() - heights[0]), "seed": seed, "minimum_margin": minimum_margin, "relative_accuracy": rtol,
        }  # fmt: skip
        self.core = _core.Session(
            self.scene.core, self.rig.core, self.settings.core, surface.core if surface else None, options
        )

    @property
    def plan(self) -> Plan:
        """What is computed, and why."""
        return Plan(self.core.plan)

    @property
    def rate(self) -> float:
        """Rate of the force loop [Hz]."""
        return self.settings.gains.rate

    def margins(self) -> Margins:
        """Stability margins at the stiffest contact of the plan."""
        return Margins(**_core.margins(self.rig.core, self.settings.core, self.plan.maximum_stiffness))

    def path_heights(self, points: int = 2001) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Distance along the path [m] and height of the (dilated) surface there [m]."""
        corners = np.asarray(self.path)
        lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
        distance = np.linspace(0.0, lengths[-1], points)
        if self.surface is None:
            return distance, np.zeros_like(distance)
        x, y = (np.interp(distance, lengths, corners[:, axis]) for axis in (0, 1))
        return distance, self.surface.height(x, y)

    def advance(self, duration: float, input: Input | None = None) -> Columns:
        """Run for a time [s] and return what was recorded, as columns; ``input`` is where hand and tip go meanwhile."""
        if not duration >= 0.0:
            raise InvalidValue(f"duration = {duration} s: it must be 0 or more")
        if input is not None:
            self.core.aim(input.operator_force, input.x, input.y, input.duration)
        left = round(duration * self.rate)
        blocks = []
        while left > 0 or not blocks:
            ticks = min(left, BLOCK_TICKS)
            self.core.advance(ticks)
            blocks.append(self.core.read(ticks))
            left -= ticks
        return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}

    def run(
        self,
        duration: float | None = None,
        *,
        operator: Sequence[Input] | None = None,
        writer: Writer | None = None,
        progress: Callable[[float], None] | None = None,
    ) -> Recording:
        """Play an operator's script from here on.

        Parameters
        ----------
        duration : float, optional
            Stretch the script to this time [s].
        operator : sequence of Input, optional
            What hand and tip do, one after another; by default approach, press (or follow the path) and retract.
        writer : Writer, optional
            Receives every block as it comes.
        progress : callable, optional
            Called with the fraction done.
        """
        script = list(operator) if operator is not None else script_for(self)
        total = sum(step.duration for step in script)
        stretch = 1.0 if duration is None else duration / total
        blocks: list[Columns] = []
        done = 0.0
        for step in script:
            step = step._replace(duration=step.duration * stretch)
            self.core.aim(step.operator_force, step.x, step.y, step.duration)
            left = step.duration
            while left > 0.5 / self.rate:
                block = self.advance(min(left, BLOCK_TICKS / self.rate))
                left -= len(block["time"]) / self.rate
                done += len(block["time"]) / self.rate
                blocks.append(block)
                if writer is not None:
                    writer.append(block)
                if progress is not None:
                    progress(min(1.0, done / (total * stretch)))
        columns = {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]} if blocks else self.advance(0.0)
        return Recording(columns, self.metadata())

    def metadata(self) -> dict[str, Any]:
        """What a recording of this session has to be read with; JSON-able, SI."""
        return {
            "alpha_p": self.settings.gains.alpha_p,
            "alpha_f": self.settings.gains.alpha_f,
            "spring_constant": self.rig.probe.spring_constant,
            "start_height": self.core.start_height,
            "master_start": self.core.master_start,
            "mode": self.mode,
            "path": [list(point) for point in self.path],
            "seed": self.seed,
            "loop_rate": self.rate,
            "stability_margin": self.margins().margin,
            "scene": self.scene.to_dict(),
            "rig": self.rig.to_dict(),
            "settings": self.settings.to_dict(),
            "plan": str(self.plan).splitlines(),
            "version": _core.version,
        }

    def arm(self, confirmed: bool = False) -> None:
        """Back to RUN after RETRACT; after LATCHED only with ``confirmed``."""
        self.core.arm(confirmed)

    def emergency_stop(self, pressed: bool = True) -> None:
        """Press or release the simulated emergency stop."""
        self.core.emergency_stop(pressed)


def _checked_path(
    mode: Mode, path: Sequence[tuple[float, float]] | None, surface: Surface | None
) -> list[tuple[float, float]]:
    if path is None:
        path = _default_path(mode, surface)
    points = [(float(x), float(y)) for x, y in path]
    needed = 1 if mode == "point" else 2
    if len(points) < needed:
        raise InvalidValue(f"mode {mode!r} needs at least {needed} point(s) in its path, not {len(points)}")
    for x, y in points:
        if not np.isfinite([x, y]).all():
            raise InvalidValue(f"path: ({x}, {y}) m is not finite")
        if surface is not None:
            width, height = surface.size
            if not (0.0 <= x <= width and 0.0 <= y <= height):
                raise InvalidValue(
                    f"path: ({x:.4g}, {y:.4g}) m is outside the surface; valid is x 0 .. {width:.4g} m, y 0 .. {height:.4g} m"
                )
    return points


def _default_path(mode: Mode, surface: Surface | None) -> list[tuple[float, float]]:
    if surface is None:
        return [(0.0, 0.0)] if mode == "point" else [(0.0, 0.0), (1e-6, 0.0)]
    width, height = surface.size
    if mode == "point":
        return [(0.5 * width, 0.5 * height)]
    return [(0.02 * width, 0.5 * height), (0.98 * width, 0.5 * height)]
