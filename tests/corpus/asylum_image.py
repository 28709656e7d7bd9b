# SPDX-License-Identifier: BSD-3-Clause
"""Asylum Research images: Igor waves of (x, y, channel), the first line at the lower edge, with labels and a note.

The pitch of the wave, scan size over N - 1, is kept as the pixel's size.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from igor_wave import note, wave
from made import Image, Made, Plane, Random, chosen, relief, shape, surface

FORMAT = "Asylum image (.ibw)"
GRID = {
    "channels": [
        "HeightTrace HeightRetrace AmplitudeTrace PhaseTrace",
        "HeightRetrace HeightTrace",
        "AmplitudeTrace HeightTrace ZSensorTrace",
        "DeflectionRetrace HeightRetrace",
        "UserIn0Trace ZSensorRetrace HeightTrace",
        "HeightTrace HeightTraceMod0",
        "Height",
        "MapHeight MapAdhesion",
    ],
    "encoding": ["latin-1", "utf-8", "shift-jis"],
    "stopped": ["", "", "NaN"],
    "stored": ["f4", "f8"],
    "big": [False, True],
    "down": [False, True],
    "square": [True, False],
    "unit": ["m", "", "V"],
}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    ny, nx = shape(random)
    dx = float(f"{10 ** random.uniform(-9, -7):.4g}")
    dy = dx if c["square"] else 2.5 * dx
    names = c["channels"].split()
    layers, planes = [], {}
    for name in names:
        heights = surface(random, (ny, nx), relief(random, dx * nx))
        if c["stopped"]:
            done = max(3, int(ny * random.uniform(0.4, 0.9)))
            heights[: ny - done] = np.nan if c["down"] else heights[: ny - done]
            heights[done:] = heights[done:] if c["down"] else np.nan
        stored = heights.astype(c["stored"])
        layers.append(stored.T)
        if name.startswith(("Height", "ZSensor", "MapHeight")):
            planes[name] = Plane(name, stored.astype(float), (dy, dx), "Retrace" not in name)
    text = note(_note(c, (ny, nx), (dy, dx)), c["encoding"]).replace(b"##", "\xb5".encode(c["encoding"], "replace"))
    data = np.stack(layers, axis=2)
    path = folder / "image.ibw"
    path.write_bytes(
        wave(data, text, name="image0000", steps=(dx, dy), units=("m", "m"), unit=c["unit"], labels=names, big=c["big"])
    )
    best, others = _ranked(planes)
    told = (("missing", "line", "row"),) if c["stopped"] else ()
    refused = "its numbers are in V" if c["unit"] == "V" else ""
    return Made(FORMAT, path, c, Image(best, others), told=told, must_refuse=refused)


def _ranked(planes: dict[str, Plane]) -> tuple[tuple[Plane, ...], tuple[Plane, ...]]:
    plain = {name: plane for name, plane in planes.items() if "Mod" not in name}
    sensor = [plane for name, plane in plain.items() if name.startswith("ZSensor")]
    traces = [plane for plane in plain.values() if plane.trace] or list(plain.values())
    best = [plane for plane in sensor if plane.trace] or [*sensor, *traces]
    return tuple(best), tuple(plane for plane in planes.values() if all(plane is not other for other in best))


def _note(c: dict[str, Any], shape: tuple[int, int], pitch: tuple[float, float]) -> dict[str, Any]:
    ny, nx = shape
    fast, slow = (nx - 1) * pitch[1], (ny - 1) * pitch[0]
    return {
        "ScanSize": f"{max(fast, slow):.5g}",
        "FastScanSize": f"{fast:.5g}",
        "SlowScanSize": f"{slow:.5g}",
        "ScanRate": 1.0016,
        "PointsLines": nx,
        "ScanPoints": nx,
        "ScanLines": ny,
        "ScanAngle": 0,
        "ImagingMode": "AC Mode",
        "InvOLS": 1e-7,
        "SpringConstant": 1,
        "ScanDown": int(c["down"]),
        "ImageNote": "## 20 ##m",
    }
