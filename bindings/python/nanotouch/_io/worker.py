# SPDX-License-Identifier: BSD-3-Clause
"""Open a file that may be hostile in a process of its own, and take the answer as data.

A server is forked from this process (from another Python, where threads run here) and forks a child for each file. The
child confines itself (:mod:`nanotouch._io.confine`) and reads. A child that is killed, crashes or never ends costs one
:class:`~nanotouch.errors.ReadError`; what it answers is plain data, and is checked again.
"""

from __future__ import annotations

import atexit
import importlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, Protocol, TypeVar, cast, get_args, get_origin

from nanotouch import guard
from nanotouch._io import transfer
from nanotouch._io.files import refuse_pipe
from nanotouch.errors import Error, InvalidValue, MissingExtra, ReadError

Answer = TypeVar("Answer")

_START_TIME = 120.0  # for the imports of another Python [s]
_PUT_ASIDE = 1 << 24  # by a reader while it reads, such as SurfaceTopography of .xyz [B]
_GRACE = 5.0  # after the child's own limit of time [s]


def ask(job: str, file: Path, options: dict[str, Any], expected: type[Answer], parts: Sequence[type] = ()) -> Answer:
    """The answer of `job` ("images.read", ...) for `file`, of a type that holds `parts`; :class:`ReadError` whatever
    happens to the worker."""
    check_system(file)
    refuse_pipe(file)
    limits = guard.LIMITS.of(file)
    request: dict[str, Any] = {"job": job, "file": str(file.absolute()), "options": options, "limits": asdict(limits)}
    kind = (get_args(expected) or (expected,))[0]
    request["written"] = limits.memory if _is_archive(file) else _PUT_ASIDE  # in the folder that is its own
    with _lock:
        answer = None if _series is None else _series.ask(request, file, (kind, *parts))
        if answer is None:
            answer = _alone(request, file, (kind, *parts))
    if isinstance(answer, dict) and "error" in answer:
        raise failure(answer, file)
    items = answer if get_origin(expected) is list and isinstance(answer, list) else [answer]
    if not all(isinstance(item, kind) for item in items):
        raise ReadError(f"{file}: the worker's answer is not what was asked for", "worker")
    return cast(Answer, answer)


def _alone(request: dict[str, Any], file: Path, types: Sequence[type]) -> Any:
    """The answer of a child for this file only."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        request["folder"] = folder
        try:
            return _process().ask(request, file, types)
        except _Gone:  # between two files: nothing is lost
            return _process().ask(request, file, types)


def check_system(file: Path) -> None:
    """Refuse where there is no guard."""
    if sys.platform != "linux":
        raise Error(f"{file}: untrusted files are opened on Linux only, not on {sys.platform}")


def failure(answer: dict[str, Any], file: Path) -> Error:
    """The error that a worker tells of."""
    message = str(answer["error"])[:1000].replace(str(file.absolute()), str(file))
    kind = {"InvalidValue": InvalidValue, "MissingExtra": MissingExtra}.get(str(answer.get("type")))
    return ReadError(message, str(answer.get("reader", ""))[:100]) if kind is None else kind(message)


def _is_archive(file: Path) -> bool:
    with suppress(OSError), file.open("rb") as stream:
        return stream.read(2) == b"PK"
    return False


class _Gone(Error):
    """The server has died: somebody killed it."""

    def __init__(self) -> None:
        super().__init__("the process that reads files was killed")


class Process:
    """The process that forks the children, and the socket to it."""

    def __init__(self) -> None:
        ours, theirs = socket.socketpair()
        self.owner = os.getpid()
        self.socket = ours
        self._popen: subprocess.Popen[bytes] | None = None
        with theirs:
            if threading.active_count() == 1:
                self.pid = _forked(theirs)
            else:
                self._popen = _started(theirs)
                self.pid = self._popen.pid
        self.lines = ours.makefile("r", encoding="utf-8")
        ours.settimeout(_START_TIME)
        try:
            ready = self.lines.readline()
        except TimeoutError:
            ready = ""
        if ready.strip() != "ready":
            self.stop()
            raise Error("the worker process for files did not start")

    def is_alive(self) -> bool:
        """Whether it still serves this process."""
        if self.owner != os.getpid():
            return False
        if self._popen is not None:
            return self._popen.poll() is None
        try:
            return os.waitpid(self.pid, os.WNOHANG) == (0, 0)
        except ChildProcessError:
            return False

    def stop(self) -> None:
        """Kill it with its children. A process that was forked from ours only forgets it."""
        self.lines.close()
        self.socket.close()
        if self.owner != os.getpid():
            return
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(self.pid, signal.SIGKILL)
        if self._popen is not None:
            self._popen.wait()
        else:
            with suppress(ChildProcessError):
                os.waitpid(self.pid, 0)

    def send(self, request: dict[str, Any], channel: int) -> None:
        """A request, whose answer comes through the channel."""
        socket.send_fds(self.socket, [line_of(request)], [channel])

    def status(self, deadline: float) -> int:
        """The exit status of the child."""
        self.socket.settimeout(max(1.0, deadline - time.monotonic()))
        line = self.lines.readline()
        if not line:
            raise _Gone
        return int(line)

    def ask(self, request: dict[str, Any], file: Path, types: Sequence[type]) -> Any:
        """The answer, of these types, or a dict with ``"error"``."""
        limits = guard.Limits(**request["limits"])
        deadline = time.monotonic() + 3 * limits.time + _GRACE
        answer: Any = None
        problem: Exception | None = None
        try:
            reading, writing = os.pipe()
            with os.fdopen(reading, "rb", buffering=0) as pipe:
                try:
                    self.send(request, writing)
                finally:
                    os.close(writing)
                try:
                    answer = transfer.unpacked(reader_of(pipe.fileno(), deadline), file, types, limits.memory)
                except (transfer.BadAnswer, EOFError, Error) as error:
                    problem = error
            status = self.status(deadline)
        except (BrokenPipeError, ConnectionError, _Gone):
            _drop(self)
            raise _Gone from None
        except (OSError, ValueError):  # TimeoutError is one
            _drop(self)
            return {"error": f"{file}: not read within {3 * limits.time:.3g} s and stopped", "reader": "worker"}
        if problem is None and status == 0:
            return answer
        return {"error": f"{file}: {fate(status, limits, problem)}", "reader": "worker"}


def line_of(request: dict[str, Any]) -> bytes:
    """A request as it is sent."""
    return json.dumps(request).encode() + b"\n"


def _forked(theirs: socket.socket) -> int:
    """A copy of this process that serves; what it imports once, its children have."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # threads of libraries: the child calls none of theirs
        child = os.fork()
    if child:
        with suppress(PermissionError, ProcessLookupError):  # the child does the same: whoever is first
            os.setpgid(child, child)
        return child
    try:
        _serve(theirs)
    finally:
        os._exit(1)


