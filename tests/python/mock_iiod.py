# SPDX-License-Identifier: BSD-3-Clause
"""A server that speaks iiod's protocol, with the two converters of docs/examples/rig/iio.toml and a trigger behind it:
libiio's own client connects to it. Scan n of input c is the number 10 n + c."""

from __future__ import annotations

import errno
import socketserver
import struct
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

_NUMBERS = "".join(f'<attribute name="{name}" filename="{name}"/>' for name in ("raw", "scale", "offset"))
_INPUTS = "".join(
    f'<channel id="voltage{at}" type="input"><scan-element index="{at}" format="be:S16/16&gt;&gt;0"/>'
    f"{_NUMBERS}</channel>"
    for at in (0, 1)
)
CONTEXT = f"""<?xml version="1.0" encoding="utf-8"?><!DOCTYPE context [<!ELEMENT context (device)*>
<!ELEMENT device (channel | attribute)*><!ELEMENT channel (scan-element?, attribute*)><!ELEMENT attribute EMPTY>
<!ELEMENT scan-element EMPTY><!ATTLIST context name CDATA #REQUIRED description CDATA #IMPLIED>
<!ATTLIST device id CDATA #REQUIRED name CDATA #IMPLIED>
<!ATTLIST channel id CDATA #REQUIRED type (input|output) #REQUIRED>
<!ATTLIST scan-element index CDATA #REQUIRED format CDATA #REQUIRED>
<!ATTLIST attribute name CDATA #REQUIRED filename CDATA #IMPLIED>]>
<context name="model" description="two converters"><device id="iio:device0" name="ad5686">
<channel id="voltage0" type="output">{_NUMBERS}</channel></device>
<device id="iio:device1" name="ad7606">{_INPUTS}</device>
<device id="trigger0" name="clock"><attribute name="sampling_frequency"/></device></context>""".replace("\n", "")


class Iiod(socketserver.ThreadingTCPServer):
    """``error``: what each scan ends with; ``comes``: how many scans there are before no more come."""

    allow_reuse_address = daemon_threads = True
    error, comes, rate = 0, 10**9, 1e4

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), _Client)
        self.timeouts: list[int] = []
        self.trigger = ""

    @property
    def uri(self) -> str:
        """For libiio."""
        return f"ip:127.0.0.1:{self.server_address[1]}"


class _Client(socketserver.StreamRequestHandler):
    server: Iiod

    def handle(self) -> None:
        while line := self.rfile.readline().decode().split():
            if line[0] == "EXIT":
                return
            self.wfile.write(self._answer(line[0], line[1:]))

    def _answer(self, word: str, rest: list[str]) -> bytes:
        told = self.server
        if word == "VERSION":
            return b"0.24.v0.24   \n"
        if word == "PRINT":
            return f"{len(CONTEXT)}\n{CONTEXT}\n".encode()
        if word == "TIMEOUT":
            told.timeouts.append(int(rest[0]))
            return b"0\n"
        if word == "READ":
            text = self._number(rest)
            return f"{len(text)}\n{text}\n".encode()
        if word == "SETTRIG":
            told.trigger = {"trigger0": "clock"}[rest[1]]  # set by id, told by name
            return b"0\n"
        if word == "GETTRIG":
            return f"{len(told.trigger)}\n{told.trigger}\n".encode() if told.trigger else b"0\n"
        if word == "READBUF":
            return self._scans(int(rest[1]) // 4)
        return b"0\n" if word in ("OPEN", "CLOSE", "SET") else f"{-errno.EINVAL}\n".encode()

    def _number(self, rest: list[str]) -> str:
        if rest[0] == "trigger0":
            return f"{self.server.rate:g}"
        if rest[-1] == "raw":
            return "0"
        span = 5e3 if rest[0] == "iio:device0" else 20e3  # [mV]
        return {"scale": f"{span / 65536:.9f}", "offset": "0"}[rest[-1]]

    def _scans(self, count: int) -> bytes:
        told = self.server
        if told.error:
            return f"{-told.error}\n".encode()
        if count > told.comes:
            time.sleep(0.05)  # the server's own timeout
            return f"{-errno.ETIMEDOUT}\n".encode()
        data = b"".join(struct.pack(">hh", 10 * n, 10 * n + 1) for n in range(count))
        return f"{len(data)}\n00000003\n".encode() + data


@contextmanager
def served() -> Iterator[Iiod]:
    """One that runs."""
    with Iiod() as server:
        threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
        yield server
        server.shutdown()
