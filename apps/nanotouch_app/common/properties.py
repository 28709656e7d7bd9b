# SPDX-License-Identifier: BSD-3-Clause
"""Options about how the image of a surface is read, common to ``touch`` and ``scan``; a scene file's ``[surface]`` says
the same, and what the sample is made of at each place."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import nanotouch as nt
from nanotouch.errors import InvalidValue

from nanotouch_app.common.quantity import parse_quantity


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


def surface_file(args: argparse.Namespace, image: str | None, tables: dict[str, Any], scene: str | None) -> Any:
    """The :class:`nanotouch.SurfaceFile` of an image, or of the scene's ``[surface]``; None where neither is named."""
    told = nt.SurfaceFile.from_tables(tables, None if scene is None else Path(scene).parent)
    if told is not None and image is not None:
        raise InvalidValue(f"{scene} names a surface ([surface]): give it or an IMAGE, not both")
    return nt.SurfaceFile(image=image, **reading(args)) if image is not None else told
