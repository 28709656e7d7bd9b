# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch export FILE --out OTHER``: recordings, curves, images and maps in formats that others open."""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import curves, images, maps, record
from nanotouch.errors import InvalidValue

from nanotouch_app.common import output
from nanotouch_app.common.quantity import parse_quantity, whole_number

HDF5_ENDINGS = (".h5", ".hdf5")
IMAGE_ENDINGS = (".gwy", ".gsf")
ONE_CURVE = (".tab", ".ibw")
ENDINGS = (".csv", *HDF5_ENDINGS, *ONE_CURVE, *IMAGE_ENDINGS)
CHANNELS = {"time": "s", "z": "m", "deflection": "m", "force": "N"}


def add_parser(subparsers: Any) -> None:
    """Add ``export`` to the command's sub-commands."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "export",
        description="Write a recording as CSV or HDF5; curves as CSV, or as afmformats' HDF5 or text; an image or a "
        "map.nc as .gwy with all its channels; an image as .gsf.",
    )
    parser.add_argument(
        "file", type=Path, metavar="FILE", help="recording.mcap, a force curve file, an AFM image, a map.nc"
    )
    parser.add_argument(
        "--out", type=Path, required=True, metavar="FILE",
        help="what to write: .csv, .h5, .hdf5, .tab or .ibw (one curve), .gwy or .gsf",
    )  # fmt: skip
    parser.add_argument(
        "--index", type=whole_number(0, 10**9), metavar="N", help="one curve of a map (default: all of them)"
    )
    parser.add_argument("--spring-constant", metavar="STIFFNESS", help="of curves, in place of the file's, as 8N/m")
    parser.add_argument("--sensitivity", metavar="SENSITIVITY", help="of curves, in place of the file's, as 40nm/V")
    parser.add_argument("--channel", metavar="NAME", help="channel of an image or a map, for .gsf")
    parser.add_argument("--pixel-size", metavar="LENGTH", help="of an image that does not state it, for .gsf, as 10nm")
    output.takes_overwrite(parser)
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Write ``args.out``; its ending says which kind of table."""
    ending = args.out.suffix.lower()
    if ending not in ENDINGS:
        raise InvalidValue(f"--out {args.out}: the ending must be {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")
    output.check_free(args.out, args)
    if ending in IMAGE_ENDINGS:
        what = _export_image(args, ending)
        args.answer = {"file": str(args.out), "holds": what}
        print(f"{args.out}: {what}")
        return 0
    with output.progress_bar("exporting") as progress:
        if record.is_recording(args.file) and ending not in ONE_CURVE:
            what = _export_recording(args.file, args.out, ending == ".csv", progress)
        else:
            if ending in ONE_CURVE and record.is_recording(args.file):
                raise InvalidValue(f"--out {args.out}: a recording is written as .csv, .h5 or .hdf5")
            found = curves.read(args.file, **_calibration(args))
            what = _export_curves(_picked(found, args), args.out, ending == ".csv", progress)
    args.answer = {"file": str(args.out), "holds": what}
    print(f"{args.out}: {what}")
    return 0


def _calibration(args: argparse.Namespace) -> dict[str, Any]:
    """What is given in place of the file's own."""
    given: dict[str, Any] = {}
    if args.spring_constant is not None:
        given["spring_constant"] = parse_quantity(args.spring_constant, "N/m")
    if args.sensitivity is not None:
        given["sensitivity"] = curves.parse_sensitivity(args.sensitivity)
    return given


def _picked(found: Sequence[curves.ForceCurve], args: argparse.Namespace) -> Sequence[curves.ForceCurve]:
    if args.index is None:
        return found
    if args.index >= len(found):
        raise InvalidValue(f"--index {args.index}: {args.file} holds the curves 0 .. {len(found) - 1}")
    return [found[args.index]]


