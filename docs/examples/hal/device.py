# SPDX-License-Identifier: BSD-3-Clause
"""A position device of its own: a program that serves where a hand is, 125 times a second, on the loopback interface.

Who has said "hello" within the last second is sent reports. Here the hand follows a script; a real device would put its
own numbers into `where`.

Usage: device.py [PORT]   prints the port that it serves
"""

import math
import os
import socket
import struct
import sys
import time
import zlib

PERIOD = 1 / 125  # between two reports [s]
REPORT = struct.Struct("<4sIQqdddI")  # magic, run, sequence, time [ns], x, y, z [m], buttons; then a CRC-32
MAGIC = b"NTP1"


def report(run: int, sequence: int, stamp: int, position: tuple[float, float, float], buttons: int = 0) -> bytes:
    """One datagram."""
    body = REPORT.pack(MAGIC, run, sequence, stamp, *position, buttons)
    return body + struct.pack("<I", zlib.crc32(body))


def where(elapsed: float) -> tuple[float, float, float]:
    """The hand goes 6.8 mm towards the sample and back again, every 4 s."""
    return 0.0, 0.0, -8e-3 + 3.4e-3 * (1.0 - math.cos(2.0 * math.pi * elapsed / 4.0))


def serve(port: int = 0) -> None:
    """Serve until the process ends."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.bind(("127.0.0.1", port))
        print(link.getsockname()[1], flush=True)
        run, sequence = int.from_bytes(os.urandom(4), "little"), 0
        listener, heard = None, -math.inf
        start = due = time.monotonic()
        while True:
            due += PERIOD
            while (left := due - time.monotonic()) > 0.0:
                link.settimeout(left)
                try:
                    message, sender = link.recvfrom(64)
                except (TimeoutError, ConnectionError):
                    continue
                if message == b"hello":
                    listener, heard = sender, time.monotonic()
            if listener is not None and time.monotonic() - heard < 1.0:
                sequence += 1
                position = where(time.monotonic() - start)
                link.sendto(report(run, sequence, time.monotonic_ns(), position), listener)


if __name__ == "__main__":
    serve(*map(int, sys.argv[1:]))
