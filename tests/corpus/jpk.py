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
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
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
}
NAMES = {"a": "approach", "r": "retract", "h": "hold", "p": "pause", "m": "modulation"}
STYLES = {"approach": "extend", "retract": "retract", "hold": "pause", "pause": "pause", "modulation": "modulation"}
TYPES = {
    "approach": "z-extend-force",
    "retract": "z-retract-height",
    "hold": "constant-force-pause",
    "pause": "constant-height-pause",
    "modulation": "sine-z-modulation-segment-settings",
}
ENDINGS = {"curve": "jpk-force", "map": "jpk-force-map", "QI map": "jpk-qi-data", "QI series": "jpk-qi-series"}
STORED = {"signedinteger": ">i4", "unsignedinteger": ">u4", "signedshort": ">i2", "float": ">f4"}
CENTRE, PITCH = (-7.829e-6, -1.674e-5), 5e-7  # of the grid of a map [m]
Properties = dict[str, Any]


@dataclass(frozen=True)
class Slot:
    """One step of a conversion chain: value = multiplier x (value in the slot before) + offset."""

    name: str
    multiplier: float
    offset: float
    unit: str


@dataclass(frozen=True)
class Channel:
    name: str
    stored: str  # key of STORED
    multiplier: float
    offset: float
    unit: str  # of the base slot
    base: str
    slots: tuple[Slot, ...]
    default: str

    def raw(self, values: Array) -> tuple[bytes, Array]:
        """`values` in the last slot as stored, and what they are then."""
        for slot in reversed(self.slots):
            values = (values - slot.offset) / slot.multiplier
        if self.stored == "float":
            data = values.astype(STORED["float"])
            back = data.astype(float)
        else:
            data = np.round((values - self.offset) / self.multiplier).astype(STORED[self.stored])
            back = data.astype(float) * self.multiplier + self.offset
        for slot in self.slots:
            back = back * slot.multiplier + slot.offset
        return data.tobytes(), back


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = _consistent(chosen(random, GRID, plain))
    held = lever(random)
    channels = _channels(random, c, held)
    points = [(NAMES[s], int(random.integers(40, 90))) for s in c["segments"].replace(" longer", "").split()]
    if c["segments"] == "a r longer":
        points[1] = ("retract", 3 * points[0][1])
    many = c["kind"] in ("map", "QI map")
    grid = (int(random.integers(2, 5)), int(random.integers(2, 4))) if many else (1, 1)
    count = grid[0] * grid[1] - (int(random.integers(1, grid[0])) if c["aborted"] else 0)
    setpoint = float(f"{random.uniform(0.3, 2):.6g}")  # V
    archive: dict[str, Any] = {"header.properties": _header(c, grid, count)}
    curves, travel = [], float(random.uniform(0.5e-6, 4e-6))
    lost = int(random.integers(1, count)) if c["lost curve"] and count > 2 else -1
    for index in range(count):
        if index == lost:
            continue
        path = f"index/{index}/" if many else ""
        if many:
            archive[f"{path}header.properties"] = _series(
                c, index, len(points), _place(index, grid, c["back and forth"]), grid
            )
        segments = _segments(random, held, points, travel)
        parts = []
        for number, (role, z, bend, duration) in enumerate(segments):
            column, part = _columns(c, channels, held, role, z, bend, duration)
            place = f"{path}segments/{number}/"
            archive[f"{place}segment-header.properties"] = _segment(
                c, channels, number, role, len(z), duration, setpoint
            )
            archive |= {f"{place}channels/{name}.dat": data for name, data in column.items()}
            if role != "modulation":
                parts.append(part)
        where = _place(index, grid, c["back and forth"]) if many else None
        curves.append(_curve(parts, held, setpoint, where))
    if c["version"] == "2.0":
        archive["shared-data/header.properties"] = _shared(c, channels, points, segments, setpoint)
    file = folder / f"curve.{ENDINGS[c['kind']]}"
    _zip(file, archive, zipfile.ZIP_DEFLATED if c["packed"] == "deflated" else zipfile.ZIP_STORED)
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


