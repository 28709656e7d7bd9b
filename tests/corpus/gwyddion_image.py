# SPDX-License-Identifier: BSD-3-Clause
"""Gwyddion's own files (.gwy), after the description in its user guide: nested components, little-endian.

The first line is the upper edge; units are SI without prefixes; a mask marks pixels.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import numpy as np
from made import Array, Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "Gwyddion image (.gwy)"
GRID = {
    "channels": ["Height", "Height Phase", "Amplitude Height", "Height Retrace", "Phase ZSensor Height"],
    "numbers": ["from 0", "gaps"],
    "title": ["stated", "missing"],
    "unit": ["m", "missing"],
    "lateral": ["m", "missing"],
    "square": [True, False],
    "mask": [False, True],
    "offset": [0.0, 3e-6],
    "graph beside": [False, True],
    "broken beside": [False, True],
    "meta": [False, True],
}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    if c["unit"] != "m":
        c["title"] = "stated"
    ny, nx = shape(random)
    side = float(f"{10 ** random.uniform(-7, -5):.4g}")
    size = (side * ny / nx * (1 if c["square"] else 0.6), side)
    items, planes = b"", []
    for number, name in enumerate(c["channels"].split()):
        key = number if c["numbers"] == "from 0" else 3 * number + 2
        heights = surface(random, (ny, nx), relief(random, side))
        high = name in ("Height", "Retrace", "ZSensor")
        unit = ("m" if c["unit"] == "m" else "") if high else {"Phase": "deg"}.get(name, "V")
        items += _object(f"/{key}/data", _field(heights[::-1], size, unit, c))
        title = {"Retrace": "Height (retrace)"}.get(name, name)
        if c["title"] == "stated":
            items += _text(f"/{key}/data/title", title)
        lost = np.zeros((ny, nx), bool)
        if c["mask"] and high:
            lost = random.random((ny, nx)) < 0.03
            items += _object(f"/{key}/mask", _field(lost[::-1].astype(float), size, "", c))
        if c["meta"]:
            items += _object(f"/{key}/meta", _component("GwyContainer", _text("Comment", "20 \xb5m")))
        if high:
            planes.append(Plane(title, np.where(lost, np.nan, heights), (size[0] / ny, size[1] / nx), _trace(c, title)))
    if c["graph beside"]:
        items += _object("/0/graph/graph/1", _component("GwyGraphModel", _text("title", "Profile 1")))
    if c["broken beside"]:
        items += _object("/90/data", _component("GwyDataField", _number("xres", "i", 5) + _number("yres", "i", 5)))
    path = folder / "image.gwy"
    path.write_bytes(b"GWYP" + _component("GwyContainer", items))
    best = [p for p in planes if p.name == "ZSensor" and p.trace] or [p for p in planes if p.trace is not False]
    given = {} if c["unit"] == "m" else {"z_unit": "m", "channel": best[0].name}
    if c["lateral"] != "m":
        given["pixel_size"] = (size[0] / ny, size[1] / nx)
    told = (("90", "left out", "broken"),) if c["broken beside"] else ()
    return Made(
        FORMAT, path, c, Image(tuple(best), tuple(p for p in planes if all(p is not b for b in best))), given, told
    )


def _trace(c: dict[str, Any], title: str) -> bool | None:
    return None if c["title"] == "missing" else "retrace" not in title


def _field(data: Array, size: tuple[float, float], unit: str, c: dict[str, Any]) -> bytes:
    ny, nx = data.shape
    inside = _number("xres", "i", nx) + _number("yres", "i", ny)
    inside += _number("xreal", "d", size[1]) + _number("yreal", "d", size[0])
    inside += _number("xoff", "d", c["offset"]) + _number("yoff", "d", -c["offset"])
    lateral = "m" if c["lateral"] == "m" else ""
    inside += _object("si_unit_xy", _component("GwySIUnit", _text("unitstr", lateral)))
    inside += _object("si_unit_z", _component("GwySIUnit", _text("unitstr", unit)))
    numbers = data.astype("<f8")
    inside += b"data\0D" + struct.pack("<I", numbers.size) + numbers.tobytes()
    return _component("GwyDataField", inside)


def _component(kind: str, inside: bytes) -> bytes:
    return kind.encode() + b"\0" + struct.pack("<I", len(inside)) + inside


def _object(key: str, component: bytes) -> bytes:
    return key.encode() + b"\0o" + component


def _text(key: str, words: str) -> bytes:
    return key.encode() + b"\0s" + words.encode() + b"\0"


def _number(key: str, kind: str, value: float) -> bytes:
    return key.encode() + b"\0" + kind.encode() + struct.pack(f"<{kind}", value)
