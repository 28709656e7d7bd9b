# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch touch``: an image becomes a surface, the simulated probe comes down on it, and what the operator felt is
recorded, summarised and drawn."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import nanotouch as nt
from nanotouch import plots, record
from nanotouch.errors import InvalidValue
from nanotouch.scene import read_tables
from nanotouch.session import MODES, settings_for_path
from nanotouch_app import output, summary, view
from nanotouch_app.quantity import parse_points, parse_quantity

SURFACES = ("grating", "dots", "flat")


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser = subparsers.add_parser("touch", help="touch a surface on the simulated rig", description=__doc__)
    parser.add_argument("image", nargs="?", metavar="IMAGE", help="AFM image; without it the built-in surface")
    parser.add_argument("--surface", choices=SURFACES, default="grating", help="built-in surface (default: %(default)s)")
    parser.add_argument("--mode", choices=MODES, default="point", help="what to do (default: %(default)s)")
    parser.add_argument("--at", metavar="X,Y", help="where to touch, as 2.5um,3um (default: the middle)")
    parser.add_argument("--line", metavar="X,Y,X,Y", help="line to scan, as 0um,2um,6um,2um (default: across the middle)")
    parser.add_argument("--scene", metavar="FILE", help="TOML file with scene, rig and gains")
    parser.add_argument("--out", default="nanotouch-out", metavar="DIR", help="folder for the results (default: %(default)s)")
    parser.add_argument("--channel", help="channel of the image (see nanotouch info)")
    parser.add_argument("--pixel-size", metavar="SIZE", help="pixel size of an image that does not tell, as 10nm")
    parser.add_argument("--z-unit", metavar="UNIT", help="height unit of an image that does not tell: nm, um, ...")
    parser.add_argument("--duration", metavar="TIME", help="stretch the operator's script to this, as 20s")
    parser.add_argument("--seed", type=int, default=1, help="of the sensors' noise (default: %(default)s)")
    parser.add_argument("--no-window", action="store_true", help="never open a 3-D window")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    scene, session = _session(args)
    out = output.folder(args.out)
    print(f"surface: {session.surface.topography if session.surface else 'flat'}")
    recording = _record(session, args, out)
    facts = summary.summarise(session, recording)
    output.write_json(out / "summary.json", facts)
    print(summary.words(facts))
    _draw(session, recording, out)
    print(f"written to {out}/: {', '.join(sorted(path.name for path in out.iterdir() if path.is_file()))}")
    if session.surface and not args.no_window and view.has_display():
        view.open_window(session.surface.topography, recording, scene.tip.radius)
    return 0


def _session(args: argparse.Namespace) -> tuple[nt.Scene, nt.Session]:
    tables = read_tables(args.scene) if args.scene else {}
    scene, rig = nt.Scene.from_tables(tables), nt.Rig.from_tables(tables)
    path = _path(args)
    surface = _surface(args, scene)
    draft = nt.Session(scene, rig, surface=surface, mode=args.mode, path=path, seed=args.seed, minimum_margin=0.0)
    settings = settings_for_path(rig, draft.relief)
    settings.update_from_tables(tables)
    session = nt.Session(
        scene, rig, settings=settings, surface=surface, mode=args.mode, path=path, seed=args.seed
    )
    return scene, session


def _path(args: argparse.Namespace) -> list[tuple[float, float]] | None:
    if args.mode == "point":
        if args.line:
            raise InvalidValue("--line goes with --mode scan or topography; --mode point takes --at X,Y")
        return parse_points(args.at, 1) if args.at else None
    if args.at:
        raise InvalidValue(f"--at goes with --mode point; --mode {args.mode} takes --line X,Y,X,Y")
    return parse_points(args.line, 2) if args.line else None


def _surface(args: argparse.Namespace, scene: nt.Scene) -> nt.Surface | None:
    if args.image is None and args.surface == "flat":
        return None
    return nt.Surface(_topography(args), scene.tip.radius, scene.tip.half_angle)


def _topography(args: argparse.Namespace) -> nt.Topography:
    if args.image is None:
        return nt.surface.grating() if args.surface == "grating" else nt.surface.dots()
    pixel_size = parse_quantity(args.pixel_size, "m") if args.pixel_size else None
    raw = nt.images.read(args.image, args.channel, pixel_size=pixel_size, z_unit=args.z_unit)
    topography, report = nt.images.prepare(raw)
    print(report)
    return topography


def _record(session: nt.Session, args: argparse.Namespace, out: Path) -> nt.Recording:
    duration = parse_quantity(args.duration, "s") if args.duration else None
    with (
        record.Writer(out / "recording.mcap", session.metadata()) as writer,
        output.progress_bar("touching") as progress,
    ):
        return session.run(duration, writer=writer, progress=progress)


def _draw(session: nt.Session, recording: nt.Recording, out: Path) -> None:
    plots.time(recording, save=out / "time.png")
    plots.force_gap(recording, save=out / "force_gap.png")
    topography = session.surface.topography if session.surface else None
    if session.mode != "point":
        plots.line(recording, topography, save=out / "line.png")
    if topography is not None:
        view.render_png(topography, recording, out / "view.png", tip_radius=session.scene.tip.radius)
