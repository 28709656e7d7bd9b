# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch live RIG.toml``: a session on the real halves that a rig file names, at the pace that these ask for. A
window or pages show it, and lead the hand where no device does."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

import nanotouch as nt
from nanotouch import record, rig_file
from nanotouch.scene import read_tables
from nanotouch.touch.options import PACE_REASONS
from nanotouch.touch.session import settings_for_path

from nanotouch_app.common import stop
from nanotouch_app.live import display, shown

BLOCK, TURN = 5000, 0.05  # rows at once; between two looks at the view [s]
MOUSE = {"motor": False, "gauge": False}  # of a hand that is led by a window: nothing pushes it


def is_named(what: str) -> bool:
    """Whether this is a rig file with a real half."""
    path = Path(what)
    return path.suffix.lower() == ".toml" and path.is_file() and rig_file.is_real(read_tables(path))


def touch(args: argparse.Namespace) -> int:
    """Until the person leaves: Q in the window, Ctrl-C in the terminal."""
    shown.check(args, f"{args.what} names a real half", "radius", "spring_constant")
    path = Path(args.what)
    file = rig_file.read(path, allow_code=args.allow_code)
    if not args.browser:
        display.check()
    session, is_led = opened(file, path.parent, args.record is not None)
    leads = shown.leads_of(session, by_device=not is_led)
    view = shown.Shown(session, args, leads)
    try:
        session.start()
        hand = {True: "your mouse leads the hand", "sideways": "its device leads z, your mouse x and y",
                False: "its device leads the hand, the view watches"}[leads]  # fmt: skip
        pace = PACE_REASONS["hard" if session.pace == "hard" else "wall"]
        print(f"{path.name}: {pace}; {hand}; {view.leave}", flush=True)
        for line in filter(None, (session.guarantee().hand, view.words)):
            print(line, flush=True)
        with stop.between_blocks() as check:
            _kept(session, view, args.record, check)
    finally:
        session.halt()
        view.close()
    return 0


def _kept(session: nt.Session, view: shown.Shown, path: str | None, check: Callable[[], None]) -> None:
    """Until the person has left; meanwhile what happens is kept, the last of it after the halt."""
    with ExitStack() as stack:
        writer = None if path is None else stack.enter_context(record.Writer(path, session.metadata()))
        try:
            while view.is_open():
                check()
                if not _drain(session, writer):
                    time.sleep(TURN)
        finally:
            session.halt()
            while _drain(session, writer):
                pass
            if writer is not None:
                writer.update(session.metadata())


def _drain(session: nt.Session, writer: record.Writer | None) -> bool:
    """Whether there was something."""
    if writer is None:
        return False
    block = session.read(BLOCK)
    if len(block["time"]):
        writer.append(block)
    return len(block["time"]) > 0


def opened(file: rig_file.RigFile, folder: Path, recorded: bool = False) -> tuple[nt.Session, bool]:
    """The session, and whether a window has to lead its hand."""
    leads = file.master is None
    scene, rig = nt.Scene.from_tables(file.rig), nt.Rig.from_tables(file.rig)
    if leads:
        for name, value in MOUSE.items():
            if name not in file.rig.get("master", {}):
                rig[f"master.{name}"] = value
    named = nt.SurfaceFile.from_tables(file.rig, folder)
    surface = None if named is None else named.touched_by(scene)
    settings = None
    if file.rig.keys() & set(nt.Settings.sections()):
        relief = 0.0 if surface is None else surface.topography.height_range
        settings = settings_for_path(rig, relief, load=float(scene.range.maximum_load))
        settings.update_from_tables(file.rig)
    session = nt.Session(scene, rig, surface=surface, settings=settings, master=file.master, slave=file.slave,
                         recorded=recorded)  # fmt: skip
    return session, leads
