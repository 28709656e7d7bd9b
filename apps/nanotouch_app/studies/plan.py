# SPDX-License-Identifier: BSD-3-Clause
"""Say what has to be computed for a scene, at which cost and with which error bound.

The scene is a TOML file or a preset. The demand may stand in the file ([demand]); what is given here
replaces it.
"""

from __future__ import annotations

import argparse
import os
import re
from pathlib import Path
from typing import Any

import nanotouch as nt
from nanotouch.errors import InvalidValue
from nanotouch.scene import Demand, Rig, Scene, Settings, read_tables
from nanotouch.scene.plan import hertz_nanoseconds
from nanotouch.touch.session import MODES
from nanotouch.units import in_words

from nanotouch_app.common import output, properties, scenes
from nanotouch_app.common.quantity import parse_quantity
from nanotouch_app.common.scenes import PAPER, PRESETS, felt

ACCURACY = "demand.relative_accuracy"


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "plan",
        description=__doc__,
        epilog="Exit status 2: the description is wrong, or the demand cannot be kept; the sentence says what can.",
    )
    parser.add_argument(
        "scene",
        metavar="SCENE",
        help=f"TOML file, whose [demand] may say more, or a preset: {', '.join(PRESETS + PAPER)}",
    )
    parser.add_argument(
        "--relative-accuracy",
        metavar="FRACTION",
        help="largest error, over the larger of quantity and pull-off: 1%%, 1e-6",
    )
    parser.add_argument("--image", metavar="IMAGE", help="plan over the surface of an AFM image or a map.nc")
    parser.add_argument("--probe", action="store_true", help="tell what the rig's probe cannot resolve, too")
    parser.add_argument(
        "--c-header", metavar="FILE", help="write plan and touch step as constants of C in single precision"
    )
    parser.add_argument("--mode", choices=MODES, default="point", help="of that touch step (default: %(default)s)")
    output.takes_overwrite(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.c_header is not None:
        output.check_free(Path(args.c_header), args, "--c-header")
    scene, rig, demand, settings = _descriptions(args.scene)
    with output.busy("reading the surface"):
        surface = _surface(args, scene)
    if args.relative_accuracy is not None:
        demand["demand.relative_accuracy"] = parse_quantity(args.relative_accuracy, "")
    try:
        with output.busy("planning"):
            plan = nt.Plan.make(scene, demand, rig if args.probe else None, surface)
    except InvalidValue as refusal:
        sentence = str(refusal).removeprefix("plan: ")
        raise InvalidValue(sentence.replace(f"{ACCURACY} =", f"{ACCURACY} (--relative-accuracy) =")) from refusal
    args.answer = plan.explain()
    if args.c_header is not None:
        _write_header(args, plan, rig, settings)
    if args.json:  # the measurement below takes its time
        return 0
    output.say(plan)
    one = hertz_nanoseconds()
    full = one * plan.explain()["full_cost"]
    output.say(
        f"on this machine a Hertz evaluation takes {in_words(one * 1e-9, 's', 3)}, this plan "
        f"{in_words(one * plan.cost * 1e-9, 's', 3)}, everything exact {in_words(full * 1e-9, 's', 3)}"
    )
    if surface is not None:
        output.say("\n".join(surface.notes))
    if args.scene in PRESETS:
        output.say(f"felt: {felt(args.scene)}")
    return 0


def _surface(args: argparse.Namespace, scene: Scene) -> nt.Surface | None:
    """Over which it is planned; None: a flat."""
    tables = read_tables(args.scene) if os.path.isfile(args.scene) else {}
    named = properties.surface_file(args, args.image, tables, args.scene)
    surface: nt.Surface | None = None if named is None else named.touched_by(scene)
    return surface


def _write_header(args: argparse.Namespace, plan: nt.Plan, rig: Rig, settings: Settings) -> None:
    """Write the constants; their names are that of the file."""
    file = Path(args.c_header)
    name = re.sub(r"\W", "_", file.stem.lower(), flags=re.ASCII)
    text = nt.c_header.write(plan, rig, settings, args.mode, name if name[:1].isalpha() else f"plan_{name}")
    with output.made(file.parent):
        file.write_text(text)


def _descriptions(name: str) -> tuple[Scene, Rig, Demand, Settings]:
    scene, rig, tables = scenes.read(name)
    settings = Settings.for_rig(rig)
    settings.update_from_tables(tables)
    if "limits" in tables:  # as a session does, up to its force limit
        scene.range.maximum_load = settings.limits.force
    return scene, rig, Demand.from_tables(tables), settings
