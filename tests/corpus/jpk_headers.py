# SPDX-License-Identifier: BSD-3-Clause
"""The property files of JPK archives: channels with their encoders and conversion chains, segments, grids."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from made import Array

STYLES = {"approach": "extend", "retract": "retract", "hold": "pause", "pause": "pause", "modulation": "modulation"}
TYPES = {
    "approach": "z-extend-force",
    "retract": "z-retract-height",
    "hold": "constant-force-pause",
    "pause": "constant-height-pause",
    "modulation": "sine-z-modulation-segment-settings",
}
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


def prefixed(channel: Channel) -> Channel:
    """The same in mV, nm and nN: what is stored, and what it means, stays."""
    per = {"V": 1e3, "m": 1e9, "N": 1e9}
    names = {"V": "mV", "m": "nm", "N": "nN"}
    is_float = channel.stored == "float"
    before = 1.0 if is_float else per[channel.unit]
    slots = []
    for slot in channel.slots:
        after = per[slot.unit]
        slots.append(Slot(slot.name, slot.multiplier * after / before, slot.offset * after, names[slot.unit]))
        before = after
    if is_float:
        return replace(channel, slots=tuple(slots))
    base = per[channel.unit]
    return replace(
        channel,
        multiplier=channel.multiplier * base,
        offset=channel.offset * base,
        unit=names[channel.unit],
        slots=tuple(slots),
    )


def header(c: Properties, grid: tuple[int, int], count: int) -> Properties:
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


def series(c: Properties, index: int, segments: int, place: tuple[int, int], grid: tuple[int, int]) -> Properties:
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


def segment(
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


def shared(
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
