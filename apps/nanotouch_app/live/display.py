# SPDX-License-Identifier: BSD-3-Clause
"""Is there a display that answers? Found out before anything waits for it."""

from __future__ import annotations

import os
import re
import socket
import sys

from nanotouch.errors import Error

PATIENCE = 3.0  # [s]
GREETING = b"l\x00\x0b\x00\x00\x00\x00\x00\x00\x00\x00\x00"  # X11, little endian, version 11.0, no authorisation
ANSWERS = (b"\x00", b"\x01", b"\x02")  # no; welcome; say who you are
BASE_PORT = 6000
HOW = "start it on a desktop, or under 'xvfb-run -a'; --film FILE.gif needs no display"


def check(patience: float = PATIENCE) -> None:
    """Return if a window can be opened here; an :class:`~nanotouch.errors.Error` in words if not."""
    if sys.platform in ("win32", "darwin"):
        return
    name = os.environ.get("DISPLAY", "")
    if not name:
        raise Error(f"no display: DISPLAY is not set; {HOW}")
    matched = re.fullmatch(r"(?:unix)?([^:/]*):(\d+)(?:\.\d+)?", name)
    if matched is None:
        raise Error(f"no display: DISPLAY is {name!r}, which names none; {HOW}")
    host, number = matched[1], int(matched[2])
    try:
        with _connected(host, number, patience) as wire:
            wire.settimeout(patience)
            wire.sendall(GREETING)
            said = wire.recv(1)
            if said in ANSWERS:  # even if it is that we have to say who we are
                return
        reason = "what answers there is no X server" if said else "it hung up"
    except TimeoutError:
        reason = f"it did not answer within {patience:g} s"
    except OSError as error:
        reason = str(error.strerror or error)
    raise Error(f"the display {name} cannot be used: {reason}; {HOW}")


def _connected(host: str, number: int, patience: float) -> socket.socket:
    if host:
        return socket.create_connection((host, BASE_PORT + number), timeout=patience)
    path = f"/tmp/.X11-unix/X{number}"
    for address in (path, "\0" + path):
        wire = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        wire.settimeout(patience)
        try:
            wire.connect(address)
            return wire
        except TimeoutError:
            wire.close()
            raise
        except OSError:
            wire.close()
    raise OSError(2, "nobody listens there")
