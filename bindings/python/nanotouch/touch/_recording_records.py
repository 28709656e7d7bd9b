# SPDX-License-Identifier: BSD-3-Clause
"""The records of an MCAP file, those after a damaged one too: the next sound one is searched for by its first bytes."""

from __future__ import annotations

import io
import re
import struct
from collections.abc import Iterator
from typing import IO, Any, NamedTuple

from nanotouch.errors import require

MAGIC = b"\x89MCAP0\r\n"
MAX_CHUNK = 1 << 28  # unpacked [byte]; ours have some 3 MB
FREE, RATIO = 1 << 28, 200  # all of it: so many bytes [byte], and so many for each of the file's; ours have some 5
FOOTER, SCHEMA, MESSAGE, CHUNK, METADATA, DATA_END = 0x02, 0x03, 0x05, 0x06, 0x0C, 0x0F
HEAD = 9  # opcode and length [byte]
_BEGINNING = re.compile(rb"\x06.{8}.{28}\x04\0\0\0zstd|\x0c.{8}\x09\0\0\0nanotouch|\x0f\x04\0\0\0\0\0\0\0", re.DOTALL)
"""of a packed block, of our metadata, of the end of the data"""


class Damage(NamedTuple):
    """What stands where a record should."""

    reason: str
    is_end: bool
    """nothing sound comes after it"""


def records(file: IO[bytes]) -> Iterator[Any]:
    """Every sound record that holds something, chunks taken apart, and a :class:`Damage` where others were."""
    data = file.read()
    found = _Records(data)
    at, bad = len(MAGIC), "" if data.startswith(MAGIC) else "it does not begin as an MCAP file does"
    while bad or at < len(data):
        if bad:
            after = found.next_sound(at)
            yield Damage(bad, after is None)
            if after is None:
                return
            at, bad = after, ""
        try:
            yield from found.at(at)
        except found.failures as error:
            bad = str(error) or type(error).__name__
            at += 1
            continue
        except (MemoryError, OverflowError):
            bad = "a record is larger than the memory"
            at += 1
            continue
        if data[at] == FOOTER:
            return
        at = found.end(at)
    yield Damage("it ends early" if data else "it is empty", is_end=True)


class _Records:
    """The records of a file, by where they begin."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self._left = FREE + RATIO * len(data)
        self._records = require("mcap.records", "record")
        self._stream = require("mcap.data_stream", "record").ReadDataStream
        self._breakup = require("mcap.stream_reader", "record").breakup_chunk
        self._zstandard = require("zstandard", "record")
        mcap_error = require("mcap.exceptions", "record").McapError
        self.failures = (mcap_error, self._zstandard.ZstdError, ValueError, struct.error)

    def end(self, at: int) -> int:
        """Where the record ends that begins here; ValueError where it cannot be one."""
        if at + HEAD > len(self.data):
            raise ValueError("it ends early")
        if not 1 <= self.data[at] <= DATA_END:
            raise ValueError(f"a record of the unknown kind {self.data[at]}")
        end = at + HEAD + int.from_bytes(self.data[at + 1 : at + HEAD], "little")
        if end > len(self.data):
            raise ValueError("it ends early")
        return end

    def next_sound(self, start: int) -> int | None:
        """Where the next record begins, from here on, that is what its first bytes say."""
        for match in _BEGINNING.finditer(self.data, start):
            at = match.start()
            if at + HEAD + int.from_bytes(self.data[at + 1 : at + HEAD], "little") <= len(self.data):
                return at
        return None

    def at(self, at: int) -> list[Any]:
        """What the record holds that begins here."""
        content = self.data[at + HEAD : self.end(at)]
        stream, kind = self._stream(io.BytesIO(content)), self.data[at]
        if kind == MESSAGE:
            return [self._records.Message.read(stream, len(content))]
        if kind not in (SCHEMA, METADATA, CHUNK):
            return []
        name = {SCHEMA: "Schema", METADATA: "Metadata", CHUNK: "Chunk"}[kind]
        record = getattr(self._records, name).read(stream)
        if stream.count != len(content):  # the length would lead into the middle of another one
            raise ValueError(f"a {name.lower()} states another length than its parts have")
        if kind != CHUNK:
            return [record]
        record.compression, record.data = "", self._unpacked(record)
        return list(self._breakup(record, validate_crc=True))

    def _unpacked(self, chunk: Any) -> bytes:
        """The content of a chunk; ValueError where it is larger than it says, or than is read."""
        stated, most = int(chunk.uncompressed_size), min(self._left, MAX_CHUNK)
        if stated > most:
            raise ValueError(f"a chunk of {len(chunk.data)} bytes unpacks to {stated}; up to {most} are read")
        if not chunk.compression:
            return bytes(chunk.data)
        if chunk.compression != "zstd":
            raise ValueError(f"a chunk is packed by {chunk.compression[:20]!r}; zstd is read")
        packed = io.BytesIO(chunk.data)
        with self._zstandard.ZstdDecompressor(max_window_size=MAX_CHUNK).stream_reader(packed) as stream:
            data: bytes = stream.read(stated + 1)
        self._left -= len(data)
        if len(data) != stated:
            raise ValueError(f"a chunk does not unpack to the {stated} bytes that it states")
        return data
