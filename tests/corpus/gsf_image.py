# SPDX-License-Identifier: BSD-3-Clause
"""Gwyddion Simple Field (.gsf), after its description: a header of text, 1 to 4 NULs, floats from the upper edge."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from made import Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "Gwyddion simple field (.gsf)"
GRID = {
    "title": ["Height", "", "Topography trace", "Phase", "Amplitude error"],
    "vertical": ["m", "nm", "\xb5m", "V", ""],
    "lateral": ["m", "\xb5m", "nm"],
    "square": [True, False],
    "missing": [False, True],
    "length": ["right", "cut", "longer"],
}
UNITS = {"m": 1.0, "\xb5m": 1e-6, "nm": 1e-9, "": 1e-9, "V": 1.0}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    ny, nx = shape(random)
    side = 10 ** random.uniform(-8, -5)
    size = float(f"{side * ny / nx * (1 if c['square'] else 1.5):.6g}"), float(f"{side:.6g}")
    values = (surface(random, (ny, nx), relief(random, side)) / UNITS[c["vertical"]]).astype("<f4")
    if c["missing"]:
        values[1, 2] = values[3, 4] = np.nan
    facts = {"XRes": nx, "YRes": ny} | {
        f"{axis}Real": repr(length / UNITS[c["lateral"]]) for axis, length in zip("YX", size, strict=True)
    }
    facts |= {"XYUnits": c["lateral"], "ZUnits": c["vertical"], "Title": c["title"]}
    header = "".join(f"{key} = {value}\n" for key, value in facts.items() if value != "")
    head = f"Gwyddion Simple Field 1.0\n{header}".encode()
    data = values[::-1].tobytes()
    data = {"right": data, "cut": data[:-4], "longer": data + bytes(4 * nx)}[c["length"]]
    path = folder / "field.gsf"
    path.write_bytes(head + bytes(4 - len(head) % 4) + data)
    plane = Plane("height", values.astype(float) * UNITS[c["vertical"]], (size[0] / ny, size[1] / nx))
    reasons = ["its numbers are in V"] if c["vertical"] == "V" else []
    reasons += ["it is no height"] if c["title"] in ("Phase", "Amplitude error") else []
    reasons += ["its length is wrong"] if c["length"] != "right" else []
    given = {} if c["vertical"] else {"z_unit": "nm"}
    return Made(FORMAT, path, c, Image((plane,)), given=given, must_refuse=" and ".join(reasons))
