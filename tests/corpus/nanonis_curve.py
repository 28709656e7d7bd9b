# SPDX-License-Identifier: BSD-3-Clause
"""Nanonis spectra over z (.dat), after SPECS' description: tagged lines, ``[DATA]``, a line of names, columns.

``Z rel (m)`` grows away from the sample; ``[bwd]`` columns belong to the same z, and were measured on the way back.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Array, Curve, Curves, Made, Part, Random, chosen, lever, motion

FORMAT = "Nanonis curves (.dat)"
GRID = {
    "quantity": ["Force (N)", "Deflection (m)"],
    "begins": ["far", "near"],
    "backward": [True, False],
    "z": ["Z rel (m)", "Z (m)"],
    "current beside": [False, True],
    "ends": ["\r\n", "\n"],
    "mark": [False, True],
    "encoding": ["utf-8", "latin-1", "shift-jis"],
    "tail": ["", "NaN"],
    "decimals": [".", ","],
    "cut": [0, 2, 5, 9],  # characters of a last row
}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    if c["encoding"] != "utf-8":
        c["mark"] = False
    c["tail"] = "" if c["cut"] else c["tail"]
    held = lever(random)
    n = int(random.integers(80, 160))
    approach, retract = motion(random, held, [("approach", 300), ("retract", 300)])
    z = np.round(np.linspace(approach[1].max(), approach[1].min(), n), 13)
    by_force = c["quantity"].startswith("Force")
    scale = held.spring_constant if by_force else 1.0
    columns = {"approach": _column(approach, z, scale), "retract": _column(retract, z, scale)}
    order = ["approach", "retract"] if c["begins"] == "far" else ["retract", "approach"]
    if c["begins"] == "near":
        z = z[::-1]
        columns = {role: values[::-1] for role, values in columns.items()}
    path = folder / "Z-Spectroscopy001.dat"
    path.write_bytes(_file(c, z, columns, order))
    parts = []
    for role, turned in zip(order, (slice(None), slice(None, None, -1)), strict=True):
        if role == order[1] and not c["backward"]:
            continue
        values = columns[role][turned]
        force, bend = (values, None) if by_force else (held.spring_constant * values, values)
        parts.append(Part(role, z[turned], bend, force))
    given = {} if by_force else {"spring_constant": held.spring_constant}
    curve = Curve(tuple(parts), None if by_force else held.spring_constant, None)
    told = (("cut off",),) if c["cut"] else ()
    return Made(FORMAT, path, c, Curves((curve,)), given=given, told=told)


def _column(move: tuple[str, Array, Array], z: Array, scale: float) -> Array:
    outwards = np.argsort(move[1])
    values = scale * np.interp(z, move[1][outwards], move[2][outwards])
    return np.array([float(f"{value:.6E}") for value in values])


def _file(c: dict[str, Any], z: Array, columns: dict[str, Array], order: list[str]) -> bytes:
    head = [
        "Experiment\tZ spectroscopy\t",
        "Saved Date\t16.12.2015 11:39:44\t",
        "User\tm\xfcller\t",
        "X (m)\t-3.3351E-7\t",
        "Y (m)\t-3.125E-7\t",
        "Z (m)\t-2.18616E-8\t",
        "Filter type\tnone\t",
        "",
        "[DATA]",
    ]
    names = [c["z"], c["quantity"]]
    table = [z, columns[order[0]]]
    kind, _, unit = c["quantity"].partition(" ")
    if c["backward"]:
        names.append(f"{kind} [bwd] {unit}")
        table.append(columns[order[1]])
    if c["current beside"]:
        names.insert(1, "Current (A)")
        table.insert(1, np.full(len(z), 1e-12))
    lines = [*head, "\t".join(names)]
    lines += [
        "\t".join(f"{value:.6E}" if k else f"{value:.12E}" for k, value in enumerate(row))
        for row in zip(*table, strict=True)
    ]
    if c["tail"]:
        lines += ["\t".join(["NaN"] * len(names))] * 3
    if c["cut"]:
        lines.append(lines[-1][: -c["cut"]])
    lines = [*lines[: len(head)], *(line.replace(".", c["decimals"]) for line in lines[len(head) :])]
    text = c["ends"].join(lines if c["cut"] else [*lines, ""])
    return text.encode("utf-8-sig" if c["mark"] else c["encoding"], "replace")