def _header(c: Properties, grid: tuple[int, int], count: int) -> Properties:
    kind = {
        "curve": ("spm-forcefile", "force-scan-series"),
        "map": ("spm-force-scan-map-file", "force-scan-map"),
        "QI map": ("spm-quantitative-image-data-file", "quantitative-imaging-map"),
        "QI series": ("spm-quantitative-image-series-file", "quantitative-imaging-series"),
    }[c["kind"]]
    top: Properties = {"jpk-data-file": kind[0], "file-format-version": c["version"], "type": kind[1]}
    about = {"instrument": "JPK00254", "source-software": "6.1.171", "user-name": "m\\u00FCller", "comment": ""}
    top |= {f"{kind[1]}.description.{key}": value for key, value in about.items()}
    if c["kind"] in ("curve", "QI series"):
        return top | {f"{kind[1]}.header.position-index": 0}
    pattern = f"{kind[1]}.position-pattern"
    return top | {
        f"{kind[1]}.indexes.type": "range",
        f"{kind[1]}.indexes.min": 0,
        f"{kind[1]}.indexes.max": count - 1,
        f"{kind[1]}.start-time": "2021-11-05 17\\:37\\:44.432 +0100",
        f"{pattern}.type": "grid-position-pattern",
        f"{pattern}.back-and-forth": str(c["back and forth"]).lower(),
        f"{pattern}.grid.xcenter": CENTRE[0],
        f"{pattern}.grid.ycenter": CENTRE[1],
        f"{pattern}.grid.ulength": grid[0] * PITCH,
        f"{pattern}.grid.vlength": grid[1] * PITCH,
        f"{pattern}.grid.theta": "-0.0",
        f"{pattern}.grid.reflect": "false",
        f"{pattern}.grid.unit.type": "metric-unit",
        f"{pattern}.grid.unit.unit": "m",
        f"{pattern}.grid.ilength": grid[0],
        f"{pattern}.grid.jlength": grid[1],
    }


def _series(c: Properties, index: int, segments: int, place: tuple[int, int], grid: tuple[int, int]) -> Properties:
    kind = "quantitative-imaging-series" if c["kind"] == "QI map" else "force-scan-series"
    return {
        "type": kind,
        f"{kind}.force-segments.count": segments,
        f"{kind}.header.position-index": index,
        f"{kind}.header.position.x": CENTRE[0] + (place[0] + 0.5 - grid[0] / 2) * PITCH,
        f"{kind}.header.position.y": CENTRE[1] + (place[1] + 0.5 - grid[1] / 2) * PITCH,
    }


def _settings(role: str, number: int, points: int, duration: float, setpoint: float) -> Properties:
    found: Properties = {
        "type": "combined",
        "style": STYLES[role],
        "feedback-mode.name": "contact",
        "segment-settings.type": TYPES[role],
        "segment-settings.identifier.type": "standard",
        "segment-settings.style": STYLES[role],
        "segment-settings.duration": duration,
        "segment-settings.num-points": points,
    }
    if role in ("approach", "retract"):
        found |= {"segment-settings.z-start": 3e-6, "segment-settings.z-end": 0.0}
    if role == "approach":
        found["segment-settings.setpoint"] = setpoint
    return {f"settings.{key}": value for key, value in found.items()}


def _segment(
    c: Properties, channels: Sequence[Channel], number: int, role: str, points: int, duration: float, setpoint: float
) -> Properties:
    head: Properties = {
        "type": "spm-force-segment-header",
        "num-points": points,
        "duration": duration,
        "time-stamp": "2021-11-05 17\\:37\\:32.064 +0100",
        "approach-id": "2021.06.30-10.52.13-00060",
        "baseline.baseline": -0.1973,
        "baseline.measured": "true",
        "force-scan-flags.aborted": "false",
    }
    if c["version"] == "2.0":
        head["force-segment-header-info.*"] = number
    else:
        head |= _settings(role, number, points, duration, setpoint)
    found = {f"force-segment-header.{key}": value for key, value in head.items()}
    listed = [channel.name for channel in channels] + (["time"] if c["time beside"] else [])
    found["channels.list"] = " ".join(listed)
    if c["time beside"]:
        found |= {
            "channel.time.data.num-points": points,
            "channel.time.data.start": 2.5e-4,
            "channel.time.data.step": 5e-4,
        }
        if c["version"] == "2.0":
            found["channel.time.lcd-info.*"] = len(channels)
        else:
            found |= {"channel.time.data.type": "raster-data", "channel.time.channel.name": "time"}
    for index, channel in enumerate(channels):
        name = f"channel.{channel.name}"
        if c["version"] == "2.0":
            found[f"{name}.lcd-info.*"] = index
        else:
            kind = {"signedshort": "short", "signedinteger": "integer-data", "float": "float"}[channel.stored]
            found |= {f"{name}.data.type": kind, f"{name}.channel.name": channel.name}
            found |= {f"{name}.data.{key}": value for key, value in _encoder(channel).items()}
            found |= {f"{name}.{key}": value for key, value in _conversions(channel).items()}
        found |= {f"{name}.data.file.name": f"channels/{channel.name}.dat", f"{name}.data.file.format": "raw"}
        found[f"{name}.data.num-points"] = points
    return found


