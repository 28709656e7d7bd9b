# SPDX-License-Identifier: BSD-3-Clause
"""A whole touch on the simulated rig: simulated time, deterministic for a seed, driven block by block."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from operator import index
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core, margins
from nanotouch._arrays import check_between
from nanotouch._control import CONTROLS, Law, choose_control
from nanotouch._path import MODES, Mode, check_inside, checked_path, core_mode
from nanotouch._plant import ProbeModel, plant_options
from nanotouch.errors import InvalidValue
from nanotouch.faults import Faults
from nanotouch.margins import ForceRange, Margins
from nanotouch.operator import Input, script_for, stretched
from nanotouch.plan import Plan, terrain_of
from nanotouch.record import Recording, Writer
from nanotouch.scene import Rig, Scene, Settings
from nanotouch.supervisor import REASONS, Guarantee
from nanotouch.surface import Surface

__all__ = [
    "CONTROLS", "MODES", "REASONS", "Columns", "Law", "Margins", "Mode", "ProbeModel", "Session", "choose_control",
    "settings_for_path",
]  # fmt: skip

BLOCK_TICKS = 500  # rows that a killed process may lose
INDENTATION_RANGE = 0.3e-6  # delta_max of Eq. 21 [m]
ATTRACTION_RANGE = 0.6e-6  # the paper's largest attraction [N]

Columns = dict[str, NDArray[Any]]


def settings_for_path(
    rig: Rig, relief: float = 0.0, clearance: float = 0.1e-6, force_range: tuple[float, float] | None = None
) -> Settings:
    """Settings whose scaling follows the paper's heuristic rule (Eq. 19, 21) for a path with this relief [m] and forces
    on the tip [N] from a plan or a test touch (:func:`nanotouch.margins.force_range`)."""
    check_between("clearance", clearance, "m", above=0.0, up_to=1e-3)
    check_between("relief", relief, "m", above=-1e-15, up_to=1e-3)
    settings = Settings.for_rig(rig)
    slave_path = clearance + INDENTATION_RANGE + relief
    settings.gains.alpha_p, settings.gains.alpha_f = _core.scaling_heuristic(rig.core, slave_path, ATTRACTION_RANGE)
    if force_range is not None:
        settings.gains.alpha_f = margins.heuristic_alpha_f(rig, ForceRange(*force_range))
    return settings


class Session:
    """Hand, master, controller, stage, probe and surface, composed once.

    Parameters
    ----------
    scene, rig : Scene, Rig
        What is touched, and with what; the paper's by default.
    rate : float, optional
        Of the force loop [Hz]; by default that of the settings, 10 kHz.
    control : {"default", "paper", "impedance"} or callable
        The control law (docs/control.md), or one's own: a function of the signals of a period
        (:class:`nanotouch._core.Signals`) that returns the motor force [N] and where the stage shall be [m], under the
        same supervisor and limits; it is tried before the session opens, to know its margins (``minimum_margin=0``
        arms without, and leaves it alone). A rig without a gauge has ``"impedance"`` as its default.
    gains : mapping, optional
        Fields of ``settings.gains`` in SI that differ, such as ``{"force_gain": 10}``.
    mode : {"point", "scan", "topography", "approach", "curve"}
        Touch at a point; touch along a path; follow the path at constant force and feel the height only; find the
        surface and hold the set-point there; a force-distance curve.
    path : sequence of (x, y), optional
        Where the tip goes [m]: at least two points for ``"scan"`` and ``"topography"``, one otherwise. By default the
        middle of the surface, or a line across it at mid-height.
    delay : float
        Of the link between hand and probe [s], beside the rig's own.
    seed : int
        Of the sensors' noise.
    settings : Settings, optional
        Gains and limits; by default those of :func:`settings_for_path` for the relief along the path.
    force_range : (lowest, highest), optional
        Forces on the tip [N] that alpha_f is to fill the hand's range with (Eq. 19), where no settings are given.
    surface : Surface, optional
        The (dilated) surface; without it a flat at z = 0.
    clearance : float
        Height of the tip above the surface at the start [m].
    rtol : float
        Largest relative error of the planned force.
    minimum_margin : float
        Refuse to open closer to the stability limit than this.
    preflight : bool
        Tare the sensors and test the stage's sign before the first tick; refuse to open if they are off.
    probe_model : {"auto", "quasi-static", "dynamic"}
        How the cantilever is simulated: at rest at every tick, or by its equation of motion (docs/plant.md). ``"auto"``
        takes the first where its error is small enough.
    substep : float
        Of the dynamic cantilever: the largest angle of its fastest oscillation in one sub-step [rad].
    faults : Faults, optional
        What fails in the simulated rig, and when.
    """

    def __init__(
        self,
        scene: Scene | None = None,
        rig: Rig | None = None,
        *,
        rate: float | None = None,
        control: str | Law = "default",
        gains: Mapping[str, float] | None = None,
        mode: Mode = "point",
        path: Sequence[tuple[float, float]] | None = None,
        delay: float = 0.0,
        seed: int = 1,
        settings: Settings | None = None,
        force_range: tuple[float, float] | None = None,
        surface: Surface | None = None,
        clearance: float = 0.1e-6,
        rtol: float = 0.01,
        minimum_margin: float = 1.5,
        preflight: bool = True,
        probe_model: ProbeModel = "auto",
        substep: float = 0.25,
        faults: Faults | None = None,
    ) -> None:
        if mode not in MODES:
            raise InvalidValue(f"mode {mode!r}: valid are {', '.join(MODES)}")
        self.scene = Scene() if scene is None else scene.copy()
        self.rig = Rig() if rig is None else rig.copy()
        self.surface = surface
        self.mode: Mode = mode
        self._mode: Mode = mode  # that it is in now
        self.seed = _checked_seed(seed)
        self.minimum_margin = float(minimum_margin)
        self.clearance = clearance
        self.path = checked_path(mode, path, surface)
        distance, heights = self.path_heights()
        self.relief = float(np.ptp(heights))
        if settings is not None and force_range is not None:
            raise InvalidValue("force_range sets alpha_f, which the settings hold already: give one of them")
        scaled = settings_for_path(self.rig, self.relief, clearance, force_range) if settings is None else settings
        self.settings = scaled.copy()
        _choose(self.settings, rate, gains, delay)
        self.control = choose_control(self.settings, control)
        self._events: list[tuple[int, str, list[Any]]] = []
        self._scales = [self.settings.gains.alpha_p, self.settings.gains.alpha_f]
        options = {
            "mode": core_mode(mode), "x": self.path[0][0], "y": self.path[0][1], "seed": self.seed,
            "clearance": clearance, "rise": float(heights.max() - heights[0]), "slope": _steepest(distance, heights),
            "minimum_margin": self.minimum_margin, "relative_accuracy": rtol, "preflight": preflight,
            "law": control if callable(control) else None,
            **plant_options(probe_model, substep, faults),
        }  # fmt: skip
        self.core = _core.Session(
            self.scene.core, self.rig.core, self.settings.core, terrain_of(self.scene, surface, rtol), options
        )
        self._amounts = None if self.core.amounts is None else Settings.from_core(self.core.amounts)
        self._faults: list[str] = []
        self.inject(Faults() if faults is None else faults)

    @property
    def plan(self) -> Plan:
        """What is computed, and why."""
        return Plan(self.core.plan)

    @property
    def rate(self) -> float:
        """Rate of the force loop [Hz]."""
        return float(self.settings.gains.rate)

    def margins(self) -> Margins:
        """Margins at the stiffest contact of the plan, and why the session was to be refused, if it was; of a law of
        one's own by what it was seen to do before the first tick, NaN where that is not known (docs/control.md)."""
        amounts = self._amounts if self.control == "own" else self.settings
        return margins.of_own_law(self.rig, self.settings, amounts, self.plan.maximum_stiffness, self.mode)

    @property
    def stability_margin(self) -> float:
        """The smallest margin of those that count in this mode; 1 is the limit."""
        return self.margins().least

    def guarantee(self) -> Guarantee:
        """What holds whatever the operator does, on this path; to be read before anything moves."""
        return Guarantee(**self.core.guarantee)

    @property
    def force_overshoot(self) -> float:
        """How far the force on the sample may exceed the set limit before the reaction shows, on this path [N]."""
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

    def advance(self, duration: float, input: Input | None = None) -> Columns:
        """Run for a time [s] and return what was recorded, as columns; ``input`` is where hand and tip go meanwhile."""
        if not 0.0 <= duration < math.inf:
            raise InvalidValue(f"duration = {duration} s: it must be a time of 0 s or more")
        if input is not None:
            self._aim(input)
        left = round(duration * self.rate)
        blocks: list[Columns] = []
        while left > 0 or not blocks:
            ticks = min(left, BLOCK_TICKS)
            self.core.advance(ticks)
            blocks.append(self.core.read(ticks))
            left -= ticks
        return _joined(blocks)

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
        script = stretched(list(operator) if operator is not None else script_for(self), duration)
        for step in script:
            self._check(step)
        ticks = [round(step.duration * self.rate) for step in script]
        blocks: list[Columns] = []
        done = told = 0
        for step, left in zip(script, ticks, strict=True):
            self._aim(step)
            for length in _blocks_of(left):
                block = self.advance(length / self.rate)
                blocks.append(block)
                done += length
                if writer is not None:
                    if told < len(self._events):  # a recording that is cut short can be replayed, too
                        told = len(self._events)
                        writer.update({"events": self.metadata()["events"]})
                    writer.append(block)
                if progress is not None:
                    progress(done / sum(ticks))
        recording = Recording(_joined(blocks) if blocks else self.advance(0.0), self.metadata())
        if writer is not None:
            writer.update(recording.metadata)
        return recording

    def _aim(self, input: Input) -> None:
        self._check(input)
        self._request("aim", self.core.aim, [input.x, input.y, input.duration], tuple(input))

    def _request(self, name: str, call: Callable[..., None], numbers: list[Any], arguments: Sequence[Any]) -> None:
        """Ask the touch step for something between two ticks, and keep it for a replay."""
        tick = self.core.ticks
        call(*arguments)
        self._events.append((tick, name, numbers))

    def _check(self, input: Input) -> None:
        """Refuse what the C library would, with the names and ranges it does not know."""
        for name, value in input._asdict().items():
            if not math.isfinite(value):
                raise InvalidValue(f"operator input: {name} = {value} is not finite")
        if input.duration < 0.0:
            raise InvalidValue(f"operator input: duration = {input.duration} s: it must be 0 s or more")
        check_inside(self.surface, input.x, input.y, "operator input")

    def metadata(self) -> dict[str, Any]:
        """What a recording of this session has to be read with; JSON-able, SI."""
        return {
            "alpha_p": self.settings.gains.alpha_p,
            "alpha_f": self.settings.gains.alpha_f,
            "spring_constant": self.rig.probe.spring_constant,
            "start_height": self.core.start_height,
            "master_start": self.core.master_start,
            "control": self.control,
            "amounts": None if self._amounts is None else self._amounts.to_dict(),
            "tare": list(self.core.tare),
            "events": [[tick, name, numbers] for tick, name, numbers in self._events],
            "mode": self.mode,
            "path": [list(point) for point in self.path],
            "seed": self.seed,
            "probe_model": self.probe_model,
            "faults": list(self._faults),
            "loop_rate": self.rate,
            "stability_margin": self.stability_margin if math.isfinite(self.stability_margin) else None,
            "scene": self.scene.to_dict(),
            "rig": self.rig.to_dict(),
            "settings": self.settings.to_dict(),
            "plan": str(self.plan).splitlines(),
            "version": _core.version,
        }

    def arm(self, confirmed: bool = False) -> None:
        """Back to RUN after RETRACT; after LATCHED only with ``confirmed``."""
        self._request("arm", self.core.arm, [confirmed], [confirmed])

    def set_mode(self, mode: Mode) -> None:
        """Go on in another mode from where the stage stands; the force fades out and in again."""
        if mode not in MODES:
            raise InvalidValue(f"mode {mode!r}: valid are {', '.join(MODES)}")
        self._check_margin("mode", mode, self._scales)
        self._request("mode", self.core.set_mode, [core_mode(mode)], [core_mode(mode)])
        self._mode = mode

    def rescale(self, alpha_p: float | None = None, alpha_f: float | None = None) -> None:
        """Change the scales [m/m], [N/N] while running: without a bump, and as far as it is passive (docs/control.md).

        Refused where the loop would run closer to its stability limit than the session's minimum.
        """
        now = self._scales
        pair = [now[0] if alpha_p is None else alpha_p, now[1] if alpha_f is None else alpha_f]
        self._check_margin("rescale", self._mode, pair)
        self._request("rescale", self.core.rescale, pair, pair)
        self._scales = pair

    def _check_margin(self, what: str, mode: Mode, scales: list[float]) -> None:
        """Refuse what the C library would, by the rule that it does not name; only it can try a law of one's own again,
        with other scales."""
        asked, stiffness = self.settings.copy(), self.plan.maximum_stiffness
        asked["gains.alpha_p"], asked["gains.alpha_f"] = scales
        own = self.control == "own"
        found = margins.of_own_law(self.rig, asked, self._amounts if own else asked, stiffness, mode)
        if self.minimum_margin > 0.0 and not found.least >= self.minimum_margin:
            raise InvalidValue(
                f"{what}: {found.rule}: margin {found.least:.3g}, at least {self.minimum_margin:g} is needed"
            )

    def clutch(self, open: bool = True) -> None:
        """Let go of the stage, to move the master alone; ``open=False`` couples them again from where they stand."""
        self._request("clutch", self.core.clutch, [open], [open])

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


