# SPDX-License-Identifier: BSD-3-Clause
"""Igor binary waves of version 5, after WaveMetrics' technical note 003: two headers, data by columns, note, labels."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any

import numpy as np

HEADERS = 64 + 320
TYPES = {"f4": 2, "f8": 4, "i2": 0x10, "i4": 0x20}


def wave(
    data: Any,
    note: bytes,
    *,
    name: str = "wave0",
    steps: Sequence[float] = (1.0, 1.0),
    units: Sequence[str] = ("", ""),
    unit: str = "",
    labels: Sequence[str] = (),
    dimension: int = 2,
    big: bool = False,
) -> bytes:
    """The bytes of one wave; `labels` of the columns or layers of `dimension`."""
    order = ">" if big else "<"
    kind = data.dtype.str[1:]
    values = data.astype(f"{order}{kind}").tobytes(order="F")
    named = b"".join(label.encode().ljust(32, b"\0") for label in ("", *labels)) if labels else b""
    sizes = [0, 0, 0, 0]
    sizes[dimension] = len(named)
    shape = [*data.shape, 0, 0, 0, 0][:4]
    pitch = [*steps, 1.0, 1.0, 1.0, 1.0][:4]
    axes = b"".join(axis.encode("latin-1").ljust(4, b"\0") for axis in [*units, "", "", "", ""][:4])
    head = struct.pack(f"{order}hhiiii4i4iiii", 5, 0, 320 + len(values), 0, len(note), 0, 0, 0, 0, 0, *sizes, 0, 0, 0)
    body = struct.pack(f"{order}iIIihh6xh32sii", 0, 3663744449, 3663744451, data.size, TYPES[kind], 0, 1,
                       name.encode(), 0, 0)  # fmt: skip
    body += struct.pack(f"{order}4i4d4d", *shape, *pitch, 0.0, 0.0, 0.0, 0.0)
    body += unit.encode("latin-1").ljust(4, b"\0") + axes
    body = body.ljust(320, b"\0")
    words = np.frombuffer(head + body, f"{order}i2")
    total = -int(words.astype(np.int64).sum()) & 0xFFFF
    checksum = struct.pack(f"{order}H", total)
    return head[:2] + checksum + head[4:] + body + values + note + named


def note(lines: dict[str, Any], encoding: str = "latin-1") -> bytes:
    return "".join(f"{key}: {value}\r" for key, value in lines.items()).encode(encoding)
