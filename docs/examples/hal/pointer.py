# SPDX-License-Identifier: BSD-3-Clause
"""A master in another process: the backend for the device of device.py."""

import contextlib
import math
import socket
import struct
import time
import zlib
from collections import deque
from typing import Any

import nanotouch as nt

PERIOD = 1 / 125  # of the device's heartbeats [s]
TRAVEL = 0.02  # z runs over half of it to either side [m]
REPORT = struct.Struct("<4sIQqdddI")  # magic, run, sequence, time [ns], x, y, z [m], buttons; then a CRC-32
HELLO_EVERY = 0.25  # the device forgets who is silent for a second [s]


class Clock:
    """From the device's stamps to the host's clock: their least difference of late is the one without delays."""

    def __init__(self) -> None:
        self.differences: deque[int] = deque(maxlen=4)
        self.last = -(2**63)

    def convert(self, stamp: int, now: int) -> int:
        self.differences.append(now - stamp)
        self.last = max(self.last, stamp + min(self.differences))
        return min(self.last, now)


class Pointer(nt.hal.Master):
    """A position device: no motor, no gauge, a heartbeat 125 times a second."""

    def __init__(self, port: int) -> None:
        self.address = ("127.0.0.1", port)
        self.link: Any = None  # a socket while it is open
        self.refused = 0  # datagrams

    def describe(self):
        channel = nt.hal.Channel("position", "m", minimum=-TRAVEL / 2, maximum=TRAVEL / 2, latency=1e-3)
        return nt.hal.Capabilities(axes=1, period=PERIOD, event_driven=True, channels=[channel])

    def open(self, host):
        self.host, self.clock = host, Clock()
        self.run, self.sequence, self.greeted = None, 0, -math.inf
        self.waiting = None  # a reading that arm has taken
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.connect(self.address)  # from now on nobody else is heard
        self.link.setblocking(False)

    def arm(self):
        deadline = time.monotonic() + 1.0
        while self.waiting is None:
            if time.monotonic() > deadline:
                raise nt.errors.DeviceError(f"no device answers at {self.address[0]}:{self.address[1]}")
            time.sleep(1e-3)
            self.waiting = self.newest()

    def read(self):
        reading, self.waiting = self.waiting, None
        return self.newest() or reading  # None: nothing new, what was is held

    def write(self, action):
        pass  # it has no motor

    def close(self):
        if self.link is not None:
            self.link.close()
            self.link = None

    def newest(self) -> nt.hal.Reading | None:
        """The newest of what has come in meanwhile; never waits."""
        self.greet()
        found = None
        for _ in range(256):  # as many as a link holds: no peer can keep us here
            try:
                found = self.understood(self.link.recv(256)) or found
            except BlockingIOError:
                break
            except ConnectionError:  # nobody is there any more: the reading grows old, which says it
                continue
        if found is None:
            return None
        stamp, z, buttons = found
        stamp = self.clock.convert(stamp, self.host.now())
        return nt.hal.Reading(position=(math.nan, math.nan, z), time=stamp, buttons=buttons)

    def greet(self) -> None:
        if time.monotonic() - self.greeted > HELLO_EVERY:
            self.greeted = time.monotonic()
            with contextlib.suppress(OSError):  # it is not there, or not yet
                self.link.send(b"hello")

    def understood(self, datagram: bytes) -> tuple[int, float, int] | None:
        """Stamp, z, buttons; None for what is no report, damaged, old or impossible."""
        body, check = datagram[: REPORT.size], datagram[REPORT.size :]
        if len(body) < REPORT.size or check != struct.pack("<I", zlib.crc32(body)) or body[:4] != b"NTP1":
            self.refused += 1
            return None
        _, run, sequence, stamp, _, _, z, buttons = REPORT.unpack(body)
        is_old = run == self.run and sequence <= self.sequence
        if is_old or not abs(z) <= TRAVEL / 2:  # NaN is not, either
            self.refused += 1
            return None
        if run != self.run:  # the device has been started anew: another clock
            self.clock.differences.clear()
        self.run, self.sequence = run, sequence
        return stamp, z, buttons