def _joined(blocks: Sequence[Columns]) -> Columns:
    return {name: np.concatenate([block[name] for block in blocks]) for name in blocks[0]}


def _blocks_of(ticks: int) -> list[int]:
    return [min(BLOCK_TICKS, ticks - start) for start in range(0, ticks, BLOCK_TICKS)]


def _checked_seed(seed: int) -> int:
    if not 0 <= index(seed) < 2**64:
        raise InvalidValue(f"seed = {seed}: valid is 0 .. 2^64 - 1")
    return index(seed)


def _steepest(distance: NDArray[np.float64], heights: NDArray[np.float64]) -> float:
    return float(np.max(np.abs(np.gradient(heights, distance)))) if distance[-1] > 0.0 else 0.0


def _choose(settings: Settings, rate: float | None, gains: Mapping[str, float] | None, delay: float) -> None:
    """What was given beside the settings goes into them."""
    for name, value in (gains or {}).items():
        if f"gains.{name}" not in settings.fields:
            raise InvalidValue(f"gains has no field {name!r}; it has {', '.join(settings.keys_of('gains'))}")
        settings[f"gains.{name}"] = value
    if rate is not None:
        settings["gains.rate"] = rate
    if not 0.0 <= delay < math.inf:
        raise InvalidValue(f"delay = {delay} s: it must be a time of 0 s or more")
    if delay > 0.0:
        settings["gains.delay"] = settings.gains.delay + delay * settings.gains.rate
