# SPDX-License-Identifier: BSD-3-Clause
"""A controller that owns its z servo (Nanonis' TCP protocol) as a slave: two of its set points, and a mailbox.

The session's travel becomes the lower z limit of the controller: its servo goes no farther. Travel is 0 where the tip
stands when the session arms. The set-point is a deflection at which the servo backs away by itself, in its own time.
So a slow link steers, and a fast servo guards.
What follows from which failure is told in docs/devices.md.

Usage: python -m nanotouch_app.devices.nanonis NAME --guard-nm 100 [--host HOST] [--port PORT ...]
then, elsewhere: nanotouch.Session(rig=..., slave=nanotouch.hal.Mailbox(NAME))
"""

from __future__ import annotations

import argparse
import math
import re
import signal
import struct
import sys
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field

from nanotouch.errors import Error, InvalidValue
from nanotouch.touch import mailbox
from nanotouch.touch.hal import NONE, Capabilities, Channel, Reading

from nanotouch_app.devices.nanonis_link import Address, Link, LinkError
from nanotouch_app.devices.nanonis_watcher import PAUSE, SILENCE, Limits, Watcher, give_back, withdraw

PERIOD = 20e-3
"""between two readings, at the latest [s]"""
OFF, ON = 1, 2
"""what ZCtrl.StatusGet says of a servo; 5 after a safe-tip event"""
SETTLING = 0.3
"""for so long the status may lag behind a servo that was switched on [s]"""

ROOM = 0.1
"""to draw back from where a session starts, of the range between the z limits [-]"""


def _single(value: float) -> float:
    """As the protocol carries it, in single precision."""
    return float(struct.unpack("f", struct.pack("f", value))[0])


@dataclass(frozen=True)
class Setup:
    """What the controller is told, and where it is."""

    guard: float
    """deflection at which its servo backs away, + upwards [m]"""
    host: str = "127.0.0.1"
    ports: tuple[int, ...] = (6501, 6502)
    """the first one is used; each is tried for a withdrawal"""
    signal: str = "Deflection (m)"
    """as Signals.NamesGet spells it"""
    scale: float = 1.0
    """deflection, + upwards, per unit of the signal [m]"""
    period: float = PERIOD
    patience: float = 0.1
    """with a reply [s]"""
    axes: int = 1
    """1: z alone; 3: x and y follow, too"""


