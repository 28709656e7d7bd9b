# SPDX-License-Identifier: BSD-3-Clause
"""JPK curves, maps and QI data, after the headers of real archives of versions 0.12 and 2.0.

An archive holds ``header.properties``, and for each segment a header and one big-endian column per channel. Values of a
channel are raw x multiplier + offset of its encoder (floats have none), in the unit of the base slot; then the chain of
conversions up to the wished slot. From version 2.0 on, what segments share stands in ``shared-data``. Heights grow away
from the sample. The first point of a map is its lower left; with ``back-and-forth`` odd lines run backwards.
"""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jpk_headers import Channel, Properties, Slot, header, prefixed, segment, series, shared
from made import Array, Curve, Curves, Lever, Made, Part, Random, chosen, lever, motion

FORMAT = "JPK curves"
GRID = {
    "kind": ["curve", "map", "QI map", "QI series"],
    "version": ["2.0", "0.12"],
    "deflection": ["signedinteger", "float", "signedshort", "unsignedinteger"],
    "measured": ["measuredHeight", "capacitiveSensorHeight", "both", "strainGaugeHeight", "none", "float"],
    "chain": ["distance force", "distance only", "volts only"],
    "segments": ["a r", "a h r", "a p r", "a p a r", "a r r", "a h m r", "p a r", "a r p", "a r longer", "a h p r"],
    "back and forth": [False, True],
    "aborted": [False, True],
    "packed": ["deflated", "stored"],
    "lost curve": [False, True],
    "time beside": [False, True],
    "default": ["as chained", "volts"],
    "offset": [0.0, 1.0],
    "units": ["SI", "mV nm nN"],
    "between": ["=", " = ", ": ", " "],  # key and value of a property
}
NAMES = {"a": "approach", "r": "retract", "h": "hold", "p": "pause", "m": "modulation"}
ENDINGS = {"curve": "jpk-force", "map": "jpk-force-map", "QI map": "jpk-qi-data", "QI series": "jpk-qi-series"}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = _consistent(chosen(random, GRID, plain))
    held = lever(random)
    channels = _channels(random, c, held)
    told = [prefixed(channel) for channel in channels] if c["units"] != "SI" else channels
    points = [(NAMES[s], int(random.integers(40, 90))) for s in c["segments"].replace(" longer", "").split()]
    if c["segments"] == "a r longer":
        points[1] = ("retract", 3 * points[0][1])
    many = c["kind"] in ("map", "QI map")
    grid = (int(random.integers(2, 5)), int(random.integers(2, 4))) if many else (1, 1)
    count = grid[0] * grid[1] - (int(random.integers(1, grid[0])) if c["aborted"] else 0)
    setpoint = float(f"{random.uniform(0.3, 2):.6g}")  # V
    archive: dict[str, Any] = {"header.properties": header(c, grid, count)}
    curves, travel = [], float(random.uniform(0.5e-6, 4e-6))
    lost = int(random.integers(1, count)) if c["lost curve"] and count > 2 else -1
    for index in range(count):
        if index == lost:
            continue
        path = f"index/{index}/" if many else ""
        if many:
            archive[f"{path}header.properties"] = series(
                c, index, len(points), _place(index, grid, c["back and forth"]), grid
            )
        segments = _segments(random, held, points, travel)
        parts = []
        for number, (role, z, bend, duration) in enumerate(segments):
            column, part = _columns(c, channels, held, role, z, bend, duration)
            place = f"{path}segments/{number}/"
            archive[f"{place}segment-header.properties"] = segment(c, told, number, role, len(z), duration, setpoint)
            archive |= {f"{place}channels/{name}.dat": data for name, data in column.items()}
            if role != "modulation":
                parts.append(part)
        where = _place(index, grid, c["back and forth"]) if many else None
        curves.append(_curve(parts, held, setpoint, where))
    if c["version"] == "2.0":
        archive["shared-data/header.properties"] = shared(c, told, points, segments, setpoint)
    file = folder / f"curve.{ENDINGS[c['kind']]}"
    method = zipfile.ZIP_DEFLATED if c["packed"] == "deflated" else zipfile.ZIP_STORED
    _zip(file, archive, method, c["between"])
    return Made(FORMAT, file, c, Curves(tuple(curves)), given=_given(c, held), told=_told(c))


def _consistent(c: Properties) -> Properties:
    single = c["kind"] in ("curve", "QI series")
    fixed: Properties = {key: c[key] and not single for key in ("aborted", "back and forth", "lost curve")}
    if c["kind"].startswith("QI"):
        fixed |= {"version": "2.0", "segments": "a r", "back and forth": False}
    if c["version"] == "0.12" and c["kind"] in ("curve", "map") and c["deflection"] == "unsignedinteger":
        fixed["deflection"] = "signedshort"
    return c | fixed


def _given(c: Properties, held: Lever) -> Properties:
    missing = {"distance only": ("spring_constant",), "volts only": ("spring_constant", "sensitivity")}
    return {name: getattr(held, name) for name in missing.get(c["chain"], ())}


def _told(c: Properties) -> tuple[tuple[str, ...], ...]:
    return (("modulation",),) if " m" in c["segments"] else ()


