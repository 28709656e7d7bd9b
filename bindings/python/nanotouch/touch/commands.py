# SPDX-License-Identifier: BSD-3-Clause
"""Ask a running session for changes, from this or another process, and read its answers.

Several clients may be attached. One at a time holds the lease and may post; a lease ends one second after it was last
taken, renewed or used. Anyone may stop.
"""

from __future__ import annotations

from typing import NamedTuple

from nanotouch import _core
from nanotouch._io.closing import Closing
from nanotouch.errors import Error
from nanotouch.touch.frames import attached


class Answer(NamedTuple):
    """What became of a request."""

    id: int
    """of the request"""
    tick: int
    """in which it was applied or refused"""
    status: int
    """0: no error"""
    pending: bool
    """not yet applied: another answer will come"""
    message: str
    """the status in words"""


class Client(Closing):
    """One who may ask; made by :func:`attach`. For one thread."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._handle = attached(_core.Client, name)

    def lease(self) -> None:
        """Take or renew the lease; :class:`~nanotouch.errors.Error` while another client holds it."""
        try:
            self._handle.lease()
        except Error as error:
            raise Error(f"another client holds the lease of session {self._name!r}, or this one is closed") from error

    def release(self) -> None:
        """Give the lease back."""
        self._handle.release()

    def post(self, kind: int, field: int = 0, value: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)) -> int:
        """Post a request and renew the lease; returns its id."""
        return self._handle.post(kind, field, value)

    def stop(self) -> int:
        """Stop the session, with or without the lease; returns the id of the request."""
        return self._handle.post(_core.request_stop, 0, (0.0, 0.0, 0.0, 0.0))

    def poll(self, id: int) -> Answer:
        """What became of a request of this client; ``pending`` until it is applied or refused."""
        return Answer(*self._handle.poll(id))

    def close(self) -> None:
        """Give the lease back and detach. May be repeated."""
        self._handle.close()

    def __repr__(self) -> str:
        return f"Client({self._name!r})"


def attach(name: str) -> Client:
    """Attach to the running session of that name; :class:`~nanotouch.errors.DeviceError` if there is none."""
    return Client(name)
