# SPDX-License-Identifier: BSD-3-Clause
"""Bare arrays in HDF5: pictures [row, column] from the top, without a size or a unit."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
from made import Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "HDF5 image (.h5)"
GRID = {
    "stored": ["<f8", "<f4", ">f8", ">f4", "<i4"],
    "name": ["height", "data", "image", "group/height"],
    "packed": [None, "gzip", "lzf"],
    "missing": [False, True],
    "vector beside": [False, True],
    "text beside": [False, True],
    "unit": ["nm", "um", "m"],
}
UNITS = {"m": 1.0, "um": 1e-6, "nm": 1e-9}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    if c["stored"] == "<i4":
        c |= {"missing": False, "unit": "nm"}
    pixels = shape(random)
    unit = UNITS[c["unit"]]
    pixel = tuple(float(f"{p:.4g}") for p in 10 ** random.uniform(-9, -7, 2))
    spread = relief(random, pixels[1] * pixel[1])
    values = (surface(random, pixels, max(spread, 1e-7) if c["stored"] == "<i4" else spread) / unit).astype(c["stored"])
    if c["missing"]:
        values[0, 1] = values[3, 2] = np.nan
    path = folder / "array.h5"
    with h5py.File(path, "w") as file:
        file.create_dataset(c["name"], data=values[::-1], compression=c["packed"], chunks=True if c["packed"] else None)
        if c["vector beside"]:
            file["time"] = np.arange(5.0)
        if c["text beside"]:
            file["comment"] = "20 \xb5m"
    plane = Plane("height", values.astype(float) * unit, pixel)  # type: ignore[arg-type]
    return Made(FORMAT, path, c, Image((plane,)), given={"pixel_size": pixel, "z_unit": c["unit"]})
