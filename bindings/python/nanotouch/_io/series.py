# SPDX-License-Identifier: BSD-3-Clause
"""A batch of files pays once for the guard: one confined child reads them in turn. A file that breaks the child, or for
which it found too little memory, is read again by a child of its own, so the answers are those of single files."""

from __future__ import annotations

import json
import os
import socket
import struct
import tempfile
import time
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import Any

from nanotouch import guard
from nanotouch._io import transfer, worker
from nanotouch.errors import Error

MOST = 256  # files that one child may see


@contextmanager
def of(files: Iterable[str | os.PathLike[str]]) -> Iterator[None]:
    """Within it, these files are read by few children where a guard is wanted; of nested ones the outer holds."""
    if worker.current_series() is not None or not guard.is_there():
        yield
        return
    found = Series([Path(file) for file in files])
    worker.enter(found)
    try:
        yield
    finally:
        worker.enter(None)
        found.stop()


class Series:
    """The child and the files that are left to it."""

    def __init__(self, files: Sequence[Path]) -> None:
        self._left = [str(file.absolute()) for file in files]
        self._seen: frozenset[str] = frozenset()
        self._process: worker.Process | None = None
        self._socket: socket.socket | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self.children = 0  # that were started

    def ask(self, request: dict[str, Any], file: Path, types: Sequence[type]) -> Any:
        """The answer; None where a child of its own is to read the file."""
        name = request["file"]
        if self._socket is None or name not in self._seen or self._process is None or not self._process.is_alive():
            if name not in self._left:
                return None
            self._start(request)
        assert self._socket is not None
        limits = guard.Limits(**request["limits"])
        read = worker.reader_of(self._socket.fileno(), time.monotonic() + 3 * limits.time)
        try:
            self._socket.sendall(worker.line_of(request))
            answer = transfer.unpacked(read, file, types, limits.memory)
        except (transfer.BadAnswer, EOFError, OSError, Error):
            answer = None
        if answer is None or (isinstance(answer, dict) and answer.get("type") == "MemoryError"):
            self.stop()
            self._left = [other for other in self._left if other != name]
            return None
        return answer

    def stop(self) -> None:
        """Kill the child."""
        process, self._process = self._process, None
        ours, self._socket = self._socket, None
        if process is None or ours is None:
            return
        process.stop()
        if process.owner == os.getpid():
            ours.close()
            if self._folder is not None:
                self._folder.cleanup()

    def _start(self, request: dict[str, Any]) -> None:
        self.stop()
        first = self._left.index(request["file"])
        self._left = self._left[first:] + self._left[:first]  # those that come next
        seen = self._left[:MOST]
        self._seen = frozenset(seen)
        limits = [guard.LIMITS.of(Path(name)) for name in seen]
        whole = guard.Limits(max(one.memory for one in limits), sum(one.time for one in limits), guard.LIMITS.files)
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        ours, theirs = socket.socketpair()
        self._process, self._socket = worker.Process(), ours
        self.children += 1
        shared = {"limits": asdict(whole), "folder": self._folder.name, "series": True}
        with theirs:
            self._process.send(request | shared, theirs.fileno())
        names = json.dumps(seen).encode()
        ours.sendall(struct.pack("<Q", len(names)) + names)
