# SPDX-License-Identifier: BSD-3-Clause
"""``nanotouch live RIG.toml``: a session on the real halves that a rig file names, at the pace that these ask for. A
window shows it, and leads the hand where no device does."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from subprocess import Popen
from typing import Any

import nanotouch as nt
from nanotouch import record, rig_file
from nanotouch.errors import Error, InvalidValue
from nanotouch.scene import read_tables
from nanotouch.touch.options import PACE_REASONS
from nanotouch.touch.session import settings_for_path

from nanotouch_app.live import display

USELESS = ("task", "film", "browser", "port", "page", "radius", "spring_constant", "dark")
BLOCK, TURN = 5000, 0.05  # rows at once; between two looks at the window [s]
MOUSE = {"motor": False, "gauge": False}  # of a hand that is led by a window: nothing pushes it


def is_named(what: str) -> bool:
    """Whether this is a rig file with a real half."""
    path = Path(what)
    return path.suffix.lower() == ".toml" and path.is_file() and rig_file.is_real(read_tables(path))


def touch(args: argparse.Namespace) -> int:
    """Until the person leaves: Q in the window, Ctrl-C in the terminal."""
    useless = [f"--{name.replace('_', '-')}" for name in USELESS if getattr(args, name) not in (None, False)]
    if useless:
        raise InvalidValue(f"{args.what} names a real half: {' and '.join(useless)} cannot be used with it")
    path = Path(args.what)
    file = rig_file.read(path, allow_code=args.allow_code)
    display.check()
    session, leads = opened(file, path.parent, args.record is not None)
    sideways = not leads and session.rig.master.axes == 1.0 and session.rig.stage.axes == 3.0
    window = session.live(hand="sideways" if sideways else leads)
    try:
        session.start()
        hand = ("your mouse leads the hand" if leads else "its device leads z, your mouse x and y" if sideways
                else "its device leads the hand, the window watches")  # fmt: skip
        pace = PACE_REASONS["hard" if session.pace == "hard" else "wall"]
        print(f"{path.name}: {pace}; {hand}; Q in the window leaves, Escape stops", flush=True)
        print(session.guarantee().hand, flush=True)
        if _kept(session, window, args.record):
            raise Error("the window has died; the session has ended in order")
    finally:
        session.halt()
        _end(window)
    return 0


def _kept(session: nt.Session, window: Popen[Any], path: str | None) -> int:
    """Until the window has gone, what it ended with; meanwhile what happens is kept, the last of it after the halt."""
    if path is None:
        return window.wait()
    with record.Writer(path, session.metadata()) as writer:
        try:
            while window.poll() is None:
                if not _drain(session, writer):
                    time.sleep(TURN)
        finally:
            session.halt()
            while _drain(session, writer):
                pass
            writer.update(session.metadata())
    return int(window.returncode)


def _drain(session: nt.Session, writer: record.Writer) -> bool:
    """Whether there was something."""
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


def _end(window: Popen[Any]) -> None:
    """It leaves when its input ends."""
    if window.poll() is None and window.stdin is not None:
        window.stdin.close()
        window.wait(5.0)
