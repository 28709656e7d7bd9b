# SPDX-License-Identifier: BSD-3-Clause
"""A mock of a controller with a z servo of its own that speaks Nanonis' TCP protocol. Its servo goes down to the lower
z limit, or until the deflection is its set-point. A test tells it to be slow, silent, rude, or gone.

Usage: mock_nanonis.py [PORT]    prints the port that it serves, then obeys lines of its standard input
"""

from __future__ import annotations

import json
import socket
import struct
import sys
import threading
import time
from contextlib import suppress
from dataclasses import dataclass, field

HEADER = struct.Struct(">32siHH")
SIGNALS = ("Current (A)", "Bias (V)", "Deflection (m)")
PIEZO = 1e-6  # from its middle to either end [m]
SPEED = 20e-6  # of its servo [m/s]
SURFACE = -100e-9  # z at which the tip touches [m]
SHARE = 0.5  # of the way into the sample that the lever bends [-]


@dataclass
class Tip:
    """z + upwards, as the controller has it; it goes towards where the servo sends it."""

    z: float = 0.0
    high: float = 0.9e-6
    low: float = -0.9e-6
    limited: int = 1
    """0: limits have no effect and cannot be set, and the piezo's are told"""
    lag: float = 0.0
    """of the status behind a servo that is switched on [s]"""
    switched: float = 0.0
    set_point: float = 0.0
    status: int = 1
    withdrawn: bool = False
    x: float = 0.0
    y: float = 0.0
    seen: float = field(default_factory=time.monotonic)
    draws: int = 0

    def move(self) -> None:
        """As far as it comes in the time since."""
        now = time.monotonic()
        way, self.seen = SPEED * (now - self.seen), now
        bottom = self.low if self.limited else -PIEZO
        goal = PIEZO if self.withdrawn else max(bottom, SURFACE - self.set_point / SHARE)
        if self.withdrawn or self.status == 2:
            self.z += max(-way, min(way, goal - self.z))

    def deflection(self) -> float:
        self.draws += 1
        return SHARE * max(0.0, SURFACE - self.z) + 1e-12 * (self.draws % 7)  # a live sensor is never still


