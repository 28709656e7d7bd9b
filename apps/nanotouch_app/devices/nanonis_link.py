# SPDX-License-Identifier: BSD-3-Clause
"""Nanonis' TCP protocol: a request, a reply, both big-endian.

A request is a name of 32 bytes, the body's size, whether a reply is wanted, two bytes of zero, then the body. A reply
repeats the name and its own size; its body ends with a status, the size of a text, and the text. Each reply has a
deadline as a whole: one that comes byte by byte does not stretch it.
"""

from __future__ import annotations

import socket
import struct
import time
from types import TracebackType
from typing import Any, NamedTuple, Self

from nanotouch.errors import DeviceError

HEADER = struct.Struct(">32siHH")
"""name, size of the body [byte], reply wanted, 0"""
LARGEST = 65536
"""of a body; a larger one is refused [byte]"""


class LinkError(DeviceError):
    """The controller is gone, silent, refuses, or says what cannot be."""


class Address(NamedTuple):
    """Of a controller."""

    host: str
    port: int


class Link:
    """One connection. After a failure only :meth:`tell` and :meth:`close` are of use."""

    def __init__(self, address: Address, patience: float) -> None:
        self.patience = patience
        """with a reply as a whole [s]"""
        try:
            self._socket = socket.create_connection(address, timeout=patience)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        except OSError as error:
            raise LinkError(f"no controller at {address.host}:{address.port}: {error}") from error

    def tell(self, command: str, takes: str = "", *values: float, wants_reply: bool = False) -> None:
        """Send a request; `takes` are the formats of its values as :mod:`struct` has them."""
        body = struct.pack(">" + takes, *values)
        try:
            self._socket.settimeout(self.patience)
            self._socket.sendall(HEADER.pack(command.encode(), len(body), wants_reply, 0) + body)
        except OSError as error:
            raise LinkError(f"{command}: {error}") from error

    def ask(self, command: str, takes: str = "", *values: float) -> bytes:
        """The body of the reply."""
        self.tell(command, takes, *values, wants_reply=True)
        due = time.monotonic() + self.patience
        name, size, *_ = HEADER.unpack(self._exactly(HEADER.size, command, due))
        if name.rstrip(b"\0") != command.encode() or not 8 <= size <= LARGEST:
            raise LinkError(f"{command}: the reply is to {name!r} with {size} bytes")
        return self._exactly(size, command, due)

    def call(self, command: str, takes: str = "", *values: float, gives: str = "") -> tuple[Any, ...]:
        """The values of the reply; LinkError with the controller's words if it refuses."""
        body = self.ask(command, takes, *values)
        form = struct.Struct(">" + gives)
        self._check(command, body, form.size)
        return form.unpack_from(body)

    def names(self) -> list[str]:
        """Of all signals, in their order."""
        command = "Signals.NamesGet"
        body = self.ask(command)
        found, at = [], 8
        try:
            for _ in range(struct.unpack_from(">i", body, 4)[0]):
                (size,) = struct.unpack_from(">i", body, at)
                found.append(body[at + 4 : at + 4 + size].decode("latin-1"))
                at += 4 + max(0, size)
        except struct.error as error:
            raise LinkError(f"{command}: {error}") from error
        self._check(command, body, at)
        return found

    def _check(self, command: str, body: bytes, at: int) -> None:
        """Status and text at the end of a body."""
        if len(body) < at + 8:
            self._refused(command, body)
        status, size = struct.unpack_from(">Ii", body, at)
        if size != len(body) - at - 8:
            self._refused(command, body)
        if status:
            raise LinkError(f"{command}: the controller refuses: {body[at + 8 :].decode('latin-1')}")

    @staticmethod
    def _refused(command: str, body: bytes) -> None:
        """A body of the wrong size: the controller may have left out the values and said why."""
        status, size = struct.unpack_from(">Ii", body)
        if status and size == len(body) - 8:
            raise LinkError(f"{command}: the controller refuses: {body[8:].decode('latin-1')}")
        raise LinkError(f"{command}: a reply of {len(body)} bytes is none")

    def _exactly(self, size: int, command: str, due: float) -> bytes:
        found = bytearray()
        while len(found) < size:
            try:
                self._socket.settimeout(max(1e-6, due - time.monotonic()))
                more = self._socket.recv(size - len(found))
            except TimeoutError as error:
                raise LinkError(f"{command}: no reply within {self.patience:g} s") from error
            except OSError as error:
                raise LinkError(f"{command}: {error}") from error
            if not more:
                raise LinkError(f"{command}: the controller closed the connection")
            found += more
        return bytes(found)

    def close(self) -> None:
        """Give it back."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()
