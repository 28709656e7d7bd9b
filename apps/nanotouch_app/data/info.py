# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch info FILE``: what an image, a force curve file, a thermal spectrum or a recording holds."""

from __future__ import annotations

import argparse
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import nanotouch as nt
from nanotouch import formats
from nanotouch.errors import MissingExtra, ReadError

from nanotouch_app.common import output

if TYPE_CHECKING:  # what only one kind of file needs takes as long to load as an image to list
    from nanotouch import curves, images

_META = (("instrument", ""), ("date", ""), ("spring constant", "N/m"), ("sensitivity", "m/V"), ("setpoint", "N"))
MCAP = b"\x89MCAP0\r\n"  # how a recording begins
_LISTED = 20  # curves of a map that are listed one by one
Answer = tuple[list[str], dict[str, Any]]
"""lines for a reader, and the same as data, SI"""


def add_parser(subparsers: Any) -> None:
    """Add ``info`` to the command's sub-commands."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "info",
        description="Say what an AFM image, a force curve file or a recording holds.",
    )
    parser.add_argument("file", type=Path, metavar="FILE", help="an AFM image, a force curve file or a recording")
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Print what ``args.file`` holds; raises :class:`nanotouch.errors.Error` where it is none of them."""
    with output.busy("reading"):
        lines, facts = _described(args.file)
    args.answer = {"file": str(args.file), **facts}
    print("\n".join(lines))
    return 0


def describe(file: Path) -> list[str]:
    """What a file holds, in lines."""
    return _described(file)[0]


def _described(file: Path) -> Answer:
    """The answer. Some endings serve both kinds (.ibw, .h5), so what the file is decided by reading it."""
    if formats.begins_with(file, MCAP):
        return _describe_recording(file)
    if file.suffix.lower() == ".tnd":
        return _describe_thermal(file)
    if file.suffix.lower() == ".toml" and file.is_file():
        raise ReadError(f"{file}: a TOML file: nanotouch plan reads a scene, nanotouch rig check a rig")
    problems: list[ReadError | MissingExtra] = []
    kinds = (_describe_curves, _describe_image)
    for kind in kinds[::-1] if formats.looks_like_image(file) else kinds:
        if kind is _describe_curves and formats.is_image(file):
            continue
        try:
            return kind(file)
        except (ReadError, MissingExtra) as error:
            problems.append(error)
    missing = [error for error in problems if isinstance(error, MissingExtra)]
    if missing:
        raise missing[0]
    if len(problems) > 1 and formats.looks_like_image(file):
        problems.reverse()
    reasons = [str(error).removeprefix(f"{file}: ") for error in problems]
    if len(set(reasons)) == 1:
        raise problems[0]
    raise ReadError(f"{file}: as a force curve: {reasons[0]}; as an image: {reasons[1]}")


def _describe_recording(file: Path) -> Answer:
    from nanotouch import record  # what only recordings need takes as long to load as an image to list

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of damage: it is told as what the recording lacks
        recording = record.read(file)
    span = f"{recording.time[0]:.6g} .. {recording.time[-1]:.6g} s" if len(recording) else "none"
    facts = {name: recording.metadata.get(name, "not stated") for name in ("mode", "control", "probe_model", "seed")}
    lines = [
        f"{file.name}: recording, {len(recording)} rows, time {span}",
        "  " + ", ".join(f"{name.replace('_', ' ')} {value}" for name, value in facts.items()),
        f"  columns: {', '.join(recording.columns)}",
    ]
    lines += [] if recording.incomplete is None else [f"  INCOMPLETE: {recording.incomplete}"]
    times = [float(recording.time[0]), float(recording.time[-1])] if len(recording) else None
    known = {"kind": "recording", "rows": len(recording), "time_s": times, "incomplete": recording.incomplete}
    return lines, known | {name: recording.metadata.get(name) for name in facts} | {"columns": list(recording.columns)}


def _describe_thermal(file: Path) -> Answer:
    found = nt.curves.thermal_spectrum(file)
    lines = [f"{file.name}: thermal spectrum, {found.frequency.size} points up to {found.frequency[-1] / 1e3:.4g} kHz"]
    for name, value, unit in (
        ("sensitivity", found.sensitivity, "m/V"),
        ("spring constant", found.spring_constant, "N/m"),
    ):
        lines.append(f"  {name}: {'not stated' if value is None else f'{value:.4g} {unit}'}")
    return lines, {
        "kind": "thermal spectrum", "points": int(found.frequency.size),
        "highest_frequency_Hz": float(found.frequency[-1]),
        "sensitivity_m_per_V": found.sensitivity, "spring_constant_N_per_m": found.spring_constant,
    }  # fmt: skip