class Controller:
    """Listens on the loopback; several connections, one after the other or at once."""

    def __init__(self, port: int = 0) -> None:
        self.tip = Tip()
        self.log: list[tuple[str, tuple[float, ...]]] = []
        """each command that came whole, with its values"""
        self.refuse: set[str] = set()
        """commands that are answered by an error"""
        self.delay = 0.0
        """before each reply [s]"""
        self.mangle = lambda reply: reply
        """what is made of each reply; b"" is none, None cuts the connection"""
        self.lock = threading.Lock()
        self.links: list[socket.socket] = []
        self.server = socket.create_server(("127.0.0.1", port))
        self.port = self.server.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def stop(self) -> None:
        """It is gone, with all connections."""
        self.server.shutdown(socket.SHUT_RDWR)
        self.server.close()
        self.cut()

    def cut(self) -> None:
        """All connections are lost; new ones are taken."""
        for link in self.links:
            with suppress(OSError):
                link.shutdown(socket.SHUT_RDWR)

    def count(self, command: str) -> int:
        return sum(name == command for name, _ in self.log)

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                link, _ = self.server.accept()
                self.links.append(link)
                threading.Thread(target=self._talk, args=(link,), daemon=True).start()

    def _talk(self, link: socket.socket) -> None:
        with suppress(OSError, struct.error), link, link.makefile("rb") as stream:
            while len(head := stream.read(HEADER.size)) == HEADER.size:
                name, size, wants_reply, _ = HEADER.unpack(head)
                command = name.rstrip(b"\0").decode()
                reply = self._answer(command, stream.read(size))
                time.sleep(self.delay)
                found = self.mangle(name + struct.pack(">i4x", len(reply)) + reply)
                if found is None:
                    return
                if wants_reply:
                    link.sendall(found)

    def _answer(self, command: str, body: bytes) -> bytes:
        takes, gives = COMMANDS.get(command, ("", ""))
        known = command in COMMANDS and len(body) == struct.calcsize(">" + takes)
        values = struct.unpack(">" + takes, body) if known else ()
        with self.lock:
            self.log.append((command, values))
            if not known or command in self.refuse:
                text = f"{command} is not possible".encode()
                return bytes(struct.calcsize(">" + gives)) + struct.pack(">Ii", 1, len(text)) + text
            self.tip.move()
            if command == "Signals.NamesGet":
                each = b"".join(struct.pack(">i", len(one)) + one.encode() for one in SIGNALS)
                return struct.pack(">ii", len(each), len(SIGNALS)) + each + bytes(8)
            return struct.pack(">" + gives, *self._done(command, *values)) + bytes(8)

    def _done(self, command: str, *values: float) -> tuple[float, ...]:
        tip = self.tip
        match command:
            case "ZCtrl.ZPosGet":
                return (tip.z,)
            case "ZCtrl.LimitsGet":
                return (tip.high, tip.low) if tip.limited else (PIEZO, -PIEZO)
            case "ZCtrl.LimitsSet":
                tip.high, tip.low = values if tip.limited else (tip.high, tip.low)
            case "ZCtrl.LimitsEnabledGet":
                return (tip.limited,)
            case "ZCtrl.LimitsEnabledSet":
                tip.limited = int(values[0])
            case "ZCtrl.SetpntGet":
                return (tip.set_point,)
            case "ZCtrl.SetpntSet":
                (tip.set_point,) = values
            case "ZCtrl.OnOffSet":
                tip.status, tip.withdrawn, tip.switched = 1 + int(values[0]), False, time.monotonic()
            case "ZCtrl.StatusGet":
                return (1 if time.monotonic() < tip.switched + tip.lag else tip.status,)
            case "ZCtrl.Withdraw":
                tip.status, tip.withdrawn = 1, True
            case "Signals.ValGet":
                return (tip.deflection(),)
            case "FolMe.XYPosSet":
                tip.x, tip.y, _ = values
            case "FolMe.XYPosGet":
                return tip.x, tip.y
        return ()


COMMANDS = {  # what each takes and gives, as struct has it
    "Signals.NamesGet": ("", ""),
    "Signals.ValGet": ("iI", "f"),
    "ZCtrl.ZPosGet": ("", "f"),
    "ZCtrl.LimitsGet": ("", "ff"),
    "ZCtrl.LimitsSet": ("ff", ""),
    "ZCtrl.LimitsEnabledGet": ("", "I"),
    "ZCtrl.LimitsEnabledSet": ("I", ""),
    "ZCtrl.SetpntGet": ("", "f"),
    "ZCtrl.SetpntSet": ("f", ""),
    "ZCtrl.OnOffSet": ("I", ""),
    "ZCtrl.StatusGet": ("", "H"),
    "ZCtrl.Withdraw": ("Ii", ""),
    "FolMe.XYPosSet": ("ddI", ""),
    "FolMe.XYPosGet": ("I", "dd"),
}


MANGLES = {
    "no": lambda reply: reply,
    "silent": lambda _: b"",
    "half": lambda reply: reply[: len(reply) // 2],
    "garbage": lambda reply: b"\xff" * len(reply),
    "closed": lambda _: None,
}


def obey(controller: Controller, line: str) -> str:
    """One line of a test, as `delay 0.2`; the answer tells z, the status and what has been asked."""
    what, _, value = line.strip().partition(" ")
    match what:
        case "delay":
            controller.delay = float(value)
        case "refuse":
            controller.refuse = set(value.split())
        case "mangle":
            controller.mangle = MANGLES[value]
        case "off":
            controller.tip.status = 5
        case "cut":
            controller.cut()
    with controller.lock:
        controller.tip.move()
    asked = {name: controller.count(name) for name in COMMANDS}
    return json.dumps(
        {"z": controller.tip.z, "status": controller.tip.status, "limited": controller.tip.limited, "asked": asked}
    )


if __name__ == "__main__":
    served = Controller(int(sys.argv[1]) if len(sys.argv) > 1 else 0)
    print(served.port, flush=True)
    for asked_line in sys.stdin:
        print(obey(served, asked_line), flush=True)
