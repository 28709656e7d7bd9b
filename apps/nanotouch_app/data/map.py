# SPDX-License-Identifier: BSD-3-Clause
"""Fit every curve of a force volume or QI map; write the maps as netCDF (HDF5), a picture and a summary."""

from __future__ import annotations

import argparse
import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
from nanotouch import maps
from nanotouch.awaiting import awaited
from nanotouch.errors import Error, require
from nanotouch.fit.result import with_sigma
from nanotouch.maps.store import finished

from nanotouch_app.common import output, stop
from nanotouch_app.common.quantity import whole_number
from nanotouch_app.data import fit

FILES = ("map.nc", "map.png", "map.json")
SHOWN = (
    "effective_modulus", "youngs_modulus", "exponent", "relaxation_time", "work_of_adhesion", "pull_off_force",
    "adhesion_work", "contact_point",
)  # fmt: skip


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser = subparsers.add_parser("map", description=__doc__)
    parser.add_argument("file", metavar="FILE", help="force map (JPK .jpk-force-map, .jpk-qi-data, NanoScope, ...)")
    fit.add_knowledge(parser)
    parser.add_argument("--sidecar", metavar="FILE", help="TOML file: exclusions, contact points and baselines by hand")
    parser.add_argument(
        "--threads", type=whole_number(0, 1024), default=0, metavar="N", help="default: one per processor"
    )
    parser.add_argument(
        "--cluster", metavar="ADDRESS", help="Dask scheduler, as tcp://host:8786, or 'local' for processes here"
    )
    parser.add_argument(
        "--restart", action="store_true", help="drop what a run that was stopped has left, instead of going on from it"
    )
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    for module in ("xarray", "h5netcdf"):
        require(module, "maps")
    with output.folder(args, FILES) as out:
        blocks = out / "map.blocks"
        if args.restart:
            _remove(blocks)
        data = _fitted(args, blocks)
        with stop.keeping(f"the fits are kept, --out {out} goes on from them:", blocks):
            awaited(lambda: maps.write(out / "map.nc", data))
            maps.draw(data, save=out / "map.png")
        summary = summarise(data)
        output.write_json(out / "map.json", summary)
        args.answer = summary | {"folder": str(out), "files": list(FILES)}
        _remove(blocks)
        print(_text(data, summary))
        print(f"written to {out}/: map.nc, map.png, map.json")
    return 0


def _fitted(args: argparse.Namespace, blocks: Path) -> Any:
    try:
        with output.progress_bar("map") as progress:
            return awaited(lambda: maps.fit(
                args.file, args.model, cluster=args.cluster, resume=blocks, threads=args.threads, progress=progress,
                branch=args.branch, sidecar=args.sidecar, **fit.reading(args), **fit.knowledge(args),
            ))  # fmt: skip
    except stop.Stopped as stopped:
        raise stop.Stopped(stopped.number, _kept(blocks)) from None


def _kept(blocks: Path) -> str:
    """Say how much of a map that has ended early is finished."""
    curves = finished(blocks)
    if not curves:
        _remove(blocks)
        return "no block of curves was finished: nothing is kept"
    return f"{curves} {'curve is' if curves == 1 else 'curves are'} kept: --out {blocks.parent} goes on from them"


def summarise(data: Any) -> dict[str, Any]:
    """Medians and quartiles of what is determined, counts, and what the map was made of."""
    known = data["status"].values == 0
    quantities = {}
    for name in SHOWN:
        if name not in data:
            continue
        values = data[name].values[known & maps.determined(data, name)]
        quartiles = [float(v) for v in np.percentile(values, (25, 50, 75))] if values.size else [None] * 3
        unit = data[name].attrs["units"]
        quantities[name] = {"unit": unit, "curves": int(values.size)} | dict(
            zip(("lower_quartile", "median", "upper_quartile"), quartiles, strict=True)
        )
    reasons: dict[str, int] = {}
    for reason in data["reason"].values[~known].ravel():
        reasons[str(reason)] = reasons.get(str(reason), 0) + 1
    return {
        "input": data.attrs["input_name"],
        "input_sha256": data.attrs["input_sha256"],
        "shape": [data.sizes["y"], data.sizes["x"]],
        "curves_without_result": data.attrs["curves_without_result"],
        "reasons": reasons,
        "flags": maps.flag_counts(data),
        "quantities": quantities,
        "settings": json.loads(data.attrs["settings"]),
        "sidecar": json.loads(data.attrs["sidecar"]),
        "sidecar_unused": json.loads(data.attrs["sidecar_unused"]),
        "calibration": json.loads(data.attrs["calibration"]),
        "assumptions": data.attrs["assumptions"],
        "versions": json.loads(data.attrs["versions"]),
    }


def _text(data: Any, summary: dict[str, Any]) -> str:
    count, without = data.attrs["curves"], data.attrs["curves_without_result"]
    lines = [f"{data.attrs['title']}: {data.sizes['y']} x {data.sizes['x']} curves, {count - without} fitted"]
    for name, found in summary["quantities"].items():
        if found["median"] is None:
            lines.append(f"  {name:18} not determined by any curve")
            continue
        spread = 0.5 * (found["upper_quartile"] - found["lower_quartile"])
        text = with_sigma(found["median"], spread, "" if found["unit"] == "1" else found["unit"])
        many = "1 curve" if found["curves"] == 1 else f"{found['curves']} curves"
        lines.append(f"  {name:18} {text} (median +- half the distance of the quartiles, {many})")
    lines += [f"  {number} x no result: {reason}" for reason, number in summary["reasons"].items()]
    lines += [f"  {number} x flag {name}" for name, number in summary["flags"].items()]
    lines += [f"  note: {name!r} of the sidecar is no curve of this map" for name in summary["sidecar_unused"]]
    return "\n".join([*lines, f"  assumed: {summary['assumptions']}"])


def _remove(folder: Path) -> None:
    try:
        shutil.rmtree(folder)
    except FileNotFoundError:
        pass
    except OSError as error:
        raise Error(f"cannot remove {folder}: {error.strerror}") from error
