# SPDX-License-Identifier: BSD-3-Clause
"""Curves that NT-MDT's Nova exports as text: z [nm] away from the sample, then approach and retraction, both outwards.

The detector's signal is in nA, not in V. Neither sensitivity nor spring constant is stated. The padding at the start of
a branch repeats its first value.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Curve, Curves, Made, Part, Random, chosen, lever, motion

FORMAT = "Nova text curves (.txt)"
GRID = {
    "decimals": [",", "."],
    "gap": ["\t", "  ", ";"],
    "mark": [False, True],
    "ends": ["\r\n", "\n", "\r"],
    "encoding": ["ascii", "utf-16"],
    "padding": ["none", "approach", "both"],
    "trailing": ["", "empty line", "gap"],
    "digits": [6, 4],
    "cut": [0, 1, 3],  # characters of a last row
}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    if c["encoding"] == "utf-16":
        c["mark"] = False
    c["trailing"] = "" if c["cut"] else c["trailing"]
    held = lever(random)  # its sensitivity is in m/nA here; given is m/A
    n = int(random.integers(80, 160))
    moves = motion(random, held, [("approach", 300), ("retract", 300)])
    z = np.linspace(moves[0][1].min(), moves[0][1].max(), n)
    columns = [np.interp(z, part[np.argsort(part)], bend[np.argsort(part)]) for _, part, bend in moves]
    signals = [np.round(bend / held.sensitivity, c["digits"]) for bend in columns]
    padding = {"none": (0, 0), "approach": (7, 0), "both": (9, 4)}[c["padding"]]
    for signal, count in zip(signals, padding, strict=True):
        signal[: count + 1] = signal[count]
    shown = np.round(z * 1e9, 6)
    lines = []
    for row in zip(shown, *signals, strict=True):
        texts = [f"{row[0]:.6f}", *(f"{value:.{c['digits']}f}" for value in row[1:])]
        lines.append(c["gap"].join(texts).replace(".", c["decimals"]) + (c["gap"] if c["trailing"] == "gap" else ""))
    if c["trailing"] == "empty line":
        lines.append("")
    text = c["ends"].join([*lines, lines[-1][: -c["cut"]] if c["cut"] else ""])
    path = folder / "Curve_DFL_Height_51.txt"
    path.write_bytes(text.encode("utf-8-sig" if c["mark"] else c["encoding"]))
    parts = []
    for role, signal, count in zip(("approach", "retract"), signals, padding, strict=True):
        heights, bend = shown[count:] * 1e-9, signal[count:] * held.sensitivity
        turned = slice(None, None, -1) if role == "approach" else slice(None)
        parts.append(Part(role, heights[turned], bend[turned], held.spring_constant * bend[turned]))
    curve = Curve(tuple(parts), held.spring_constant, held.sensitivity * 1e9)
    given: dict[str, Any] = {"spring_constant": held.spring_constant, "sensitivity": held.sensitivity * 1e9}
    told = (("cut off",),) if c["cut"] else ()
    return Made(FORMAT, path, c, Curves((curve,)), given=given, told=told)
