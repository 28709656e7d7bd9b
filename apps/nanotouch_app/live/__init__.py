# SPDX-License-Identifier: BSD-3-Clause
"""Touch with your own hand: a simulated session at the pace of the clock in one process, a window with its mouse and
keys in another."""

from __future__ import annotations

import argparse
from typing import Any

from nanotouch_app.live import display
from nanotouch_app.live.desk import Desk
from nanotouch_app.live.host import Host
from nanotouch_app.live.subject import PRESETS, of_preset

EPILOG = """examples:
  nanotouch live                      silicon in humid air: scroll down until the water snaps
  nanotouch live silicone_rubber      press deep, then pull
  nanotouch live --list               all presets, with what to try"""


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser(
        "live",
        help="touch with your own hand, in a window",
        description=__doc__,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("what", nargs="?", default="silicon_in_air", metavar="PRESET",
                        choices=list(PRESETS), help="what is touched (default: %(default)s)")  # fmt: skip
    parser.add_argument("--list", action="store_true", help="show the presets and end")
    parser.add_argument("--record", metavar="FILE", help="record the session to this MCAP file")


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.list:
        for name, preset in PRESETS.items():
            print(f"{name:16} {preset.title}: {preset.hint}")
        return 0
    display.check()
    subject = of_preset(args.what)
    desk = Desk(subject.topography)
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
