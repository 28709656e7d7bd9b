# SPDX-License-Identifier: BSD-3-Clause
"""Who comes in at the server's port: so many at once, none that stays silent. What a crowd or a broken program costs a
session is bounded, and is nothing that its terminal tells."""

from __future__ import annotations

import asyncio
import logging
from typing import Any

from aiohttp.http_exceptions import HttpProcessingError

MOST = 256  # connections at once: watching pages, and some that come and go
SILENCE = 10.0  # within which a connection must ask for something [s]
WORDS = b"too many connections to this session: close a page, or wait ten seconds\n"
BUSY = (b"HTTP/1.1 503 Service Unavailable\r\nContent-Type: text/plain\r\nRetry-After: 10\r\nConnection: close\r\n"
        b"Content-Length: %d\r\n\r\n%s" % (len(WORDS), WORDS))  # fmt: skip


class Busy(asyncio.Protocol):
    """A connection that is refused in words."""

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Say so, and close it."""
        if isinstance(transport, asyncio.Transport):
            transport.write(BUSY)
            transport.close()


class Door:
    """Makes the protocol of each connection; ``server``: aiohttp's, of a runner that is set up."""

    def __init__(self, loop: asyncio.AbstractEventLoop, server: Any) -> None:
        self.loop, self.server = loop, server
        self.silent: set[Any] = set()

    def __call__(self) -> asyncio.BaseProtocol:
        """For one who knocks. Many who knock at once are made before aiohttp counts the first of them."""
        if len(self.silent.union(self.server.connections)) >= MOST:
            return Busy()
        made: asyncio.BaseProtocol = self.server()
        self.silent.add(made)
        self.loop.call_later(SILENCE, self._close, made)
        return made

    def heard(self, protocol: Any) -> None:
        """It has asked for something."""
        self.silent.discard(protocol)

    def _close(self, protocol: Any) -> None:
        if protocol in self.silent:
            self.silent.discard(protocol)
            if protocol.transport is not None:
                protocol.transport.close()


def quiet_log() -> logging.Logger:
    """Where aiohttp tells its troubles: what is no HTTP was answered, and is none of ours."""
    log = logging.getLogger("nanotouch.browser")
    if not log.filters:
        log.addFilter(lambda record: not (record.exc_info and isinstance(record.exc_info[1], HttpProcessingError)))
    return log
