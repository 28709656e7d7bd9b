# SPDX-License-Identifier: BSD-3-Clause
"""What a touch has to be: it runs, it keeps below a force, it reacts to a fault, its backend keeps the contract."""

from __future__ import annotations

import json
import math
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from nanotouch.errors import InvalidValue
from nanotouch.testing._given import TIME, number, rows_of
from nanotouch.touch import _stopped
from nanotouch.touch.columns import COLUMNS, STATES
from nanotouch.touch.hal import Mailbox, Master, Rehearsed, Replay, SharedObject, Slave, _check_move, rehearse
from nanotouch.touch.record import Recording
from nanotouch.touch.session import Session
from nanotouch.units import in_words

ROUNDING = 1e-9  # of a limit: what the sums of a promise may lose
LARGEST_LOAD = 1.0  # N, of any scene (range.maximum_load)
ON_THE_SAMPLE = ("tip_force", "tip_force_x", "tip_force_y", "slave_force")
OPENED_WITH = ("scene", "rig", "settings", "control")  # what decides a promise


def assert_runs(recording: Recording) -> None:
    """The session was in RUN in every period that was recorded."""
    state = _states(recording)
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
    limit = number("limit", limit, "N")
    if not 0.0 < limit < math.inf:
        raise InvalidValue(f"limit = {limit} N: valid is a finite force above 0 N")
    if channel not in COLUMNS or COLUMNS[channel].unit != "N":
        forces = ", ".join(name for name, column in COLUMNS.items() if column.unit == "N")
        raise InvalidValue(f"channel {channel!r} is no force; valid are {forces}")
    if channel in ON_THE_SAMPLE and limit > LARGEST_LOAD:
        raise InvalidValue(f"limit = {limit:g} N: no load on a sample is above {LARGEST_LOAD:g} N; 400 nN are 400e-9")
    _assert_below(recording, channel.replace("_", " "), _column(recording, channel), limit)


def assert_guarantee_kept(session: Session, recording: Recording) -> None:
    """What the open session promises (:meth:`nanotouch.Session.guarantee`) held: the force on the sample along z and
    sideways, and the motor's force on the hand. Where a fault was injected, the promise is that with one failure.

    It takes the true force of a simulated sample; of a slave of your own take :func:`assert_force_below` with
    ``"slave_force"``."""
    time = _column(recording, "time")
    _is_of(session, recording)
    promised = session.guarantee()
    failed = bool(recording.metadata.get("faults"))
    force = promised.with_failure if failed else promised.force
    if not force < math.inf:
        raise InvalidValue(f"the session promises no bound of the tip force{' with one failure' * failed}: {force} N")
    _assert_below(recording, "tip force", _column(recording, "tip_force"), force + promised.zero_drift * time)
    if "tip_force_x" in recording and promised.moves_sideways and not failed:
        sideways = np.hypot(recording.tip_force_x, recording.tip_force_y)
        _assert_below(recording, "sideways tip force", sideways, promised.lateral_force)
    pushes = _column(recording, "motor_force")
    if "motor_force_x" in recording:
        pushes = np.sqrt(pushes**2 + recording.motor_force_x**2 + recording.motor_force_y**2)
    _assert_below(recording, "motor force", pushes, promised.hand.force)


def assert_reacts(
    recording: Recording, state: Literal["HOLD", "RETRACT", "LATCHED"], *, after: float, within: float
) -> None:
    """The session went to `state`, or to a stronger one, at most `within` [s] after the time `after` [s], and not
    before it. An event happens in the period that is nearest to `after`."""
    if state not in STATES[1:]:
        raise InvalidValue(f"state {state!r}: valid are {', '.join(STATES[1:])}")
    after, within = number("after", after, "s"), number("within", within, "s")
    if not within > 0.0:
        raise InvalidValue(f"within = {within} s: valid is above 0 s")
    found = _states(recording)
    time = recording.time
    if not time[0] <= after <= time[-1]:
        raise InvalidValue(f"after = {after} s: the recording holds {time[0]:{TIME}} .. {time[-1]:{TIME}} s")
    reached = np.flatnonzero(found >= STATES.index(state))
    if not len(reached):
        ended = _stopped.of_columns(recording.columns)
        raise AssertionError(f"no {state} within {_after(within)} of {after:{TIME}} s; it ended in {ended}")
    row, rate = int(reached[0]), _rate(recording)
    ticks = np.rint((time - time[0]) * rate)
    event = math.floor((after - time[0]) * rate + 0.5)
    if ticks[row] < event:
        raise AssertionError(f"{_state_at(recording, row)}, before {after:{TIME}} s")
    late = _is_late(ticks[row], event, within * rate)
    if row:
        since = ticks[row - 1] + 1  # it may have come in any period since
        if since < event or _is_late(since, event, within * rate) != late:
            when = f"within {_after(within)} of" if since >= event else "before"
            raise InvalidValue(
                f"no rows between {time[row - 1]:{TIME}} s and {time[row]:{TIME}} s: whether {state} came {when} "
                f"{after:{TIME}} s is not known; give every period"
            )
    if late:
        said = f"{_state_at(recording, row)}, {_after(time[row] - after)} later"
        raise AssertionError(f"no {state} within {_after(within)} of {after:{TIME}} s; {said}")


