# SPDX-License-Identifier: BSD-3-Clause
"""Matrices of text: bare numbers, or under the comments that Gwyddion writes; the first line is the upper edge."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Array, Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "text image (.txt)"
GRID = {
    "head": ["Gwyddion", "none", "free comment"],
    "gap": ["\t", " ", ";", ",", "  "],
    "decimals": [".", ","],
    "mark": [False, True],
    "ends": ["\n", "\r\n", "\r"],
    "encoding": ["utf-8", "latin-1", "utf-16", "shift-jis"],
    "lateral": ["\xb5m", "nm", "um", "m"],
    "vertical": ["nm", "\xb5m", "m", "\xc5"],
    "numbers": [".8e", ".6f", ".9g", ".0f"],
    "comment": ["# ", "#", "% "],
    "missing": [False, True],
    "square": [True, False],
    "trailing gap": [False, True],
    "empty lines": [0, 1],
    "padding": ["none", "NULs", "end mark of DOS"],
    "ending": ["txt", "asc", "csv", "dat"],
}
UNITS = {"m": 1.0, "\xb5m": 1e-6, "um": 1e-6, "nm": 1e-9, "\xc5": 1e-10, "A": 1e-10}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = _consistent(chosen(random, GRID, plain))
    ny, nx = shape(random)
    side = float(f"{10 ** random.uniform(-7, -5):.4g}")
    size = (float(f"{side * ny / nx * (1 if c['square'] else 0.5):.4g}"), side)
    unit = UNITS[c["vertical"]]
    values = surface(random, (ny, nx), relief(random, side)) / unit
    if c["missing"]:
        values[1, 2] = values[3, 0] = np.nan
    if c["numbers"] in (".6f", ".0f") and np.nanmax(np.abs(values)) < (0.1 if c["numbers"] == ".6f" else 100):
        c["numbers"] = ".8e"
    text = [[format(value, c["numbers"]) for value in row] for row in values]
    stored = np.array(text, float)
    pixel = (size[0] / ny, size[1] / nx)
    path = folder / f"matrix.{c['ending']}"
    path.write_bytes(_file(c, text, size))
    given: dict[str, Any] = {}
    if c["head"] != "Gwyddion":
        given = {"pixel_size": pixel, "z_unit": c["vertical"]}
    plane = Plane("height", _scaled(stored, unit), pixel)
    return Made(FORMAT, path, c, Image((plane,)), given=given)


def _consistent(c: dict[str, Any]) -> dict[str, Any]:
    if c["decimals"] == "," and c["gap"] == ",":
        c["gap"] = ";"
    if c["encoding"] == "shift-jis" and "\xc5" in (c["vertical"], c["lateral"]):
        c["encoding"] = "utf-8"
    if c["head"] == "none":
        c["encoding"] = "utf-8" if c["encoding"] != "utf-16" else "utf-16"
        c["vertical"] = {"\xb5m": "um", "\xc5": "A"}.get(c["vertical"], c["vertical"])
    elif c["head"] == "free comment":
        c["vertical"] = {"\xb5m": "um", "\xc5": "A"}.get(c["vertical"], c["vertical"])
    if c["encoding"] == "utf-16":
        c["padding"] = "none"
    return c | {"mark": c["mark"] and c["encoding"] == "utf-8"}


def _scaled(stored: Array, unit: float) -> Array:
    return stored[::-1] * unit


def _file(c: dict[str, Any], text: list[list[str]], size: tuple[float, float]) -> bytes:
    lateral = UNITS[c["lateral"]]
    lines = {
        "Gwyddion": [
            "# Channel: Height",
            f"# Width: {size[1] / lateral:.6g} {c['lateral']}",
            f"# Height: {size[0] / lateral:.6g} {c['lateral']}",
            f"# Value units: {c['vertical']}",
        ],
        "none": [],
        "free comment": [f"{c['comment']}measured on a wet day", f"{c['comment']}20 \xb5m scanner"],
    }[c["head"]]
    for row in text:
        numbers = [number.replace(".", c["decimals"]) for number in row]
        lines.append(c["gap"].join(numbers) + (c["gap"] if c["trailing gap"] else ""))
    lines += [""] * (1 + c["empty lines"])
    words = c["ends"].join(lines)
    if c["head"] == "Gwyddion" and c["decimals"] == ",":
        head, _, rest = words.partition(c["vertical"] + c["ends"])
        words = head.replace(".", ",") + c["vertical"] + c["ends"] + rest
    if c["encoding"] == "shift-jis":
        words = words.replace("\xb5", "\u03bc")  # Shift-JIS has the Greek letter only
    padding = {"none": b"", "NULs": bytes(512), "end mark of DOS": b"\x1a"}[c["padding"]]
    return words.encode("utf-8-sig" if c["mark"] else c["encoding"]) + padding
