# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch rig``: is a rig file whole, does this machine keep its rate, and what are its numbers?

Only calibrate moves anything. allow lets a rig file load the shared object that it names.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import nanotouch as nt
from nanotouch import rig_file
from nanotouch.errors import InvalidValue
from nanotouch.scene import read_tables
from nanotouch.touch import allowed_code
from nanotouch.units import in_words

from nanotouch_app.common import scenes
from nanotouch_app.rigs import calibrate, latency


def add_parser(subparsers: Any) -> None:
    """Register the sub-command."""
    parser: argparse.ArgumentParser = subparsers.add_parser("rig", description=__doc__)
    jobs = parser.add_subparsers(dest="job", required=True, metavar="JOB")
    for job, words in (
        ("check", "read the file: everything must be there and fit its chips; no device is touched"),
        (
            "allow",
            "let the file load the shared object that it names as it is now, until that changes; nothing is loaded",
        ),
        ("probe", "time the frames of its devices and the wake-up of a loop; exit status 1 if the rate is not kept"),
    ):
        one = jobs.add_parser(job, help=words, description=words)
        one.add_argument("file", type=Path, metavar="RIG.toml")
        if job == "probe":
            latency.add_options(one, "that of the session that the file describes")
    words = "drive the rig and fit its numbers, with their uncertainties"
    one = jobs.add_parser("calibrate", help=words, description=words)
    one.add_argument("file", type=Path, metavar="RIG.toml")
    scenes.add_allow_code(one)
    calibrate.add_options(one)


def run(args: argparse.Namespace) -> int:
    """Run the sub-command."""
    if args.job == "calibrate":
        found = rig_file.read(args.file, allow_code=args.allow_code)
    else:
        found = rig_file.described(read_tables(args.file), args.file.parent)
    nt.Scene.from_tables(found.rig)
    settings = nt.Settings.for_rig(nt.Rig.from_tables(found.rig))
    settings.update_from_tables(found.rig)
    halves = {"master": found.master, "slave": found.slave}
    args.answer = {name: _told(half) for name, half in halves.items()}
    for name, half in halves.items():
        allowed = not isinstance(half, nt.hal.SharedObject) or allowed_code.is_allowed(args.file, half)
        print(f"{name}: {_told(half)}" + ("" if allowed else f", not allowed yet: nanotouch rig allow {args.file}"))
    if args.job == "calibrate":
        return calibrate.run(args, found)
    if args.job == "allow":
        return _allow(args, halves)
    if args.job == "check":
        return 0
    if args.rate is None:
        args.rate = f"{settings.gains.rate:.17g}Hz"
    return _probe(args, halves)


def _told(half: rig_file.RealHalf | None) -> str:
    if half is None:
        return "simulated"
    if isinstance(half, nt.hal.Mailbox):
        return f"the program with the mailbox {half.name}"
    if isinstance(half, nt.hal.SharedObject):
        return f"the shared object {half.path}"
    chips = ", ".join(f"{chip['chip']} at {chip['device']}" for chip in half.setup["chips"])
    oldest = min(half.calibrated.values())
    return f"{chips}; {len(half.calibrated)} channels, calibrated {oldest} or later"


def _allow(args: argparse.Namespace, halves: dict[str, rig_file.RealHalf | None]) -> int:
    """Remember the shared objects of the file as they are now."""
    named = {name: half for name, half in halves.items() if isinstance(half, nt.hal.SharedObject)}
    if not named:
        raise InvalidValue(f"{args.file} names no shared object: there is nothing to allow")
    for name, half in named.items():
        print(f"{name}: allowed, SHA-256 {allowed_code.remember(args.file, half, name)}")
    return 0


def _probe(args: argparse.Namespace, halves: dict[str, rig_file.RealHalf | None]) -> int:
    frames = 0.0
    for half in halves.values():
        if not isinstance(half, rig_file.Converters):
            continue
        driven = [axis["converter"] for axis in half.setup["driven"] if axis]
        for i, (chip, times) in enumerate(zip(half.setup["chips"], rig_file.frame_times(half), strict=True)):
            print(f"{chip['chip']}: a frame p50 {in_words(times.median, 's', 3)}, p99.9 {in_words(times.late, 's', 3)}")
            frames += (1 + 2 * driven.count(i)) * times.late  # each output is written and asked for
    met = latency.measured(args)
    latency.tell(met, args.priority)
    late = met.quantiles[0.999]
    share = latency.SHARE_OF_PERIOD * met.period
    kept = late <= share and met.missed == 0 and late + frames <= met.period
    reasons = [
        *([f"p99.9 of the wake-up is above a fifth of the period, {in_words(share, 's', 3)}"] if late > share else []),
        *([f"{met.missed} periods were lost"] if met.missed else []),
        *(["wake-up and frames do not fit into a period"] if late + frames > met.period else []),
    ]
    args.answer |= {"rate": args.rate, "kept": kept, "reasons": reasons, "latency": met._asdict()}
    print(f"{in_words(1.0 / met.period, 'Hz')}: " + ("kept" if kept else "not kept: " + "; ".join(reasons)))
    return 0 if kept else 1