def _is_late(tick: float, event: float, periods: float) -> bool:
    return bool(tick - event > periods * (1.0 + ROUNDING))


def assert_conforms(
    half: Master | Slave | SharedObject | Mailbox | Replay,
    *,
    slave: bool = False,
    duration: float = 0.2,
    move: float = 0.0,
) -> Rehearsed:
    """A backend keeps the contract of docs/hal.md, in time that does not pass on a clock. Without `move` nothing is
    moved, so a stage that ignores its commands passes: `unchecked` of what it returns says what was not looked at.

    Parameters
    ----------
    half : Master, Slave, SharedObject, Mailbox or Replay
        What to try.
    slave : bool
        Which half a shared object, a mailbox or a replay is.
    duration : float
        How long it is read and written in each of two lives [s].
    move : float
        How far a slave may be moved along each axis whose position it reads, and back [m], up to 1e-4 m; z away from
        the sample where its range allows it. It has to arrive within half of that, and the other axes to stay. 0:
        nothing is moved.
    """
    if not 1e-3 <= number("duration", duration, "s") <= 3600.0:
        raise InvalidValue(f"duration = {duration} s: valid is 0.001 .. 3600 s")
    _check_move(half, not (slave or isinstance(half, Slave)), number("move", move, "m"))
    waits = isinstance(half, Mailbox)  # its program lives on the clock
    try:
        return rehearse(half, slave=slave, duration=duration, real_time=waits, move=move)
    except InvalidValue as broken:
        raise AssertionError(f"the contract of a backend is broken: {broken}") from None


def _is_of(session: Session, recording: Recording) -> None:
    """A promise of one session says nothing about a recording of another."""
    opened = session.metadata()
    for name in OPENED_WITH:
        if name in recording.metadata and _plain(recording.metadata[name]) != _plain(opened.get(name)):
            raise InvalidValue(
                f"the recording is of a session with another {name}: this session promises nothing of it"
            )


def _plain(value: object) -> Any:
    """As it comes back from a file, and NaN equal to itself."""
    return json.loads(json.dumps(value, default=str), parse_constant=str)


def _assert_below(
    recording: Recording, name: str, force: NDArray[np.float64], limit: float | NDArray[np.float64]
) -> None:
    """`force` is within +- `limit` in every row."""
    time, most = recording.time, np.broadcast_to(limit, force.shape)
    unknown = np.flatnonzero(np.isnan(force))
    if len(unknown):
        rows = f"{len(unknown)} period{'s' * (len(unknown) != 1)}"
        simulated = name.endswith("tip force") and len(unknown) == len(force)
        hint = "; only a simulated sample has it, a real one has slave_force" if simulated else ""
        raise AssertionError(f"{name} is not known at {time[unknown[0]]:{TIME}} s: NaN in {rows}{hint}")
    size = np.abs(force)
    above = np.flatnonzero(size > most * (1.0 + ROUNDING))
    if not len(above):
        return
    first, worst = int(above[0]), int(above[np.argmax(size[above])])
    text = f"{name} {in_words(force[worst], 'N', 3)} exceeded {in_words(most[worst], 'N', 3)}"
    where = f"at {time[first]:{TIME}} s" + (f", and most at {time[worst]:{TIME}} s" if worst != first else "")
    raise AssertionError(f"{text} {where}; {_reaction(recording, first)}")


def _reaction(recording: Recording, first: int) -> str:
    """What the supervisor did from this row on."""
    if "state" not in recording:
        return "no state was recorded"
    state = _states(recording)
    if state[first] != 0:
        return f"it was in {STATES[int(state[first])]}"
    stopped = np.flatnonzero(state[first:] != 0)
    if not len(stopped):
        return "nothing stopped it"
    row = first + int(stopped[0])
    ticks = round((recording.time[row] - recording.time[first]) * _rate(recording))  # rows may be a selection
    return f"{STATES[int(state[row])]} came {ticks} tick{'s' * (ticks != 1)} later"


def _state_at(recording: Recording, row: int) -> str:
    bits = int(recording.reasons[row]) if "reasons" in recording else 0
    return _stopped.in_words(int(recording.state[row]), float(recording.time[row]), bits)


def _states(recording: Recording) -> NDArray[Any]:
    found = _column(recording, "state")
    unknown = np.flatnonzero(found >= len(STATES))
    if len(unknown):
        row = int(unknown[0])
        states = ", ".join(STATES)
        raise InvalidValue(f"state {found[row]} at {recording.time[row]:{TIME}} s: valid are 0 .. 3 ({states})")
    return found


def _column(recording: Recording, name: str) -> NDArray[Any]:
    if name not in rows_of(recording):
        raise InvalidValue(f"the recording has no {name}; recorded: {', '.join(recording.columns)}")
    return recording.columns[name]


def _rate(recording: Recording) -> float:
    found = recording.metadata.get("loop_rate")
    if found is not None:
        return float(found)
    steps = np.diff(recording.time)
    return 1.0 / float(np.median(steps)) if len(steps) else 1.0  # of one row every rate tells the same


def _after(seconds: float) -> str:
    return in_words(float(seconds), "s", 3)