def _serve(theirs: socket.socket) -> None:
    """In the copy: nothing of what was open here, and none of what signals meant."""
    if os.getpgrp() != os.getpid():
        os.setsid()
    for sign in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGALRM):
        signal.signal(sign, signal.SIG_DFL)
    signal.set_wakeup_fd(-1)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for number in range(3):
        os.dup2(nowhere, number)
    for name in os.listdir("/proc/self/fd"):
        if int(name) > 2 and int(name) != theirs.fileno():
            with suppress(OSError):
                os.close(int(name))
    importlib.import_module("nanotouch._worker_process").serve(theirs)  # of the uppermost layer


def _started(theirs: socket.socket) -> subprocess.Popen[bytes]:
    """Another Python: a process with threads is not copied."""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p), "OMP_NUM_THREADS": "1"}
    environment |= {"OPENBLAS_NUM_THREADS": "1"}
    return subprocess.Popen(
        [sys.executable, "-P", "-m", "nanotouch._worker_process", str(theirs.fileno())],
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        pass_fds=[theirs.fileno()], env=environment, start_new_session=True,
    )  # fmt: skip


def reader_of(channel: int, deadline: float) -> Callable[[int], bytes]:
    """What gives so many bytes of a channel."""

    def read(count: int) -> bytes:
        buffer = bytearray()
        while len(buffer) < count:
            if not select.select([channel], [], [], max(0.0, deadline - time.monotonic()))[0]:
                raise TimeoutError
            piece = os.read(channel, min(count - len(buffer), 1 << 20))
            if not piece:
                raise EOFError
            buffer += piece
        return bytes(buffer)

    return read


def fate(status: int, limits: guard.Limits, problem: Exception | None) -> str:
    """What became of a child, from its exit status."""
    if status < 0:
        name = signal.Signals(-status).name
        if -status in (signal.SIGXCPU, signal.SIGALRM, signal.SIGKILL):
            return f"not read within {limits.time:.3g} s and stopped"
        return f"it crashes its reader ({name})"
    return f"the worker gave no valid answer ({problem or f'exit status {status}'})"


class Series(Protocol):
    """One child for several files (:mod:`nanotouch._io.series`)."""

    def ask(self, request: dict[str, Any], file: Path, types: Sequence[type]) -> Any:
        """The answer; None where a child of its own is to read the file."""


_lock = threading.Lock()
_current: Process | None = None
_series: Series | None = None


def current_series() -> Series | None:
    """The one that is asked first."""
    return _series


def enter(series: Series | None) -> None:
    """Ask this one first from now on."""
    global _series
    with _lock:
        _series = series


def _process() -> Process:
    global _current
    if _current is not None and not _current.is_alive():
        _drop(_current)
    if _current is None:
        _current = Process()
    return _current


def _drop(process: Process) -> None:
    global _current
    process.stop()
    if process is _current:
        _current = None


@atexit.register
def _stop_at_exit() -> None:
    if _current is not None:
        _drop(_current)
