# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch export FILE --out TABLE``: a recording or a force curve as CSV or HDF5, with the units in the headers."""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import curves, record
from nanotouch.errors import InvalidValue, require

from nanotouch_app import output

HDF5_ENDINGS = (".h5", ".hdf5")
CHANNELS = {"time": "s", "z": "m", "deflection": "m", "force": "N"}


def add_parser(subparsers: Any) -> None:
    """Add ``export`` to the command's sub-commands."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "export",
        help="a recording or a force curve as CSV or HDF5, with units",
        description="Write a recording or a force curve as CSV or HDF5, with the units in the headers.",
    )
    parser.add_argument("file", type=Path, metavar="RECORDING|CURVE", help="recording.mcap, or a force curve file")
    parser.add_argument("--out", type=Path, required=True, metavar="FILE", help="table to write: .csv, .h5 or .hdf5")
    output.add_overwrite(parser)
    parser.add_argument(
        "--untrusted", action="store_true", help="open CURVE in a worker with limits on memory, time and open files"
    )
    parser.set_defaults(run=run)


def run(args: argparse.Namespace) -> int:
    """Write ``args.out``; its ending says which kind of table."""
    ending = args.out.suffix.lower()
    if ending not in (".csv", *HDF5_ENDINGS):
        raise InvalidValue(f"--out {args.out}: the ending must be .csv, .h5 or .hdf5")
    output.check_free(args.out, args)
    with output.progress_bar("exporting") as progress:
        if record.is_recording(args.file):
            what = _export_recording(args.file, args.out, ending == ".csv", progress)
        else:
            found = curves.read(args.file, untrusted=args.untrusted)
            what = _export_curves(found, args.out, ending == ".csv", progress)
    print(f"{args.out}: {what}")
    return 0


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
        _write_hdf5(out, found, progress)
    points = sum(len(segment) for curve in found for segment in curve.segments)
    return f"{len(found)} force curve{'s' if len(found) > 1 else ''}, {points} points"


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


def _write_hdf5(out: Path, found: Sequence[curves.ForceCurve], progress: Callable[[float], None]) -> None:
    """One group per curve, in it one per segment, in it one dataset per channel with its unit."""
    h5py = require("h5py", "record")
    with record.replacing(out) as part, h5py.File(part, "w") as file:
        for number, curve in enumerate(found):
            group = file.create_group(f"curve {number}")
            group.attrs["name"] = curve.name
            group.attrs.update({key: json.dumps(value, default=str) for key, value in curve.meta.items()})
            for position, segment in enumerate(curve.segments):
                inner = group.create_group(f"segment {position}")
                inner.attrs["role"], inner.attrs["z channel"] = segment.role, segment.z_channel
                for name, values in _channels(segment).items():
                    dataset = inner.create_dataset(name, data=values, **record.HDF5_STORAGE)
                    dataset.attrs["unit"] = CHANNELS[name]
            progress((number + 1) / len(found))
