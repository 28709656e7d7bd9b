# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch image`` for several images: a folder for each, one table of all; options from a TOML file."""

from __future__ import annotations

import argparse
import csv
import glob
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from nanotouch.batch import files_of
from nanotouch.batch.sidecar import toml_tables
from nanotouch.errors import Error, InvalidValue
from nanotouch.touch.record import replacing

from nanotouch_app.common import output

TABLE = "images.csv"
FLAGS = ("scars", "despeckle", "pits", "spectrum", "histogram")
TEXTS = ("channel", "pixel_size", "z_unit", "level", "mask", "smooth", "tip", "grains", "line")

One = Callable[[argparse.Namespace, Path, Path], dict[str, Any]]  # options, file, folder


def configured(args: argparse.Namespace) -> None:
    """Set the options of the file that ``--config`` names, where the command line leaves them out."""
    if args.config is None:
        return
    for key, value in toml_tables(args.config).items():
        if key in FLAGS:
            right = isinstance(value, bool)
        elif key in TEXTS:
            right = isinstance(value, str)
        else:
            raise InvalidValue(f"{args.config}: {key!r}: valid are {', '.join((*TEXTS, *FLAGS))}")
        if not right:
            kind = "true or false" if key in FLAGS else "a text, as on the command line"
            raise InvalidValue(f"{args.config}: {key} = {value!r}: expected {kind}")
        if getattr(args, key) in (None, False):
            setattr(args, key, value)


def is_meant(names: list[str]) -> bool:
    """Whether the names stand for more than one file."""
    return len(names) > 1 or Path(names[0]).is_dir() or (glob.has_magic(names[0]) and not Path(names[0]).exists())


def run(args: argparse.Namespace, one: One) -> int:
    """All images; one that cannot be read is a row that says why. The status is 1 where none has a result."""
    files, rows = files_of(args.image), []
    with output.folder(args, (TABLE,)) as out:
        for file, folder in zip(files, _folders(files, out), strict=True):
            row: dict[str, Any] = {"file": str(file), "folder": folder.name, "status": "ok", "reason": ""}
            print(f"{os.fsencode(file.name).decode(errors='backslashreplace')}:")
            try:
                with output.made(folder):
                    facts = one(args, file, folder)
                row |= {_headed(symbol, found["unit"]): found["value"] for symbol, found in facts["parameters"].items()}
                row |= {"grains": facts["grains"]["count"]} if "grains" in facts else {}
            except Error as error:
                row |= {"status": "failed", "reason": str(error)}
                print(f"  failed: {error}")
            rows.append(row)
        _write(out / TABLE, rows)
        good = sum(row["status"] == "ok" for row in rows)
        args.answer = {"folder": str(out), "images": rows}
        images = "image" if good == 1 else "images"
        print(f"{good} {images} of {len(rows)}; written to {out}/: {TABLE}, and a folder for each")
    return 0 if good else 1


def _folders(files: list[Path], out: Path) -> list[Path]:
    """One for each, by its name; names that come twice get a number."""
    found: list[Path] = []
    for file in files:
        name, number = file.name, 2
        while (path := out / f"{name}.results") in found:
            name, number = f"{file.name}-{number}", number + 1
        found.append(path)
    return found


def _headed(symbol: str, unit: str) -> str:
    return f"{symbol} [{unit}]" if unit else symbol


def _write(path: Path, rows: list[dict[str, Any]]) -> None:
    names = list(dict.fromkeys(key for row in rows for key in row))
    with replacing(path) as part, part.open("w", encoding="utf-8", errors="backslashreplace", newline="") as stream:
        table = csv.DictWriter(stream, names, restval="")
        table.writeheader()
        table.writerows({key: "" if value is None else value for key, value in row.items()} for row in rows)
