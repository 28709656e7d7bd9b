# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch latency``: how late this machine wakes a loop up, as cyclictest tells it. No device is touched."""

from __future__ import annotations

import argparse
import math
from pathlib import Path
from typing import Any

from nanotouch import rig_file
from nanotouch.errors import InvalidValue
from nanotouch.plots import new_figure, saved
from nanotouch.units import in_words, parse_quantity

from nanotouch_app.common import output
from nanotouch_app.common.quantity import number, whole_number

SHARE_OF_PERIOD = 0.2
"""a wake-up later than this share of a period is late (docs/session.md)"""


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("latency", description=__doc__)
    add_options(parser)
    parser.add_argument("--out", type=Path, metavar="FILE.png", help="also draw the histogram")
    output.takes_overwrite(parser)


def add_options(parser: argparse.ArgumentParser, rate: str = "1kHz") -> None:
    """The loop that is tried; ``rate`` in words is for the caller to put in."""
    default = rate if rate[0].isdigit() else None
    parser.add_argument("--rate", default=default, metavar="RATE", help=f"of the loop (default: {rate})")
    parser.add_argument(
        "--seconds", type=number(0.01, 86400.0), default=10.0, metavar="S", help="how long (default: 10)"
    )
    parser.add_argument(
        "--priority", type=whole_number(0, 99), default=80, help="of SCHED_FIFO; 0: an ordinary thread (default: 80)"
    )
    parser.add_argument("--processor", type=whole_number(-1, 1023), default=-1, help="to stay on (default: any)")


def measured(args: argparse.Namespace) -> rig_file.Latency:
    """What the loop of these options met."""
    rate = parse_quantity(args.rate, "Hz")
    if not 1.1 <= rate <= 1e6:
        raise InvalidValue(f"--rate {args.rate}: valid is 1.1 Hz .. 1 MHz")
    with output.busy(f"waking up for {args.seconds:g} s"):
        return rig_file.latency(1.0 / rate, args.seconds, priority=args.priority, processor=args.processor)


def tell(found: rig_file.Latency, priority: int) -> None:
    """In words: what was granted, and how late it was."""
    print(f"{found.ticks} wake-ups at {in_words(1.0 / found.period, 'Hz')}, {found.missed} periods lost")
    words = ", ".join(f"p{100.0 * share:g} {in_words(value, 's', 3)}" for share, value in found.quantiles.items())
    print(f"wake-up: {words}, longest {in_words(found.longest, 's', 3)}")
    granted = "priority, locked memory and no deep sleep: granted" if priority else "an ordinary thread, as asked"
    print(found.refused.rstrip() or granted)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.out:
        if args.out.suffix.lower() not in {".png", ".svg", ".pdf"}:
            raise InvalidValue(f"--out {args.out}: the ending must be .png, .svg or .pdf")
        output.check_free(args.out, args)
        if not args.out.absolute().parent.is_dir():  # before the trial, which may take hours
            raise InvalidValue(f"--out {args.out}: there is no folder {args.out.parent}")
    found = measured(args)
    args.answer = found._asdict()
    tell(found, args.priority)
    if args.out:
        draw(found, args.out)
        print(f"histogram: {args.out}")
    return 0


def draw(found: rig_file.Latency, file: Path) -> None:
    """Number of wake-ups over their lateness, both logarithmic, with the fifth of the period that is late."""
    figure = new_figure(7.0, 4.0)
    axes = figure.add_subplot(xscale="log", yscale="log")
    micro = [1e6 * max(edge, 1e-9) for edge in found.edges]
    widths = [2.0 ** max(math.floor(math.log2(1e3 * edge)) - 4, 0) / 1e3 for edge in micro]  # as timing.h has them
    axes.bar(micro, found.counts, widths, align="edge", color="C0")
    axes.axvline(1e6 * SHARE_OF_PERIOD * found.period, color="C3", label="a fifth of the period")
    for share, value in found.quantiles.items():
        if math.isfinite(value):
            axes.axvline(1e6 * value, color="0.7", lw=0.8)
            axes.text(1e6 * value, 1.0, f" p{100.0 * share:g}", rotation=90, va="bottom", fontsize="small")
    axes.set(xlabel="lateness of the wake-up [µs]", ylabel="wake-ups [-]")
    axes.legend()
    saved(figure, file)
