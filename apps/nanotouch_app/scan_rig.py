# SPDX-License-Identifier: BSD-3-Clause
"""A scan on the real slave of a rig file: contact mode by a session, whose height servo holds the force."""

from __future__ import annotations

import argparse
from typing import Any

import nanotouch as nt
from nanotouch.errors import InvalidValue
from nanotouch.units import in_words

from nanotouch_app import output, scenes
from nanotouch_app.quantity import parse_quantity

LINES = 16  # of the raster that tell the relief, if a surface is named
SETTLES = 2.0  # time constants of the height servo in a pixel, where no line rate is given


def is_named(args: argparse.Namespace) -> bool:
    """Whether the scene is a rig file whose slave is real."""
    return "slave" in scenes.real_halves(args.scene)


def mode(args: argparse.Namespace, tables: dict[str, Any]) -> str:
    """Contact, of which the hal has all channels."""
    asked = args.mode or tables.get("zloop", {}).get("mode", "contact")
    if asked != "contact" or args.free_amplitude is not None:
        raise InvalidValue(
            "a rig file has no channels for the drive and the lock-in amplifier of tapping: its probe scans with "
            "--mode contact"
        )
    if args.steady is not None:
        raise InvalidValue("--steady: an image of the simulated scanner; a real probe scans in time")
    return "contact"


def opened(args: argparse.Namespace, settings: nt.Scan, surface: nt.Surface, rate: float | None) -> nt.Session:
    """The session that scans, armed; sets the line rate. ``rate``: that somebody gave [Hz]."""
    scene, rig, tables = scenes.read(args.scene)
    raster = settings.raster
    lines = (raster.y + raster.height * line / (LINES - 1) for line in range(LINES))
    path = [(x, y) for y in lines for x in (raster.x, raster.x + raster.width)]
    what: dict[str, Any] = {"surface": surface, "mode": "topography", "path": path}
    wanted = nt.Session(scene, rig, minimum_margin=0.0, **what).settings.copy()
    wanted.update_from_tables(tables)
    wanted.gains.set_point = settings.zloop.set_force
    if args.gain is not None:
        wanted.gains.height_gain = parse_quantity(args.gain, "Hz")
    servo = float(wanted.gains.height_gain)
    raster.line_rate = rate if rate is not None else float(f"{servo / (2.0 * SETTLES * raster.pixels):.2g}")
    session = nt.Session(scene, rig, settings=wanted, **what, **scenes.real_halves(args.scene))
    output.say(
        f"promised {in_words(session.guarantee().force, 'N', 4)} at most on the sample; it is held at "
        f"{in_words(wanted.gains.set_point, 'N', 4)}, with K_I = {servo:.3g}/s"
    )
    return session


def taken(session: nt.Session, settings: nt.Scan) -> nt.scan.Image:
    """The image. The session ends with it, and close lifts the tip."""
    with output.busy("scanning"):
        image: nt.scan.Image = nt.raster.image(session, settings)
    return image
