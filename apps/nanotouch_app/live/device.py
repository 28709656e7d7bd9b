# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch live --hand DEVICE``: a haptic device leads the hand over a simulated sample, at wall pace. Its bridge is
started here and ended with the session; pages show the touch, or a window where there is a display, or the terminal."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import nanotouch as nt
import numpy as np
from nanotouch import record
from nanotouch.errors import DeviceError, Error, InvalidValue
from nanotouch.units import in_words

from nanotouch_app.common import output, stop
from nanotouch_app.devices import calibration, guide
from nanotouch_app.devices.launch import Launched, first
from nanotouch_app.devices.table import DEVICES, Device
from nanotouch_app.live import display, shown
from nanotouch_app.live.hands import KINDS
from nanotouch_app.live.subject import Subject

BLOCK, ROWS = 5000, 65536  # rows that are kept at a time; blocks of them that no ring holds
TURN, LINE = 0.02, 1.0  # of the loop; between two lines [s]
FELT = 0.3  # a force that a hand feels [N]
OWN = "a program of your own"
LOST = "device lost"
"""why a session is latched whose mailbox nobody serves any more"""


def is_named(name: str) -> bool:
    """Whether this hand is a haptic device: one of the table, or the mailbox of a program of one's own."""
    return name not in ("auto", "none", *KINDS)


def touch(args: argparse.Namespace, subject: Callable[[], Subject]) -> int:
    """Until the person leaves: Q in the window, Ctrl-C in the terminal."""
    shown.check(args, f"--hand {args.hand} is a haptic device")
    (name, _, option), begun = args.hand.partition(":"), time.monotonic()
    device = DEVICES.get(name)
    if args.calibrate and device is None:
        raise InvalidValue(f"--calibrate: valid for --hand {', '.join(DEVICES)}")
    with ExitStack() as stack:
        bridge = (
            None
            if device is None
            else stack.enter_context(Launched(device, option, found=_calibrated(args, device, option)))
        )
        session = opened(subject(), device, args.hand if bridge is None else bridge.name, args.record is not None)
        stack.callback(session.halt)
        session.publish(f"hand-{os.getpid()}")
        keeps = None if args.record is None else stack.enter_context(record.Writer(args.record, session.metadata()))
        view = _view(session, args)
        if view is not None:
            stack.callback(view.close)
        _say(session, device, view)
        with first():
            session.start("wall")
        with stop.between_blocks() as check:
            try:
                for _ in _turns(session, bridge, view, begun):
                    _keep(session, keeps)
                    check()
            finally:  # whatever ends it: the recording is whole
                session.halt()
                _keep(session, keeps)
                if keeps is not None:
                    keeps.update(session.metadata())
                    keeps.close()
    return 0


def _calibrated(args: argparse.Namespace, device: Device, option: str) -> Path | None:
    """The file of its calibration, made now where that is asked for; None: there is none."""
    path = calibration.path_of(device.name)
    if not (args.calibrate or path.is_file()) and sys.stdin.isatty():
        args.calibrate = input(f"{device.title} is not calibrated. Do it now, 30 s? [y/N] ").strip().lower() == "y"
    if args.calibrate:
        begun = time.monotonic()
        found = guide.calibrate(device, option, lambda step: print(f"  {step}", flush=True))
        calibration.write(path, found)
        output.say(f"calibrated in {time.monotonic() - begun:.0f} s: {guide.words(found)}; kept in {path}")
    elif path.is_file():
        calibration.read(path)  # a file that is none is refused here, not by the bridge
    else:
        output.say("not calibrated, so the middle and the axes are the maker's: --calibrate, 30 s")
        return None
    return path


def opened(subject: Subject, device: Device | None, mailbox: str, recorded: bool) -> nt.Session:
    """A session that this device leads: without a gauge, its force and rate those of the device."""
    rig = subject.rig.copy()
    rig["master.gauge"] = "no"
    gains: Any = {} if device is None else device.lead(rig)
    width, height = subject.topography.size
    try:
        return nt.Session(
            subject.scene, rig, surface=subject.touched(subject.scene), master=nt.hal.Mailbox(mailbox),
            path=[(0.5 * width, 0.5 * height)], relative_accuracy=subject.accuracy, recorded=recorded, gains=gains,
        )  # fmt: skip
    except DeviceError as error:
        if device is not None:
            raise
        raise InvalidValue(
            f"--hand {mailbox}: valid are auto, none, {', '.join((*KINDS, *DEVICES))}, or the mailbox of a program of "
            f"your own that runs (docs/devices.md); there is none: {error}"
        ) from error


def _view(session: nt.Session, args: argparse.Namespace) -> shown.Shown | None:
    """Pages where they are asked for, a window where there is a display; either leads what the device does not."""
    if not args.browser:
        try:
            display.check()
        except Error:
            output.say("no display: the touch is shown here")
            return None
    return shown.Shown(session, args, shown.leads_of(session, by_device=True))


def _say(session: nt.Session, device: Device | None, view: shown.Shown | None) -> None:
    title = OWN if device is None else device.title
    hand = "z, your mouse x and y" if view is not None and view.leads else "the hand"
    leave = "Ctrl-C ends the session" if view is None else view.leave
    print(f"{title}: leads {hand}, at wall pace, for the sample is simulated; {leave}", flush=True)
    for line in filter(None, (session.guarantee().hand, view and view.words)):
        print(line, flush=True)


def _turns(session: nt.Session, bridge: Launched | None, view: shown.Shown | None, begun: float) -> Iterator[None]:
    """Look after the bridge and show the force, until somebody leaves; each turn leaves time for what else is to do."""
    with nt.frames.attach(session._name) as frames:
        is_felt, due = False, 0.0
        while view is None or view.is_open():
            since = frames.read()
            if len(since):
                frame = since[-1]
                if not is_felt and np.abs(since["motor_force"][:, 2]).max() > FELT:
                    is_felt = True
                    print(f"first force on the hand {time.monotonic() - begun:.1f} s after the command", flush=True)
                if view is None and time.monotonic() > due:
                    due = time.monotonic() + LINE
                    print(line(frame, session), flush=True)
            yield
            _check(session, bridge)
            time.sleep(TURN)


def line(frame: Any, session: nt.Session) -> str:
    """What is felt, for the terminal."""
    hand, tip = float(frame["motor_force"][2]), float(frame["tip_force"][2])
    why = "" if session.state == "RUN" else f"  ({', '.join(session.reasons)})"
    return f"{float(frame['time']):8.1f} s  {session.state:8} hand {hand:+.2f} N  tip {in_words(tip, 'N', 3)}{why}"


def _keep(session: nt.Session, keeps: Any) -> None:
    """What was recorded so far; of a session that runs a second of it, for it may come faster than it is kept."""
    blocks = 2 if session.progress.runs else ROWS
    for _ in range(blocks if keeps is not None else 0):
        block = session.read(BLOCK)
        if not len(block["time"]):
            return
        keeps.append(block)


def _check(session: nt.Session, bridge: Launched | None) -> None:
    """An error where the device is lost for good: its force has faded, and the recording is kept."""
    if not session.progress.runs:
        raise DeviceError(f"the session has ended: {session.progress.status}")
    if bridge is not None and bridge.ended:
        raise DeviceError(f"{bridge.ended}; its force is gone. Start the command again")
    if session.state == "LATCHED" and LOST in session.reasons:
        if bridge is not None:  # it hangs
            bridge.process.kill()
        raise DeviceError(
            "the program of the device does not answer any more; its force is gone. Start the command again"
        )
