# SPDX-License-Identifier: BSD-3-Clause
"""What an open session lets nobody do: assign to it, or copy it; and running it in a thread of its own."""

from __future__ import annotations

import json
import math
import re
from operator import index
from typing import Any, NoReturn, TypeVar

from nanotouch import _core
from nanotouch.errors import DeviceError, InvalidValue
from nanotouch.manipulation import Laid
from nanotouch.plasticity import Dent
from nanotouch.scene import Rig, Scene, Settings
from nanotouch.touch._stopped import reasons_of
from nanotouch.touch.columns import STATES
from nanotouch.touch.options import PACES, Pace, Progress

Described = TypeVar("Described", Scene, Settings)

CHANGES = {
    "scene": "session.change('scene', field, value)",
    "settings": "session.change('settings', field, value), the scales by session.rescale(alpha_p, alpha_f)",
    "mode": "session.set_mode(mode)",
}
LONGEST = 1e9  # run at one go [s]
TOLD = ("mode", "rescale", "setting", "scene")  # events that change what a session says of itself


def as_now(told: Described, now: Any, words: str) -> Described:
    """The description that was told last, with what has changed since, frozen with these words."""
    changed = {name: now.get(name) for name in told.fields if now.get(name) != told[name]}
    if not changed:
        return told
    made = told.copy()
    for name, value in changed.items():
        made[name] = value
    return made.frozen(words)


class Frozen:
    """Attributes stay as they are once :meth:`_freeze` was called, or recordings would tell what did not run."""

    _is_frozen = False

    def _freeze(self) -> None:
        self._is_frozen = True

    def __setattr__(self, name: str, value: object) -> None:
        if self._is_frozen and not name.startswith("_"):
            self._refuse(name)
        object.__setattr__(self, name, value)

    def __delattr__(self, name: str) -> None:
        self._refuse(name)

    def _refuse(self, name: str) -> NoReturn:
        instead = CHANGES.get(name, "open another one")
        raise AttributeError(f"session.{name} of an open session stays as it is: {instead}")

    def __reduce__(self) -> NoReturn:
        raise TypeError("an open session cannot be copied: open another one with the same arguments, and take it to "
                        "where this one is by restore(session.snapshot())")  # fmt: skip


