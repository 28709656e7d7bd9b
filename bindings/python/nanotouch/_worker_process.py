# SPDX-License-Identifier: BSD-3-Clause
"""The other side of :mod:`nanotouch._io.worker`: imports the readers, and forks a limited child for each file."""

from __future__ import annotations

import ctypes
import importlib
import json
import os
import resource
import signal
import socket
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from . import curves, images
from ._io import transfer
from ._io.readers import _registered
from .errors import Error
from .images.values import plane_of

_READERS = ("cv2", "h5py", "scipy.io", "tifffile", "igor2.binarywave", "SurfaceTopography.IO", "afmformats")
_JOBS: dict[str, Callable[..., Any]] = {
    "images.read": images.read,
    "images.plane": plane_of,
    "images.channels": images.channels,
    "curves.read": curves.read,
}
_CLONE_NEWUSER, _CLONE_NEWNET = 0x10000000, 0x40000000


def main() -> None:
    """Serve the socket whose number is the argument, until it closes."""
    control = socket.socket(fileno=int(sys.argv[1]))
    for name in _READERS:
        try:
            importlib.import_module(name)
        except ImportError:  # an extra that is not installed; asking for it will say so
            continue
    with suppress(Error):  # a reader that cannot be loaded is named when it is wanted
        _registered()
    _leave_network()
    control.sendall(b"ready\n")
    while True:
        message, files, _, _ = socket.recv_fds(control, 1 << 16, 1)
        if not message:
            return
        while not message.endswith(b"\n"):
            message += control.recv(1 << 16)
        child = os.fork()
        if child == 0:
            control.close()
            os._exit(_serve(json.loads(message), files[0]))
        os.close(files[0])
        control.sendall(f"{os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])}\n".encode())


def _leave_network() -> None:
    """Into a network of our own, without an interface; where that is forbidden, as a user of our own."""
    libc = ctypes.CDLL(None)
    if libc.unshare(_CLONE_NEWNET) != 0:
        libc.unshare(_CLONE_NEWUSER | _CLONE_NEWNET)


def _serve(request: dict[str, Any], pipe: int) -> int:
    _limit(request["limits"])
    try:
        answer = transfer.packed(_JOBS[request["job"]](Path(request["file"]), **request["options"]))
    except Error as error:
        reader = getattr(error, "reader", "")
        answer = transfer.packed({"error": str(error), "type": type(error).__name__, "reader": reader})
    except MemoryError:
        answer = transfer.packed({"error": f"{request['file']}: asks for more memory than is allowed"})
    with os.fdopen(pipe, "wb") as stream:
        for piece in answer:
            stream.write(piece)
    return 0


def _limit(limits: dict[str, Any]) -> None:
    seconds = max(1, round(limits["time"]))
    for what, value in (
        (resource.RLIMIT_AS, limits["memory"]),
        (resource.RLIMIT_FSIZE, 0),
        (resource.RLIMIT_CORE, 0),
        (resource.RLIMIT_NOFILE, limits["files"]),
    ):
        resource.setrlimit(what, (value, value))
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 1))
    signal.signal(signal.SIGALRM, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_REAL, 3.0 * limits["time"])


if __name__ == "__main__":
    main()
