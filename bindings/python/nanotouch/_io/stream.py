# SPDX-License-Identifier: BSD-3-Clause
"""The curves of a large file, one block after the other, by a guarded process that stays."""

from __future__ import annotations

import os
import socket
import time
import weakref
from dataclasses import asdict
from pathlib import Path
from typing import Any

from nanotouch import guard
from nanotouch._io import transfer, worker
from nanotouch.errors import Error, ReadError

BLOCK = 64  # curves


class Guarded:
    """Curves and their places, as :class:`nanotouch.curves.Stream` gives them.

    Parameters
    ----------
    file : Path
        The archive.
    options : dict
        The calibration that is given.
    types : tuple of type
        Of what a curve is made.
    """

    def __init__(self, file: Path, options: dict[str, Any], types: tuple[type, ...]) -> None:
        worker.check_system(file)
        self.file, self._types, self._limits = file, types, guard.LIMITS.of(file)
        self._held: tuple[int, list[Any]] = (0, [])
        ours, theirs = socket.socketpair()
        self._process = worker.Process()
        weakref.finalize(self, _close, self._process, ours)
        self._socket = ours
        request = {"job": "curves.stream", "file": str(file.absolute()), "options": options}
        with theirs:
            self._process.send(request | {"limits": asdict(self._limits)}, theirs.fileno())
        answer = self._answer()
        if not isinstance(answer, dict) or not isinstance(answer.get("places"), list):
            raise ReadError(f"{file}: the worker's answer is not what was asked for", "worker")
        self._places: list[dict[str, Any]] = answer["places"]

    def __len__(self) -> int:
        return len(self._places)

    def __getitem__(self, number: int) -> Any:
        start, curves = self._held
        if not start <= number < start + len(curves):
            start = number - number % BLOCK
            self._socket.sendall(f"{start} {min(start + BLOCK, len(self))}\n".encode())
            curves = self._answer()
            if not isinstance(curves, list) or len(curves) != min(BLOCK, len(self) - start):
                raise ReadError(f"{self.file}: the worker's answer is not what was asked for", "worker")
            self._held = start, curves
        curve = curves[number - start]
        if isinstance(curve, dict) and "error" in curve:
            raise worker.failure(curve, self.file)
        if not isinstance(curve, self._types[0]):
            raise ReadError(f"{self.file}: the worker's answer is not what was asked for", "worker")
        return curve

    def place(self, number: int) -> dict[str, Any]:
        """What ``meta`` says of grid and position."""
        return self._places[number]

    def _answer(self) -> Any:
        deadline = time.monotonic() + 3 * self._limits.time
        read = worker.reader_of(self._socket.fileno(), deadline)
        try:
            answer = transfer.unpacked(read, self.file, self._types, self._limits.memory)
        except (transfer.BadAnswer, EOFError, OSError, Error) as problem:
            ended = problem if isinstance(problem, transfer.BadAnswer) else None
            try:
                said = worker.fate(self._process.status(time.monotonic() + 5.0), self._limits, ended)
            except (OSError, ValueError, Error):
                said = f"not read within {3 * self._limits.time:.3g} s and stopped"
            raise ReadError(f"{self.file}: {said}", "worker") from None
        if isinstance(answer, dict) and "error" in answer:
            raise worker.failure(answer, self.file)
        return answer


def _close(process: worker.Process, ours: socket.socket) -> None:
    if process.owner == os.getpid():
        ours.close()
    process.stop()
