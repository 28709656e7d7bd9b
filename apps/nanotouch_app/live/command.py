# SPDX-License-Identifier: BSD-3-Clause
"""Touch with your own hand: a simulated session at the pace of the clock in one process, a window with its mouse and
keys in another. What was recorded can be looked at again."""

from __future__ import annotations

import argparse
import warnings
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from nanotouch import record
from nanotouch.errors import InvalidValue
from nanotouch.images import Topography

from nanotouch_app.common import output, scenes, stop
from nanotouch_app.common.quantity import parse_quantity, whole_number
from nanotouch_app.devices.table import DEVICES
from nanotouch_app.live import device, display, files, real
from nanotouch_app.live.board import TASKS
from nanotouch_app.live.desk import Desk
from nanotouch_app.live.host import Host
from nanotouch_app.live.reel import surface_of
from nanotouch_app.live.subject import PRESETS, Subject

Front = Callable[[Topography], Any]  # a window or a server, over a surface
CURVE = ("radius", "spring_constant")  # options of a force curve
FILMS, RECORDS = (".gif", ".mp4", ".png"), (".mcap",)
EPILOG = """examples:
  nanotouch live                         silicon in humid air: scroll down until the water snaps
  nanotouch live --list                  all presets, with what to try
  nanotouch live --task find             a task with a score; --task lesson begins the lesson
  nanotouch live image.ibw               your own surface
  nanotouch live curve.jpk-force --radius 30nm      what you have measured: its fit becomes the scene
  nanotouch live silicon_in_air --record touch.mcap; nanotouch live touch.mcap
  nanotouch live rig.toml                what lies under the stage of your own that a rig file names
  nanotouch live --hand inverse3         a haptic device leads the hand: its bridge is started with it
  nanotouch live --browser               the same in a browser: here, or through ssh -L
  nanotouch live silicon_in_air --film touch.gif    a film of a touch; needs no display"""


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "live",
        description=__doc__,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "what", nargs="?", metavar="PRESET|IMAGE|CURVE|MAP|SCENE|RIG|RECORDING",
        help="what is touched: a preset, an AFM image, a force curve, a map.nc, a TOML file, which may name a real "
             "slave; or a recording (default: silicon_in_air, or the sample of the task)",
    )  # fmt: skip
    parser.add_argument("--task", metavar="NAME", help="begin a task, or the lesson: see --list; its CSV is kept here")
    parser.add_argument("--list", action="store_true", help="show the presets and end")
    parser.add_argument("--radius", metavar="LENGTH", help="of the tip that measured CURVE, as 30nm")
    parser.add_argument("--spring-constant", metavar="STIFFNESS", help="of its lever, in place of the file's, as 8N/m")
    scenes.add_allow_code(parser)
    parser.add_argument("--record", metavar="FILE.mcap", help="record the session to this file")
    parser.add_argument("--film", metavar="FILE", help="film a scripted touch instead: .gif, .mp4, or .png of its end")
    output.takes_overwrite(parser)
    parser.add_argument("--hand", default="auto", metavar="NAME",
                        help=f"a haptic device that leads the hand: {', '.join(DEVICES)}, with :OPTION where it needs "
                             "one (docs/devices.md), or the mailbox of a program of your own; or gamepad, spacemouse, "
                             "auto or none, beside mouse and keys (default: %(default)s)")  # fmt: skip
    parser.add_argument(
        "--calibrate", action="store_true", help="the device of --hand first: 30 s, guided, kept in a file"
    )
    parser.add_argument("--browser", action="store_true",
                        help="show it in browsers instead of a window: prints the links (docs/page.md)")  # fmt: skip
    parser.add_argument("--port", type=whole_number(0, 65535), metavar="N",
                        help="of --browser, on this machine only (default: one that is free)")  # fmt: skip
    parser.add_argument("--page", metavar="FILE", help="the page of --browser (default: that of `make page`)")
    parser.add_argument("--dark", action="store_true", help="begin with the dark colours")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.list:
        return _list()
    if args.what is None:
        args.what = next(iter(PRESETS)) if args.task is None else _task(args.task)["preset"]
    _check_written(args)
    if real.is_named(args.what):
        return real.touch(args)
    is_recording = _checked(args)
    if device.is_named(args.hand) and not is_recording:
        return device.touch(args, partial(_subject, args))
    if args.calibrate:
        raise InvalidValue(f"--calibrate is for a haptic device: --hand {', '.join(DEVICES)}")
    if args.film is not None:
        return _film(args)
    front = _browsers(args, is_recording) if args.browser else _window(args)
    if is_recording:
        return _play(Path(args.what), args)
    return _touch(args, front, None if args.task is None else {"do": "task", "name": args.task})


