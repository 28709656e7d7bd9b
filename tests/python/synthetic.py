# SPDX-License-Identifier: BSD-3-Clause
"""Small measured-looking files in real formats, and surfaces and curves whose answer is known.

Heights are given as everywhere in nanotouch, row 0 at the lower edge; every writer puts them where its format wants
them, from the published description of the format, not through the readers under test.
"""

from __future__ import annotations

import json
import os
import struct
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
#: real files, beside the checkout where present
DATA = Path(os.environ.get("NANOTOUCH_DATA", Path(__file__).resolve().parents[2].parent / "shared" / "data"))


def asymmetric(ny: int = 24, nx: int = 32) -> Array:
    """A picture [m] that no flip, turn or transposition leaves alone: an L in the lower left, a block upper right."""
    heights = 1e-9 * np.linspace(0.0, 1.0, nx) * np.ones((ny, 1))
    heights[2:16, 2:5] = 40e-9
    heights[2:5, 2:14] = 40e-9
    heights[ny - 5 : ny - 2, nx - 6 : nx - 2] = 25e-9
    return heights


def grating(
    n: int = 128, side: float = 10e-6, *, height: float = 480e-9, duty: float = 0.3, along_y: bool = True
) -> tuple[Array, NDArray[np.bool_]]:
    """A square grating of 3 um period (n, n) [m] and its ridge mask; lines along y, or along x (the fast axis)."""
    x = (np.arange(n) + 0.5) * side / n
    ridge = np.tile(((x - 0.75e-6) % 3e-6) < duty * 3e-6, (n, 1))
    if not along_y:
        ridge = ridge.T.copy()
    return np.where(ridge, height, 0.0), ridge


def tilted(heights: Array, side: float, slope_y: float, slope_x: float) -> Array:
    """The same on a slope."""
    ny, nx = heights.shape
    y, x = np.meshgrid(np.arange(ny) * side / ny, np.arange(nx) * side / nx, indexing="ij")
    return np.asarray(heights + slope_y * y + slope_x * x)


# --- images -----------------------------------------------------------------------------------------------------------


def write_matrix(path: Path, heights: Array, side: tuple[float, float] | None, unit: str | None = "m") -> Path:
    """Text matrix with Gwyddion's header: first line is the top of the picture; side = (Ly, Lx) [m], values in unit."""
    header = ["# Channel: Topography"]
    if side is not None:
        header += [f"# Width: {side[1] * 1e6:.9g} µm", f"# Height: {side[0] * 1e6:.9g} µm"]
    if unit is not None:
        header.append(f"# Value units: {unit}")
    rows = ["\t".join(f"{z:.9g}" for z in row) for row in heights[::-1]]
    path.write_text("\n".join(header + rows) + "\n", encoding="utf-8")
    return path


def write_gwy(
    path: Path,
    heights: Array,
    side: tuple[float, float],
    mask: NDArray[np.bool_] | None = None,
    more: dict[str, tuple[Array, str]] | None = None,
    first: tuple[str, str] = ("Height", "m"),
) -> Path:
    """Gwyddion's native format: nested named components, little endian, first row is the top; title and unit of the
    ``first`` channel, and ``more`` channels with their units."""

    def text(value: str) -> bytes:
        return value.encode() + b"\0"

    def component(name: str, kind: bytes, value: bytes) -> bytes:
        return text(name) + kind + value

    def thing(name: str, parts: list[bytes]) -> bytes:
        body = b"".join(parts)
        return text(name) + struct.pack("<I", len(body)) + body

    def field(rows: Array, unit_z: str) -> bytes:
        shape = (("xres", rows.shape[1]), ("yres", rows.shape[0]))
        parts = [component(k, b"i", struct.pack("<i", v)) for k, v in shape]
        parts += [component(k, b"d", struct.pack("<d", v)) for k, v in (("xreal", side[1]), ("yreal", side[0]))]
        for key, unit in (("si_unit_xy", "m"), ("si_unit_z", unit_z)):
            parts.append(component(key, b"o", thing("GwySIUnit", [component("unitstr", b"s", text(unit))])))
        data = np.ascontiguousarray(rows[::-1], "<f8")
        parts.append(component("data", b"D", struct.pack("<I", data.size) + data.tobytes()))
        return thing("GwyDataField", parts)

    title, unit_z = first
    container = [component("/0/data/title", b"s", text(title)), component("/0/data", b"o", field(heights, unit_z))]
    if mask is not None:
        container.append(component("/0/mask", b"o", field(mask.astype(float), "")))
    for number, (name, (values, unit)) in enumerate((more or {}).items(), 1):
        container.append(component(f"/{number}/data/title", b"s", text(name)))
        container.append(component(f"/{number}/data", b"o", field(values, unit)))
    path.write_bytes(b"GWYP" + thing("GwyContainer", container))
    return path


