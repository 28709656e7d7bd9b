# SPDX-License-Identifier: BSD-3-Clause
"""The halves of a rig: write one in Python, load one from a shared object, rehearse it; and what this machine has.

::

    class Mouse(nanotouch.hal.Master):
        def describe(self):
            return nanotouch.hal.Capabilities(period=1 / 125, event_driven=True)

        def read(self):
            return nanotouch.hal.Reading(position=(math.nan, math.nan, self.z))

The guide is docs/hal.md. A half in Python runs at free and wall pace.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from nanotouch import _core
from nanotouch.errors import DeviceError, InvalidValue

Vector = Sequence[float]
"""x, y and towards the sample; a tuple, a list or an array of three"""

NONE = (math.nan, math.nan, math.nan)
"""three numbers that are not measured"""


class Channel(NamedTuple):
    """One channel of a half, read or driven. All its numbers are in its own unit; latency is in seconds."""

    name: str
    unit: str
    """``"m"`` or ``"N"``; of drive and lock-in amplifier ``"m"``, ``"rad"`` or ``"Hz"``"""
    driven: bool = False
    axis: int = 2
    """0, 1, 2: x, y, z; 3: of drive or lock-in amplifier"""
    minimum: float = -math.inf
    maximum: float = math.inf
    step: float = 0.0
    """of its converter; 0: none is known"""
    noise: float = 0.0
    """standard deviation"""
    latency: float = 0.0
    """from the moment measured to the reading, or from the write to its effect [s]"""
    safe: float = math.nan
    """what a driven channel is left at; of one that is read: NaN"""


class Capabilities(NamedTuple):
    """What a half can do. The default is a position device of one axis."""

    axes: int = 1
    """1 (z alone), 2 (x and y are positions, too) or 3"""
    period: float = 0.0
    """between its own measurements; 0: a new one in every period of the loop [s]"""
    feels: bool = False
    """a master measures the operator's force, a slave its deflections"""
    pushes: bool = False
    """a master has motors"""
    servos: bool = False
    """a slave owns its z servo; what is written is its set-point"""
    event_driven: bool = False
    """readings come when something happens, and a heartbeat every period"""
    taps: bool = False
    """a slave's lever is driven, and a lock-in amplifier reads amplitude and lag"""
    channels: Sequence[Channel] = ()


class Half(NamedTuple):
    """A half of an open session, simulated or not, as it describes itself."""

    axes: int
    period: float
    """between its own measurements; 0: a new one in every period of the loop [s]"""
    feels: bool
    pushes: bool
    servos: bool
    leads: bool
    """the clock: its readings are the ticks"""
    real: bool
    """an actuator can move something"""
    event_driven: bool
    slow: bool
    """its calls are not real-time safe"""
    taps: bool
    """its lever is driven, and a lock-in amplifier reads amplitude and lag"""
    channels: tuple[Channel, ...]

    def channel(self, name: str) -> Channel:
        """The channel of this name."""
        for row in self.channels:
            if row.name == name:
                return row
        raise InvalidValue(f"channel {name!r}: valid are {', '.join(row.name for row in self.channels)}")


class Halves(NamedTuple):
    """Both halves of a session."""

    master: Half
    slave: Half


def halves_of(core: _core.Session) -> Halves:
    """What both say of themselves."""
    found = [core.half(half) for half in range(2)]
    return Halves(*(Half(**(one | {"channels": tuple(Channel(*row) for row in one["channels"])})) for one in found))


class Configuration(NamedTuple):
    """What a half is told before it is armed."""

    period: float
    """of the loop [s]"""
    lift: float
    """slave: how far close has to lift the tip, at the least [m]"""
    option: str
    """what the user gave for it"""


class Reading(NamedTuple):
    """What a half measured. NaN where nothing was: never 0."""

    position: Vector = NONE
    """of hand or stage [m]"""
    felt: Vector = NONE
    """master: the operator's force [N]; slave: deflections, the third one upwards [m]"""
    time: int | None = None
    """of the measurement, on the clock of ``host.now`` [ns]; None: now"""
    sequence: int | None = None
    """rising with each measurement; None: one more than the last"""
    flags: Sequence[str] = ()
    """of ``emergency_stop``, ``limit_switch``, ``invalid``, ``saturated``, ``device_lost``"""
    buttons: int = 0
    """of a master, bit by bit"""
    amplitude: float = math.nan
    """of a slave that taps: of the deflection at the drive's frequency [m]"""
    lag: float = math.nan
    """of a slave that taps: of the deflection behind the drive [rad]"""


