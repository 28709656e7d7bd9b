# SPDX-License-Identifier: BSD-3-Clause
"""Open a file that may be hostile in a worker process, and take the answer as data.

One process (``_worker_process``) imports the readers once; for each file it forks a child, which limits itself
(memory, time, open files, no writing, no network where the kernel allows) and reads. A child that is killed, crashes or
never ends costs one :class:`~nanotouch.errors.ReadError`. It guards against damaged files, bombs and readers that loop
or crash; it is no sandbox against a file that takes over the reader.
"""

from __future__ import annotations

import atexit
import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, TypeVar, cast, get_args, get_origin

from nanotouch._io import transfer
from nanotouch.errors import Error, InvalidValue, MissingExtra, ReadError

Answer = TypeVar("Answer")

_START_TIME = 120.0  # for the imports [s]
_GRACE = 5.0  # after the child's own limit of time [s]


@dataclass(frozen=True)
class Limits:
    """What a child may use.

    Attributes
    ----------
    memory : int
        Address space [byte], of which the libraries take 0.6 GiB.
    time : float
        Of the processor, and of the clock by a factor 3 [s].
    files : int
        Open at a time.
    """

    memory: int = 2 << 30
    time: float = 20.0
    files: int = 16


LIMITS = Limits()


def ask(job: str, file: Path, options: dict[str, Any], expected: type[Answer], parts: Sequence[type] = ()) -> Answer:
    """The answer of `job` ("images.read", ...) for `file`, of a type that holds `parts`; :class:`ReadError` whatever
    happens to the worker."""
    if sys.platform != "linux":
        raise Error(f"{file}: untrusted files are opened on Linux only, not on {sys.platform}")
    request = {"job": job, "file": str(file.absolute()), "options": options, "limits": asdict(LIMITS)}
    kind = (get_args(expected) or (expected,))[0]
    with _lock:
        answer = _process().ask(request, file, (kind, *parts))
    if isinstance(answer, dict) and "error" in answer:
        raise _failure(answer, file)
    items = answer if get_origin(expected) is list and isinstance(answer, list) else [answer]
    if not all(isinstance(item, kind) for item in items):
        raise ReadError(f"{file}: the worker's answer is not what was asked for", "worker")
    return cast(Answer, answer)


def _failure(answer: dict[str, Any], file: Path) -> Error:
    message = str(answer["error"])[:1000].replace(str(file.absolute()), str(file))
    kind = {"InvalidValue": InvalidValue, "MissingExtra": MissingExtra}.get(str(answer.get("type")))
    return ReadError(message, str(answer.get("reader", ""))[:100]) if kind is None else kind(message)


class _Process:
    """The process that forks the children, and the socket to it."""

    def __init__(self) -> None:
        ours, theirs = socket.socketpair()
        self.owner = os.getpid()
        self.socket = ours
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p), "OMP_NUM_THREADS": "1"}
        environment |= {"OPENBLAS_NUM_THREADS": "1", "HDF5_PLUGIN_PRELOAD": "::"}  # no filters from elsewhere
        with theirs:
            self.popen = subprocess.Popen(
                [sys.executable, "-P", "-m", "nanotouch._worker_process", str(theirs.fileno())],
                stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()], env=environment, start_new_session=True,
            )  # fmt: skip
        self.lines = ours.makefile("r", encoding="utf-8")
        ours.settimeout(_START_TIME)
        try:
            ready = self.lines.readline()
        except TimeoutError:
            ready = ""
        if ready.strip() != "ready":
            self.stop()
            raise Error("the worker process for untrusted files did not start")

    def stop(self) -> None:
        """Kill it with its children. A process that was forked from ours only forgets it."""
        self.lines.close()
        self.socket.close()
        if self.owner == os.getpid():
            if self.popen.poll() is None:
                os.killpg(self.popen.pid, signal.SIGKILL)
            self.popen.wait()

    def ask(self, request: dict[str, Any], file: Path, types: Sequence[type]) -> Any:
        """The answer, of these types, or a dict with ``"error"``."""
        limits = Limits(**request["limits"])
        reading, writing = os.pipe()
        deadline = time.monotonic() + 3 * limits.time + _GRACE
        answer: Any = None
        problem: Exception | None = None
        try:
            with os.fdopen(reading, "rb", buffering=0) as pipe:
                try:
                    socket.send_fds(self.socket, [json.dumps(request).encode() + b"\n"], [writing])
                finally:
                    os.close(writing)
                try:
                    answer = transfer.unpacked(lambda count: _read(pipe.fileno(), count, deadline), file, types)
                except (transfer.BadAnswer, EOFError, Error) as error:
                    problem = error
            self.socket.settimeout(max(1.0, deadline - time.monotonic()))
            status = int(self.lines.readline() or "-1")
        except (OSError, ValueError):  # TimeoutError is one
            _drop(self)
            return {"error": f"{file}: not read within {3 * limits.time:g} s and stopped", "reader": "worker"}
        if problem is None and status == 0:
            return answer
        return {"error": f"{file}: {_fate(status, limits, problem)}", "reader": "worker"}


def _read(pipe: int, count: int, deadline: float) -> bytes:
    buffer = bytearray()
    while len(buffer) < count:
        if not select.select([pipe], [], [], max(0.0, deadline - time.monotonic()))[0]:
            raise TimeoutError
        piece = os.read(pipe, min(count - len(buffer), 1 << 20))
        if not piece:
            raise EOFError
        buffer += piece
    return bytes(buffer)


def _fate(status: int, limits: Limits, problem: Exception | None) -> str:
    """What became of a child, from its exit status."""
    if status < 0:
        name = signal.Signals(-status).name
        if -status in (signal.SIGXCPU, signal.SIGALRM):
            return f"not read within {limits.time:g} s and stopped"
        return f"it crashes its reader ({name})"
    return f"the worker gave no valid answer ({problem or f'exit status {status}'})"


_lock = threading.Lock()
_current: _Process | None = None


def _process() -> _Process:
    global _current
    if _current is not None and (_current.owner != os.getpid() or _current.popen.poll() is not None):
        _drop(_current)
    if _current is None:
        _current = _Process()
    return _current


def _drop(process: _Process) -> None:
    global _current
    process.stop()
    _current = None


@atexit.register
def _stop_at_exit() -> None:
    if _current is not None:
        _drop(_current)