def _list() -> int:
    for name, preset in PRESETS.items():
        output.say(f"{name:16} {preset['title']}: {preset['hint']}")
    for name, one in TASKS.items():
        if not one["is_page"]:
            print(f"--task {name:9} {one['title']}")
    return 0


def _task(name: str) -> dict[str, Any]:
    if name not in TASKS:
        raise InvalidValue(f"task {name!r}: valid are {', '.join(TASKS)}")
    return TASKS[name]


def _check_written(args: argparse.Namespace) -> None:
    """Refuse files that cannot be written."""
    for option, file, endings in (("--film", args.film, FILMS), ("--record", args.record, RECORDS)):
        if file is not None:
            if Path(file).suffix.lower() not in endings:
                raise InvalidValue(f"{option} {file}: valid endings are {', '.join(endings)}")
            if not Path(file).parent.is_dir():
                raise InvalidValue(f"{option} {file}: {Path(file).parent} is not a folder")
            output.check_free(Path(file), args, option)


def _checked(args: argparse.Namespace) -> bool:
    """Refuse what cannot be done; whether a recording is named."""
    files.check_named(args.what)
    is_recording = Path(args.what).is_file() and record.is_recording(args.what)
    _check_together(args, is_recording)
    return is_recording


def _window(args: argparse.Namespace) -> Front:
    display.check()
    return partial(Desk, dark=args.dark, hand=args.hand)


def _browsers(args: argparse.Namespace, is_recording: bool) -> Front:
    if is_recording:
        raise InvalidValue("--browser shows a running session: a recording is played in a window")
    from nanotouch_app.browser import page  # its server is an extra
    from nanotouch_app.browser.desk import BrowserDesk

    return partial(BrowserDesk, page=page(args.page), port=args.port or 0)


def _touch(args: argparse.Namespace, front: Front, first: dict[str, Any] | None) -> int:
    """Until the person leaves: Q in a window, Ctrl-C in the terminal."""
    subject = _subject(args)
    desk = front(subject.topography)
    try:
        host = Host(subject, desk.tell, args.record)
        try:
            host.folder = Path.cwd()
            for line in filter(None, [desk.wait_ready()]):
                print(line, flush=True)
            desk.serve(host, first)
        finally:
            host.close()
    finally:
        desk.close()
    return 0


def _check_together(args: argparse.Namespace, is_recording: bool) -> None:
    """Refuse options that would do nothing here."""
    for what, is_so, others in (
        (f"{args.what} is a recording, which is played", is_recording,
         ("task", "record", "film", *CURVE, "browser")),
        ("--film films a scripted touch", args.film is not None, ("task", "record", "browser")),
        (f"{args.what} is no force curve",
         args.what in PRESETS or Path(args.what).suffix.lower() in (".toml", ".nc"), CURVE),
        ("without --browser a window shows it", not args.browser, ("page", "port")),
    ):  # fmt: skip
        useless = [f"--{name.replace('_', '-')}" for name in others if getattr(args, name) not in (None, False)]
        if is_so and useless:
            raise InvalidValue(f"{what}: {' and '.join(useless)} cannot be used with it")


def _subject(args: argparse.Namespace) -> Subject:
    radius, spring = (
        None if text is None else parse_quantity(text, unit)
        for text, unit in ((args.radius, "m"), (args.spring_constant, "N/m"))
    )
    with output.busy(f"reading {args.what}", 0.5) as told:
        return files.of(args.what, radius, spring, None, told)


def _film(args: argparse.Namespace) -> int:
    from nanotouch_app.live import film  # a window is drawn in another process

    path, subject = Path(args.film), _subject(args)
    # a signal waits for the end of the picture: VTK would swallow what is raised while it draws
    with stop.between_blocks() as check, output.progress_bar("filming") as progress:

        def told(share: float) -> None:
            check()
            progress(share)

        film.write([(subject, film.PRESS)], path, told, dark=args.dark)
    print(f"written to {path}: {path.stat().st_size / 1e6:.2f} MB")
    return 0


def _play(path: Path, args: argparse.Namespace) -> int:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        met, corner = surface_of(record.read(path))
    for warning in caught:
        print(f"note: {warning.message}")
    desk = Desk(met, dark=args.dark, recording=path, corner=corner)
    try:
        desk.wait_ready()
        desk.process.wait()
    finally:
        desk.close()
    return 0