class Action(NamedTuple):
    """What a half shall do."""

    tick: int
    time: int
    """of this tick [ns]"""
    state: str
    """RUN, HOLD, RETRACT or LATCHED"""
    target: tuple[float, float, float]
    """master: motor force [N]; slave: x, y and travel towards the sample [m]"""
    drive_amplitude: float = 0.0
    """slave that taps: that its lever shall have far from the sample; 0: no drive [m]"""
    drive_frequency: float = 0.0
    """slave that taps [Hz]"""


class _Half:
    """The life of a half: open, describe, configure, arm; read and write once a period; disarm, close.

    What a method raises is a failed device for the loop (LATCHED, or refused to open) and reaches the caller after it.
    """

    option: str = ""
    """for :meth:`configure`"""

    def open(self, host: _core.Host) -> None:
        """Find the device. ``host.now()`` is the loop's clock [ns], ``host.say(text)`` a line for the user: a
        session logs it as a warning of the logger ``nanotouch.hal``."""

    def describe(self) -> Capabilities:
        """Say what this half can do; unless overridden, a position device of one axis."""
        return Capabilities()

    def configure(self, configuration: Configuration) -> None:
        """Take the loop's period, the lift and the user's option; may wait."""

    def arm(self) -> None:
        """Get ready: the next :meth:`read` has a position."""

    def read(self) -> Reading | None:
        """The newest measurement; None: nothing new. Never waits."""
        raise NotImplementedError(f"{type(self).__name__} has no read")

    def write(self, action: Action) -> None:
        """Do what is asked; never waits."""

    def disarm(self) -> None:
        """Leave every driven channel at its safe value; a slave lifts."""

    def close(self) -> None:
        """Give everything back."""


class Master(_Half):
    """Base of a master written in Python: a mouse, a haptic device, a script.

    Override :meth:`describe` and :meth:`read`; with motors :meth:`write`, too. docs/devices.md has a whole one.
    """


class Slave(_Half):
    """Base of a slave written in Python: a stage and a probe.

    Override :meth:`describe`, :meth:`read` and :meth:`write`, and :meth:`disarm`, which lifts the tip.
    """

    def describe(self) -> Capabilities:
        """What it can do: by default all three axes and the deflection."""
        return Capabilities(axes=3, feels=True)

    def write(self, action: Action) -> None:
        """Go to ``action.target``; never waits."""
        raise NotImplementedError(f"{type(self).__name__} has no write")


@dataclass(frozen=True)
class SharedObject:
    """A half in a shared object, by its path. It includes ``nanotouch/hal_backend.h`` and links nothing."""

    path: str
    option: str = ""
    """for its ``configure``"""

    def __init__(self, path: str | PathLike[str], option: str = "") -> None:
        object.__setattr__(self, "path", str(Path(fspath(path)).absolute()))
        object.__setattr__(self, "option", option)


@dataclass(frozen=True)
class Mailbox:
    """A half in another process, by the name of its mailbox (:mod:`nanotouch.touch.mailbox`, docs/devices.md)."""

    name: str


