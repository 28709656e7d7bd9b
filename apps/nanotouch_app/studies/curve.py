# SPDX-License-Identifier: BSD-3-Clause
"""Compute and plot the force over the gap for Hertz, DMT, JKR and Maugis-Dugdale, on retraction from contact.

Each has all of the scene's adhesion, with the part that a plan gives to the van der Waals tail (docs/interaction.md).
"""

from __future__ import annotations

import argparse
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import plots
from nanotouch.contact import MODELS, Contact, evaluate, pull_off_force
from nanotouch.touch.record import write_csv

from nanotouch_app.common import output, scenes

TITLES = {"hertz": "Hertz", "dmt": "DMT", "jkr": "JKR", "maugis": "Maugis-Dugdale"}
POINTS = 2001
FILES = ("curve.csv", "curve.png")


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("curve", description=__doc__)
    parser.add_argument(
        "--scene", metavar="SCENE", help=scenes.HELP.format(what="the scene") + " (default: silicon in humid air)"
    )
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    scene = scenes.read(args.scene).scene
    print(scene.plan())
    alone = scene.copy()
    alone.adhesion.hamaker_constant = 0.0  # without a tail, contact has all of w
    facts = alone.plan().explain()
    contact = Contact(
        facts["radius"], facts["effective_modulus"], facts["work_of_adhesion"], facts["cohesive_stress"] or None
    )
    gap = _gaps(contact, facts)
    curves = {TITLES[model]: (gap, evaluate(model, -gap, contact).F) for model in MODELS}
    pulls = {model: pull_off_force(model, contact) for model in MODELS}
    for model in MODELS:
        print(f"{TITLES[model]:15} pull-off {pulls[model] * 1e9:.3f} nN")
    with output.folder(args, FILES) as out:
        columns = {"gap [m]": gap} | {f"{model} force [N]": curves[TITLES[model]][1] for model in MODELS}
        write_csv(out / "curve.csv", columns, {"scene": str(scene)})
        plots.force_curves(curves, save=out / "curve.png")
        args.answer = {"pull_off_force_N": pulls, "folder": str(out), "files": list(FILES)}
        print(f"written to {out}/: curve.csv, curve.png")
    return 0


def _gaps(contact: Contact, facts: dict[str, Any]) -> Any:
    """From beyond the last attraction to where the load is some times the pull-off force."""
    far = 1.5 * max(facts["release_gap"], facts["capture_gap"])
    load = 3.0 * pull_off_force("dmt", contact) or 1e-9
    deep = float(nt.contact.indentation("dmt", load, contact))
    return np.linspace(max(far, 0.3 * deep), -deep, POINTS)
