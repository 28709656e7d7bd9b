# SPDX-License-Identifier: BSD-3-Clause
"""Options that name the files of a surface, common to ``touch``, ``scan``, ``plan`` and ``live``: heights, and what the
sample is made of at each place."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any, get_args

import nanotouch as nt
from nanotouch.errors import InvalidValue
from nanotouch.images.values import QUANTITIES, Fill

from nanotouch_app.common.quantity import parse_quantity

_TOLD = {
    "youngs_modulus": "E of the sample", "effective_modulus": "E* of the contact", "work_of_adhesion": "w",
    "pull_off_force": "what a tip like the scene's is pulled off with",
}  # fmt: skip


def add_reading(group: Any) -> None:
    """How an IMAGE is read."""
    group.add_argument("--channel", metavar="NAME", help="channel of the image (nanotouch info lists them)")
    group.add_argument("--pixel-size", metavar="LENGTH", help="pixel size of an image that does not state it, as 10nm")
    group.add_argument("--z-unit", metavar="UNIT", help="height unit of an image that does not state it: nm, um, ...")
    group.add_argument(
        "--level", metavar="METHOD", help="how IMAGE is levelled: auto, or plane, poly2 .. poly6, lines, rows, medians "
        "and terraces, joined by +; none (default: auto)",
    )  # fmt: skip


def refuse_reading(args: argparse.Namespace) -> None:
    """Where there is no IMAGE to read."""
    for option in ("channel", "pixel_size", "z_unit", "level"):
        if getattr(args, option) not in (None, False):
            raise InvalidValue(f"--{option.replace('_', '-')} goes with an IMAGE")


def reading(args: argparse.Namespace) -> dict[str, Any]:
    """What these options say, as :class:`nanotouch.SurfaceFile` takes it; commands without them read by default."""
    pixel_size = getattr(args, "pixel_size", None)
    return {
        "channel": getattr(args, "channel", None),
        "level": getattr(args, "level", None) or "auto",
        "pixel_size": None if pixel_size is None else parse_quantity(pixel_size, "m"),
        "z_unit": getattr(args, "z_unit", None),
    }


def add_options(parser: argparse.ArgumentParser) -> None:
    """A channel for each quantity."""
    group = parser.add_argument_group("what the sample is made of at each place")
    for name in QUANTITIES:
        group.add_argument(f"--{name.replace('_', '-')}", metavar="CHANNEL", help=f"channel of {_TOLD[name]}")
    group.add_argument("--properties", metavar="FILE", help="image or map.nc with these channels (default: IMAGE)")
    group.add_argument(
        "--unit", action="append", default=[], metavar="QUANTITY=UNIT", help="of a channel that states none, as "
        "youngs_modulus=GPa",
    )  # fmt: skip
    group.add_argument(
        "--fill-by", choices=get_args(Fill), help="what pixels without a value get (default: they are refused)"
    )


def given(args: argparse.Namespace) -> list[str]:
    """Which of these options there are."""
    named = [name for name in (*QUANTITIES, "properties", "fill_by") if getattr(args, name) is not None]
    return [f"--{name.replace('_', '-')}" for name in named] + ["--unit"] * bool(args.unit)


def surface_file(args: argparse.Namespace, image: str | None, tables: dict[str, Any], scene: str | None) -> Any:
    """The :class:`nanotouch.SurfaceFile` of the options, or of the scene's ``[surface]``; None where neither names
    one."""
    folder = None if scene is None else Path(scene).parent
    told = nt.SurfaceFile.from_tables(tables, folder)
    if told is not None and (image is not None or given(args)):
        what = "an IMAGE" if image is not None else given(args)[0]
        raise InvalidValue(f"{scene} names a surface ([surface]): give it or {what}, not both")
    if told is not None or image is None:
        if told is None and given(args):
            raise InvalidValue(f"{given(args)[0]} goes with an IMAGE")
        return told
    return nt.SurfaceFile(
        image=image,
        **reading(args),
        file=args.properties,
        properties={name: getattr(args, name) for name in QUANTITIES if getattr(args, name) is not None},
        units=dict(_pair(text) for text in args.unit),
        fill_by=args.fill_by,
    )


def _pair(text: str) -> tuple[str, str]:
    name, equals, unit = text.partition("=")
    if not equals:
        raise InvalidValue(f"--unit {text}: write it as youngs_modulus=GPa")
    return name, unit
