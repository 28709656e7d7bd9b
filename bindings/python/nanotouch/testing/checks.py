# SPDX-License-Identifier: BSD-3-Clause
"""What a touch has to be: it runs, it keeps below a force, it reacts to a fault, its backend keeps the contract."""

from __future__ import annotations

import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import InvalidValue
from nanotouch.touch import _stopped
from nanotouch.touch.columns import COLUMNS, STATES
from nanotouch.touch.hal import Mailbox, Master, Rehearsed, Replay, SharedObject, Slave, rehearse
from nanotouch.touch.record import Recording
from nanotouch.touch.session import Session
from nanotouch.units import in_words

ROUNDING = 1e-9  # of a limit: what the sums of a promise may lose


def assert_runs(recording: Recording) -> None:
    """The session was in RUN in every period."""
    state = _column(recording, "state")
    stopped = np.flatnonzero(state != 0)
    if not len(stopped):
        return
    ran = np.count_nonzero(state == 0)
    raise AssertionError(
        f"{_state_at(recording, int(stopped[0]))}; it was in RUN in {ran} of {len(state)} periods and ended in "
        f"{STATES[int(state[-1])]}"
    )


def assert_force_below(recording: Recording, limit: float, channel: str = "tip_force") -> None:
    """A force stays within +- `limit` [N].

    Parameters
    ----------
    recording : Recording
        What was recorded.
    limit : float
        The largest force of either sign [N], above 0.
    channel : str
        ``"tip_force"`` is the true force of a simulated sample. A real one has ``"slave_force"``, as it was measured,
        with its noise; the hand has ``"motor_force"`` and ``"operator_force"``.
    """
    if not 0.0 < limit < math.inf:
        raise InvalidValue(f"limit = {limit} N: valid is a finite force above 0 N")
    if channel not in COLUMNS or COLUMNS[channel].unit != "N":
        forces = ", ".join(name for name, column in COLUMNS.items() if column.unit == "N")
        raise InvalidValue(f"channel {channel!r} is no force; valid are {forces}")
    _assert_below(recording, channel.replace("_", " "), np.abs(_column(recording, channel)), limit)


def assert_guarantee_kept(session: Session, recording: Recording) -> None:
    """What the open session promises (:meth:`nanotouch.Session.guarantee`) held: the force on the sample along z and
    sideways, and the motor's force on the hand. Where a fault was injected, the promise is that with one failure."""
    promised = session.guarantee()
    force = promised.with_failure if recording.metadata.get("faults") else promised.force
    force += promised.zero_drift * float(recording.time[-1] if len(recording) else 0.0)
    _assert_below(recording, "tip force", np.abs(_column(recording, "tip_force")), force)
    if "tip_force_x" in recording and promised.moves_sideways and not recording.metadata.get("faults"):
        sideways = np.hypot(recording.tip_force_x, recording.tip_force_y)
        _assert_below(recording, "sideways tip force", sideways, promised.lateral_force)
    pushes = np.abs(_column(recording, "motor_force"))
    if "motor_force_x" in recording:
        pushes = np.sqrt(pushes**2 + recording.motor_force_x**2 + recording.motor_force_y**2)
    _assert_below(recording, "motor force", pushes, promised.hand.force)


def assert_reacts(
    recording: Recording, state: Literal["HOLD", "RETRACT", "LATCHED"], *, after: float, within: float
) -> None:
    """The session went to `state`, or to a stronger one, at most `within` [s] after the time `after` [s], and not
    before it."""
    if state not in STATES[1:]:
        raise InvalidValue(f"state {state!r}: valid are {', '.join(STATES[1:])}")
    if not within > 0.0:
        raise InvalidValue(f"within = {within} s: valid is above 0 s")
    time, found = _column(recording, "time"), _column(recording, "state")
    if not len(time) or not time[0] <= after <= time[-1]:
        span = f"{time[0]:.6g} .. {time[-1]:.6g} s" if len(time) else "no time"
        raise InvalidValue(f"after = {after} s: the recording holds {span}")
    reached = np.flatnonzero(found >= STATES.index(state))
    half = 0.5 / _rate(recording)  # periods are at multiples of theirs, but for rounding
    if len(reached) and time[reached[0]] < after - half:
        raise AssertionError(f"{_state_at(recording, int(reached[0]))}, before {after:.6g} s")
    if len(reached) and time[reached[0]] <= after + within + half:
        return
    late = f"{_state_at(recording, int(reached[0]))}, {_after(time[reached[0]] - after)} later" if len(reached) else (
        f"it ended in {_stopped.of_columns(recording.columns)}"
    )  # fmt: skip
    raise AssertionError(f"no {state} within {_after(within)} of {after:.6g} s; {late}")


def assert_conforms(
    half: Master | Slave | SharedObject | Mailbox | Replay, *, slave: bool = False, duration: float = 0.2
) -> Rehearsed:
    """A backend keeps the contract of docs/hal.md, in time that does not pass on a clock. Nothing is moved.

    Parameters
    ----------
    half : Master, Slave, SharedObject, Mailbox or Replay
        What to try.
    slave : bool
        Which half a shared object, a mailbox or a replay is.
    duration : float
        How long it is read and written in each of two lives [s].
    """
    waits = isinstance(half, Mailbox)  # its program lives on the clock
    try:
        return rehearse(half, slave=slave, duration=duration, real_time=waits)
    except InvalidValue as broken:
        raise AssertionError(f"the contract of a backend is broken: {broken}") from None


def _assert_below(recording: Recording, name: str, force: NDArray[np.float64], limit: float) -> None:
    time = recording.time
    unknown = np.flatnonzero(np.isnan(force))
    if len(unknown):
        raise AssertionError(f"{name} is not known at {time[unknown[0]]:.6g} s: NaN in {len(unknown)} periods")
    above = np.flatnonzero(force > limit * (1.0 + ROUNDING))
    if not len(above):
        return
    first, worst = int(above[0]), int(np.argmax(force))
    text = f"{name} {in_words(force[worst], 'N', 3)} exceeded {in_words(limit, 'N', 3)}"
    where = f"at {time[first]:.6g} s" + (f", and most at {time[worst]:.6g} s" if worst != first else "")
    raise AssertionError(f"{text} {where}; {_reaction(recording, first)}")


def _reaction(recording: Recording, first: int) -> str:
    """What the supervisor did from this row on."""
    if "state" not in recording:
        return "no state was recorded"
    state = recording.state
    if state[first] != 0:
        return f"it was in {STATES[int(state[first])]}"
    stopped = np.flatnonzero(state[first:] != 0)
    if not len(stopped):
        return "nothing stopped it"
    ticks = int(stopped[0])
    return f"{STATES[int(state[first + ticks])]} came {ticks} tick{'s' * (ticks != 1)} later"


def _state_at(recording: Recording, row: int) -> str:
    bits = int(recording.reasons[row]) if "reasons" in recording else 0
    return _stopped.in_words(int(recording.state[row]), float(recording.time[row]), bits)


def _column(recording: Recording, name: str) -> NDArray[Any]:
    if name not in recording:
        raise InvalidValue(f"the recording has no {name}; recorded: {', '.join(recording.columns)}")
    return recording.columns[name]


def _rate(recording: Recording) -> float:
    found = recording.metadata.get("loop_rate")
    if found is not None:
        return float(found)
    steps = np.diff(recording.time)
    return 1.0 / float(np.median(steps)) if len(steps) else math.inf


def _after(seconds: float) -> str:
    return in_words(float(seconds), "s", 3)
