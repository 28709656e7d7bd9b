# SPDX-License-Identifier: BSD-3-Clause
"""Asylum Research force curves: one Igor wave with the columns Raw, Defl, ZSnsr, or a pair of waves.

Heights are those of the piezo towards the sample, so z = -ZSnsr. ``Indexes`` of the note names the last point of each
movement, ``Direction`` what it is: 1 towards the sample, 0 a dwell, -1 away. Pairs have no spring constant.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from igor_wave import note, wave
from made import Array, Curve, Curves, Lever, Made, Part, Random, chosen, lever, motion

FORMAT = "Asylum curves (.ibw)"
GRID = {
    "kind": ["wave", "pair"],
    "segments": ["a r", "a h r", "a p r", "a r longer", "a p a r", "a r p", "p a r", "p a h r"],
    "columns": ["Raw Defl ZSnsr", "Defl ZSnsr", "Raw Defl", "ZSnsr Defl Raw", "Raw Defl ZSnsr Amp"],
    "indexes": ["stated", "missing"],
    "tail": ["", "NaN"],
    "stored": ["f4", "f8"],
    "encoding": ["latin-1", "utf-8", "shift-jis"],
    "big": [False, True],
    "trigger": ["Force", "Deflection"],
    "sensor": ["ZSnsr", "Raw"],
}
NAMES = {"a": "approach", "r": "retract", "h": "hold", "p": "pause"}
SIGNS = {"approach": "1", "hold": "0", "pause": "0", "retract": "-1"}
RATE = 2000.0


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = _consistent(chosen(random, GRID, plain))
    held = lever(random)
    points = [(NAMES[s], int(random.integers(60, 120))) for s in c["segments"].replace(" longer", "").split()]
    if c["segments"] == "a r longer":
        points[1] = ("retract", 3 * points[0][1])
    moves = motion(random, held, points)
    z = np.concatenate([part for _, part, _ in moves])
    bend = np.concatenate([part for _, _, part in moves])
    setpoint = float(f"{random.uniform(0.5, 3) * held.sensitivity * held.spring_constant:.5g}")
    columns = {"Raw": -1.02 * z + 2e-7, "ZSnsr": -z + 1e-7, "Defl": bend, "Amp": np.zeros_like(z)}
    stored = {name: values.astype(c["stored"]) for name, values in columns.items()}
    text = note(_note(c, held, points, setpoint), c["encoding"])
    path = _files(c, folder, stored, text)
    pair = c["kind"] == "pair"
    source = c["sensor"] if pair else ("ZSnsr" if "ZSnsr" in c["columns"] else "Raw")
    heights = -stored[source].astype(float)
    deflection = stored["Defl"].astype(float)
    constant = None if pair else held.spring_constant
    parts = _parts(c, points, heights, deflection, constant)
    newtons = None if pair or c["trigger"] != "Force" else setpoint
    curve = Curve(parts, constant, None if pair else held.sensitivity, newtons)
    return Made(FORMAT, path, c, Curves((curve,)))


def _consistent(c: dict[str, Any]) -> dict[str, Any]:
    if c["kind"] == "pair":
        c["tail"] = ""
    if c["indexes"] == "missing" or c["kind"] == "pair":
        c["segments"] = {"a p a r": "a r", "a h r": "a p r", "a r p": "a r", "p a r": "a r", "p a h r": "a r"}.get(
            c["segments"], c["segments"]
        )
    if c["indexes"] == "missing":
        c["segments"] = "a r longer" if c["segments"] == "a r longer" else "a r"
    return c


def _parts(
    c: dict[str, Any], points: Sequence[tuple[str, int]], z: Array, bend: Array, constant: float | None
) -> tuple[Part, ...]:
    """By the indexes; without them the lowest z ends the approach."""
    bounds = np.cumsum([0, *(n for _, n in points)])
    roles = [role if role != "hold" else "pause" for role, _ in points]
    if c["indexes"] == "missing":
        lowest = int(np.argmin(z)) + 1
        bounds, roles = np.array([0, lowest, len(z)]), ["approach", "retract"]
    found = []
    for role, start, end in zip(roles, bounds, bounds[1:], strict=False):
        force = None if constant is None else constant * bend[start:end]
        found.append(Part(role, z[start:end], bend[start:end], force))
    return tuple(found)


def _files(c: dict[str, Any], folder: Path, stored: dict[str, Any], text: bytes) -> Path:
    filler = np.full(20, np.nan) if c["tail"] else np.empty(0)

    def filled(values: Any) -> Any:
        return np.concatenate([values, filler.astype(values.dtype)])

    common = {"steps": (1 / RATE,), "units": ("s",), "unit": "m", "dimension": 1, "big": c["big"]}
    if c["kind"] == "wave":
        names = c["columns"].split()
        path = folder / "Curve0001.ibw"
        data = np.stack([filled(stored[name]) for name in names], axis=1)
        path.write_bytes(wave(data, text, name="Curve0001", labels=names, **common))
        return path
    for name in ("Defl", c["sensor"]):
        path = folder / f"Line0000Point0000{name}.ibw"
        path.write_bytes(wave(filled(stored[name]), text, name=path.stem, labels=[name], **common))
    return folder / "Line0000Point0000Defl.ibw"


def _note(c: dict[str, Any], held: Lever, points: Sequence[tuple[str, int]], setpoint: float) -> dict[str, Any]:
    total = sum(n for _, n in points)
    ends = np.cumsum([n for _, n in points]) - 1
    indexes = ",".join(["0", *(str(end) for end in ends)])
    signs = ",".join(["NaN", *(SIGNS[role] for role, _ in points)])
    found: dict[str, Any] = {"XLVDT": -3.077e-05, "YLVDT": -3.283e-05}
    if c["kind"] == "wave":
        found |= {
            "IgorFileVersion": "6.3.8.1",
            "DwellSetting": int(len(points) > 2),
            "DwellTime": 0.992,
            "NumPtsPerSec": f"{RATE:g}",
            "TriggerChannel": c["trigger"],
            "TriggerPoint": f"{setpoint:.5g}",
            "ApproachVelocity": 1e-6,
            "RetractVelocity": 1e-6,
            "ImagingMode": "Contact",
            "InvOLS": f"{held.sensitivity:.10g}",
            "SpringConstant": f"{held.spring_constant:.10g}",
            "AmpInvOLS": 4.9e-08,
            "InputTime": total / RATE,
            "MicroscopeModel": "MFP3D",
            "Version": "16.11.212",
            "Date": "2020-02-05",
            "Time": "10:47:31",
            "StartHeadTemp": "29.5625 \xb0C",
        }
    if c["indexes"] == "stated":
        found["Indexes"] = indexes + ("," if c["kind"] == "pair" else "")
        if c["kind"] == "wave":
            found["Direction"] = signs + ","
    return found
