# SPDX-License-Identifier: BSD-3-Clause
"""WSxM images (.stp, .top), after real files: a header of sections, then integers or doubles.

The first value is the lower right corner. Doubles are in the unit of ``Z Amplitude``, which also is the range of the
heights; integers span it.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from made import Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "WSxM image (.stp)"
GRID = {
    "stored": ["double", "float", "int16"],
    "unit": ["nm", "\xb5m", "\xc5", "pm"],
    "side": ["nm", "\xb5m", "\xc5", "pm"],
    "size": ["right", "miscounted"],
    "square": [True, False],
    "ending": ["stp", "top"],
    "copyright": ["UAM", "Nanotec Electronica", "WSxM solutions"],
    "encoding": ["latin-1", "utf-8"],
    "current": [False, True],
    "decimals": [".", ","],
}
UNITS = {"nm": 1e-9, "\xb5m": 1e-6, "\xc5": 1e-10, "pm": 1e-12}
STORED = {"double": "<f8", "float": "<f4", "int16": "<i2"}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    ny, nx = shape(random)
    side = 10 ** random.uniform(-8, -5.3)
    size = tuple(
        float(f"{side * n / nx * f / UNITS[c['side']]:.6g}") for n, f in ((ny, 1 if c["square"] else 1.5), (nx, 1))
    )
    unit = UNITS[c["unit"]]
    wished = surface(random, (ny, nx), relief(random, side)) / unit
    if c["stored"] == "int16":
        span = float(f"{np.ptp(wished):.6g}")
        raw = np.round((wished - wished.min()) / np.ptp(wished) * 40000 - 20000)
        heights = raw * span / np.ptp(raw)
    else:
        raw = wished.astype(STORED[c["stored"]])
        heights, span = raw.astype(float), float(np.ptp(raw.astype(float)))
    path = folder / f"image.{c['ending']}"
    head = _header(c, (ny, nx), size, span)
    path.write_bytes(head + raw[:, ::-1].astype(STORED[c["stored"]]).tobytes())
    pixel = tuple(s * UNITS[c["side"]] / n for s, n in zip(size, (ny, nx), strict=True))
    plane = Plane("Topography", heights * unit, pixel, free=c["stored"] == "int16")  # type: ignore[arg-type]
    refused = "the picture is a current" if c["current"] else ""
    return Made(FORMAT, path, c, Image((plane,)), must_refuse=refused)


def _header(c: dict[str, Any], shape: tuple[int, int], size: tuple[float, ...], span: float) -> bytes:
    channel, unit = ("Current", "nA") if c["current"] else ("Topography", c["unit"])
    sections = {
        "Control": {"Set Point": "-0.3727 V", "X Amplitude": f"{size[1]:.9g} {c['side']}", "X Offset": "-712.919 nm",
                    "Y Amplitude": f"{size[0]:.9g} {c['side']}", "Z Gain": 3},
        "General Info": {"Acquisition channel": channel, "Acquisition time": "03/11/2011, 20:23:46.484",
                         "Head type": "AFM", "Image Data Type": c["stored"], "Number of columns": shape[1],
                         "Number of rows": shape[0], "Z Amplitude": f"{span:.12g} {unit}"},
        "Head Settings": {"X Calibration": "1829.09 \xc5/V"},
        "Miscellaneous": {"Comments": "GO", "Version": "1.0 (April 2000)"},
    }  # fmt: skip
    if c["stored"] == "int16":
        del sections["General Info"]["Image Data Type"]
    lines = []
    for name, fields in sections.items():
        told = {key: re.sub(r"^(-?\d+)\.(\d+(?: \S+)?)$", rf"\1{c['decimals']}\2", str(v)) for key, v in fields.items()}
        lines += [f"[{name}]", "", *(f"    {key}: {value}" for key, value in told.items()), ""]
    body = "\r\n".join([*lines, "[Header end]", ""])
    start = f"WSxM file copyright {c['copyright']}\r\nSxM Image file\r\nImage header size: "
    total = len((start + "0000\r\n\r\n" + body).encode(c["encoding"]))
    stated = total if c["size"] == "right" else total + 3
    return (start + f"{stated:04d}\r\n\r\n" + body).encode(c["encoding"])
