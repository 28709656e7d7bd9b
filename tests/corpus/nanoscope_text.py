# SPDX-License-Identifier: BSD-3-Clause
"""Ramps that NanoScope Analysis exports as text: the header in quotes, a line of names, columns of both ways in the
order of time; or a branch that was marked and copied, two columns under their units.

Ex is the extension of the piezo. Where a ramp ended early, the far end of the approach holds the lowest integer.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Array, Curve, Curves, Lever, Made, Part, Random, chosen, lever, motion

FORMAT = "NanoScope text curves (.txt)"
GRID = {
    "header": [True, False],
    "quoted": [False, True],
    "table": ["both ways", "copied approach", "copied retraction"],
    "signal": ["pN", "nN", "nm", "V"],
    "height": ["Calc_Ramp_{}_nm", "Calc_Ramp_{}_um", "Height_Sensor_nm_{}", "Ramp_nm_{}"],
    "counts": ["towards the sample", "away from it"],
    "decimals": [".", ","],
    "ends": ["\r\n", "\n"],
    "encoding": ["latin-1", "utf-8", "utf-16"],
    "trailing gap": [False, True],
    "fillers": [0, 6],
    "cut": [0, 3],  # characters of a last row
}
VOLTS = 0.000375  # [V/LSB]
UNITS = {"pN": 1e-12, "nN": 1e-9, "nm": 1e-9, "V": 1.0}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = chosen(random, GRID, plain)
    held = lever(random)
    copied = c["table"] != "both ways"
    if copied:
        c |= {
            "header": False,
            "fillers": 0,
            "trailing gap": False,
            "height": c["height"].replace("Height_Sensor", "Ramp"),
        }
        c["signal"] = {"V": "nm"}.get(c["signal"], c["signal"])
    if c["cut"]:
        c["trailing gap"] = False
    n = int(random.integers(80, 160))
    moves = motion(random, held, [("approach", n), ("retract", n)])
    factor = {"V": 1 / held.sensitivity, "nm": 1 / 1e-9}.get(
        c["signal"], held.spring_constant / UNITS.get(c["signal"], 1)
    )
    sign, unit = (-1 if c["counts"] == "towards the sample" else 1), (1e-6 if "um" in c["height"] else 1e-9)
    columns, parts = [], []
    for role, z, bend in moves:
        if copied and role[:3] != c["table"].split()[1][:3]:
            continue
        heights, signal = _printed(sign * z / unit), _printed(bend * factor)
        deflection = signal / factor
        columns.append((heights, signal))
        parts.append(Part(role, sign * heights * unit, deflection, held.spring_constant * deflection))
    if c["fillers"]:
        heights, signal = columns[0]
        low = -32768 * VOLTS * held.sensitivity * factor
        signal[: c["fillers"]] = low
        first = parts[0]
        assert first.deflection is not None
        assert first.force is not None
        kept = slice(c["fillers"], None)
        parts[0] = Part(first.role, first.z[kept], first.deflection[kept], first.force[kept])
    path = folder / "ramp.spm.txt"
    path.write_bytes(_file(c, held, columns))
    return _made(c, held, path, parts)


def _made(c: dict[str, Any], held: Lever, path: Path, parts: list[Part]) -> Made:
    told = [("cut off",)] if c["cut"] else []
    told += [("left out",)] if c["fillers"] else []
    told += [("which way",)] if c["table"] != "both ways" else []
    by_force = c["signal"] in ("pN", "nN")
    needed = {} if c["header"] or by_force else {"spring_constant": held.spring_constant}
    if not c["header"] and c["signal"] == "V":
        needed["sensitivity"] = held.sensitivity
    known = held.spring_constant if c["header"] or needed else None
    if known is None:
        parts = [Part(part.role, part.z, None, part.force) for part in parts]
    curve = Curve(tuple(parts), known, held.sensitivity if c["header"] else None)
    return Made(FORMAT, path, c, Curves((curve,)), given=needed, told=tuple(told))


def _printed(values: Array) -> Array:
    return np.array([float(f"{value:.8e}") for value in values])


def _file(c: dict[str, Any], held: Lever, columns: list[tuple[Array, Array]]) -> bytes:
    lines = _header(held) if c["header"] else []
    if len(columns) == 2:
        ways = ("Ex", "Rt")
        names = [c["height"].format(way) for way in ways] + [f"Defl_{c['signal']}_{way}" for way in ways]
        table = [columns[0][0], columns[1][0], columns[0][1], columns[1][1]]
    else:
        names = ["    \xb5m         " if "um" in c["height"] else "nm", c["signal"]]
        table = list(columns[0])
    names = [f'"{name}"' for name in names] if c["quoted"] and len(columns) == 2 else names
    last = "\t" if c["trailing gap"] else ""
    rows = ["\t".join(f"{value:.8e}" for value in row).replace(".", c["decimals"]) + last
            for row in zip(*table, strict=True)]  # fmt: skip
    lines += ["\t".join(names) + last, *rows, rows[-1][: -c["cut"]] if c["cut"] else ""]
    return c["ends"].join(lines).encode(c["encoding"])


def _header(held: Lever) -> list[str]:
    lines = ["\\*Force file list", "\\Version: 0x08150305", "\\*Ciao scan list",
             f"\\@Sens. DeflSens: V {held.sensitivity * 1e9:.10g} nm/V", "\\*Ciao force image list",
             f"\\Spring Constant: {held.spring_constant:.10g}",
             '\\@4:Image Data: S [DeflectionError] "Deflection Error"',
             f"\\@4:Z scale: V [Sens. DeflSens] ({VOLTS:.10f} V/LSB) 24.57600 V", "\\*Force file list end"]  # fmt: skip
    return [f'"{line}"' for line in lines]