def _encoder(channel: Channel) -> Properties:
    if channel.stored == "float":
        return {}
    scaling = _scaling(channel.multiplier, channel.offset, channel.unit)
    return {"encoder.type": channel.stored} | {f"encoder.{key}": value for key, value in scaling.items()}


def _scaling(multiplier: float, offset: float, unit: str) -> Properties:
    return {
        "scaling.type": "linear",
        "scaling.style": "offsetmultiplier",
        "scaling.offset": repr(offset).upper(),
        "scaling.multiplier": repr(multiplier).upper(),
        "scaling.unit.type": "metric-unit",
        "scaling.unit.unit": unit,
    }


def _conversions(channel: Channel) -> Properties:
    found: Properties = {
        "conversions.list": " ".join(slot.name for slot in channel.slots),
        "conversions.default": channel.default,
        "conversions.base": channel.base,
        f"conversion.{channel.base}.name": channel.base.capitalize(),
        f"conversion.{channel.base}.defined": "false",
    }
    before = channel.base
    for slot in channel.slots:
        name = f"conversion.{slot.name}"
        found |= {f"{name}.name": slot.name.capitalize(), f"{name}.defined": "true", f"{name}.type": "simple"}
        found |= {f"{name}.base-calibration-slot": before, f"{name}.calibration-slot": slot.name}
        found |= {f"{name}.{key}": value for key, value in _scaling(slot.multiplier, slot.offset, slot.unit).items()}
        before = slot.name
    if channel.name == "strainGaugeHeight":
        found |= {"conversion.calibrated.name": "User-calibrated", "conversion.calibrated.defined": "false"}
    return {f"conversion-set.{key}": value for key, value in found.items()}


def _shared(
    c: Properties,
    channels: Sequence[Channel],
    points: Sequence[tuple[str, int]],
    segments: Sequence[tuple[str, Array, Array, float]],
    setpoint: float,
) -> Properties:
    more = int(c["time beside"])
    found: Properties = {"lcd-infos.count": len(channels) + more, "force-segment-header-infos.count": len(points)}
    if more:
        found |= {f"lcd-info.{len(channels)}.type": "raster-data", f"lcd-info.{len(channels)}.channel.name": "time"}
        found |= {f"lcd-info.{len(channels)}.unit.unit": "s"}
    for index, channel in enumerate(channels):
        name = f"lcd-info.{index}"
        found |= {
            f"{name}.type": "float-data" if channel.stored == "float" else "integer-data",
            f"{name}.channel.type": "channel",
            f"{name}.channel.name": channel.name,
            f"{name}.unit.type": "metric-unit",
            f"{name}.unit.unit": channel.unit,
        }
        if channel.stored == "signedshort":
            found[f"{name}.type"] = "short-data"
        found |= {f"{name}.{key}": value for key, value in (_encoder(channel) | _conversions(channel)).items()}
    for number, (role, z, _, duration) in enumerate(segments):
        settings = _settings(role, number, len(z), duration, setpoint)
        found |= {f"force-segment-header-info.{number}.{key}": value for key, value in settings.items()}
    return found


def _zip(file: Path, archive: dict[str, Any], method: int) -> None:
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
                    f"{key}={str(value) if not isinstance(value, float) else repr(value).upper()}"
                    for key, value in content.items()
                ]
                content = "\n".join(["#Wed Jun 30 13:48:15 BST 2021", *lines, ""]).encode("latin-1")
            packed.writestr(name, content)