def _curve(parts: Sequence[Part], held: Lever, setpoint: float, place: tuple[int, int] | None) -> Curve:
    newtons = setpoint * held.sensitivity * held.spring_constant
    return Curve(tuple(parts), held.spring_constant, held.sensitivity, newtons, place, free_z=False)


def _place(index: int, grid: tuple[int, int], snake: bool) -> tuple[int, int]:
    j, i = divmod(index, grid[0])
    return (grid[0] - 1 - i if snake and j % 2 else i), j


def _segments(
    random: Random, held: Lever, points: Sequence[tuple[str, int]], travel: float
) -> list[tuple[str, Array, Array, float]]:
    moves = [("hold" if role == "modulation" else role, n) for role, n in points]
    found = []
    for (role, _), (_, z, bend) in zip(points, motion(random, held, moves, travel), strict=True):
        if role == "modulation":
            z = z + 1e-8 * np.sin(np.linspace(0, 12 * np.pi, len(z)))
        found.append((role, z + 8e-6, bend, len(z) * 5e-4))
    return found


def _channels(random: Random, c: Properties, held: Lever) -> list[Channel]:
    deflection = c["deflection"]
    volts = {"signedshort": 20 / 2**16, "signedinteger": 20 / 2**32, "unsignedinteger": 20 / 2**32, "float": 1.0}
    offset = (-10.0 if deflection == "unsignedinteger" else 0.00443) if c["offset"] else 0.0
    if deflection == "unsignedinteger":
        offset = -10.0
    chain = (Slot("distance", held.sensitivity, 0.0, "m"), Slot("force", held.spring_constant, 0.0, "N"))
    chain = chain[: {"distance only": 1, "volts only": 0}.get(c["chain"], 2)]
    found = [
        Channel(
            "vDeflection",
            deflection,
            volts[deflection],
            offset,
            "V",
            "volts",
            chain,
            chain[-1].name if chain and c["default"] == "as chained" else "volts",
        )
    ]
    wide = "signedshort" if c["version"] == "0.12" else "signedinteger"
    bits = 2**16 if wide == "signedshort" else 2**32
    piezo = (
        Slot("nominal", -1.2e-6, 1.2e-4, "m"),
        Slot("calibrated", float(f"{random.uniform(0.55, 0.75):.6g}"), 0.0, "m"),
    )
    found.append(Channel("height", wide, 100 / bits, 50.0000000116, "V", "volts", piezo, "calibrated"))
    metres = (Slot("nominal", 1.0, 1.5e-5, "m"),)
    gauge = (Slot("absolute", -1e-5, 0.0, "m"), Slot("nominal", 1.0, 1.0e-4, "m"))
    for name in {"both": ["measuredHeight", "capacitiveSensorHeight"], "none": [], "float": ["measuredHeight"]}.get(
        c["measured"], [c["measured"]]
    ):
        if name == "strainGaugeHeight":
            found.append(Channel(name, wide, 20 / bits, -0.008, "V", "volts", gauge, "nominal"))
        else:
            stored = "float" if c["measured"] == "float" else wide
            found.append(Channel(name, stored, -5e-5 / bits, -1.692e-5, "m", "absolute", metres, "nominal"))
    return found


def _columns(
    c: Properties, channels: Sequence[Channel], held: Lever, role: str, z: Array, bend: Array, duration: float
) -> tuple[dict[str, bytes], Part]:
    values = {"vDeflection": bend, "height": 1.03 * z - 1e-7}
    if c["chain"] not in ("distance only", "volts only"):
        values["vDeflection"] = bend * held.spring_constant
    if c["chain"] == "volts only":
        values["vDeflection"] = bend / held.sensitivity
    stored = {channel.name: channel.raw(values.get(channel.name, z)) for channel in channels}
    read = stored["vDeflection"][1]
    if c["chain"] == "volts only":
        read = read * held.sensitivity
    force = read if c["chain"] not in ("distance only", "volts only") else read * held.spring_constant
    heights = next(
        (stored[ch.name][1] for ch in channels if ch.name not in ("vDeflection", "height")), stored["height"][1]
    )
    name = "pause" if role in ("hold", "pause") else role
    part = Part(name, heights, force / held.spring_constant, force, duration)
    return {name: data for name, (data, _) in stored.items()}, part


def _zip(file: Path, archive: dict[str, Any], method: int, between: str) -> None:
    with zipfile.ZipFile(file, "w", method) as packed:
        known: set[str] = set()
        for name, content in archive.items():
            steps = name.split("/")[:-1]
            for folder in ("/".join(steps[:n]) + "/" for n in range(1, len(steps) + 1)):
                if folder not in known:
                    known.add(folder)
                    packed.writestr(folder, b"")
            if isinstance(content, dict):
                lines = [
                    f"{key}{between}{str(value) if not isinstance(value, float) else repr(value).upper()}"
                    for key, value in content.items()
                ]
                content = "\n".join(["#Wed Jun 30 13:48:15 BST 2021", *lines, ""]).encode("latin-1")
            packed.writestr(name, content)