@dataclass
class Bridge:
    """Between the controller and a mailbox, until it is stopped or the controller fails."""

    setup: Setup
    stopped: threading.Event = field(default_factory=threading.Event)
    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(("readings", "withdrawals", "attempts"), 0))
    is_ours: bool = False
    """the servo is on at our request, so the tip may touch"""
    watcher: Watcher | None = None
    """that withdraws if we cannot; told each round where we stand"""
    heard: float = math.inf
    """when the watcher was last told where we stand [s]"""
    settled: float = 0.0
    """from this moment on a servo that is off is one that somebody has switched off [s]"""

    def connect(self) -> None:
        """Find signal and limits. The z limits that the user has set are the range of the session."""
        self.link = Link(Address(self.setup.host, self.setup.ports[0]), self.setup.patience)
        try:
            self._find()
        except Error:
            self.link.close()
            raise

    def _find(self) -> None:
        setup, names = self.setup, self.link.names()
        if setup.signal not in names:
            raise InvalidValue(f"signal = {setup.signal!r}: this controller has {', '.join(names)}")
        if setup.scale == 1.0 and not re.search(r"\(m\)$", setup.signal):
            raise InvalidValue(f"signal = {setup.signal!r} is not in m: give its scale in m per unit")
        self.index = names.index(setup.signal)
        (are_enabled,) = self.link.call("ZCtrl.LimitsEnabledGet", gives="I")
        if not are_enabled:
            raise InvalidValue("z limits = off: the controller takes none. Set them, and switch them on")
        high, low = self.link.call("ZCtrl.LimitsGet", gives="ff")
        if not -1.0 < low < high < 1.0:
            raise InvalidValue(f"z limits = {low:g} .. {high:g} m: the lower one must be below the other")
        self.limits = self.told = Limits(high, low)
        self.guard = _single(setup.guard / setup.scale)

    def capabilities(self) -> Capabilities:
        """A slave with a servo of its own. Towards the sample is down: our z is minus theirs, from where the tip stands
        when a session arms. So the range is the widest that there can be; the limits hold in any case."""
        width = self.limits.high - self.limits.low
        z = [Channel("stage z", "m", minimum=-width, maximum=width),
             Channel("travel", "m", driven=True, minimum=-width, maximum=width)]  # fmt: skip
        felt = [Channel("deflection", "m", minimum=-math.inf, maximum=math.inf)]
        return Capabilities(axes=self.setup.axes, period=self.setup.period, feels=True, servos=True, channels=z + felt)

    def serve(self, box: mailbox.Device) -> None:
        """Until it is stopped; then the tip is withdrawn. LinkError if the controller fails."""
        while not self.stopped.is_set():
            begun = time.monotonic()
            self._tell()
            self._steer(box.ask())
            self._tell()
            box.publish(self._reading(box))
            self.counts["readings"] += 1
            self.stopped.wait(max(0.0, begun + self.setup.period / 4 - time.monotonic()))
        if self.is_ours:
            self._withdraw(self.link)

    def _tell(self) -> None:
        if self.watcher:
            self.watcher.tell(self.limits if self.is_ours else None)
        self.heard = time.monotonic()

    def _has_hung(self) -> bool:
        """For longer than the watcher waits: it has withdrawn, and what was asked before is no longer true."""
        return time.monotonic() - self.heard > SILENCE * self.setup.patience

    # --- what the controller is told ---

    def _steer(self, request: mailbox.Request) -> None:
        if request.is_armed and not self.is_ours:
            self._take()
        elif not request.is_armed and self.is_ours:  # the session has ended, or is silent
            self._withdraw(self.link)
        if not request.is_armed:
            return
        target = request.target
        if math.isfinite(target[2]):
            self._limit(self.start - target[2])
        self._check()
        if self.is_ours and self._has_hung():
            self._withdraw(self.link)
        if self.is_ours and self.setup.axes == 3 and all(map(math.isfinite, target)):
            self.link.call("FolMe.XYPosSet", "ddI", target[0], target[1], 0)

    def _limit(self, low: float) -> None:
        low = _single(min(max(low, self.limits.low), self.limits.high))
        self.told = Limits(self.limits.high, low)
        self.link.call("ZCtrl.LimitsSet", "ff", self.told.high, low)

    def _check(self) -> None:
        """Is it as it was told? Somebody else may set limits and guard, or switch the limits off."""
        kept = Limits(*self.link.call("ZCtrl.LimitsGet", gives="ff"))
        (guard,) = self.link.call("ZCtrl.SetpntGet", gives="f")
        if (kept != self.told or guard != self.guard) and not self._has_hung():
            was, told = (f"z limits of {each.low:g} .. {each.high:g} m" for each in (kept, self.told))
            raise LinkError(
                f"the controller has {was} and a set-point of {guard:g}, told were {told} and {self.guard:g}"
            )

    def _take(self) -> None:
        """The servo goes on, at the most where the tip stands. Each set point is read back first."""
        self.start = self._start(self._height())
        self.is_ours = True  # from here on a failure withdraws
        self._tell()
        self._limit(self.start)
        self.link.call("ZCtrl.SetpntSet", "f", self.guard)
        self._check()
        if not self._has_hung():
            self.link.call("ZCtrl.OnOffSet", "I", 1)
        self.settled = time.monotonic() + SETTLING

    def _start(self, z: float) -> float:
        """Where the tip stands; lower where there is no room to draw back, for a withdrawal may have left it high."""
        room = ROOM * (self.limits.high - self.limits.low)
        return min(max(z, self.limits.low), self.limits.high - room)

    def _height(self) -> float:
        (z,) = self.link.call("ZCtrl.ZPosGet", gives="f")
        return float(z)

    def _withdraw(self, link: Link) -> None:
        self.counts["attempts"] += 1
        withdraw(link)
        self.is_ours = False
        self.counts["withdrawals"] += 1
        give_back(link, self.limits)

    # --- what it says ---

    def _reading(self, box: mailbox.Device) -> Reading:
        """What is no number stays NaN. A servo that somebody else switched off is an emergency stop."""
        flags = []
        if self.is_ours and self._is_off():
            flags.append("emergency_stop")
        begun = box.now()  # no earlier: the reading may be older than the reply
        z = self._height()
        travel = (self.start if self.is_ours else self._start(z)) - z
        (value,) = self.link.call("Signals.ValGet", "iI", self.index, 0, gives="f")
        x, y = NONE[:2] if self.setup.axes == 1 else self.link.call("FolMe.XYPosGet", "I", 0, gives="dd")
        place = tuple(each if math.isfinite(each) else math.nan for each in (x, y, travel))
        deflection = value * self.setup.scale if math.isfinite(value) else math.nan
        return Reading(position=place, felt=(math.nan, math.nan, deflection), time=begun, flags=flags)

    def _is_off(self) -> bool:
        (status,) = self.link.call("ZCtrl.StatusGet", gives="H")
        if status == ON:
            self.settled = 0.0
        return bool(status != ON and (status != OFF or time.monotonic() >= self.settled))

    # --- when the controller fails ---

    def rescue(self) -> None:
        """Let go. A tip that may touch is withdrawn by every way there is, until one is acknowledged: blindly, then by
        new connections."""
        if self.is_ours:
            with suppress(LinkError):
                self.link.tell("ZCtrl.Withdraw", "Ii", 0, -1)
        self.link.close()
        while self.is_ours and not self._is_withdrawn_anew() and not self.stopped.wait(PAUSE):
            pass
        with suppress(LinkError):
            self._tell()

    def _is_withdrawn_anew(self) -> bool:
        for port in self.setup.ports:
            with suppress(LinkError):
                self._tell()
            with suppress(LinkError), Link(Address(self.setup.host, port), self.setup.patience) as link:
                self._withdraw(link)
            if not self.is_ours:
                return True
        return False


