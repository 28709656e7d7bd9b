# SPDX-License-Identifier: BSD-3-Clause
"""Say what has to be computed for a scene, at which cost and with which error bound.

The scene is a TOML file or a preset. The demand may stand in the file ([demand]); what is given here
replaces it.
"""

from __future__ import annotations

import argparse
import difflib
import json
import math
import os
from typing import Any

import nanotouch as nt
from nanotouch import presets
from nanotouch.errors import InvalidValue
from nanotouch.plan import hertz_nanoseconds
from nanotouch.scene import Demand, Rig, Scene, Settings, read_tables
from nanotouch.units import in_words

from nanotouch_app.quantity import number, parse_quantity

PRESETS = tuple(presets.FELT)
PAPER = (
    "paper_silicon", "paper_gold", "paper_mica", "paper_polyester", "paper_silicone_rubber", "paper_inas",
)  # fmt: skip
"""the scenes of the paper as they stand there, up to the largest load of its rig"""

OPTIONS = {"demand.relative_accuracy": "--rtol", "demand.budget": "--budget"}


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "plan",
        help="say what has to be computed for a scene, and why",
        description=__doc__,
        epilog="Exit status 2: the description is wrong, or the demand cannot be kept; the sentence says what can.",
    )
    parser.add_argument("scene", metavar="SCENE", help=f"TOML file, or a preset: {', '.join(PRESETS + PAPER)}")
    parser.add_argument(
        "--rtol", metavar="SHARE", help="largest error, over the larger of quantity and pull-off: 1%%, 1e-6; 0: exact"
    )
    parser.add_argument("--atol", metavar="FORCE", help="forces below this cannot be felt, such as 10pN")
    parser.add_argument(
        "--quantity", choices=("force", "stiffness", "radius", "folds"), help="of what (default: force)"
    )
    parser.add_argument(
        "--budget", type=number(1.0, 1e9), metavar="N", help="what an evaluation may cost, in Hertz evaluations"
    )
    parser.add_argument("--probe", action="store_true", help="tell what the rig's probe cannot resolve, too")
    parser.add_argument(
        "--json", action="store_true", help='print the plan as data, SI; what is not finite as null or "inf"'
    )


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    scene, rig, demand = _descriptions(args.scene)
    if args.rtol is not None:
        demand["demand.relative_accuracy"] = parse_quantity(args.rtol, "")
    if args.atol is not None:
        demand["demand.force_floor"] = parse_quantity(args.atol, "N")
    if args.quantity is not None:
        demand["demand.quantity"] = args.quantity
    if args.budget is not None:
        demand["demand.budget"] = args.budget
    try:
        plan = nt.Plan.make(scene, demand, rig if args.probe else None)
    except InvalidValue as refusal:
        sentence = str(refusal).removeprefix("plan: ")
        for field, option in OPTIONS.items():
            sentence = sentence.replace(f"{field} =", f"{field} ({option}) =")
        raise InvalidValue(sentence) from refusal
    print(json.dumps(as_json(plan.explain()), indent=2, allow_nan=False) if args.json else plan)
    if not args.json:
        one = hertz_nanoseconds()
        full = one * plan.explain()["full_cost"]
        print(
            f"on this machine a Hertz evaluation takes {in_words(one * 1e-9, 's', 3)}, this plan "
            f"{in_words(one * plan.cost * 1e-9, 's', 3)}, everything exact {in_words(full * 1e-9, 's', 3)}"
        )
    if args.scene in PRESETS and not args.json:
        print(f"felt: {presets.FELT[args.scene]}")
    return 0


def as_json(value: Any) -> Any:
    """What JSON has a spelling for: NaN (not known) is null, infinities are the strings ``"inf"`` and ``"-inf"``."""
    if isinstance(value, dict):
        return {key: as_json(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [as_json(entry) for entry in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    return value


def _descriptions(name: str) -> tuple[Scene, Rig, Demand]:
    if name in PRESETS + PAPER:
        return *getattr(presets, name)(), Demand()
    if not name.endswith(".toml") and not os.path.isfile(name):
        close = difflib.get_close_matches(name, PRESETS + PAPER, n=1)
        hint = f"; did you mean {close[0]}" if close else ""
        raise InvalidValue(f"{name!r} is neither a TOML file nor a preset{hint}; presets are {', '.join(PRESETS)}")
    tables = read_tables(name)
    scene, rig = Scene.from_tables(tables), Rig.from_tables(tables)
    if "limits" in tables:  # as a session does, up to its force limit
        settings = Settings.for_rig(rig)
        settings.update_from_tables(tables)
        scene.range.maximum_load = settings.limits.force
    return scene, rig, Demand.from_tables(tables)
