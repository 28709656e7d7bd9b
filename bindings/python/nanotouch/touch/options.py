# SPDX-License-Identifier: BSD-3-Clause
"""What a session may be given besides scene, rig, surface, mode, path and settings, and the settings for its path."""

from __future__ import annotations

import math
from collections.abc import Mapping
from operator import index
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, TypedDict, get_args

from nanotouch import _core
from nanotouch._arrays import check_between
from nanotouch._io.words import told
from nanotouch.errors import InvalidValue
from nanotouch.manipulation import Particles, Rod
from nanotouch.scene import BOUNDS, Bound, Rig, Scene, Settings
from nanotouch.scene.surface import Surface
from nanotouch.touch import margins
from nanotouch.touch._control import Control, ControlLaw, choose_control
from nanotouch.touch._plant import ProbeModel
from nanotouch.touch.faults import Faults
from nanotouch.touch.hal import Mailbox, Master, Replay, SharedObject, Slave
from nanotouch.touch.margins import ForceRange
from nanotouch.touch.rig_file import Converters

if TYPE_CHECKING:
    from nanotouch._fields import SettingsGainsValues

    Gains = SettingsGainsValues

INDENTATION_RANGE = 0.3e-6  # delta_max of Eq. 21 [m]
ATTRACTION_RANGE = 0.6e-6  # the paper's largest attraction [N]

Pace = Literal["free", "wall", "hard"]
RING_CAPACITY = 65536
PACES: tuple[Pace, ...] = get_args(Pace)
PACE_REASONS: dict[Pace, str] = {
    "free": "free pace, for nothing of it is real",
    "wall": "wall pace, for its master is real and its slave simulated: lateness slows the clock",
    "hard": "hard pace, for its slave is real: each tick at its deadline",
}
"""why a session has its pace"""


class Options(TypedDict, total=False):
    """What a session may be given besides scene, rig, surface, mode, path and settings."""

    rate: float | None
    """of the force loop [Hz]; by default that of the settings, 10 kHz"""
    control: Control | ControlLaw
    """the control law (docs/control.md): "default", "paper", "impedance"; or one's own, a function of the signals of a
    period (:class:`nanotouch._core.Signals`) that returns the motor force [N] and where the stage shall be [m], under
    the same supervisor and limits. It is tried before the session opens, to know its margins (``minimum_margin=0`` arms
    without, and leaves it alone). A rig without a gauge has "impedance" as its default"""
    gains: Gains
    """fields of ``settings.gains`` in SI that differ, such as ``{"force_gain": 10}``"""
    delay: float
    """of the link between hand and probe, beside the rig's own [s]"""
    seed: int
    """of all that is random in the simulated halves; 1"""
    force_range: tuple[float, float]
    """lowest and highest force on the tip [N] that alpha_f is to fill the hand's range with (Eq. 19), where no settings
    are given; without it, and without ``gains={"alpha_f": ...}``, the sample's pull-off is to be clearly felt
    (:func:`nanotouch.touch.margins.felt_alpha_f`)"""
    clearance: float
    """height of the tip above the surface at the start; 0.1 um [m]"""
    relative_accuracy: float
    """largest relative error of the planned force; 0.01"""
    bound: Bound
    """what the bound of that force is held to, as in :meth:`nanotouch.Scene.plan`; "kept". A real slave is armed with a
    bound that is known, and with no other"""
    minimum_margin: float
    """refuse to open closer to the stability limit than this; 1.5"""
    preflight: bool
    """tare the sensors and test the stage's sign before the first tick; refuse to open if they are off"""
    probe_model: ProbeModel
    """how the cantilever is simulated: at rest at every tick, or by its equation of motion (docs/plant.md). "auto"
    takes the first where its error is small enough"""
    substep: float
    """of the dynamic cantilever: the largest angle of its fastest oscillation in one sub-step; 0.25, and no more than
    20 000 of them in a period [rad]"""
    faults: Faults
    """what fails in the simulated halves, and when"""
    particles: Particles
    """what :meth:`Session.lay` may lay on a flat at z = 0, to be pushed: its tip has the scene's radius and half
    angle, the lever is the rig's (docs/manipulation.md)"""
    rod: Rod
    """the same of one rod, instead of particles: what :meth:`Session.lay_rod` may lay"""
    master: Master | SharedObject | Mailbox | Replay | Converters | None
    """one's own half instead of the simulated hand and master (:mod:`nanotouch.touch.hal`, docs/hal.md)"""
    slave: Slave | SharedObject | Mailbox | Replay | Converters | None
    """one's own half instead of the simulated stage, probe and sample"""
    recorded: bool
    """False: no records are kept; for :meth:`Session.step`"""