def write_ibw(
    path: Path,
    wave: Array,
    labels: list[str],
    *,
    pitch: float = 1.0,
    note: dict[str, object] | None = None,
    unit: str = "m",
) -> Path:
    """Igor binary wave, version 5 (Igor's technical note 3): `wave` with the channels on the last axis, named `labels`.

    Igor's index runs fastest along the first axis; a picture is wave[x, y, channel] with y upwards.
    """
    dims = [*wave.shape, 0, 0, 0][:4]
    data = np.asfortranarray(wave, "<f8").tobytes("F")
    text = "".join(f"{k}: {v}\r" for k, v in (note or {}).items()).encode("latin-1")
    channel_axis = wave.ndim - 1
    names = b"".join(name.encode().ljust(32, b"\0") for name in ["", *labels])
    label_sizes = [len(names) if axis == channel_axis else 0 for axis in range(4)]
    steps = [pitch if axis < channel_axis else 1.0 for axis in range(4)]
    metre = b"m\0\0\0"
    units = [metre if axis < channel_axis else b"\0" * 4 for axis in range(4)]
    wave_header = struct.pack("<4xIIihhxxxxxxh32sii", 0, 0, wave.size, 4, 0, 1, b"wave0".ljust(32, b"\0"), 0, 0)
    wave_header += struct.pack("<4i4d4d", *dims, *steps, *[0.0] * 4)
    wave_header += unit.encode("latin-1").ljust(4, b"\0") + b"".join(units)
    wave_header = wave_header.ljust(320, b"\0")

    def file_header(checksum: int) -> bytes:
        sizes = (320 + len(data), 0, len(text), 0, 0, 0, 0, 0, *label_sizes, 0, 0, 0)
        return struct.pack("<hh15i", 5, checksum, *sizes)

    shorts = np.frombuffer(file_header(0) + wave_header, "<i2").astype(np.int64)  # they shall sum to zero
    checksum = int(np.array(-shorts.sum(), np.int64).astype(np.int16))
    path.write_bytes(file_header(checksum) + wave_header + data + text + names)
    return path


def write_ibw_image(path: Path, channels: dict[str, Array], pitch: float) -> Path:
    """An Asylum image: channels (ny, nx) by name, square pixels of `pitch` [m]."""
    wave = np.stack([heights.T for heights in channels.values()], axis=-1)
    ny, nx = wave.shape[1], wave.shape[0]
    note: dict[str, object] = {"MicroscopeModel": "Synthetic", "Version": "1", "ScanPoints": nx, "ScanLines": ny}
    note |= {"FastScanSize": f"{(nx - 1) * pitch:.6g}", "SlowScanSize": f"{(ny - 1) * pitch:.6g}"}
    return write_ibw(path, wave, list(channels), pitch=pitch, note=note)


def write_nid(path: Path, heights: Array, side: tuple[float, float]) -> Path:
    """Nanosurf easyScan: an INI-like header, then lines of int32 from the bottom of the picture up."""
    ny, nx = heights.shape
    low, span = float(heights.min()), float(np.ptp(heights)) * (1 + 1e-9)
    header: dict[str, dict[str, object]] = {
        "DataSet": {"Version": 2, "GroupCount": 1, "Gr0-Name": "Scan", "Gr0-Count": 1, "Gr0-Ch0": "DataSet-0:0"},
        "DataSet-Info": {"Date": "01-02-2020", "Time": "10:11:12"},
        r"DataSet\DataSetInfos\Scan": {"Image size": f"{side[1] * 1e6:g}µm", "Points": nx, "Lines": ny},
        "DataSet-0:0": {
            "Version": 2, "Points": nx, "Lines": ny, "Frame": "Scan forward", "SaveMode": "Binary", "SaveBits": 32,
            "SaveSign": "Signed", "SaveOrder": "Intel", "Dim0Name": "X", "Dim0Unit": "m", "Dim0Range": side[1],
            "Dim0Min": 0, "Dim1Name": "Y", "Dim1Unit": "m", "Dim1Range": side[0], "Dim1Min": 0, "Dim2Name": "Z-Axis",
            "Dim2Unit": "m", "Dim2Range": repr(span), "Dim2Min": repr(low),
        },
    }  # fmt: skip
    lines = [f"[{section}]\r\n" + "".join(f"{k}={v}\r\n" for k, v in keys.items()) for section, keys in header.items()]
    raw = np.round((heights - low) / span * (2.0**32 - 1) - 2.0**31).astype("<i4")
    path.write_bytes("".join(lines).encode("latin-1") + b"#!" + raw.tobytes())
    return path


