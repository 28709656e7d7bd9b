# SPDX-License-Identifier: BSD-3-Clause
"""Indent a sample that yields, with the simulated rig: down to a load, and back. The force over the gap is recorded,
and the dent that stays is drawn, with its ridge."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import plasticity, record
from nanotouch.errors import InvalidValue, require
from nanotouch.plots import new_figure, saved
from nanotouch.units import in_words

from nanotouch_app.common import output, scenes
from nanotouch_app.common.quantity import parse_quantity, whole_number

FILES = ("recording.mcap", "indent.json", "indent.png")
PIXELS, REACH = 161, 3.0  # of the drawn dent: to so many of its radii
ROOM = 1.25  # the largest planned load, over that which is asked for
SIGMAS = 5.0  # of the lever's noise, that a load has to exceed


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("indent", description=__doc__)
    parser.add_argument("load", metavar="LOAD", help="the max, as 100nN")
    parser.add_argument("--scene", metavar="SCENE", help="TOML file with scene and rig, or a preset; adhesion and what "
                        "acts before contact are left out (default: a diamond tip of 20 nm on gold)")  # fmt: skip
    parser.add_argument("--yield-strength", metavar="STRESS", help="Y of the sample, as 0.35GPa, where the scene does "
                        "not tell it")  # fmt: skip
    parser.add_argument("--piled-up", type=float, default=0.8, metavar="SHARE",
                        help="of the displaced volume that goes into the ridge (default: %(default)s)")  # fmt: skip
    parser.add_argument("--seed", type=whole_number(0, 2**32 - 1, "2^32 - 1"), default=1, metavar="N",
                        help="of the noise (default: %(default)s)")  # fmt: skip
    output.add_options(parser)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    load, displacement = parse_quantity(args.load, "N"), plasticity.Displacement(piled_up=args.piled_up)
    scene, rig = _scene(args)
    _check(args.load, load, rig)
    scene.range.maximum_load = ROOM * load
    with output.folder(args, FILES) as out:
        session = nt.Session(scene, rig, mode="curve", path=[(0.0, 0.0)], seed=args.seed)
        session.change("settings", "gains.set_point", load)
        with output.busy("indenting"):
            recording = session.run()
        facts = facts_of(session, recording)
        record.write(out / "recording.mcap", recording)
        output.write_json(out / "indent.json", facts)
        with output.picture():
            draw(recording, displacement, out / "indent.png")
        args.answer = output.answered(out, FILES, facts, words(facts))
    return 0


def _scene(args: argparse.Namespace) -> tuple[nt.Scene, nt.Rig]:
    """Contact alone, on a sample that keeps dents."""
    if args.scene is None:
        scene = nt.Scene(tip={"material": "diamond"}, sample={"material": "gold", "yield_strength": 0.35e9})
        rig = nt.Rig()
    else:
        scene, rig, _ = scenes.read(args.scene)
        scene = scene.copy()
    if args.yield_strength is not None:
        scene.sample.yield_strength = parse_quantity(args.yield_strength, "Pa")
    elif not scene.sample.yield_strength > 0.0:
        raise InvalidValue("the scene does not tell the yield strength of its sample: add --yield-strength, as 0.35GPa")
    scene["sample.dents"] = "yes"
    scene.adhesion.work_of_adhesion = scene.adhesion.hamaker_constant = scene.adhesion.contact_potential = 0.0
    scene.medium.relative_humidity = 0.0
    return scene, rig


def _check(told: str, load: float, rig: nt.Rig) -> None:
    """A load below the noise of the lever would end the way down before the tip has touched."""
    noise = float(rig.probe.spring_constant * rig.probe.sensitivity * rig.probe.noise) / 6.0
    if not load > SIGMAS * noise:
        why = f", {SIGMAS:.0f} times the noise of the lever" if noise > 0.0 else ""
        raise InvalidValue(f"LOAD {told}: valid is above {in_words(SIGMAS * noise, 'N', 3)}{why}")


def facts_of(session: nt.Session, recording: nt.Recording) -> dict[str, float]:
    """The numbers, SI; without a dent radius and depth are 0."""
    facts = session.plan.explain()
    law = plasticity.Indentation(
        facts["radius"], facts["effective_modulus"], float(session.scene.sample.yield_strength)
    )
    dent = recording.dents[-1] if recording.dents else None
    return {
        "largest_force_N": float(np.max(recording.tip_force)),
        "largest_indentation_m": -float(np.min(recording.columns["gap"])),
        "yields_from_N": law.yield_load,
        "plastic_from_N": law.plastic_load,
        "dent_radius_m": dent.imprint.radius if dent else 0.0,
        "dent_depth_m": dent.imprint.depth if dent else 0.0,
        "heat_J": float(law.at_load(dent.load).dissipated) if dent else 0.0,
    }


def words(facts: dict[str, float]) -> str:
    """The same in words."""
    nN = {name: 1e9 * value for name, value in facts.items() if name.endswith("_N")}
    pressed = (
        f"pressed with {nN['largest_force_N']:.4g} nN, {1e9 * facts['largest_indentation_m']:.3g} nm deep; it yields "
        f"from {nN['yields_from_N']:.3g} nN, all plastic from {nN['plastic_from_N']:.3g} nN"
    )
    if not facts["dent_radius_m"]:
        return f"{pressed}\nit stayed elastic: no dent"
    depth, width = 1e9 * facts["dent_depth_m"], 2e9 * facts["dent_radius_m"]
    heat = 1e18 * facts["heat_J"]
    return f"{pressed}\nthe dent is {depth:.3g} nm deep, {width:.3g} nm wide; {heat:.3g} aJ became heat"


def draw(recording: nt.Recording, displacement: plasticity.Displacement, path: Path) -> None:
    """Force over gap, and the dent with its ridge."""
    require("matplotlib", "app")
    figure = new_figure(9.6, 4.0)
    loop, shown = figure.subplots(1, 2)
    columns = recording.columns
    first = columns["surface_height"] == columns["surface_height"][0]  # before the dent lowered it
    near = first & (columns["gap"] < 2e-9)
    loop.plot(-1e9 * columns["gap"][near], 1e9 * columns["tip_force"][near])
    loop.set(xlabel="indentation (nm)", ylabel="force on the tip (nN)")
    if not recording.dents:
        shown.axis("off")
        shown.text(0.5, 0.5, "no dent", ha="center")
        saved(figure, path)
        return
    heights, pitch = dented(recording.dents[-1], displacement)
    half = 0.5e9 * pitch * PIXELS
    picture = shown.imshow(1e9 * heights, origin="lower", extent=(-half, half, -half, half), cmap="afmhot")
    figure.colorbar(picture, ax=shown, label="height (nm)")
    shown.set(xlabel="x (nm)", ylabel="y (nm)")
    saved(figure, path)


def dented(dent: plasticity.Dent, displacement: plasticity.Displacement) -> tuple[np.ndarray, float]:
    """A flat with the dent in its middle; and the pixel [m]."""
    pitch = 2.0 * REACH * dent.imprint.radius / PIXELS
    middle = 0.5 * (PIXELS - 1) * pitch
    specimen = plasticity.Specimen(np.zeros((PIXELS, PIXELS)), pitch, displacement=displacement)
    placed = dent.imprint._replace(start_x=middle, start_y=middle, end_x=middle, end_y=middle)
    specimen.take(dent._replace(imprint=placed, before=None))
    return specimen.heights, pitch
