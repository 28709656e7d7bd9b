# SPDX-License-Identifier: BSD-3-Clause
"""Matrices of text: bare numbers, or under the headers of Gwyddion, SPIP and WSxM, or WSxM's list of points; the first
line of a matrix is the upper edge."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Array, Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "text image (.txt)"
GRID = {
    "head": ["Gwyddion", "none", "free comment", "no unit", "SPIP", "# SPIP", "WSxM matrix", "WSxM points"],
    "damage": ["", "", "cut number", "second matrix", "volts"],
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
BIT_TO_NM = 0.125
REFUSED = {"": "", "cut number": "its last number is cut off", "second matrix": "there are two under one header",
           "volts": "its numbers are in V"}  # fmt: skip
UNITS = {"m": 1.0, "\xb5m": 1e-6, "um": 1e-6, "nm": 1e-9, "\xc5": 1e-10, "A": 1e-10}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = _consistent(chosen(random, GRID, plain))
    ny, nx = shape(random)
    side = float(f"{10 ** random.uniform(-7, -5):.4g}")
    size = (float(f"{side * ny / nx * (1 if c['square'] else 0.5):.4g}"), side)
    unit = UNITS[c["vertical"]]
    values = surface(random, (ny, nx), relief(random, side)) / unit / (BIT_TO_NM if "SPIP" in c["head"] else 1.0)
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
    if c["head"] in ("none", "free comment"):
        given = {"pixel_size": pixel, "z_unit": c["vertical"]}
    if c["head"] == "no unit":
        given = {"z_unit": c["vertical"]}
    scale = BIT_TO_NM if "SPIP" in c["head"] else 1.0
    plane = Plane("height", _scaled(stored, unit * scale), pixel)
    return Made(FORMAT, path, c, Image((plane,)), given=given, must_refuse=REFUSED[c["damage"]])


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
    if "SPIP" in c["head"]:
        c["vertical"] = c["lateral"] = "nm"
    if c["head"].startswith("WSxM"):
        c["missing"] = False
    if c["head"] == "WSxM points":
        c |= {"gap": "\t", "trailing gap": False, "numbers": ".9g", "lateral": "nm", "vertical": "nm"}
    if c["head"] in ("none", "free comment", "no unit", "SPIP", "# SPIP") and c["damage"] == "volts":
        c["damage"] = ""
    if c["head"] == "WSxM points" and c["damage"] != "volts":
        c["damage"] = ""
    if c["damage"] == "cut number":
        fixed = c["numbers"] if c["numbers"] == ".6f" else ".8e"
        c |= {"numbers": fixed, "trailing gap": False, "padding": "none", "empty lines": 0}
    return c | {"mark": c["mark"] and c["encoding"] == "utf-8"}


def _scaled(stored: Array, unit: float) -> Array:
    return stored[::-1] * unit


def _file(c: dict[str, Any], text: list[list[str]], size: tuple[float, float]) -> bytes:
    head = _head(c, size, (len(text), len(text[0])))
    if c["decimals"] == "," and c["head"] not in ("none", "free comment"):
        head = [line.replace(".", ",") for line in head]
    rows = [[number.replace(".", c["decimals"]) for number in row] for row in text]
    if c["head"] == "WSxM points":
        ny, nx = len(rows), len(rows[0])
        steps = size[1] / UNITS["nm"] / nx, size[0] / UNITS["nm"] / ny
        places = [(i, j) for j in range(ny) for i in range(nx)]
        rows = [[f"{n * step:.9g}".replace(".", c["decimals"]) for n, step in zip((i, ny - 1 - j), steps, strict=True)]
                + [rows[j][i]] for i, j in places]  # fmt: skip
    table = [c["gap"].join(row) + (c["gap"] if c["trailing gap"] else "") for row in rows]
    if c["damage"] == "second matrix":
        table += ["", *table]
    lines = [*head, *table, *[""] * (1 + c["empty lines"])]
    words = c["ends"].join(lines)
    if c["damage"] == "cut number":
        words = words.rstrip("\r\n")[:-3]
    if c["encoding"] == "shift-jis":
        words = words.replace("\xb5", "\u03bc")  # Shift-JIS has the Greek letter only
    padding = {"none": b"", "NULs": bytes(512), "end mark of DOS": b"\x1a"}[c["padding"]]
    return words.encode("utf-8-sig" if c["mark"] else c["encoding"]) + padding


def _head(c: dict[str, Any], size: tuple[float, float], shape: tuple[int, int]) -> list[str]:
    height, width = (f"{side / UNITS[c['lateral']]:.6g}" for side in size)
    unit = "V" if c["damage"] == "volts" else c["vertical"]
    gwyddion = ["# Channel: Height", f"# Width: {width} {c['lateral']}", f"# Height: {height} {c['lateral']}"]
    spip = ["File Format = ASCII", "Created by SPIP 6.0.13", "Original file: a.mdt", f"x-pixels = {shape[1]}",
            f"y-pixels = {shape[0]}", f"x-length = {width}", f"y-length = {height}", "x-offset = 0", "y-offset = 0",
            f"Bit2nm = {BIT_TO_NM}", "Voidpixels =0", "Start of Data :"]  # fmt: skip
    wsxm = ["WSxM file copyright UAM"]
    return {
        "Gwyddion": [*gwyddion, f"# Value units: {unit}"],
        "no unit": gwyddion,
        "none": [],
        "free comment": [f"{c['comment']}measured on a wet day", f"{c['comment']}20 \xb5m scanner"],
        "SPIP": spip,
        "# SPIP": [f"# {line}" for line in spip],
        "WSxM matrix": [*wsxm, "WSxM ASCII Matrix file", f"X Amplitude: {width} {c['lateral']}",
                        f"Y Amplitude: {height} {c['lateral']}", f"Z Amplitude: 12.5 {unit}", ""],
        "WSxM points": [*wsxm, "WSxM ASCII XYZ file", f"X[nm]\tY[nm]\tZ[{unit}]", ""],
    }[c["head"]]  # fmt: skip
