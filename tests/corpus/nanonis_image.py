# SPDX-License-Identifier: BSD-3-Clause
"""Nanonis scans (.sxm), after SPECS' description and a real file: tags, 0x1A 0x04, big-endian floats.

The first line of an ``up`` scan is the lower edge, of a ``down`` scan the upper. ``both`` means forward, then backward,
which is stored from right to left. Lines that were not scanned are NaN.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Array, Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "Nanonis image (.sxm)"
GRID = {
    "direction": ["both", "both", "forward", "backward"],
    "name": ["Z", "[P1]_Z"],
    "order of bytes": ["MSBFIRST", "LSBFIRST"],
    "scan": ["up", "down"],
    "stopped": [False, False, True],
    "order": ["Z first", "Z last"],
    "square": [True, False],
    "ends": ["\n", "\r\n"],
    "comment": ["", "\xb5m", "decimal commas"],
    "encoding": ["latin-1", "utf-8", "shift-jis"],
    "spaces": ["\t", "  "],
    "angle": [0.0, 30.0],
}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    ny, nx = shape(random)
    pixel = float(f"{10 ** random.uniform(-10, -8):.4g}")
    size = (ny * pixel * (1 if c["square"] else 1.6), nx * pixel)
    step = (size[0] / ny, size[1] / nx)
    done = max(3, int(ny * random.uniform(0.4, 0.9))) if c["stopped"] else ny
    info, data, planes = [], b"", []
    channels = ["Z", "Current", "Phase"] if c["order"] == "Z first" else ["Current", "Phase", "Z"]
    for number, name in enumerate(channels):
        info.append(
            [
                str(number),
                c["name"] if name == "Z" else name,
                {"Z": "m", "Current": "A"}.get(name, "deg"),
                c["direction"],
                "1.000E+0",
                "0.000E+0",
            ]
        )
        for forward in {"both": (True, False), "forward": (True,), "backward": (False,)}[c["direction"]]:
            heights = surface(random, (ny, nx), relief(random, size[1]))
            lower = c["scan"] == "up"
            heights[done:] = np.nan if lower else heights[done:]
            heights[: ny - done] = heights[: ny - done] if lower else np.nan
            stored = heights.astype(">f4" if c["order of bytes"] == "MSBFIRST" else "<f4")
            data += _scanned(stored, lower, forward).tobytes()
            if name == "Z":
                planes.append(Plane("Z", stored.astype(float), step, forward))
    path = folder / "image.sxm"
    path.write_bytes(_header(c, (ny, nx), size, info) + data)
    told = (("missing", "line", "row"),) if c["stopped"] else ()
    return Made(FORMAT, path, c, Image((planes[0],), tuple(planes[1:])), told=told)


def _scanned(heights: Any, lower: bool, forward: bool) -> Any:
    rows: Array = heights if lower else heights[::-1]
    return rows if forward else rows[:, ::-1]


def _header(c: dict[str, Any], shape: tuple[int, int], size: tuple[float, float], info: list[list[str]]) -> bytes:
    ny, nx = shape
    gap = c["spaces"]
    tags = {
        "NANONIS_VERSION": ["2"],
        "SCANIT_TYPE": ["              FLOAT            " + c["order of bytes"]],
        "REC_DATE": [" 16.12.2015"],
        "REC_TIME": ["11:39:44"],
        "REC_TEMP": ["      290.0000000000"],
        "ACQ_TIME": ["      3201.9"],
        "SCAN_PIXELS": [f"       {nx}       {ny}"],
        "SCAN_FILE": ["C:\\AFM\\_data\\A151216.123306-02602.sxm"],
        "SCAN_TIME": ["             2.001E+1             5.002E+0"],
        "SCAN_RANGE": [f"           {size[1]:.6E}           {size[0]:.6E}"],
        "SCAN_OFFSET": ["             -3.335099E-7         -3.124986E-7"],
        "SCAN_ANGLE": [f"            {c['angle']:.3E}"],
        "SCAN_DIR": [c["scan"]],
        "BIAS": ["            -9.000E-4"],
        "COMMENT": [c["comment"]],
        "Ext. VI 1>Temperature (V)": ["1,5951E+0" if c["comment"] == "decimal commas" else "1.5951E+0"],
        "Z-Controller>Z (m)": ["-21.8616E-9"],
        "DATA_INFO": [
            gap.join(["", *row]) for row in [["Channel", "Name", "Unit", "Direction", "Calibration", "Offset"], *info]
        ],
    }
    lines = [line for tag, values in tags.items() for line in (f":{tag}:", *values)]
    text = c["ends"].join([*lines, "", ":SCANIT_END:", "", "", ""])
    return text.encode(c["encoding"], "replace") + b"\x1a\x04"
