# SPDX-License-Identifier: BSD-3-Clause
"""Digital Surf surfaces (.sur), version 1: a header of 512 bytes, then integers; the first line is the upper edge.

Value = raw x dz in the unit of dz, plus an offset. Points that were not measured hold Zmin - 2.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
from made import Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "Digital Surf image (.sur)"
GRID = {
    "bits": [32, 16],
    "lateral": ["mm", "\xb5m", "nm", "m"],
    "vertical": ["\xb5m", "nm", "mm", "m"],
    "missing": [False, True],
    "offset": [0.0, 1.5],
    "comment": [b"", b"made for a test"],
    "square": [True, False],
    "type": [2, 2, 3, 5],  # surface, binary image, series of surfaces
    "measured": ["Z", "Z", "Height", "Phase", "Intensity"],
    "inversion": [0, 1, 2, 3],
}
UNITS = {"m": 1.0, "mm": 1e-3, "\xb5m": 1e-6, "nm": 1e-9}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    ny, nx = shape(random)
    pitch = 10 ** random.uniform(-8, -6)
    lateral, vertical = UNITS[c["lateral"]], UNITS[c["vertical"]]
    dx = float(np.float32(pitch / lateral))
    dy = dx if c["square"] else float(np.float32(2 * dx))
    spread = relief(random, nx * pitch)
    dz = float(np.float32(spread / 20000 / vertical))
    raw = np.round(surface(random, (ny, nx), spread) / vertical / dz).astype(int)
    low, high = int(raw.min()), int(raw.max())
    offset = float(np.float32(c["offset"] * spread / vertical))
    heights = (raw * dz + offset) * vertical
    if c["missing"]:
        lost = random.random((ny, nx)) < 0.02
        lost[0, 0], lost[2, 1] = False, True
        raw[lost], heights[lost] = low - 2, np.nan
    path = folder / "surface.sur"
    head = _header(c, (ny, nx), (low, high), (dx, dy, dz), offset)
    path.write_bytes(head + c["comment"] + raw[::-1].astype(f"<i{c['bits'] // 8}").tobytes())
    turned = {0: heights, 1: -heights, 2: -heights[:, ::-1], 3: -heights[::-1]}[c["inversion"]]
    plane = Plane("height", turned, (dy * lateral, dx * lateral), free=offset != 0)
    refused = "it is no surface" if c["type"] != 2 else ""
    refused = "it is no height" if c["measured"] in ("Phase", "Intensity") else refused
    return Made(FORMAT, path, c, Image((plane,)), must_refuse=refused)


def _header(
    c: dict[str, Any],
    shape: tuple[int, int],
    limits: tuple[int, int],
    steps: tuple[float, float, float],
    offset: float,
) -> bytes:
    def text(words: str, length: int) -> bytes:
        return words.encode("latin-1")[:length].ljust(length)

    units = [text(c["lateral"], 16), text(c["lateral"], 16), text(c["vertical"], 16)]
    head = b"DIGITAL SURF" + struct.pack("<4h", 0, 1, 1, c["type"]) + text("surface", 30) + text("nobody", 30)
    head += struct.pack("<5h", 0, 6, 1, int(c["missing"]), 1) + bytes(8) + struct.pack("<h", c["bits"])
    head += struct.pack("<5i", *limits, shape[1], shape[0], shape[0] * shape[1]) + struct.pack("<3f", *steps)
    head += text("X", 16) + text("Y", 16) + text(c["measured"], 16) + b"".join(units) + b"".join(units)
    head += struct.pack("<3f", 1, 1, 1) + struct.pack("<3h", 0, c["inversion"], 0) + bytes(12)
    head += struct.pack("<7h", 44, 46, 11, 3, 11, 2022, 4) + struct.pack("<f", 1.0) + bytes(10)
    head += struct.pack("<2h", len(c["comment"]), 0) + bytes(128) + struct.pack("<3f", 0.0, 0.0, offset)
    return head.ljust(512, b"\0")
