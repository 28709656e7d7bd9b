# SPDX-License-Identifier: BSD-3-Clause
"""NanoScope ramps, force volumes and PeakForce captures, as the headers of real files (8.15, 9.1, 9.2) write them.

Both branches are stored from the deepest point outwards, the approach first; ``Samps/line`` counts the retraction
first. Where they differ, both have the place of the longer one, and what follows in the shorter is whatever was in
memory. Deflection = raw x (V/LSB in parentheses) x soft scale, also where data are 32 bits wide under a header of 2
bytes (from 9.2 on). z falls by the ramp's size over the points of the retraction from point to point. A capture is one
period of a sine, deepest at ``Sync Distance QNM``, which counts samples of ``Sample Points`` a period.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Curve, Curves, Lever, Made, Part, Random, chosen, lever, motion, pressed

FORMAT = "NanoScope force curves"
OFFSET = 8192
VOLTS = 0.000375  # [V/LSB]
GRID = {
    "kind": ["ramp", "volume", "capture"],
    "version": ["0x08150305", "0x09010300", "0x0920B046", "0x07300000"],
    "branches": ["equal", "approach shorter", "retraction shorter"],
    "filler": ["memory", "zeros", "lowest"],
    "sensor": ["none", "after", "before"],
    "sensitivity": ["nm/V", "no unit", "missing"],
    "constant": ["stated", "missing"],
    "ramp size": ["Ramp size", "Ramp Size"],
    "beside": ["", "friction", "beyond"],
    "ends": ["\r\n", "\n"],
    "aborted": [False, True],
    "sentinel": [False, True],
    "halved": [False, True],  # samples that the image's section states
    "sync": ["middle", "late", "of 128 points"],
    "name": ["force.spm", "force.000", "force.003", "force.pfc"],
}
SENSOR, PIEZO = 906.473, 13.203  # soft scales of height sensor and piezo [nm/V]


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = _consistent(chosen(random, GRID, plain))
    held = lever(random)
    grid = (1, 1) if c["kind"] == "ramp" else (int(random.integers(2, 5)), int(random.integers(2, 5)))
    many = grid[0] * grid[1]
    count = many - (int(random.integers(1, grid[0])) if c["aborted"] else 0)
    points = _points(random, c)
    travel = float(f"{random.uniform(0.3e-6, 2e-6):.7g}")
    ramp = float(f"{travel / (PIEZO * 1e-9):.7g}")  # V
    make = _capture if c["kind"] == "capture" else _ramp
    sync = _sync(c, points[1])
    blocks, curves = [], []
    for index in range(count):
        place = (index % grid[0], index // grid[0]) if many > 1 else None
        raw, parts = make(random, c, held, points, ramp * PIEZO * 1e-9, sync)
        blocks.append(raw)
        curves.append(Curve(parts, held.spring_constant, held.sensitivity, None, place, cycle=c["kind"] == "capture"))
    data = np.concatenate([*blocks, np.zeros((many - count) * 2 * max(points), int)])
    path = folder / c["name"]
    path.write_bytes(_file(c, held, data, points, ramp, grid, sync))
    refused = "its image states half of the samples of a curve" if c["halved"] else ""
    return Made(FORMAT, path, c, Curves(tuple(curves)), given=_given(c, held), told=_told(c), must_refuse=refused)


def _consistent(c: dict[str, Any]) -> dict[str, Any]:
    wide = 4 if c["version"] == "0x0920B046" else 2
    fixed: dict[str, Any] = {"bytes": wide, "aborted": c["aborted"] and c["kind"] == "volume"}
    if c["kind"] != "ramp":
        fixed |= {"branches": "equal", "sensor": "none"}
    if c["kind"] == "capture" or c["branches"] != "equal" or c["aborted"]:
        fixed |= {"halved": False}
    if c["kind"] != "capture":
        fixed |= {"sentinel": False, "sync": "middle", "name": c["name"] if c["name"] != "force.pfc" else "force.spm"}
    return c | fixed


def _points(random: Random, c: dict[str, Any]) -> tuple[int, int]:
    """Points of the approach and of the retraction."""
    n = int(random.integers(60, 150))
    short = int(n * random.uniform(0.55, 0.98))
    return {"equal": (n, n), "approach shorter": (short, n), "retraction shorter": (n, short)}[c["branches"]]


def _sync(c: dict[str, Any], n: int) -> tuple[float, int]:
    """Sync distance, and the samples a period that it counts."""
    if c["sync"] == "of 128 points":
        return 66.0, 128
    return float(n + (2 if c["sync"] == "late" else 0)), 2 * n


def _given(c: dict[str, Any], held: Lever) -> dict[str, Any]:
    missing = {"sensitivity": c["sensitivity"] == "missing", "spring_constant": c["constant"] == "missing"}
    return {name: getattr(held, name) for name, is_missing in missing.items() if is_missing}


def _told(c: dict[str, Any]) -> tuple[tuple[str, ...], ...]:
    told: list[tuple[str, ...]] = [("without a unit", "nm/V")] if c["sensitivity"] == "no unit" else []
    if c["aborted"]:
        told.append(("without data", "left out", "missing"))
    return tuple(told)


def _ramp(
    random: Random, c: dict[str, Any], held: Lever, points: tuple[int, int], size: float, sync: tuple[float, int]
) -> tuple[Any, tuple[Part, ...]]:
    step = size / points[1]
    moves = motion(random, held, [("approach", 400), ("retract", 400)], travel=size)
    parts, stored = [], []
    for (role, z, bend), n in zip(moves, points, strict=True):
        outwards = np.argsort(z)  # from the deepest point
        heights = step * np.arange(n)
        wished = np.interp(heights, z[outwards] - z.min(), bend[outwards])
        raw = np.round(wished / held.sensitivity / VOLTS).astype(int)
        stored.append(raw)
        deflection = raw * VOLTS * held.sensitivity
        turned = slice(None, None, -1) if role == "approach" else slice(None)
        parts.append(Part(role, heights[turned], deflection[turned], held.spring_constant * deflection[turned]))
    lowest = -(2 ** (8 * c["bytes"] - 1))
    longest = max(points)
    for number, raw in enumerate(stored):
        left = longest - len(raw)
        filler = {"memory": random.integers(-30000, 30000, left), "zeros": np.zeros(left, int)}
        stored[number] = np.concatenate([raw, filler.get(c["filler"], np.full(left, lowest))])
    return np.concatenate(stored), tuple(parts)


def _capture(
    random: Random, c: dict[str, Any], held: Lever, points: tuple[int, int], size: float, sync: tuple[float, int]
) -> tuple[Any, tuple[Part, ...]]:
    n = points[1]
    deepest = sync[0] * 2 * n / sync[1]
    amplitude = 100e-9
    z = -amplitude * np.cos(2 * np.pi * (np.arange(2 * n) - deepest) / (2 * n))
    bend = pressed(random, held, z, contact=-0.3 * amplitude)
    raw = np.round(bend / held.sensitivity / VOLTS).astype(int)
    deflection = raw * VOLTS * held.sensitivity
    measured = np.arange(2 * n) > 0 if c["sentinel"] else np.ones(2 * n, bool)
    if c["sentinel"]:
        raw[0] = -(2 ** (8 * c["bytes"] - 1))
    rising = (np.arange(2 * n) - deepest) % (2 * n) < n
    parts = tuple(
        Part(role, z[which], deflection[which], held.spring_constant * deflection[which])
        for role, which in (("approach", measured & ~rising), ("retract", measured & rising))
    )
    return np.concatenate([raw[:n][::-1], raw[n:]]), parts


def _file(
    c: dict[str, Any],
    held: Lever,
    data: Any,
    points: tuple[int, int],
    ramp: float,
    grid: tuple[int, int],
    sync: tuple[float, int],
) -> bytes:
    samples = f"{points[1]} {points[0]}"
    mode = {"ramp": "Force", "volume": "Force Volume", "capture": "Image"}[c["kind"]]
    unit = {"nm/V": " nm/V", "no unit": " "}.get(c["sensitivity"])
    lines = ["*Force file list", f"Version: {c['version']}", "Date: 01:06:11 PM Wed Oct 09 2019"]
    lines += [f"Start context: {'FOL' if c['kind'] == 'ramp' else 'FVOL'}", f"Data length: {OFFSET}", "Text: "]
    lines += ["*Equipment list", "Description: Multimode 8 - Piezo J", "Microscope: MultiMode 8", "*Scanner list"]
    lines += ["Scanner type: AFM", "Piezo size: J", f"@Sens. Zsens: V {PIEZO:.5f} nm/V", "*Ciao scan list"]
    lines += [f"Operating mode: {mode}", "Scan Size: 2000 nm", "Samps/line: 64", "Lines: 64", "Aspect Ratio: 1:1"]
    capture = c["kind"] == "capture"
    lines += [f"PeakForce Capture: {'Allow' if capture else 'Never'}", "PFT Freq: 2 KHz", "Peak Force Amplitude: 100"]
    lines += [f"Sample Points: {sync[1] if capture else 128}", f"Sync Distance: {sync[0]:.3f}"]
    lines += ["Sync Distance New: 0", f"Sync Distance QNM: {sync[0]:.3f}"]
    lines += ["Capture mode : Previous", f"@Sens. ZsensSens: V {SENSOR:.4f} nm/V"]
    if unit is not None:
        lines.append(f"@Sens. DeflSens: V {held.sensitivity * 1e9:.10g}{unit}")
    lines += ["*Ciao force list", "Scan rate: 1.01725", "Forward vel.: 462.282", "Reverse vel.: 462.282"]
    lines += [
        f"Samps/line: {samples}",
        f"Samps/line, retrace: {points[1]}",
        "Display mode: Both",
        "Trigger mode: Relative",
    ]
    lines += ["Hold Samples: 0", "Hold Time: 0", f"force/line: {grid[0]} 0", "Z direction: Retract"]
    lines += ["@4:Trig Threshold Deflection: V [Sens. DeflSens] (0.0003750000 V/LSB) 1.200000 V"]
    lines += ['@4:Ramp channel: S [Zsweep] "Z"']
    lines += [f"@4:{c['ramp size']} Zsweep: V [Sens. Zsens] (0.006713765 V/LSB) {ramp:.7g} V"]
    stated = f"{points[1] // 2} {points[0] // 2}" if c["halved"] else samples
    lists, body = _lists(c, held, data, stated, ramp, grid)
    text = "".join(f"\\{line}{c['ends']}" for line in [*lines, *lists, "*File list end"])
    head = text.encode("latin-1") + b"\x1a"
    assert len(head) <= OFFSET, "a longer header than its place"
    return head.ljust(OFFSET, b"\0") + body


def _lists(
    c: dict[str, Any], held: Lever, data: Any, samples: str, ramp: float, grid: tuple[int, int]
) -> tuple[list[str], bytes]:
    """The lists of the channels, and their data."""
    raw = data.astype(f"<i{c['bytes']}").tobytes()
    other = (data // 3 - 900).astype(f"<i{c['bytes']}").tobytes()
    lines, body = [], b""
    if c["kind"] != "ramp":
        picture = np.arange(grid[0] * grid[1], dtype=f"<i{c['bytes']}").tobytes()
        lines += _picture(grid, OFFSET, len(picture))
        body += picture
    order = {"none": ["defl"], "after": ["defl", "sensor"], "before": ["sensor", "defl"]}[c["sensor"]]
    for name in [*order, *([c["beside"]] if c["beside"] else [])]:
        at = OFFSET + len(body) if name != "beyond" else 10**7
        lines += _list(c, held, name, at, len(raw), samples, ramp)
        if name != "beyond":
            body += raw if name == "defl" else other
    return lines, body


def _picture(grid: tuple[int, int], at: int, length: int) -> list[str]:
    return [
        "*Ciao image list",
        f"Data offset: {at}",
        f"Data length: {length}",
        "Bytes/pixel: 2",
        f"Samps/line: {grid[0]}",
        f"Number of lines: {grid[1]}",
        "Aspect Ratio: 1:1",
        f"Scan Size: 2 {2 * grid[1] / grid[0]:.6g} ~m",
        "Scan Line: Main",
        "Line Direction: Retrace",
        '@2:Image Data: S [Height] "Height"',
        "@2:Z scale: V [Sens. Zsens] (0.006103497 V/LSB) 400.0000 V",
    ]


def _list(c: dict[str, Any], held: Lever, name: str, at: int, length: int, samples: str, ramp: float) -> list[str]:
    kind, soft = {
        "defl": ('[DeflectionError] "Deflection Error"', "Sens. DeflSens"),
        "sensor": ('[ZSensor] "Height Sensor"', "Sens. ZsensSens"),
    }.get(name, ('[Friction] "Friction"', "Sens. Friction"))
    constant = [f"Spring Constant: {held.spring_constant:.10g}"] if c["constant"] == "stated" else []
    return [
        "*Ciao force image list",
        f"Data offset: {at}",
        f"Data length: {length}",
        "Bytes/pixel: 2",
        "Start context: FOL",
        "Data type: AFM",
        f"Samps/line: {samples}",
        "Scan Line: Main",
        "Z direction: Retract",
        *constant,
        "X Data Type: Ramp",
        f"@4:Image Data: S {kind}",
        "@Z magnify: C [4:Z scale] 1.000000 ",
        f"@4:Z scale: V [{soft}] ({VOLTS:.10f} V/LSB) 2.500000 V",
        f"@4:Z offset: V [{soft}] ({VOLTS:.10f} V/LSB) -0.7762273 V",
        f"@4:{c['ramp size']}: V [Sens. Zsens] (0.006713765 V/LSB) {ramp:.7g} V",
    ]