# --- force curves -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class KnownCurve:
    """Approach and retraction over a stiff sample, z away from the sample [m], force + repulsive [N]."""

    approach_z: Array
    approach_force: Array
    retract_z: Array
    retract_force: Array
    snap_in_force: float
    pull_off_force: float
    contact_point: float
    spring_constant: float
    noise: float


def known_curve(
    *, n: int = 1500, noise: float = 10e-12, tilt: float = 2e-4, waves: float = 0.0, seed: int = 1
) -> KnownCurve:
    """In contact the tip follows the base, F = k (z_0 - z) down to -pull-off; free: offset, tilt, interference."""
    k, contact = 0.8, 3.0e-7
    rng = np.random.default_rng(seed)
    z_in, z_out = np.linspace(8e-7, 2.8e-7, n), np.linspace(2.8e-7, 7.5e-7, n)

    def measured(z: Array, depth: float) -> tuple[Array, float]:
        touching = k * (contact - z)
        held = touching > -depth
        free = -3e-9 + tilt * (z - 5e-7) + waves * np.sin(2 * np.pi * z / 3.2e-7)
        force = np.where(held, touching, 0.0) + free + noise * rng.standard_normal(z.size)
        return force, float(-touching[held].min())  # the deepest attraction that was sampled

    force_in, snap_in = measured(z_in, 2e-9)
    force_out, pull_off = measured(z_out, 12e-9)
    return KnownCurve(z_in, force_in, z_out, force_out, snap_in, pull_off, contact, k, noise)


def write_ibw_curve(path: Path, curve: KnownCurve) -> Path:
    """An Asylum force curve: every point in one run, Z pushing towards the sample counted up, deflection in m."""
    z = np.concatenate([curve.approach_z, curve.retract_z])
    deflection = np.concatenate([curve.approach_force, curve.retract_force]) / curve.spring_constant
    note = {
        "IgorFileVersion": 6, "ImagingMode": "Contact", "NumPtsPerSec": 2000, "InvOLS": 5e-8,
        "TriggerChannel": "Force", "TriggerPoint": 1e-8,
        "SpringConstant": curve.spring_constant, "InputTime": 1.0, "ApproachVelocity": 1e-6, "RetractVelocity": 1e-6,
        "MicroscopeModel": "Synthetic", "Version": "1", "Date": "2020-02-01", "Time": "10:11:12",
    }  # fmt: skip
    return write_ibw(path, np.stack([-z, deflection, -z], axis=-1), ["Raw", "Defl", "ZSnsr"], note=note)


def write_jpk(
    path: Path,
    segments: list[tuple[str, Array, Array]],
    *,
    spring_constant: float | None = 0.05,
    sensitivity: float = 6e-8,
) -> Path:
    """JPK's .jpk-force: a zip of property files and big-endian integers; segments of (style, z [m], force [N]).

    Style is "extend", "pause" or "retract". Without a spring constant the file is uncalibrated, as JPK leaves it.
    """
    k = spring_constant or 0.05
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(
            "header.properties",
            "force-scan-series.header.position-index=0\nforce-scan-series.description.instrument=Synthetic\n",
        )
        archive.writestr("segments/", "")
        for number, (style, z, force) in enumerate(segments):
            folder = f"segments/{number}/"
            archive.writestr(folder, "")
            lines = [
                f"force-segment-header.settings.style={style}",
                "force-segment-header.settings.segment-settings.type=constant-force-pause",
                "force-segment-header.settings.segment-settings.duration=1.0",
                f"force-segment-header.settings.segment-settings.z-start={float(z[0])!r}",
                f"force-segment-header.settings.segment-settings.z-end={float(z[-1])!r}",
                "force-segment-header.settings.feedback-mode.name=contact",
                "force-segment-header.duration=1.0",
                f"force-segment-header.num-points={z.size}",
                "force-segment-header.approach-id=synthetic",
                "force-segment-header.time-stamp=2020-02-01 10\\:11\\:12.0 +0100",
            ]
            scales = [("distance", "volts", sensitivity, "m"), ("force", "distance", k, "N")]
            lines += _jpk_channel("vDeflection", force / (k * sensitivity), scales if spring_constant else scales[:1])
            if spring_constant is None:
                lines.append("channel.vDeflection.conversion-set.conversion.force.name=Force")
            for name, slot in (("measuredHeight", "nominal"), ("height", "calibrated")):
                lines += _jpk_channel(name, z / 1e-6, [(slot, "volts", 1e-6, "m")])
            archive.writestr(folder + "segment-header.properties", "\n".join(lines) + "\n")
            channels = {"vDeflection": force / (k * sensitivity), "measuredHeight": z / 1e-6, "height": z / 1e-6}
            for name, volts in channels.items():
                archive.writestr(f"{folder}channels/{name}.dat", _jpk_raw(volts)[0].tobytes())
    return path