def _export_image(args: argparse.Namespace, ending: str) -> str:
    """All channels of an image or a map as .gwy, one as .gsf."""
    if args.file.suffix == ".nc":
        return _export_map(args, ending)
    if ending == ".gsf":
        size = None if args.pixel_size is None else parse_quantity(args.pixel_size, "m")
        topography = images.read(args.file, args.channel, pixel_size=size)
        images.write(args.out, topography)
        ny, nx = topography.shape
        told = f"{topography.channel or 'heights'}, {nx} x {ny} pixels"
        if topography.masked_pixels:
            told += f"; {topography.masked_pixels} missing ones are NaN"
        return told
    found, left_out = images.planes(args.file)
    images.write_planes(args.out, found)
    for text in left_out:
        print(f"nanotouch export: left out {text}", file=sys.stderr)
    return _named(found)


def _export_map(args: argparse.Namespace, ending: str) -> str:
    """As _export_image; of one channel the first if none is named."""
    found = maps.planes(maps.read(args.file))
    if ending == ".gsf":
        found = [plane for plane in found if args.channel in (None, plane.name)][:1]
        if not found:
            raise InvalidValue(f"--channel {args.channel}: {args.file} determines no such quantity")
    images.write_planes(args.out, found)
    return _named(found)


def _named(planes: Sequence[images.Plane]) -> str:
    return f"{len(planes)} channel{'s' if len(planes) > 1 else ''}: {', '.join(plane.name for plane in planes)}"


def _export_recording(file: Path, out: Path, as_csv: bool, progress: Callable[[float], None]) -> str:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        recording = record.read(file)
    for warning in caught:
        print(f"nanotouch export: {warning.message}", file=sys.stderr)
    if as_csv:
        recording.to_csv(out, progress)
    else:
        recording.to_hdf5(out)
    return f"{len(recording)} rows, {len(recording.columns)} columns"


def _export_curves(
    found: Sequence[curves.ForceCurve], out: Path, as_csv: bool, progress: Callable[[float], None]
) -> str:
    if as_csv:
        _write_csv(out, found, progress)
    else:
        curves.write(out, found, progress)
    points = sum(len(segment) for curve in found for segment in curve.segments)
    told = f"{len(found)} force curve{'s' if len(found) > 1 else ''}, {points} points"
    if out.suffix.lower() == ".ibw":
        told += "; in nanite and PyJibe add the step 'segment discovery', as their reader parts no .ibw into branches"
    return told


def _segments(found: Sequence[curves.ForceCurve]) -> Iterator[tuple[int, int, curves.Segment]]:
    for number, curve in enumerate(found):
        for position, segment in enumerate(curve.segments):
            yield number, position, segment


def _channels(segment: curves.Segment) -> dict[str, Any]:
    """The channels the segment has, by name."""
    values = {name: getattr(segment, name) for name in CHANNELS}
    return {name: channel for name, channel in values.items() if channel is not None}


def _write_csv(out: Path, found: Sequence[curves.ForceCurve], progress: Callable[[float], None]) -> None:
    """One row per point: which curve, which segment, and its channels; NaN where a segment lacks one."""
    segments = list(_segments(found))
    sizes = [len(segment) for *_, segment in segments]
    table: dict[str, Any] = {
        "curve": np.repeat([number for number, _, _ in segments], sizes),
        "segment": np.repeat([position for _, position, _ in segments], sizes),
        "role": np.repeat([segment.role for *_, segment in segments], sizes),
    }
    for name, unit in CHANNELS.items():
        channels = [_channels(segment).get(name, np.full(len(segment), np.nan)) for *_, segment in segments]
        table[f"{name} [{unit}]"] = np.concatenate(channels)
    comments = {"file": found[0].name, "z": ", ".join(sorted({segment.z_channel for *_, segment in segments}))}
    comments |= {key: json.dumps(value, default=str) for key, value in found[0].meta.items() if len(found) == 1}
    record.write_csv(out, table, comments, progress)