class Runs:
    """A session in a thread of its own."""

    core: _core.Session
    rate: float
    rig: Rig
    _begun: _core.Snapshot | None
    _is_published, _name = False, ""

    def metadata(self) -> dict[str, Any]:
        """What a recording has to be read with."""
        raise NotImplementedError

    def _now(self) -> dict[str, Any]:
        """What of it has changed since it was opened."""
        raise NotImplementedError

    def _ticks(self, duration: float) -> int:
        """A time [s] in ticks."""
        if not 0.0 <= duration <= LONGEST:
            raise InvalidValue(f"duration = {duration} s: it must be a time of 0 s or more, up to {LONGEST:g} s")
        return round(duration * self.rate)

    @property
    def state(self) -> str:
        """RUN, HOLD, RETRACT or LATCHED after the last tick."""
        return STATES[self.core.state]

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why it is in its state, in words; some are flags of a session that runs."""
        return reasons_of(self.core.reasons)

    @property
    def pace(self) -> Pace:
        """That its devices ask for: ``"hard"`` where a real slave can hurt a sample; ``"wall"`` where only a real
        master is driven, and lateness does no more than slow the clock; else ``"free"``."""
        return PACES[self.core.pace]

    def start(self, pace: Pace | None = None, duration: float | None = None) -> None:
        """Run in a thread of its own, without the GIL, until :meth:`halt` or for a time [s] of the session.

        ``"free"``: as fast as it goes. ``"wall"``: at the pace of a clock, slower where the machine lags. Both
        wait for :meth:`read` when the ring is full. ``"hard"``: each tick at its deadline, for a real slave. By default
        :attr:`pace`, and ``"wall"`` where nothing is real. A real master at ``"wall"`` holds each force until the
        machine wakes up again: that is measured, and counts in the margin and in what is promised to the hand.
        """
        if pace is None:
            pace = "wall" if self.pace == "free" else self.pace
        if pace not in PACES:
            raise InvalidValue(f"pace {pace!r}: valid are {', '.join(PACES)}")
        if duration is not None and not duration > 0.0:
            raise InvalidValue(f"duration = {duration} s: it must be above 0 s")
        self.core.start(PACES.index(pace), 0 if duration is None else max(1, self._ticks(duration)))

    def halt(self) -> None:
        """End the thread between two ticks; raises what it has ended by itself with."""
        self.core.halt()

    def pause(self, paused: bool = True) -> None:
        """Stop the clock of a running session, or let it go on; in free and wall pace."""
        self.core.pause(paused)

    def step_on(self, ticks: int = 1) -> None:
        """Let a paused session do some ticks, at full speed. A pause, or its end, takes back what is left of them."""
        self.core.step_on(ticks)

    def set_speed(self, speed: float) -> None:
        """Session time over time on the clock, 0.001 .. 1000: slow motion below 1."""
        self.core.set_speed(speed)

    @property
    def progress(self) -> Progress:
        """How a run in its own thread goes."""
        return Progress(**self.core.progress)

    @property
    def dents(self) -> tuple[Dent, ...]:
        """What the tip has left in a simulated sample that keeps dents (scene: ``sample.dents``), the oldest first."""
        return tuple(Dent.from_numbers(numbers) for numbers in self.core.dents())

    def undent(self) -> None:
        """Take the last dent back, while the tip touches nothing."""
        self.core.undent()

    def lay(self, number: int, place: tuple[float, float]) -> None:
        """Lay particle ``number`` at rest at x, y [m]: the next one, or one that lies there already, which the tip does
        not touch. Of a session that was opened with ``particles``."""
        self.core.lay(index(number), float(place[0]), float(place[1]))

    def lay_rod(self, pose: tuple[float, float, float]) -> None:
        """Lay the rod at rest with its middle at x, y [m] and its axis turned by an angle from x [rad], where the tip
        does not touch it; it is taken away from where it was. Of a session that was opened with ``rod``."""
        x, y, angle = (float(number) for number in pose)
        self.core.lay_rod(x, y, angle)

    @property
    def particles(self) -> Laid:
        """What lies on the surface, spheres or a rod, after the newest tick; also while the session runs."""
        return Laid(**self.core.particles())

    def rewind(self, duration: float) -> None:
        """Take a running simulation back by a time [s], to the last quarter of a second before that moment."""
        if not 0.0 <= duration < math.inf:
            raise InvalidValue(f"rewind: {duration} s: it must be a time of 0 s or more")
        self.core.rewind(duration)

    def publish(self, name: str = "") -> None:
        """Show every tick to observers of this name (:mod:`nanotouch.touch.frames`), in any process of this user."""
        if not re.fullmatch(r"[A-Za-z0-9._-]{0,64}", name):
            raise InvalidValue(f"publish: name {name!r}: valid are up to 64 letters, digits, '.', '-' and '_'")
        self.core.publish(name)
        self._is_published, self._name = True, name
        self.describe()

    def describe(self) -> None:
        """Renew the description that observers read. Changes of this session renew it by themselves; what an observer
        has changed is told at the next :meth:`read`, or by this."""
        if self._is_published:
            about = {name: value for name, value in self.metadata().items() if name != "events"} | self._now()
            self.core.describe(json.dumps(about))

    def snapshot(self) -> _core.Snapshot:
        """All that a simulated session needs to go on from here."""
        return self.core.snapshot()

    def restore(self, snapshot: _core.Snapshot) -> None:
        """Back to where a snapshot was taken."""
        self.core.restore(snapshot)

    def reset(self) -> None:
        """Back to where it was opened; of a session whose halves are simulated."""
        if self._begun is None:
            raise DeviceError("a session with a half of one's own cannot go back")
        self.core.restore(self._begun)