def run(name: str, bridge: Bridge, timeout: float) -> None:
    """Serve the mailbox `name`. If the controller fails it closes, which latches the session; then the tip lifts."""
    bridge.connect()
    setup = bridge.setup
    with Watcher(setup.host, setup.ports, setup.patience) as bridge.watcher:
        try:
            with mailbox.Device(name, bridge.capabilities(), half="slave", timeout=timeout) as box:
                bridge.serve(box)
        except LinkError as error:
            if bridge.is_ours:
                print(f"nanonis: {error}: withdrawing", file=sys.stderr, flush=True)
            raise
        finally:
            bridge.rescue()
            if bridge.is_ours:
                raise LinkError("no controller has acknowledged a withdrawal: the tip may still touch")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="nanonis", description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("name", metavar="NAME", help="of the mailbox")
    parser.add_argument("--guard-nm", type=float, required=True, metavar="NM",
                        help="deflection at which the controller's servo backs away; above any of a touch")  # fmt: skip
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument(
        "--port",
        type=int,
        nargs="+",
        default=[6501, 6502],
        help="two or more; the first one is used, the others withdraw",
    )
    parser.add_argument("--signal", default="Deflection (m)", help="of the deflection (default: %(default)s)")
    parser.add_argument("--scale", type=float, default=1.0, metavar="M", help="deflection per unit of it [m]")
    parser.add_argument("--axes", type=int, choices=(1, 3), default=1)
    parser.add_argument("--period-ms", type=float, default=1e3 * PERIOD, metavar="MS", help="(default: %(default)g)")
    parser.add_argument("--timeout", type=float, default=0.5, metavar="S", help="of the mailbox (default: %(default)g)")
    return parser


def _setup(args: argparse.Namespace) -> Setup:
    ranges = {"guard-nm": (args.guard_nm, 1e-3, 1e5), "period-ms": (args.period_ms, 1.0, 1e3),
              "timeout": (args.timeout, 1e-2, 60.0), "scale": (abs(args.scale), 1e-12, 1.0)}  # fmt: skip
    if len(args.port) < 2:
        raise InvalidValue(f"port = {args.port[0]}: two are needed, for the controller serves one program at each")
    for key, (value, least, most) in ranges.items():
        if not least <= value <= most:
            raise InvalidValue(f"{key} = {value:g}: valid is {least:g} .. {most:g}")
    return Setup(1e-9 * args.guard_nm, args.host, tuple(args.port), args.signal, args.scale, 1e-3 * args.period_ms,
                 0.4 * args.timeout, args.axes)  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program; 2 with one line if it cannot begin, or the controller failed."""
    args = _parser().parse_args(arguments)
    try:
        bridge = Bridge(_setup(args))
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: bridge.stopped.set())
        run(args.name, bridge, args.timeout)
    except Error as error:
        print(f"nanonis: error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