class Progress(NamedTuple):
    """What a run in its own thread has been so far."""

    ticks: int
    """run in all"""
    dropped: int
    """records that a full ring has lost; hard pace only"""
    slowdown: float
    """wall pace: time on the clock over time in the session, lately; 1 where it keeps up"""
    worst_delay: float
    """wall and hard pace: of a wake-up [s]"""
    runs: bool
    paused: bool
    """asked for"""
    stands: bool
    """paused, no tick runs any more, and no granted step is left"""
    status: str
    """why it has ended by itself"""


def settings_for_path(
    rig: Rig,
    relief: float = 0.0,
    clearance: float = 0.1e-6,
    *,
    force_range: tuple[float, float] | None = None,
    load: float = math.inf,
) -> Settings:
    """Settings whose scaling follows the paper's heuristic rule (Eq. 19, 21) for a path with this relief [m] and forces
    on the tip [N] from a plan or a test touch (:func:`nanotouch.touch.margins.force_range`). The force limit is at most
    the largest ``load`` of the scene [N], and half of it is held in topography, approach and curve."""
    check_between("clearance", clearance, "m", above=0.0, up_to=1e-3)
    check_between("relief", relief, "m", above=-1e-15, up_to=1e-3)
    settings = Settings.for_rig(rig)
    slave_path = clearance + INDENTATION_RANGE + relief
    settings.gains.alpha_p, settings.gains.alpha_f = _core.scaling_heuristic(rig.core, slave_path, ATTRACTION_RANGE)
    if force_range is not None:
        settings.gains.alpha_f = margins.heuristic_alpha_f(rig, ForceRange(*force_range))
    settings.core.keep_to(load)
    return settings


def settings_with(
    scene: Scene, rig: Rig, surface: Surface | None, *, relief: float, settings: Settings | None, options: Options
) -> Settings:
    """The settings that are given, or those for a path with this relief [m] up to the scene's largest load, with what
    the options say beside them; where neither says how forces are scaled, so that the sample's pull-off is felt."""
    force_range, gains = options.get("force_range"), options.get("gains") or {}
    if settings is not None and force_range is not None:
        raise InvalidValue("force_range sets alpha_f, which the settings hold already: give one of them")
    load = float(scene.range.maximum_load)
    is_scaled = settings is not None or force_range is not None or "alpha_f" in gains
    if settings is None:
        settings = settings_for_path(rig, relief, options.get("clearance", 0.1e-6), force_range=force_range, load=load)
    wanted = settings.copy()
    _choose(wanted, options.get("rate"), gains, options.get("delay", 0.0))
    choose_control(wanted, options.get("control", "default"))
    if not is_scaled:
        accuracy, bound = demanded(options)
        plan = scene.plan(accuracy, surface=surface, bound=bound)
        wanted.gains.alpha_f = margins.felt_alpha_f(rig, wanted, plan, load=load)
    return wanted


def checked_seed(seed: int) -> int:
    """In its range, as an int."""
    if not 0 <= index(seed) < 2**64:
        raise InvalidValue(f"seed = {seed}: valid is 0 .. 2^64 - 1")
    return index(seed)


def demanded(options: Options) -> tuple[float, Bound]:
    """How true the planned force has to be, and what its bound is held to."""
    bound = options.get("bound", "kept")
    if bound not in BOUNDS:
        raise InvalidValue(f"bound {bound!r}: valid are {', '.join(BOUNDS)}")
    return float(options.get("relative_accuracy", 0.01)), bound


def check_options(options: Mapping[str, Any]) -> None:
    """Refuse what there is not."""
    unknown = set(options) - set(Options.__annotations__)
    if unknown:
        raise TypeError(f"Session has no option {min(unknown)!r}; it has {', '.join(Options.__annotations__)}")
    for name in ("preflight", "recorded"):
        if not isinstance(options.get(name, True), bool):
            raise InvalidValue(f"{name} = {told(options[name])}: valid are True and False")
    particles, rod = options.get("particles"), options.get("rod")
    if not isinstance(particles, Particles | None):
        raise TypeError(f"particles = {told(particles)}: valid is a set, nt.Particles(one of them)")
    if not isinstance(rod, Rod | None):
        raise TypeError(f"rod = {told(rod)}: valid is a nt.manipulation.Rod")


def _choose(settings: Settings, rate: float | None, gains: Gains | None, delay: float) -> None:
    """What was given beside the settings goes into them."""
    for name, value in dict[str, Any](gains or {}).items():
        if f"gains.{name}" not in settings.fields:
            raise InvalidValue(f"gains has no field {name!r}; it has {', '.join(settings.keys_of('gains'))}")
        settings[f"gains.{name}"] = value
    if rate is not None:
        settings["gains.rate"] = rate
    if not 0.0 <= delay < math.inf:
        raise InvalidValue(f"delay = {delay} s: it must be a time of 0 s or more")
    if delay > 0.0:
        settings["gains.delay"] = settings.gains.delay + delay * settings.gains.rate
