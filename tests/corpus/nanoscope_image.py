# SPDX-License-Identifier: BSD-3-Clause
"""NanoScope images, as the headers of real files (versions 5, 7, 8.15, 9.1, 9.4) write them.

A header is lines ``\\key: value`` in lists, ended by 0x1A and filled up to the first data. Height = raw x (hard value
/ 2^(8 bytes)) x soft scale, where *bytes* is what ``Bytes/pixel`` says, although from version 9.2 on the data are 32
bits wide under a header of 2. The first line of the data is the lower edge. With an aspect other than 1:1 pixels are
square, although ``Scan Size`` repeats the width.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from made import Array, Image, Made, Plane, Random, chosen, surface

FORMAT = "NanoScope image"
OFFSET = 8192
GRID = {
    "version": ["0x08150300", "0x05300001", "0x07200000", "0x09010201", "0x09400103"],
    "wide": [False, True],  # from 9.2: 32-bit data under a header of 2 bytes, or of 4
    "aspect": ["1:1", "2:1", "4:1", "0.7", "1:1 lines"],
    "size unit": ["~m", "nm", "um", "\xb5m"],
    "size numbers": ["width twice", "width", "width and height"],
    "slow axis": [False, True],
    "cropped": [False, True],
    "rotated": [0, 90],
    "stopped": ["", "", "zeros", "short", "more held"],
    "order": ["trace", "retrace, trace", "trace, retrace", "retrace"],
    "kinds": ["Height", "Height Sensor", "both"],
    "interleave": [False, True],
    "beside": ["", "phase", "empty", "beyond", "no scale"],
    "soft": ["nm/V", "\xb5m/V"],
    "hard": ["full", "after plane fit"],
    "offset": [0.0, 0.5765625],
    "ends": ["\r\n", "\n"],
    "down": [False, True],
}
SOFT = {"nm/V": 1e-9, "\xb5m/V": 1e-6}
UNITS = {"~m": 1e-6, "um": 1e-6, "\xb5m": 1e-6, "nm": 1e-9}
SENSORS = {"Height": ("Height", "Sens. Zsens"), "Height Sensor": ("ZSensor", "Sens. ZsensSens")}


def write(random: Random, folder: Path, plain: bool = False) -> Made:
    c = _consistent(chosen(random, GRID, plain))
    nx = int(random.integers(3, 11)) * 4
    ny, held, valid = _lines(random, c, nx)
    width = float(f"{10 ** random.uniform(-0.3, 1.3):.3g}")  # um
    side = width * 1e-6
    height = side if c["aspect"] in ("1:1", "1:1 lines") else side * ny / nx
    c["high"] = f"{height / UNITS[c['size unit']]:.7g}"
    c["height"] = f"{height * 1e9:.7g}"
    pixel = (height / ny, side / nx)
    ranges = float(10 ** random.uniform(-8.5, -6.5))
    channels: list[dict[str, Any]] = []
    for kind in ["Height", "Height Sensor"] if c["kinds"] == "both" else [c["kinds"]]:
        for direction in c["order"].split(", "):
            channels.append({"kind": kind, "trace": direction == "trace", "line": "Main"})
    if c["interleave"]:
        channels.insert(0, {"kind": channels[0]["kind"], "trace": channels[0]["trace"], "line": "Interleave"})
    soft = {"Height": float(f"{random.uniform(5, 20):.5g}"), "Height Sensor": float(f"{random.uniform(200, 950):.6g}")}
    for channel in channels:
        raw, heights, scale = _raw(random, c, (held, nx), valid, ranges, soft[channel["kind"]] * 1e-9)
        channel |= {
            "raw": raw,
            "hard": scale,
            "plane": Plane(channel["kind"], heights, pixel, channel["trace"], free=c["offset"] != 0),
        }
    path = folder / "image.spm"
    path.write_bytes(_file(c, channels, soft, (ny, nx), width, valid, held))
    told = []
    if c["beside"] in ("empty", "beyond", "no scale"):
        told.append(("Phase", "Amplitude"))
    if len(valid) < ny:
        told.append(("line", "row", "missing", "pixel"))
    defaults, others = _ranked(channels)
    return Made(FORMAT, path, c, Image(defaults, others), told=tuple(told))


def _consistent(c: dict[str, Any]) -> dict[str, Any]:
    new = c["version"] == "0x09400103"
    wide = {"bytes": 4 if new else 2, "said": 4 if new and c["wide"] else 2}
    if c["aspect"] != "1:1" and c["stopped"] == "more held":
        c["stopped"] = ""
    if c["cropped"]:
        c |= {"stopped": "", "slow axis": False}
        if c["aspect"] == "1:1 lines":
            c["aspect"] = "1:1"
    return c | wide


def _lines(random: Random, c: dict[str, Any], nx: int) -> tuple[int, int, range]:
    """Lines of the full scan, lines held by the data, lines that were measured."""
    ny = {"1:1": nx, "2:1": nx // 2, "4:1": nx // 4, "0.7": round(0.7 * nx), "1:1 lines": nx // 2}[c["aspect"]]
    ny = ny if ny > 4 else 4
    done = int(np.maximum(4, int(ny * random.uniform(0.4, 0.9))))
    if c["stopped"] == "zeros":
        return ny, ny, range(ny - done, ny) if c["down"] else range(done)
    if c["stopped"] == "short":
        return ny, done, range(done)
    if c["stopped"] == "more held":
        return ny, ny // 2, range(ny // 2)
    return ny, ny, range(ny)


def _raw(random: Random, c: dict[str, Any], held: tuple[int, int], valid: range, ranges: float, soft: float) -> Any:
    top = 2 ** (8 * c["said"])
    wished = surface(random, (len(valid), held[1]), ranges)
    full = 440.0 if soft < 5e-8 else 24.576
    hard = full if c["hard"] == "full" else float(f"{3 * ranges / soft:.7g}")
    scale = hard / top * soft
    raw = np.zeros(held, int)
    raw[valid.start : valid.stop] = np.round(wished / scale)
    heights: Array = raw[valid.start : valid.stop] * scale
    return raw, heights, hard


def _ranked(channels: list[dict[str, Any]]) -> tuple[tuple[Plane, ...], tuple[Plane, ...]]:
    """What may be the default: the sensor's trace; where the sensor has a retrace only, the piezo's trace as well."""
    main = [ch for ch in channels if ch["line"] == "Main"]
    traces = [ch for ch in main if ch["trace"]] or main
    sensor = [ch for ch in main if ch["kind"] == "Height Sensor"]
    best = [ch for ch in sensor if ch["trace"]] or [*sensor[:1], *traces]
    return tuple(ch["plane"] for ch in best), tuple(ch["plane"] for ch in channels if ch not in best)


def _file(
    c: dict[str, Any],
    channels: list[dict[str, Any]],
    soft: dict[str, float],
    shape: tuple[int, int],
    width: float,
    valid: range,
    held: int,
) -> bytes:
    ny, nx = shape
    size = f"{width * 1e-6 / UNITS[c['size unit']]:.6g}"
    unit = SOFT[c["soft"]]
    scanner = [f"@Sens. Zsens: V {soft['Height'] * 1e-9 / unit:.10g} {c['soft']}"]
    sensor = f"@Sens. ZsensSens: V {soft['Height Sensor'] * 1e-9 / unit:.10g} {c['soft']}"
    lines = ["*File list", f"Version: {c['version']}", "Date: 01:33:51 PM Mon Dec 15 2014", "Start context: OL2BIG"]
    lines += [f"Data length: {OFFSET}", "Text: ", "*Equipment list", "Description: Dimension Icon", "*Scanner list"]
    lines += ["Scanner type: AFM", "Piezo size: J", *scanner, "*Ciao scan list", "Operating mode: Image"]
    full = 2 if c["cropped"] else 1  # the scan of which this is a part
    lines += [f"Scan Size: {full * width * 1e3:.6g} nm", "X Offset: 0 nm", f"Samps/line: {full * nx}"]
    lines += [f"Slow Axis Size: {c['height']} nm"] if c["slow axis"] else []
    lines += [f"Rotate Ang.: {c['rotated']}"]
    lines += [f"Lines: {ny // 4 if c['stopped'] == 'more held' else full * ny}"]
    lines += [f"Aspect Ratio: {c['aspect'].split()[0]}"]
    lines += [sensor, "@Sens. Phase: V 1.000000 ", "@Sens. DeflSens: V 41.14015 nm/V"]
    body, at = b"", OFFSET
    for ch in channels:
        data = ch["raw"].astype(f"<i{c['bytes']}").tobytes()
        lines += _list(c, ch["kind"], ch["trace"], ch["line"], at, len(data), nx, ny, size, valid, ch["hard"])
        body, at = body + data, at + len(data)
    if c["beside"]:
        data = np.arange(nx * held, dtype=f"<i{c['bytes']}").tobytes()
        where = at if c["beside"] != "beyond" else at + 10**6
        lines += _list(c, "Phase", True, "Main", where, len(data), nx, ny, size, valid, 359.9945)
        if c["beside"] == "empty":
            start = len(lines) - 1 - lines[::-1].index(f"Samps/line: {nx}")
            lines[start] = "Samps/line: 0 0"
        if c["beside"] == "no scale":
            lines = lines[:-2] + lines[-1:]
        if c["beside"] != "beyond":
            body += data
    lines.append("*File list end")
    return _text(c, lines) + body


def _text(c: dict[str, Any], lines: list[str]) -> bytes:
    """The header, filled up to the first data."""
    text = "".join(f"\\{line}{c['ends']}" for line in lines)
    if c["version"] == "0x05300001":
        for new, old in (
            ("Scan Size", "Scan size"),
            ("Line Direction", "Line direction"),
            ("Aspect Ratio", "Aspect ratio"),
        ):
            text = text.replace(new, old)
    head = text.encode("latin-1") + b"\x1a"
    assert len(head) <= OFFSET, "a longer header than its place"
    return head.ljust(OFFSET, b"\0")


def _list(
    c: dict[str, Any],
    kind: str,
    trace: bool,
    line: str,
    at: int,
    length: int,
    nx: int,
    ny: int,
    size: str,
    valid: range,
    hard: float,
) -> list[str]:
    internal, soft = SENSORS.get(kind, ("Phase", "Sens. Phase"))
    unit = "V" if kind in SENSORS else "\xba"
    stated = {"width twice": f"{size} {size}", "width": size}.get(c["size numbers"], f"{size} {c['high']}")
    return [
        "*Ciao image list",
        f"Data offset: {at}",
        f"Data length: {length}",
        f"Bytes/pixel: {c['said']}",
        "Start context: OL",
        "Data type: AFM",
        "Note: ",
        "Plane fit: 0 0 0 5",
        f"Frame direction: {'Down' if c['down'] else 'Up'}",
        "Capture start line: 0",
        f"Samps/line: {nx}",
        f"Number of lines: {ny}",
        f"Aspect Ratio: {c['aspect'].split()[0]}",
        f"Scan Size: {stated} {c['size unit']}",
        f"Scan Line: {line}",
        f"Line Direction: {'Trace' if trace else 'Retrace'}",
        "Realtime Planefit: Line",
        "Offline Planefit: None",
        "Valid data start X: 0",
        f"Valid data start Y: {valid.start}",
        f"Valid data len X: {nx}",
        f"Valid data len Y: {len(valid)}",
        f'@2:Image Data: S [{internal}] "{kind}"',
        "@Z magnify: C [2:Z scale] 1.000000 ",
        f"@2:Z scale: V [{soft}] ({hard / 2 ** (8 * c['said']):.10f} {unit}/LSB) {hard:.7g} {unit}",
        f"@2:Z offset: V [{soft}] ({hard / 2 ** (8 * c['said']):.10f} {unit}/LSB) {c['offset']:9.7g} {unit}",
    ]
