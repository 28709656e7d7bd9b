# SPDX-License-Identifier: BSD-3-Clause
"""A device in a process of its own: the program's end of a mailbox in shared memory. docs/devices.md has a whole one.

::

    with nt.mailbox.Device("falcon", nt.hal.Capabilities(pushes=True, period=1e-3)) as device:
        while True:
            request = device.ask()
            ...                                 # the force request.target[2] to the motor
            device.publish(nt.hal.Reading(position=(math.nan, math.nan, z)))

and in the session's process ``nt.Session(master=nt.hal.Mailbox("falcon"))``. If the program dies, the session holds,
then latches. If the session dies, :meth:`Device.ask` says so.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

from nanotouch import _core
from nanotouch._io.closing import Closing
from nanotouch.errors import InvalidValue
from nanotouch.touch.columns import STATES
from nanotouch.touch.hal import Capabilities, Reading


class Request(NamedTuple):
    """What the session wants."""

    is_armed: bool
    """False: nobody drives. A motor gives 0 N; a slave that was armed lifts by ``lift``, once"""
    state: str
    """RUN, HOLD, RETRACT or LATCHED"""
    tick: int
    time: int
    """when it was asked, on the clock of :meth:`Device.now` [ns]"""
    target: tuple[float, float, float]
    """master: motor force, 0 unless armed [N]; slave: x, y and travel, NaN: stay [m]"""
    lift: float
    """slave: how far to lift at the least, once nobody drives any more [m]"""
    drive_amplitude: float
    """slave that taps: that its lever shall have far from the sample; 0: no drive [m]"""
    drive_frequency: float
    """slave that taps [Hz]"""


class Device(Closing):
    """The program's end. One program has a name at a time; what a dead one left is removed.

    Parameters
    ----------
    name : str
        Letters, digits, ``.``, ``-`` and ``_``.
    capabilities : Capabilities
        What the device can do.
    half : {"master", "slave"}
        Which half of a rig it is.
    timeout : float
        Who gives no sign of life for so long is lost, program or session: above 2 periods, 1 at most [s].

    Raises
    ------
    InvalidValue
        A name or capabilities that cannot be.
    Error
        Another program, or another user, has the name.
    """

    def __init__(
        self,
        name: str,
        capabilities: Capabilities,
        *,
        half: Literal["master", "slave"] = "master",
        timeout: float = 0.1,
    ) -> None:
        if half not in ("master", "slave"):
            raise InvalidValue(f"half = {half!r}: valid are master and slave")
        self._mailbox = _core.rigs.Mailbox(name, half == "master", capabilities, timeout)

    def publish(self, reading: Reading) -> None:
        """A new measurement, and a sign of life. ``time`` is on the clock of :meth:`now`, None: now; the mailbox
        numbers the readings itself."""
        self._mailbox.publish(reading)

    def beat(self) -> None:
        """A sign of life without a measurement: the device is silent, its last reading grows old."""
        self._mailbox.beat()

    def ask(self) -> Request:
        """What the session wants now; not armed if there is none, or if it was silent for the timeout."""
        armed, state, *rest = self._mailbox.ask()
        return Request(armed, STATES[state], *rest)

    def now(self) -> int:
        """The clock of both sides: ``time.monotonic_ns()`` on Linux [ns]."""
        return int(self._mailbox.now())

    def close(self) -> None:
        """Remove the mailbox; a session sees in its next tick that the device is gone."""
        self._mailbox.close()
