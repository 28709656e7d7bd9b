# SPDX-License-Identifier: BSD-3-Clause
"""Nanosurf scans (.nid), after real files: sections of text, ``#!``, then the channels in the order of the groups.

Value = (raw + half the range of the integer) / range x Dim2Range + Dim2Min; the first line is the lower edge.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Image, Made, Plane, Random, chosen, shape, surface

FORMAT = "Nanosurf image (.nid)"
GRID = {
    "bits": [16, 32, 8],
    "order of bytes": ["Intel", "Motorola"],
    "channels": ["Z-Axis", "Deflection Z-Axis", "Deflection Z-Axis Z-AxisSensor", "Amplitude Z-Axis Phase"],
    "groups": ["forward backward", "backward forward", "forward"],
    "encoding": ["latin-1", "utf-8", "shift-jis"],
    "square": [True, False],
    "minimum": ["symmetric", "shifted"],
    "missing section": [False, True],
    "unsigned beside": [False, True],
    "numbers": ["e-05", "e-005"],
}
ORDERS = {"Intel": "<", "Motorola": ">"}
KINDS = {
    "Z-Axis": (1, "m"),
    "Deflection": (0, "N"),
    "Z-AxisSensor": (7, "m"),
    "Amplitude": (2, "V"),
    "Phase": (3, "\xb0"),
}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    ny, nx = shape(random)
    side = float(f"{10 ** random.uniform(-6, -4.3):.4g}")
    size = (side * (1 if c["square"] else 0.5), side)
    pixel = (size[0] / ny, size[1] / nx)
    full = float(f"{10 ** random.uniform(-6, -4.7):.4g}")
    low = -full / 2 if c["minimum"] == "symmetric" else float(f"{-0.3 * full:.6g}")
    names = sorted(c["channels"].split(), key=lambda name: KINDS[name][0])
    head, sections, data, planes = [f"GroupCount={len(c['groups'].split())}"], [], b"", []
    for group, direction in enumerate(c["groups"].split()):
        head += [f"Gr{group}-Name=Scan {direction}", f"Gr{group}-ID={group}", f"Gr{group}-Count=21"]
        for name in names:
            number, unit = KINDS[name]
            head.append(f"Gr{group}-Ch{number}=DataSet-{group}:{number}")
            spread = 0.1 * full
            wished = surface(random, (ny, nx), spread)
            raw = np.round((wished - low) / full * 2 ** c["bits"] - 2 ** (c["bits"] - 1))
            data += raw.astype(f"{ORDERS[c['order of bytes']]}i{c['bits'] // 8}").tobytes()
            if unit == "m":
                heights = (raw + 2 ** (c["bits"] - 1)) / 2 ** c["bits"] * full + low
                planes.append((name, Plane(name, heights, pixel, direction == "forward")))
            sections.append(_section(c, f"{group}:{number}", direction, name, unit, (ny, nx), size, (full, low)))
        if c["unsigned beside"] and group == 0:
            head.append("Gr0-Ch8=DataSet-0:8")
            text = _section(c, "0:8", direction, "Friction force", "V", (ny, nx), size, (10.0, -5.0))
            sections.append(text.replace("SaveSign=Signed", "SaveSign=Unsigned"))
            data += bytes(ny * nx * c["bits"] // 8)
        if c["missing section"]:
            head.append(f"Gr{group}-Ch9=DataSet-{group}:9")
    path = folder / "image.nid"
    lines = [
        "[DataSet]",
        "Version=2",
        *head,
        "SetInfos=DataSet-Info",
        "",
        *_info(side, ny, nx),
        *sections,
        "[ProcessorSet]",
    ]
    text = "\r\n".join("\n".join([*lines, "ProcessorCount=0", "", "", ""]).split("\n"))
    path.write_bytes(text.encode(c["encoding"], "replace") + b"#!" + data)
    return Made(FORMAT, path, c, Image(*_ranked(planes)))


def _ranked(planes: list[tuple[str, Plane]]) -> tuple[tuple[Plane, ...], tuple[Plane, ...]]:
    forward = [(name, plane) for name, plane in planes if plane.trace] or planes
    best = [plane for name, plane in forward if name == "Z-AxisSensor"] or [plane for _, plane in forward]
    return tuple(best), tuple(plane for _, plane in planes if all(plane is not other for other in best))


def _info(side: float, ny: int, nx: int) -> list[str]:
    return ["[DataSet-Info]", "-- Scan --=--------", f"Image size={side * 1e6:.4g}\xb5m", "Scan direction=Up",
            f"Points={nx} ", f"Lines={ny} ", "Rotation=0 \xb0", "Date=01-03-2016", "Time=18:36:58", ""]  # fmt: skip


def _section(
    c: dict[str, Any],
    number: str,
    direction: str,
    name: str,
    unit: str,
    shape: tuple[int, int],
    size: tuple[float, float],
    values: tuple[float, float],
) -> str:
    if unit != "m":
        values = (10.0, -5.0)
    fields = {
        "Version": 2,
        "Points": shape[1],
        "Lines": shape[0],
        "Frame": f"Scan {direction}",
        "CurLine": shape[0] - 1,
    }
    axes = (("X*", "m", size[1], 0.0), ("Y*", "m", size[0], 0.0), (name, unit, *values))
    for axis, (title, in_unit, spread, least) in enumerate(axes):
        fields |= {f"Dim{axis}Name": title, f"Dim{axis}Unit": in_unit}
        fields |= {f"Dim{axis}Range": _number(c, spread), f"Dim{axis}Min": _number(c, least)}
    fields |= {"SaveMode": "Binary", "SaveBits": c["bits"], "SaveSign": "Signed", "SaveOrder": c["order of bytes"]}
    return "\n".join([f"[DataSet-{number}]", *(f"{key}={value}" for key, value in fields.items()), ""])


def _number(c: dict[str, Any], value: float) -> str:
    text = f"{value:.10g}"
    return text.replace("e-0", "e-00") if c["numbers"] == "e-005" else text
