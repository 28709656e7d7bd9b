# SPDX-License-Identifier: BSD-3-Clause
"""A scan on the real slave of a rig file: a session's height servo holds the force, or the amplitude of a tap."""

from __future__ import annotations

import argparse
import math
from typing import Any

import nanotouch as nt
from nanotouch.errors import InvalidValue
from nanotouch.units import in_words

from nanotouch_app.common import output, scenes, stop
from nanotouch_app.common.quantity import parse_quantity

PEAK = 0.1  # accuracy of the peak force that is told
LINES = 16  # of the raster that tell the relief, if a surface is named
LEAST_QUALITY = 10.0  # of a lever that is simulated
SETTLES = 2.0  # time constants of the height servo in a pixel, where no line rate is given


def is_named(args: argparse.Namespace) -> bool:
    """Whether the scene is a rig file whose slave is real."""
    return scenes.is_real(args.scene)


def mode(args: argparse.Namespace, tables: dict[str, Any]) -> str:
    """Contact, or tapping or phase where the slave has a lock-in amplifier."""
    asked = str(args.mode or tables.get("zloop", {}).get("mode", "contact"))
    if asked not in nt.raster.MODES:
        raise InvalidValue(f"--mode {asked}: a rig file's probe scans with {' or '.join(nt.raster.MODES)}")
    slave = scenes.real_halves(args.scene, args.allow_code)["slave"]
    if asked != "contact" and isinstance(slave, nt.rig_file.Converters) and not any(slave.setup["lock_in"]):
        raise InvalidValue(
            f"{args.scene} has no [slave.amplitude] and [slave.lag]: without a lock-in amplifier its probe scans with "
            "--mode contact (docs/hardware.md)"
        )
    if asked == "contact" and args.free_amplitude is not None:
        raise InvalidValue("--free-amplitude goes with --mode tapping or phase")
    if args.steady is not None:
        raise InvalidValue("--steady: an image of the simulated scanner; a real probe scans in time")
    return asked


def _take_tap(wanted: nt.Settings, settings: nt.Scan, drive: nt.Drive, tables: dict[str, Any]) -> None:
    """What [drive] and [zloop] say, and the options, into the settings of the session."""
    for name in ("at", "frequency", "free_amplitude"):
        wanted[f"tap.{name}"] = drive[f"drive.{name}"]
    wanted["tap.set_amplitude"] = settings["zloop.set_amplitude"]
    wanted["tap.set_phase"] = settings["zloop.set_phase"]
    wanted["tap.hold"] = "phase" if settings.zloop.mode == "phase" else "amplitude"
    for name in ("lock_in", "noise"):
        if any(key.startswith(name) for key in tables.get("zloop", {})):
            wanted[f"tap.{name}"] = settings[f"zloop.{name}"]


def _with_margin(scene: nt.Scene, rig: nt.Rig, wanted: nt.Settings, what: dict[str, Any]) -> float:
    """The K_I that nobody has named: the usual one, or what leaves a margin of 2 on this lever and stage."""
    usual = float(wanted.gains.height_gain)
    if rig["probe.quality"] < LEAST_QUALITY:
        return usual
    simulated = nt.Session(scene, rig, settings=wanted, mode="tapping", minimum_margin=0.0, **what)
    return min(usual, float(f"{0.5 * usual * simulated.stability_margin:.2g}"))


def opened(
    args: argparse.Namespace, settings: nt.Scan, drive: nt.Drive, surface: nt.Surface | None, rate: float | None
) -> nt.Session:
    """The session that scans, armed; sets the line rate. ``rate``: that somebody gave [Hz]."""
    scene, rig, tables = scenes.read(args.scene)
    raster = settings.raster
    lines = (raster.y + raster.height * line / (LINES - 1) for line in range(LINES))
    path = [(x, y) for y in lines for x in (raster.x, raster.x + raster.width)]
    what: dict[str, Any] = {"surface": surface, "path": path}
    wanted = nt.Session(scene, rig, minimum_margin=0.0, mode="topography", **what).settings.copy()
    wanted.update_from_tables(tables)
    taps = settings.zloop.mode != "contact"
    if taps:
        _take_tap(wanted, settings, drive, tables)
    else:
        wanted.gains.set_point = settings.zloop.set_force
    if args.gain is not None:
        wanted.gains.height_gain = parse_quantity(args.gain, "Hz")
    elif taps and not any(key.startswith("height_gain") for key in tables.get("gains", {})):
        wanted.gains.height_gain = _with_margin(scene, rig, wanted, what)
    servo = float(wanted.gains.height_gain)
    if not servo > 0.0:
        raise InvalidValue(f"K_I = {servo:g}/s of the height servo (--gain, gains.height_gain): valid is above 0/s")
    raster.line_rate = rate if rate is not None else float(f"{servo / (2.0 * SETTLES * raster.pixels):.2g}")
    mode = nt.raster.MODES[str(settings.zloop.mode)]
    session = nt.Session(
        scene, rig, settings=wanted, mode=mode, **what, **scenes.real_halves(args.scene, args.allow_code)
    )
    promised = in_words(session.guarantee().force, "N", 4)
    if taps:
        _say_tapping(session, drive, promised, servo)
    else:
        held = in_words(wanted.gains.set_point, "N", 4)
        output.say(f"promised {promised} at most on the sample; it is held at {held}, with K_I = {servo:.3g}/s")
    return session


def _say_tapping(session: nt.Session, drive: nt.Drive, promised: str, servo: float) -> None:
    """What is held, and the peak force of a tap, which is told by the scene alone."""
    steady = nt.Steady(session.plan, session.rig, drive, accuracy=PEAK)
    if session.settings.tap.hold == "phase":
        held = f"a phase of {math.degrees(session.settings['tap.set_phase']):.3g} degrees"
        motion = steady.at_phase(session.settings["tap.set_phase"])
    else:
        amplitude = session.settings["tap.set_amplitude"] * session.settings["tap.free_amplitude"]
        held, motion = f"an amplitude of {in_words(amplitude, 'm', 4)}", steady.at_amplitude(amplitude)
    output.say(
        f"promised {promised} at most on the sample, as a mean over many taps; {held} is held, with K_I = {servo:.3g}/s"
    )
    if motion is None:
        output.say("no motion of this set point repeats in this scene: its peak force is not known")
    else:
        output.say(f"each tap presses with {in_words(motion.peak_force, 'N', 3)} in this scene; nothing measures it")


def taken(session: nt.Session, settings: nt.Scan) -> tuple[nt.scan.Image, list[int]]:
    """The image, and the signals that ended it, if any did. The session ends with it, and close lifts the tip."""
    with stop.asked() as signals, output.progress_bar("scanning") as progress:

        def after_block(done: float) -> bool:
            progress(done)
            return not signals

        image = nt.raster.image(session, settings, after_block)
    return image, signals
