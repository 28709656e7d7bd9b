# SPDX-License-Identifier: BSD-3-Clause
"""A whole touch: a scene, a rig of two halves, a loop. Simulated by default: the same record for the same seed."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import asdict
from typing import Any, Literal, Unpack

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch.errors import InvalidValue
from nanotouch.scene import BOUNDS, Rig, Scene, Settings
from nanotouch.scene.plan import Plan
from nanotouch.scene.surface import Surface
from nanotouch.touch import _stopped, _told, margins, views
from nanotouch.touch._control import CONTROLS, Control, ControlLaw, choose_control
from nanotouch.touch._open import TOLD, Frozen, Runs, as_now
from nanotouch.touch._path import MODES, Mode, checked_path, core_mode
from nanotouch.touch._plant import ProbeModel, plant_options
from nanotouch.touch._play import BLOCK_TICKS, joined, played
from nanotouch.touch._recorder import REWINDS_BEFORE, ROWS, rewinds
from nanotouch.touch._sideways import Sideways, margins_of, sideways_of
from nanotouch.touch.faults import Faults
from nanotouch.touch.hal import Halves, halves_of
from nanotouch.touch.margins import Calm, Margins
from nanotouch.touch.operator import Hold, Input, core_input, script_for, stretched
from nanotouch.touch.options import Options, Pace, Progress, check_options, checked_seed, demanded, settings_with
from nanotouch.touch.options import settings_for_path as settings_for_path
from nanotouch.touch.record import Metadata, Recording, Writer
from nanotouch.touch.supervisor import REASONS, Guarantee

__all__ = [
    "CONTROLS", "MODES", "REASONS", "Calm", "Columns", "Control", "ControlLaw", "Margins", "Mode", "Options", "Pace",
    "ProbeModel", "Progress", "Session", "choose_control", "settings_for_path",
]  # fmt: skip

RING_CAPACITY = 65536
CLOCKS = ("virtual: ticks times period", "monotonic, of this machine: a tick for each of its periods")
Columns = dict[str, NDArray[Any]]
FROZEN = "an open session is changed by session.change({!r}, field, value), which is recorded"


class Session(Runs, Frozen):
    """Hand, master, controller, stage, probe and surface, composed once.

    Parameters
    ----------
    scene, rig : Scene, Rig
        What is touched, and with what; the paper's by default.
    surface : Surface, optional
        The (dilated) surface; without it a flat at z = 0.
    mode : {"point", "scan", "topography", "approach", "curve", "tapping"}
        Touch at a point; touch along a path; follow the path at constant force and feel the height only; find the
        surface and hold the set-point there; a force-distance curve; follow the path at constant amplitude of a driven
        lever, as ``settings.tap`` says.
    path : sequence of (x, y), optional
        Where the tip starts and goes [m]: at least two points for ``"scan"`` and ``"topography"``, one otherwise. By
        default the middle of the surface, or a line across it at mid-height. Inputs, scans and clients may lead the
        tip beyond it, so that it narrows nothing of what is promised.
    settings : Settings, optional
        Gains and limits; by default those of :func:`settings_for_path` for the relief along the path and up to the
        scene's largest load, with the sample's pull-off clearly felt (:func:`nanotouch.touch.margins.felt_alpha_f`).
    **options
        See :class:`Options`.

    What is open is frozen: ``scene``, ``rig`` and ``settings`` of a session refuse changes. :meth:`change` makes them,
    and records them.
    """

    _ring_capacity = RING_CAPACITY  # rows

    def __init__(
        self,
        scene: Scene | None = None,
        rig: Rig | None = None,
        *,
        surface: Surface | None = None,
        mode: Mode = "point",
        path: Sequence[tuple[float, float]] | None = None,
        settings: Settings | None = None,
        **options: Unpack[Options],
    ) -> None:
        if mode not in MODES:
            raise InvalidValue(f"mode {mode!r}: valid are {', '.join(MODES)}")
        check_options(options)
        self._scene = (Scene() if scene is None else scene).frozen(FROZEN.format("scene"))
        self.rig = (Rig() if rig is None else rig).frozen("the rig of an open session stays as it is: open another one")
        self.surface = surface
        self._mode: Mode = mode  # that it was opened in, or was asked for last
        self.seed = checked_seed(options.get("seed", 1))
        self.minimum_margin = float(options.get("minimum_margin", 1.5))
        self.relative_accuracy, self.bound = demanded(options)
        self.clearance = options.get("clearance", 0.1e-6)
        self.path = tuple(checked_path(mode, path, surface))
        heights = self.path_heights()[1]
        self.relief = float(np.ptp(heights))
        wanted = settings_with(self._scene, self.rig, surface, relief=self.relief, settings=settings, options=options)
        control = options.get("control", "default")
        self.control = choose_control(wanted, control)
        self._settings = wanted.frozen(FROZEN.format("settings"))
        self.rate = float(wanted.gains.rate)
        """of the force loop [Hz]"""
        self._events: list[tuple[int, str, list[Any]]] = []
        faults, particles, rod = options.get("faults"), options.get("particles"), options.get("rod")
        parts = (None, None, None) if surface is None else surface.parts
        with self._scene.naming_terms():
            self.core = _core.Session(
                self._scene.core, self.rig.core, wanted.core, {
                    **dict(zip(("surface", "radii", "properties"), parts, strict=True)),
                    "mode": core_mode(mode), "path": np.asarray(self.path, dtype=float), "seed": self.seed,
                    "rise": float(heights.max() - heights[0]),
                    "clearance": self.clearance, "minimum_margin": self.minimum_margin,
                    "preflight": options.get("preflight", True), "law": control if callable(control) else None,
                    "relative_accuracy": self.relative_accuracy, "bound": BOUNDS.index(self.bound),
                    "master": options.get("master"), "slave": options.get("slave"),
                    "ring_capacity": self._ring_capacity * options.get("recorded", True), "rod": rod and rod._core,
                    **plant_options(options.get("probe_model", "auto"), options.get("substep"), faults),
                    "particles": None if particles is None else particles._core,
                },
            )  # fmt: skip
        described = {"scene": self._scene, "rig": self.rig, "settings": self._settings}
        self._opened_with: dict[str, Any] = {name: one.to_dict() for name, one in described.items()}
        self._opened_with |= {"mode": mode, "stability_margin": self._finite_margin()}
        self._amounts = None if self.core.amounts is None else Settings.from_core(self.core.amounts).to_dict()
        pushed = (("particles", particles), ("rod", rod))
        self._opened_with |= {name: asdict(one) for name, one in pushed if one is not None}
        self.is_led = options.get("master") is not None  # by a device: no script pushes its hand
        self._faults: list[str] = []
        self.inject(Faults() if faults is None else faults)
        own = options.get("master") or options.get("slave")
        self._begun = None if own else self.core.snapshot()
        self._freeze()

    @property
    def halves(self) -> Halves:
        """What master and slave say of themselves: capabilities, and a row for each channel."""
        return halves_of(self.core)

    @property
    def plan(self) -> Plan:
        """What is computed, and why."""
        return Plan(self.core.plan)

    @property
    def scene(self) -> Scene:
        """As it is touched now; frozen."""
        self._scene = as_now(self._scene, self.core.scene, FROZEN.format("scene"))
        return self._scene

    @property
    def settings(self) -> Settings:
        """As they hold now, with the scales that were asked for last; frozen."""
        self._settings = as_now(self._settings, self.core.settings, FROZEN.format("settings"))
        return self._settings

    @property
    def mode(self) -> Mode:
        """That it is in now, or goes over to."""
        now = self.core.mode
        if core_mode(self._mode) != now:  # a client of its frames has asked
            self._mode = next(mode for mode in MODES if core_mode(mode) == now)
        return self._mode

    def margins(self) -> Margins:
        """In this mode, at these scales and the stiffest contact of the plan; a law of one's own: docs/control.md."""
        return margins_of(self)

    def sideways(self) -> Sideways:
        """In x and y, and of all axes together; ``margins`` counts them."""
        return sideways_of(self)

    def calm(self) -> Calm:
        """What is felt of the loop itself in touch, at these scales and the stiffest contact of the plan; of a law of
        one's own as of the default law that it amounts to, NaN where that is not known."""
        settings = self.settings
        if self.control == "own" and self.core.amounts is not None:
            settings = Settings.from_core(self.core.amounts)
        return margins.calm(self.rig, settings, self.plan.maximum_stiffness)

    def _finite_margin(self) -> float | None:
        """As JSON has it."""
        margin = self.stability_margin
        return margin if math.isfinite(margin) else None

    @property
    def stability_margin(self) -> float:
        """The smallest margin of those that count in this mode; 1 is the limit."""
        return self.margins().least

    def guarantee(self) -> Guarantee:
        """What holds whatever the operator does, wherever the tip can be led; to be read before anything moves."""
        return Guarantee(**self.core.guarantee, hand=margins.MotorBound(**self.core.motor_bound))

    @property
    def force_overshoot(self) -> float:
        """How far the force on the sample may exceed the set limit before the reaction shows [N]."""
        return self.guarantee().force - float(self.settings.limits.force)

    @property
    def is_done(self) -> bool:
        """An approach has found the surface, or a curve is complete."""
        return bool(self.core.phase == 2)

    def path_heights(self, points: int = 2001) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Distance along the path [m] and height of the (dilated) surface there [m]."""
        corners = np.asarray(self.path)
        lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))])
        distance = np.linspace(0.0, lengths[-1], points)
        if self.surface is None:
            return distance, np.zeros_like(distance)
        x, y = (np.interp(distance, lengths, corners[:, axis]) for axis in (0, 1))
        return distance, self.surface.height(x, y)

    def advance(self, duration: float, input: Input | Hold | None = None) -> Columns:
        """Run for a time [s] and return what was recorded, as columns; ``input`` is where hand and tip go meanwhile."""
        left = self._ticks(duration)
        if input is not None:
            self.aim(input)
        blocks: list[Columns] = []
        while left > 0 or not blocks:
            ticks = min(left, BLOCK_TICKS)
            self.core.advance(ticks)
            blocks.append(self.read(ticks))
            left -= ticks
        return joined(blocks)

    def step(self, input: Input | Hold | None = None) -> _core.Frame:
        """Run one period: some microseconds. The frame of that tick holds what was measured and what was true. A
        recorded session keeps up to 65 536 steps and 4096 inputs until :meth:`read` takes them."""
        return self.core.step(None if input is None else core_input(input))

    def read(self, rows: int = BLOCK_TICKS) -> Columns:
        """Up to so many rows of what was recorded and not read yet, as columns."""
        columns: Columns = self.core.read(rows)
        asked = self.core.read_events()
        self._events += asked
        if any(name in TOLD for _, name, _ in asked):  # by an observer, too
            self.describe()
        return columns

    def aim(self, input: Input | Hold) -> None:
        """Where hand and tip go from the next tick on; from any thread, the newest counts."""
        self.core.aim(core_input(input))

    def run(
        self,
        duration: float | None = None,
        *,
        operator: Sequence[Input | Hold] | None = None,
        writer: Writer | None = None,
        progress: Callable[[float], None] | None = None,
        keep: bool = True,
    ) -> Recording:
        """Play an operator's script from here on; where a device is real, at :attr:`pace`. Warns where it was stopped.

        Parameters
        ----------
        duration : float, optional
            Stretch the script to this time [s].
        operator : sequence of Input or Hold, optional
            What hand and tip do, one after another; by default approach, press (or follow the path) and retract.
        writer : Writer, optional
            Receives every block as it comes.
        progress : callable, optional
            Called with the fraction done.
        keep : bool
            False: the rows go to the writer alone, so that memory does not grow; the Recording has the last block.
        """
        begun = rewinds(self._asked())
        script = stretched(operator if operator is not None else script_for(self), duration)
        for step in script:
            self.core.check(core_input(step))
        blocks: list[Columns] = []
        told = 0
        with closing(played(self, script)) as comes:
            for block, done in comes:
                if not keep:
                    blocks.clear()
                blocks.append(block)
                if writer is not None:
                    if told < len(self._events):  # a recording that is cut short can be replayed, too
                        told = len(self._events)
                        writer.update({"events": self.metadata()["events"]})
                    writer.append(block)
                if progress is not None:
                    progress(done)
        columns = joined(blocks) if blocks else self.read(0)
        metadata = self.metadata()
        if writer is not None:
            writer.update(metadata)
        _stopped.warn(columns, _told.stopped(self))
        own = {REWINDS_BEFORE: begun} if begun else {}
        return Recording(columns, metadata | own | ({ROWS: len(columns["time"])} if keep else {}))

    live = views.watch

    __repr__ = _told.in_a_line
    _repr_html_ = _told.as_html

    def metadata(self) -> dict[str, Any]:
        """What a recording of this session has to be read with; JSON-able, SI. Scene, rig and settings are those it was
        opened with: what has changed since is in the events."""
        entries = {
            "alpha_p": self._opened_with["settings"]["gains"]["alpha_p"],
            "alpha_f": self._opened_with["settings"]["gains"]["alpha_f"],
            "spring_constant": self.rig.probe.spring_constant,
            "start_height": None if math.isnan(self.core.start_height) else self.core.start_height,
            "master_start": self.core.master_start, "control": self.control, "amounts": self._amounts,
            "relative_accuracy": self.relative_accuracy, "bound": self.bound, "tare": list(self.core.tare),
            "events": self._asked(),
            "path": [list(point) for point in self.path],
            "seed": self.seed,
            "probe_model": self.probe_model,
            "faults": list(self._faults),
            "loop_rate": self.rate,
            "clock": CLOCKS[any(half.real for half in self.halves)],
            **self._opened_with,
            "plan": str(self.plan).splitlines(),
            "version": _core.version,
        }  # fmt: skip
        if self.surface is not None:
            entries["surface_size"] = list(self.surface.size)
            if self.surface.origin is not None:
                entries["surface"] = self.surface.origin
        return Metadata(entries, self._asked)

    def _now(self) -> dict[str, Any]:
        return {
            "scene": self.scene.to_dict(), "settings": self.settings.to_dict(), "mode": self.mode,
            "stability_margin": self._finite_margin(), "plan": str(self.plan).splitlines(),
            "guaranteed_force": self.guarantee().force, "clearance": self.clearance,
        }  # fmt: skip

    def _asked(self) -> list[list[Any]]:
        """What was asked of it so far, as JSON keeps it."""
        self._events += self.core.read_events()
        return [[tick, name, numbers] for tick, name, numbers in self._events]

    def arm(self, confirmed: bool = False) -> None:
        """Go back to RUN after RETRACT. After LATCHED this needs ``confirmed``: somebody has looked at the rig."""
        self.core.arm(confirmed)

    def set_mode(self, mode: Mode) -> None:
        """Go on in another mode from where the stage stands; the force fades out and in again."""
        if mode not in MODES:
            raise InvalidValue(f"mode {mode!r}: valid are {', '.join(MODES)}")
        self.core.set_mode(core_mode(mode))
        self._mode = mode
        self.describe()

    def rescale(self, alpha_p: float | None = None, alpha_f: float | None = None) -> None:
        """Change the scales [m/m], [N/N] while running. The stage does not jump, and the loop stays passive.

        A rise may wait until the hand has paid its energy (docs/control.md). Refused below the least stability margin.
        """
        now = self.settings.gains
        self.core.rescale(now.alpha_p if alpha_p is None else alpha_p, now.alpha_f if alpha_f is None else alpha_f)
        self.describe()

    def change(self, what: Literal["scene", "settings"], field: str, value: float | str) -> None:
        """Change a field of the open session's scene or settings, such as ``("scene", "sample.youngs_modulus", 1e9)``.

        Plan, margins and guarantee are made anew while the loop goes on, and take effect between two ticks. Refused
        where the margin or the demand could not be kept. ``gains.alpha_p``, ``gains.alpha_f``: :meth:`rescale`.
        """
        if what not in ("scene", "settings"):
            raise InvalidValue(f"change {what!r}: valid are scene, settings")
        asked: Scene | Settings = (self.scene if what == "scene" else self.settings).copy()
        if field not in asked.fields:
            raise InvalidValue(f"change: {what} has no field {field!r}; it has {', '.join(asked.fields)}")
        asked[field] = value
        self.core.change(what == "scene", field, asked[field])
        self.describe()

    def clutch(self, open: bool = True) -> None:
        """Let go of the stage, to move the master alone; ``open=False`` couples them again from where they stand."""
        self.core.clutch(open)

    def inject(self, faults: Faults) -> None:
        """Let the simulated rig fail; times count from the session's first tick."""
        for fault in faults:
            if fault.at is not None:
                self.core.inject(fault.core)
            self._faults.append(str(fault))

    @property
    def probe_model(self) -> ProbeModel:
        """How the cantilever is simulated."""
        return "dynamic" if self.core.is_dynamic else "quasi-static"

    def emergency_stop(self, pressed: bool = True) -> None:
        """Press or release the simulated emergency stop; from any thread, also during :meth:`advance`."""
        self.core.emergency_stop(pressed)
