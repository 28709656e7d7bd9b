# SPDX-License-Identifier: BSD-3-Clause
"""Recordings (MCAP) written record by record, as no writer of ours would."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from pathlib import Path

MAGIC = b"\x89MCAP0\r\n"
TIME = [{"name": "time", "dtype": "<f8", "unit": "s"}]


def _text(text: str | bytes) -> bytes:
    data = text.encode() if isinstance(text, str) else text
    return struct.pack("<I", len(data)) + data


def _record(kind: int, body: bytes) -> bytes:
    return bytes([kind]) + struct.pack("<Q", len(body)) + body


class Recording:
    """What is asked for, in order."""

    def __init__(self) -> None:
        self.parts = [MAGIC, _record(1, _text("") + _text("hostile"))]

    def schema(self, data: bytes | None = None) -> Recording:
        """The columns, by default ``time`` alone, and a channel of them."""
        told = json.dumps({"columns": TIME}).encode() if data is None else data
        self.parts.append(_record(3, struct.pack("<H", 1) + _text("n") + _text("nanotouch.columns") + _text(told)))
        self.parts.append(_record(4, struct.pack("<HH", 1, 1) + _text("t") + _text("x") + struct.pack("<I", 0)))
        return self

    def metadata(self, values: Mapping[str, str]) -> Recording:
        """Texts of JSON by their names."""
        body = b"".join(_text(key) + _text(value) for key, value in values.items())
        self.parts.append(_record(12, _text("nanotouch") + struct.pack("<I", len(body)) + body))
        return self

    def chunk(self, compression: str, size: int, data: bytes) -> Recording:
        """Packed records that say how large they are."""
        head = struct.pack("<QQQI", 0, 0, size, 0) + _text(compression) + struct.pack("<Q", len(data))
        self.parts.append(_record(6, head + data))
        return self

    def write(self, path: Path) -> Path:
        """The file."""
        end = _record(15, struct.pack("<I", 0)) + _record(2, struct.pack("<QQI", 0, 0, 0)) + MAGIC
        path.write_bytes(b"".join(self.parts) + end)
        return path