def _describe_image(file: Path) -> Answer:
    from nanotouch.images.words import lengths

    listed = nt.images.channels(file)
    lines = [f"{file.name}: AFM image, {len(listed)} channel{'s' if len(listed) > 1 else ''}"]
    for channel in listed:
        shape = "? pixels" if channel.shape is None else f"{channel.shape[1]} x {channel.shape[0]} pixels"
        size = "size not stated" if channel.size is None else lengths(channel.size[::-1])
        unit = channel.unit or "not stated"
        mark = "  <- read by default" if channel.default else ""
        lines.append(f"  {channel.name:24} {channel.kind:11} {shape}, {size}, unit {unit}{mark}")
    facts: dict[str, Any] = {"kind": "image", "channels": [_channel(channel) for channel in listed]}
    try:
        topography = nt.images.read(file)
    except ReadError as error:
        reason = str(error).removeprefix(f"{file}: ")
        return [*lines, f"  cannot be touched as it is: {reason}"], facts | {"cannot_be_touched": reason}
    low, high = float(topography.heights.min()), float(topography.heights.max())
    dy, dx = topography.pixel_size
    lines.append(f"  heights {lengths((low, high), 4, ' .. ')}, pixel {lengths((dx, dy))}, {topography.source}")
    if topography.masked_pixels:
        lines.append(f"  {topography.masked_pixels} missing pixels, filled from their neighbours")
    facts |= {
        "heights_m": [low, high], "pixel_size_m": [dx, dy], "reader": topography.source,
        "missing_pixels": int(topography.masked_pixels), "notes": list(topography.notes),
    }  # fmt: skip
    return lines + [f"  note: {note}" for note in topography.notes], facts


def _channel(channel: images.Channel) -> dict[str, Any]:
    """x before y, as the lines have it."""
    return {
        "name": channel.name, "kind": channel.kind, "unit": channel.unit or None, "default": channel.default,
        "pixels": None if channel.shape is None else [int(count) for count in channel.shape[::-1]],
        "size_m": None if channel.size is None else [float(side) for side in channel.size[::-1]],
    }  # fmt: skip


def _describe_curves(file: Path) -> Answer:
    found = nt.curves.read(file)
    first = found[0]
    lines = [f"{file.name}: {len(found)} force curve{'s' if len(found) > 1 else ''}, {first.meta.get('format', '')}"]
    for key, unit in _META:
        if key in first.meta:
            value = first.meta[key]
            lines.append(f"  {key}: {value:.4g} {unit}" if isinstance(value, float) else f"  {key}: {value}")
    lines += [f"  note: {note}" for note in first.meta.get("notes", ())]
    for curve in found[:_LISTED]:
        lines.append(f"  curve {curve.meta.get('enum', 0)}: " + "; ".join(_segment(s) for s in curve.segments))
    if len(found) > _LISTED:
        lines.append(f"  and {len(found) - _LISTED} more")
    names = {f"{key} {unit}".strip().replace(" ", "_").replace("/", "_per_"): key for key, unit in _META}
    return lines, {
        "kind": "force curves", "curves": len(found), "format": first.meta.get("format"),
        **{name: first.meta.get(key) for name, key in names.items()},
        "notes": list(first.meta.get("notes", ())),
        "segments": [[_facts(segment) for segment in curve.segments] for curve in found],
    }  # fmt: skip


def _facts(segment: curves.Segment) -> dict[str, Any]:
    force = segment.force
    return {
        "role": segment.role, "points": len(segment), "z_channel": segment.z_channel,
        "z_m": [float(segment.z[0]), float(segment.z[-1])],
        "force_N": None if force is None else [float(force.min()), float(force.max())],
    }  # fmt: skip


def _segment(segment: curves.Segment) -> str:
    z = segment.z * 1e6
    text = f"{segment.role} {len(segment)} points, {segment.z_channel} {z[0]:.4g} -> {z[-1]:.4g} um"
    if segment.force is not None:
        text += f", force {segment.force.min() * 1e9:.4g} .. {segment.force.max() * 1e9:.4g} nN"
    return text