@dataclass(frozen=True)
class Replay:
    """A half that gives again what it measured in a recording: the same hand on another sample, or a touch felt once
    more. What it is told moves nothing.

    As a master it takes ``master_position`` and ``operator_force``, as a slave ``stage_position`` and ``deflection``,
    with x and y where the recording has them. Each row comes at its own time since the first. After the last one
    nothing new comes: the session holds, and lifts if it was the slave.
    """

    recording: Any
    """a Recording of one row or more"""

    def rows(self, half: str) -> tuple[int, NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Axes; time (n,) [s]; position (n, 3) [m]; force [N] or deflection [m] (n, 3), NaN where none was measured."""
        if not hasattr(self.recording, "columns"):
            raise TypeError(f"Replay: {type(self.recording).__name__} is no recording, as nt.record.read gives one")
        if not len(self.recording):
            raise InvalidValue("Replay: the recording has no row")
        position, felt = REPLAYED[half]
        axes = 3 if all(name in self.recording for name in position) else 1
        missing = np.full(len(self.recording), np.nan)

        def columns(names: tuple[str, str, str]) -> NDArray[np.float64]:
            sideways = [getattr(self.recording, name) if name in self.recording else missing for name in names[:2]]
            return np.column_stack([*sideways, getattr(self.recording, names[2])]).astype(np.float64)

        time = np.asarray(self.recording.time, np.float64)
        return axes, time - time[0], columns(position), columns(felt)


REPLAYED = {
    "master": (("master_x", "master_y", "master_position"), ("operator_force_x", "operator_force_y", "operator_force")),
    "slave": (("x", "y", "stage_position"), ("deflection_x", "deflection_y", "deflection")),
}
"""the columns that each half measured"""


QUIET = {
    5: "the deflection is the same number in every reading: a session takes that for a dead sensor, and latches "
       "(sensor stuck). Of a sensor without noise declare that: Rig(probe={'noise': 0.0}), in a rig file noise_V = 0 "
       "under [probe]; or the step of its converter, above its noise, as probe.resolution",
    6: "the amplitude is the same number in every reading: a session takes that for a dead sensor, and latches (sensor "
       "stuck). Of a lock-in amplifier without noise declare that: settings.tap.noise = 0",
}  # fmt: skip
"""of a slave's channels by their bit, that have shown no noise"""


class Rehearsed(NamedTuple):
    """What was seen in a rehearsal."""

    readings: int
    """new ones"""
    oldest: float
    """largest age of a valid reading [s]"""
    said: list[str]
    """what it told the user"""
    advice: tuple[str, ...]
    """what to declare, so that a session does not take it for broken"""
    unchecked: tuple[str, ...] = ()
    """what a rehearsal of this half did not look at"""


def rehearse(
    half: Master | Slave | SharedObject | Mailbox | Replay,
    *,
    slave: bool = False,
    period: float = 1e-3,
    duration: float = 0.2,
    real_time: bool = True,
    move: float = 0.0,
) -> Rehearsed:
    """Does it keep the contract (docs/hal.md)? Opened and closed, then twice its whole life; nothing is moved without
    `move`.

    Parameters
    ----------
    half : Master, Slave, SharedObject, Mailbox or Replay
        What to try.
    slave : bool
        Which half a shared object, a mailbox or a replay is.
    period : float
        Of the loop [s].
    duration : float
        How long it is read and written in each life [s].
    real_time : bool
        Periods pass on the clock; without, they take no time, which suits a half that makes its own readings.
    move : float
        At the end, a slave goes this far and back along each axis whose position it reads [m], z away from the sample
        where its range allows it, each way in half of `duration`; up to 1e-4 m. It has to arrive, and the other axes
        to stay, within half of that. 0: it is commanded to stay where it is.

    Raises
    ------
    InvalidValue
        The rule that it breaks, what was found and what is allowed.
    Exception
        What a method of a Python half has raised.
    """
    if not 1e-6 <= period <= 1.0:
        raise InvalidValue(f"period = {period} s: valid is 1e-06 .. 1 s")
    if not period <= duration <= 3600.0:
        raise InvalidValue(f"duration = {duration} s: valid is {period:g} .. 3600 s")
    is_master = not (slave or isinstance(half, Slave))
    _check_move(half, is_master, move)
    periods = round(duration / period)
    readings, oldest, said, same, moved, feels, pushes, axes = _core.rehearse(
        half, is_master, period, periods, real_time, move
    )
    advice = tuple(words for bit, words in QUIET.items() if not is_master and same >> bit & 1)
    for words in advice:
        warnings.warn(words, stacklevel=2)
    unchecked = _not_pushed(feels, pushes) if is_master else _not_moved(feels, axes, moved, move)
    if not real_time:
        unchecked.append("how long its calls take: no time passed on a clock")
    return Rehearsed(readings, oldest, said, advice, tuple(unchecked))


def _not_pushed(feels: bool, pushes: bool) -> list[str]:
    told = ["the motor's force: it got 0 N"] if pushes else []
    return [*told, "the operator's force: nobody pushed"] if feels else told


def _not_moved(feels: bool, axes: int, moved: int, move: float) -> list[str]:
    why = "no position is read" if move else "nothing was moved; move=... [m] does"
    unseen = [i for i in ((0, 1, 2) if axes > 1 else (2,)) if not moved >> i & 1]
    told = [f"whether {'xyz'[i]} goes where it is commanded: {why}" for i in unseen]
    return [*told, "sign and size of the deflection: nothing was touched"] if feels else told


def _check_move(half: object, is_master: bool, move: float) -> None:
    if move != 0.0 and (is_master or isinstance(half, Replay)):
        raise InvalidValue(f"move = {move} m: a {'master' if is_master else 'replay'} is not moved; valid is 0 m")
    if not 0.0 <= move <= 1e-4:
        raise InvalidValue(f"move = {move} m: valid is 0 .. 0.0001 m")


class GpioLine(NamedTuple):
    """One line of a GPIO chip."""

    chip: str
    offset: int
    name: str
    """empty if the line has none"""
    consumer: str
    """who holds it; empty if it is free"""


def gpio_lines() -> list[GpioLine]:
    """The lines of all chips that may be opened; :class:`~nanotouch.errors.DeviceError` if built without libgpiod."""
    if not hasattr(_core, "gpio_lines"):
        raise DeviceError("built without libgpiod: install libgpiod 2.1 or newer, then install nanotouch again")
    return [GpioLine(*line) for line in _core.gpio_lines()]