def _jpk_raw(volts: Array) -> tuple[NDArray[np.int32], float, float]:
    offset, scale = float(volts.mean()), (float(np.ptp(volts)) or 1.0) / 2.0**31
    return np.round((volts - offset) / scale).astype(">i4"), scale, offset


def _jpk_channel(name: str, volts: Array, scales: list[tuple[str, str, float, str]]) -> list[str]:
    _, scale, offset = _jpk_raw(volts)
    head, conversion = f"channel.{name}", f"channel.{name}.conversion-set"
    lines = [
        f"{head}.data.encoder.type=signedinteger",
        f"{head}.data.encoder.scaling.offset={offset!r}",
        f"{head}.data.encoder.scaling.multiplier={scale!r}",
        f"{head}.data.encoder.scaling.unit.unit=V",
        f"{conversion}.conversions.base=volts",
    ]
    for slot, base, factor, unit in scales:
        scaling = f"{conversion}.conversion.{slot}"
        lines += [
            f"{scaling}.name={slot}", f"{scaling}.base-calibration-slot={base}", f"{scaling}.scaling.offset=0.0",
            f"{scaling}.scaling.multiplier={factor!r}", f"{scaling}.scaling.unit.unit={unit}",
        ]  # fmt: skip
    return lines


def write_tab(path: Path, columns: dict[str, Array], meta: dict[str, object]) -> Path:
    """afmformats' tab-separated values: metadata as commented JSON, then a table."""
    lines = ["# afmformats", "#", "# BEGIN METADATA"]
    lines += ["# " + line for line in json.dumps(meta, indent=2).split("\n")]
    lines += ["# END METADATA", "#", "# " + "\t".join(columns)]
    lines += ["\t".join(f"{value:.8g}" for value in row) for row in zip(*columns.values(), strict=True)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def write_nanoscope(
    path: Path,
    curves: list[tuple[Array, Array]],
    *,
    ramp: float = 300e-9,
    sensitivity: float = 41e-9,
    spring_constant: float = 0.999,
    version: str = "0x08150305",
    scan: str = "",
) -> Path:
    """Bruker's NanoScope 8 force file: deflections [V] of (approach, retraction), both from the deepest outwards."""
    near, far = (len(branch) for branch in curves[0])
    kind, volts_per_lsb = ("<i4", 0.000375 / 65536) if version >= "0x092" else ("<i2", 0.000375)
    piezo, offset = 12.18e-9, 4096
    data = b"".join(np.round(branch / volts_per_lsb).astype(kind).tobytes() for curve in curves for branch in curve)
    volts = ramp / piezo
    lines = [
        "*Force file list", f"Version: {version}", "Date: 01:06:11 PM Wed Oct 09 2019", f"Data length: {offset}",
        "*Scanner list", f"@Sens. Zsens: V {piezo * 1e9:.5f} nm/V",
        "*Ciao scan list", *([f"Scan Size: {scan}"] * bool(scan)), f"@Sens. DeflSens: V {sensitivity * 1e9:.5f} nm/V",
        "*Ciao force list", f"Forward vel.: {4 * volts}", f"Reverse vel.: {2 * volts}", "Ramp delay: 0",
        "Reverse delay: 0", f"force/line: {max(1, int(len(curves) ** 0.5))} 0",
        "*Ciao force image list", f"Data offset: {offset}", f"Data length: {len(data)}", f"Bytes/pixel: {kind[2]}",
        f"Samps/line: {far} {near}", f"Spring Constant: {spring_constant}",
        '@4:Image Data: S [DeflectionError] "Deflection Error"', "@Z magnify: C [4:Z scale] 1.000000",
        f"@4:Z scale: V [Sens. DeflSens] ({volts_per_lsb:.16f} V/LSB) 2.500000 V",
        f"@4:Ramp size: V [Sens. Zsens] (0.006103497 V/LSB) {volts:.6f} V", "*File list end",
    ]  # fmt: skip
    header = "".join(f"\\{line}\r\n" for line in lines).encode("latin-1") + b"\x1a"
    path.write_bytes(header.ljust(offset, b"\0") + data)
    return path
