# SPDX-License-Identifier: BSD-3-Clause
"""Touch with your own hand: a simulated session at the pace of the clock in one process, a window with its mouse and
keys in another. What was recorded can be looked at again."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from nanotouch import record
from nanotouch.errors import InvalidValue

from nanotouch_app import output
from nanotouch_app.live import display, files, film
from nanotouch_app.live.desk import Desk
from nanotouch_app.live.host import Host
from nanotouch_app.live.reel import surface_of
from nanotouch_app.live.subject import PRESETS, Subject
from nanotouch_app.quantity import parse_quantity

FILMS = (".gif", ".mp4", ".png")
EPILOG = """examples:
  nanotouch live                         silicon in humid air: scroll down until the water snaps
  nanotouch live --list                  all presets, with what to try
  nanotouch live image.ibw               your own surface
  nanotouch live curve.jpk-force --radius 30nm      what you have measured: its fit becomes the scene
  nanotouch live silicon_in_air --record touch.mcap; nanotouch live touch.mcap
  nanotouch live silicon_in_air --film touch.gif    a film of a touch; needs no display"""


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "live",
        help="touch with your own hand, in a window",
        description=__doc__,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "what", nargs="?", default="silicon_in_air", metavar="PRESET|IMAGE|CURVE|MAP|SCENE|RECORDING",
        help="what is touched: a preset, an AFM image, a force curve, a map.nc, a TOML file; or a recording "
             "(default: %(default)s)",
    )  # fmt: skip
    parser.add_argument("--list", action="store_true", help="show the presets and end")
    parser.add_argument("--radius", metavar="LENGTH", help="of the tip that measured CURVE, as 30nm")
    parser.add_argument("--record", metavar="FILE.mcap", help="record the session to this file")
    parser.add_argument("--film", metavar="FILE", help="film a scripted touch instead: .gif, .mp4, or .png of its end")
    output.add_overwrite(parser)
    parser.add_argument("--dark", action="store_true", help="begin with the dark colours")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.list:
        for name, preset in PRESETS.items():
            print(f"{name:16} {preset.title}: {preset.hint}")
        return 0
    for file in filter(None, (args.film, args.record)):
        output.check_free(Path(file), args)
    if args.film is not None:
        return _film(args)
    display.check()
    path = Path(args.what)
    if path.is_file() and record.is_recording(path):
        return _play(path, args)
    subject = _subject(args)
    desk = Desk(subject.topography, dark=args.dark)
    try:
        host = Host(subject, desk.tell, args.record)
        try:
            desk.wait_ready()
            desk.serve(host)
        finally:
            host.close()
    finally:
        desk.close()
    return 0


def _subject(args: argparse.Namespace) -> Subject:
    return files.of(args.what, None if args.radius is None else parse_quantity(args.radius, "m"))


def _film(args: argparse.Namespace) -> int:
    path = Path(args.film)
    if path.suffix.lower() not in FILMS:
        raise InvalidValue(f"--film {args.film}: valid endings are {', '.join(FILMS)}")
    with output.progress_bar("filming") as progress:
        film.write([(_subject(args), film.PRESS)], path, progress, dark=args.dark)
    print(f"written to {path}: {path.stat().st_size / 1e6:.2f} MB")
    return 0


def _play(path: Path, args: argparse.Namespace) -> int:
    desk = Desk(surface_of(record.read(path)), dark=args.dark, recording=path)
    try:
        desk.wait_ready()
        desk.process.wait()
    finally:
        desk.close()
    return 0
